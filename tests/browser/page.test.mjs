// What holds for a run's page as a whole: its length, paper, charts and the time to open.
import assert from "node:assert/strict";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { changePage, kNarrow, kWide, multiply, open, openRun, openViewer, pageOf, readData, settle } from "./support.mjs";

const kRunPages = ["several", "odd", "untrue", "single"];
const kMostWords = 1500, kChoiceAbove = 600, kMostPaper = 2, kMostOpenSeconds = 10;
const countPaper = (pdf) => pdf.toString("latin1").match(/\/Type\s*\/Page\b(?!s)/g).length;

test("TheDefaultPage_IsShort_AndBeginsWithItsAnswer", async (context) => {
  for (const run of kRunPages) {
    const { page, close } = await openRun(run);
    const words = (await page.evaluate(() => document.body.innerText)).split(/\s+/).filter(Boolean).length;
    const bottom = await page.locator(".choice").evaluate((each) => each.getBoundingClientRect().bottom);
    context.diagnostic(`${run}: ${words} words; the answer ends at ${Math.round(bottom)} px`);
    assert.ok(words <= kMostWords, `${run}: ${words} words`);
    assert.ok(bottom > 0 && bottom < kChoiceAbove, `${run}: ${bottom} px`);
    await close();
  }
});

test("TheReasons_HaveRoom_OnEveryScreen", async () => {
  for (const viewport of [kWide, { width: 820, height: 1000 }, kNarrow]) {
    const { page, close } = await openRun("several", { viewport });
    await page.waitForSelector(".worst canvas");
    const { width } = await page.locator(".choice + ul").boundingBox();
    assert.ok(width > 0.5 * viewport.width, `${width} of ${viewport.width} px`);
    const sizes = await page.locator(".worst canvas").evaluateAll((all) => all.map((each) => [each.clientWidth, each.clientHeight].join()));
    assert.equal(sizes[0], sizes[1], "truth and filter are drawn in one size");
    await close();
  }
});

test("Paper_TakesTwoPages_HoweverManyConfigurations", async (context) => {
  const many = changePage("several", "paper.html", (data) => multiply(data, 300));
  for (const file of [...kRunPages.map((run) => pageOf(run)), many]) {
    const { page, close } = await open(file);
    await settle(page);
    const count = countPaper(await page.pdf());
    context.diagnostic(`${file.split("/").slice(-2).join("/")}: ${count} pages`);
    assert.ok(count <= kMostPaper, `${file}: ${count} pages`);
    await close();
  }
});

test("APageOfTwoHundredCells_OpensSoon", async (context) => {
  const file = changePage("several", "cells.html", (data) => multiply(data, 100));
  const { page, messages, close } = await open(file, { waits: false }), data = await readData(page);
  assert.equal(data.cells.length, 200);
  const times = [];
  for (let i = 0; i < 3; ++i) {
    const begin = Date.now();
    await page.goto(pathToFileURL(file).href + `#${i}`);
    await page.reload();
    await page.waitForFunction(() => document.querySelector(".choice")?.textContent && document.querySelectorAll(".numbers tbody tr").length === 100);
    times.push((Date.now() - begin) / 1000);
  }
  context.diagnostic(`200 cells open in ${times.map((time) => time.toFixed(2)).join(", ")} s`);
  assert.ok(Math.min(...times) < kMostOpenSeconds);
  assert.deepEqual(messages, []);
  await close();
});

test("AClickOnAMark_OpensTheViewerWithThatFilterAndTheTruth", async () => {
  const { page, messages, close } = await openRun("several"), data = await readData(page);
  const chart = await page.evaluate(() => {
    const { charts } = JSON.parse(document.getElementById("charts").textContent);
    return charts.findIndex(({ charts }) => charts.some(({ series }) => series.some(({ points }) => points.some((point) => point[4]))));
  });
  assert.ok(chart >= 0, "a chart whose marks open cells");
  const figure = page.locator("figure.chart").nth(chart);
  for (const select of await figure.locator("label:not(:has-text('width')) select").all())
    await select.selectOption({ index: (await select.locator("option").count()) - 1 });
  await figure.locator("svg").scrollIntoViewIfNeeded();
  const marks = figure.locator("svg > g:not(.key) path[transform]"), opened = new Set();
  for (let i = 0; i < (await marks.count()); ++i) {
    const box = await marks.nth(i).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    const said = await figure.locator(".tip").textContent();
    if ((await figure.locator("svg").evaluate((svg) => svg.style.cursor)) !== "pointer") continue;
    await page.evaluate(() => history.replaceState(null, "", "#"));
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await page.waitForFunction(() => location.hash.startsWith("#view="));
    const [place, left, right] = new URL(page.url()).hash.slice(6).split(",").map(decodeURIComponent);
    assert.ok(data.places.some(({ title }) => title === place));
    assert.equal(left, "truth");
    assert.ok(said.includes(right), `${said} opens ${right}`);
    assert.ok(await page.locator(".viewer .panes").evaluate((panes) => panes.getBoundingClientRect().top < innerHeight && panes.getBoundingClientRect().bottom > 0), "the viewer is seen");
    opened.add(right);
    await figure.locator("svg").scrollIntoViewIfNeeded();
  }
  assert.ok(opened.size > 2, [...opened].join());
  assert.deepEqual(messages, []);
  await close();
});

test("AFileOfValuesThatIsGone_IsSaid_AndTheRestWorks", async () => {
  const file = changePage("several", "gone.html", (data) => {
    for (const cell of data.cells) cell.values = cell.values.replace("values.js", "gone.js");
    data.truths.forEach((truth) => { truth.values = truth.values.replace("values.js", "gone.js"); });
  });
  const { page, messages, close } = await openViewer(file, { hash: "#view=cubes,truth,none,visibility,side,0,0,1" });
  assert.match(await page.locator(".viewer .message").first().textContent(), /gone\.js cannot be read: the file is not beside this page\.$/);
  assert.match(await page.locator(".worst").textContent(), /^There is no picture of the worst place: .*gone\.js cannot be read/);
  const slider = page.locator('.sliders input[name="error.rmse"]'), before = await page.locator(".answer code").textContent();
  await slider.fill("1");
  assert.notEqual(await page.locator(".answer code").textContent(), before);
  await page.locator('.numbers input[type="search"]').fill("vsm");
  assert.equal(await page.locator(".numbers tbody tr").count(), 2);
  assert.ok(messages.every((text) => text.includes("ERR_FILE_NOT_FOUND")), "nothing but the browser's own word on missing files: " + messages);
  await close();
});

test("TheWidth_ChoosesTheMarksOfOneClass", async () => {
  const { page, messages, close } = await openRun("several"), data = await readData(page);
  const classes = [...new Set(data.configurations.map((configuration) => configuration.class).filter(Boolean))];
  const select = page.locator("#front label:has-text('width') select"), keys = page.locator("#front .key text");
  assert.ok(classes.length > 1);
  assert.deepEqual((await select.locator("option").evaluateAll((all) => all.map((each) => each.value))).sort(), ["", ...classes].sort());
  const all = await keys.count();
  for (const name of classes) {
    await select.selectOption(name);
    const filters = new Set(data.configurations.filter((configuration) => configuration.class === name).map(({ filter }) => filter));
    const shown = (await keys.allTextContents()).filter((text) => !text.startsWith("front"));
    assert.ok(shown.length > 0 && shown.every((text) => filters.has(text)), `${name}: ${shown}`);
  }
  await select.selectOption("");
  assert.equal(await keys.count(), all);
  assert.deepEqual(messages, []);
  await close();
});
