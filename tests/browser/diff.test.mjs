// The page of two pictures that `diff --html` writes, beside what the run's own page shows of them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { colours, folderOf, openViewer, pageOf, runProgram, settle } from "./support.mjs";

const compare = (name, words) => {
  const folder = folderOf(name), { status, stderr } = runProgram(["diff", ...words, "--html", folder]);
  assert.equal(status, 0, stderr);
  return pageOf(name);
};
const cubes = (part) => `${pageOf("several", "cubes.exr")}#${part}`;

test("Mask_HatchesWhatTheRunDoes", async () => {
  const mask = ["--mask", cubes("truth.mask")], pictures = [cubes("none.visibility"), cubes("truth.area")];
  const seen = [];
  for (const file of [pageOf("several"), compare("masked", [...pictures, ...mask]), compare("unmasked", pictures)]) {
    const both = file === pageOf("several") ? "cubes,truth,none" : `both,truth,${encodeURIComponent(pictures[0])}`;
    const { page, messages, shoot, close } = await openViewer(file, { hash: `#view=${both},error,side,0,0,1` });
    await settle(page);
    seen.push({ colours: await colours(page, 1), said: await page.locator(".viewer .scale").textContent() });
    await shoot("diff_" + seen.length);
    assert.deepEqual(messages, []);
    await close();
  }
  const [run, masked, unmasked] = seen;
  assert.ok(run.colours["156,156,156"] > 1000);
  for (const colour of ["156,156,156", "168,168,168", "189,23,33", "23,79,168"])
    assert.ok(Math.abs(masked.colours[colour] / run.colours[colour] - 1) < 0.02, colour);
  assert.equal(unmasked.colours["156,156,156"], undefined);
  assert.match(masked.said, /hatched: left out by the mask/);
});

// A grey picture of floats, rows from the bottom up (Portable FloatMap).
const writePicture = (name, values) => {
  const file = join(folderOf("several"), name + ".pfm");
  writeFileSync(file, Buffer.concat([Buffer.from("Pf\n32 16\n-1.0\n"), Buffer.from(Float32Array.from({ length: 512 }, (_, i) => values(i % 32, 15 - (i >> 5))).buffer)]));
  return file;
};

test("LargeAndTinyValues_AreSaidAndDrawn", async () => {
  for (const [name, unit, expected, most] of [["large", 1000, ["812.500", "0.008"], "484"], ["tiny", 1e-5, ["0.00000813", "0.00000500"], "0.00000484"]]) {
    const small = unit === 1000 ? 0.008 : 5e-6;
    const first = writePicture(name + "_first", (x, y) => (y < 8 ? (unit * x) / 32 : small)), second = writePicture(name + "_second", (x, y) => (y < 8 ? (unit * x) / 64 : small));
    const { page, messages, shoot, close } = await openViewer(compare(name, [first, second]), { hash: `#view=both,truth,${encodeURIComponent(first)},error,side,0,0,1` });
    await page.waitForSelector(".viewer .strip button canvas");
    const box = await page.locator(".viewer .panes canvas").first().boundingBox();
    for (const [i, y] of [3, 12].entries()) {
      await page.mouse.move(box.x + (26.5 / 32) * box.width, box.y + ((y + 0.5) / 16) * box.height);
      assert.equal(await page.locator(".viewer tbody tr").nth(1).locator("td").first().textContent(), expected[i]);
    }
    assert.ok(Object.keys(await colours(page, 1)).length > 10, "the difference has colours");
    assert.ok((await page.locator(".viewer figcaption").nth(1).textContent()).endsWith(`, 0 to +${most}`), "the pane says how far its values go");
    assert.match(await page.locator(".viewer .scale").textContent(), /^Error .*darker than the truth.*lighter than the truth/);
    await shoot("diff_" + name);
    assert.deepEqual(messages, []);
    await close();
  }
});
