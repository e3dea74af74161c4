// What a browser makes of a page's charts: no text lies over another, names hide curves, and both buttons save a file.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { kNarrow, kWide, listOverlaps, open, pageOf, readPng, testPage } from "./support.mjs";

for (const [name, viewport] of [["wide", kWide], ["narrow", kNarrow]])
  testPage(`Charts_AnswerToThePointer_AndAreSaved: ${name}`, () => open(pageOf("bias", "bias.html"), { viewport, waits: false }), async ({ page }) => {
    const figure = page.locator("figure.chart").first(), svg = figure.locator("svg").first(), marks = svg.locator("path[transform]");
    await svg.scrollIntoViewIfNeeded();
    for (const each of await page.locator(".holder svg").all()) {
      assert.deepEqual(await listOverlaps(each), []);
      assert.deepEqual(await each.evaluate((chart) => {
        const { width, height } = chart.viewBox.baseVal, isOut = (p) => p.x < -1 || p.x + p.width > width + 1 || p.y < -1 || p.y + p.height > height + 1;
        return [...chart.querySelectorAll("text")].filter((text) => isOut(text.getBBox())).map((text) => text.textContent);
      }), [], "texts that leave the chart");
    }
    await marks.first().hover({ force: true });
    assert.notEqual(await figure.locator(".tip:visible").textContent(), "");
    const before = await marks.count();
    await figure.locator(".key").first().click();
    assert.ok((await marks.count()) < before);
    await figure.locator(".key").first().click();
    assert.equal(await marks.count(), before);
    const save = async (title) => {
      const [download] = await Promise.all([page.waitForEvent("download"), figure.getByRole("button", { name: title }).click()]);
      return readFileSync(await download.path());
    };
    assert.match((await save("SVG")).toString(), /^<svg [^]*<path [^>]*transform[^]*<\/svg>\s*$/);
    const { width, data } = readPng(await save("PNG"));
    assert.ok(width > 1000 && data[0] === 255 && new Set(data).size > 10, "not a white sheet");
  });

testPage("CurvesThatSayLeast_AreHidden_UntilTheirNamesAreClicked", () => open(pageOf("stress", "stress.html"), { waits: false }), async ({ page }) => {
  const figure = page.locator("figure.chart", { has: page.locator('.key[opacity="0.3"]') }).first(), marks = figure.locator("svg path");
  const hidden = figure.locator('.key[opacity="0.3"]'), [before, count] = [await marks.count(), await hidden.count()];
  await hidden.first().click();
  assert.equal(await hidden.count(), count - 1);
  assert.ok((await marks.count()) > before);
});
