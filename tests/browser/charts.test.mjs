// What a browser makes of a page's charts: no text lies over another, names hide curves, and both buttons save a file.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { kNarrow, kWide, open, pageOf, readPng } from "./support.mjs";

for (const [name, viewport] of [["wide", kWide], ["narrow", kNarrow]])
  test(`Charts_AnswerToThePointer_AndAreSaved: ${name}`, async () => {
    const { page, messages, shoot, close } = await open(pageOf("bias", "bias.html"), { viewport, waits: false });
    const figure = page.locator("figure.chart").first(), svg = figure.locator("svg").first(), marks = svg.locator("path[transform]");
    await svg.scrollIntoViewIfNeeded();
    const overlaps = await page.locator(".holder svg").evaluateAll((all) => all.flatMap((each) => {
      const size = each.viewBox.baseVal, boxes = [...each.querySelectorAll("text")].map((text) => [text.textContent, text.getBBox()]);
      const isOut = (p) => p.x < -1 || p.x + p.width > size.width + 1 || p.y < -1 || p.y + p.height > size.height + 1;
      const isOver = (p, q) => p.x + 1 < q.x + q.width && q.x + 1 < p.x + p.width && p.y + 4 < q.y + q.height && q.y + 4 < p.y + p.height;
      return boxes.flatMap(([a, p], i) => (isOut(p) ? [`${a} leaves the chart`] : boxes.slice(i + 1).filter(([, q]) => isOver(p, q)).map(([b]) => `${a} over ${b}`)));
    }));
    assert.deepEqual(overlaps, []);
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
    const { width, pixels } = readPng(await save("PNG"));
    assert.ok(width > 1000 && pixels[0] === 255 && new Set(pixels).size > 10, "not a white sheet");
    await shoot(`charts.${name}`);
    assert.deepEqual(messages, []);
    await close();
  });

test("CurvesThatSayLeast_AreHidden_UntilTheirNamesAreClicked", async () => {
  const { page, close } = await open(pageOf("stress", "stress.html"), { waits: false });
  const figure = page.locator("figure.chart", { has: page.locator('.key[opacity="0.3"]') }).first(), marks = figure.locator("svg path");
  const hidden = figure.locator('.key[opacity="0.3"]'), [before, count] = [await marks.count(), await hidden.count()];
  await hidden.first().click();
  assert.equal(await hidden.count(), count - 1);
  assert.ok((await marks.count()) > before);
  await close();
});
