// The page of two pictures that `diff --html` writes, beside what the run's own page shows of them.
import assert from "node:assert/strict";
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
  assert.deepEqual(masked.colours, run.colours);
  assert.equal(unmasked.colours["156,156,156"], undefined);
  assert.match(masked.said, /hatched: left out by the mask/);
});
