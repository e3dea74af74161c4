// The section that draws with WebGL 2 where there is much to draw.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { compareShots, keepTime, openLive, press, readTable } from "./live_support.mjs";
import { dragOver, kNarrow, kWide, measureOverflow, pageOf, pick, settle, testPage } from "./support.mjs";

const kMostSeconds = 10;

testPage("APageOfManyConfigurations_DrawsSoon", () => openLive(pageOf("hundreds"), { viewport: kNarrow }), async ({ page, data }, context) => {
  const since = async (begin, what) => {
    const seconds = (Date.now() - begin) / 1000;
    context.diagnostic(`${labels.length} configurations: ${what} after ${seconds} s`);
    return seconds;
  };
  const begin = Date.now(), labels = data.configurations.map(({ label }) => label);
  assert.equal(labels.length, 400);
  const isDrawn = (name) => page.waitForFunction((right) => {
    const canvas = document.querySelector(".live-stage canvas");
    return canvas.width > 1 && canvas.getAttribute("aria-label")?.includes(`right ${right},`);
  }, name);
  await isDrawn(labels[0]);
  assert.ok((await since(begin, "both sides are drawn")) < kMostSeconds);
  const chosen = Date.now();
  await pick(page, "Right", { label: labels.at(-1) }, ".live");
  await isDrawn(labels.at(-1));
  assert.ok((await since(chosen, "another filter is drawn")) < kMostSeconds);
  const checked = Date.now();
  await press(page, "Check against the run");
  await since(checked, "all are checked");
  const rows = await readTable(page);
  assert.deepEqual(rows.map(([label]) => label), labels);
  for (const [label, rmse] of rows) assert.match(rmse, /^[\d.e-]+$/, label);
  for (const viewport of [kNarrow, kWide]) {
    await page.setViewportSize(viewport);
    assert.ok((await measureOverflow(page)) <= 0, `${viewport.width}`);
  }
});

testPage("AVeryLargeScene_TravelsAsReceiversAndMap", () => openLive(pageOf("waves"), { init: keepTime }), async ({ page, data }, context) => {
  const label = data.configurations[1].label;
  const settled = async () => {
    await settle(page);
    return page.locator(".live-stage canvas").evaluate((canvas) => canvas.toDataURL());
  };
  await pick(page, "Right", { label }, ".live");
  await page.locator(".live-stage input").fill("0");
  const before = await settled(), own = data.cells.find(({ configuration }) => configuration === 1);
  const gap = compareShots([Buffer.from(before.split(",")[1], "base64"), readFileSync(pageOf("waves", decodeURI(own.picture)))]);
  context.diagnostic(`the picture differs from the run's by ${gap.mean} of 255`);
  assert.ok(gap.mean < 0.1, JSON.stringify(gap));
  // View and light stay; parameters do not.
  await dragOver(page.locator(".live-stage canvas"), [100, 60], [60, 0]);
  await page.waitForFunction(() => document.querySelector(".live").textContent.includes("Camera and light cannot move: the scene has more triangles"));
  assert.equal(await settled(), before);
  await page.locator(".live").getByRole("button", { name: "As it was" }).click();
  assert.equal(await settled(), before);
  await press(page, "Time on this GPU");
  for (const [filter, same, , all, time] of await readTable(page)) assert.ok(Number(same) < 1e-3 && same === all && time !== "", `${filter}: ${same}, ${all}, ${time}`);
  await page.locator("select[name=cost]").selectOption({ label: "static light, this GPU" });
  assert.ok((await page.evaluate(() => shadowbench.answer.judge().keeping.length)) > 0);
});
