// The section that draws with WebGL 2 where there is much to draw, and where something is missing.
import assert from "node:assert/strict";
import test from "node:test";
import { kMesa, openLive, press, readTable, withBrowser } from "./live_support.mjs";
import { kNarrow, kWide, listViolations, measureOverflow, open, pageOf, pick, readData } from "./support.mjs";

const kMostSeconds = 10;

for (const [run, count] of [["forty", 40], ["hundreds", 400]])
  test(`APageOf_${count}_Configurations`, (context) => withBrowser(kMesa, async (browser) => {
    const { page, messages, shoot, close } = await openLive(pageOf(run), browser, { viewport: kNarrow });
    const since = async (begin, what) => {
      const seconds = (Date.now() - begin) / 1000;
      context.diagnostic(`${count} configurations: ${what} after ${seconds} s`);
      return seconds;
    };
    const begin = Date.now(), labels = (await readData(page)).configurations.map(({ label }) => label);
    assert.equal(labels.length, count);
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
    await shoot(`live.${run}`);
    if (count < 100) assert.deepEqual(await listViolations(page), []);
    assert.deepEqual(messages, []);
    await close();
  }));

// In a page before its scripts: the browser draws into no floats.
const lackFloats = () => {
  const { getExtension } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.getExtension = function (name) { return name === "EXT_color_buffer_float" ? null : getExtension.call(this, name); };
};
test("WithoutTargetsOfFloats_ThePageSaysSo_AndGoesOn", () => withBrowser(kMesa, async (browser) => {
  const { page, messages, close } = await open(pageOf("several"), { browser, init: lackFloats });
  const says = (place) => page.waitForFunction((where) => document.querySelector(where).textContent.includes("lacks EXT_color_buffer_float"), place);
  await page.locator("#live").evaluate((section) => section.scrollIntoView());
  await says(".live");
  assert.equal(await page.locator(".live canvas").count(), 0);
  await page.locator(".answer").getByRole("button", { name: "Live" }).click();
  await says(".answer .split p.note");
  await page.locator("select[name=cost]").selectOption({ label: "this GPU (measure)" });
  await says(".answer form");
  // The rest of the page works.
  await page.locator(".picks button").last().click();
  assert.ok(await page.locator(".stage img").first().isVisible());
  await pick(page, "Right", { index: 3 });
  assert.deepEqual(messages, []);
  await close();
}));
