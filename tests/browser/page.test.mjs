// What holds for a run's page as a whole: its length, paper, charts and the time to open.
import assert from "node:assert/strict";
import { changePage, kNarrow, kWide, listOverlaps, multiply, open, openRun, pageOf, settle, testPage } from "./support.mjs";

const kRunPages = ["several", "odd", "untrue", "single"];
const kMostWords = 500, kMostFirst = 120, kChoiceAbove = 600, kMostPaper = 2;
const countPaper = (pdf) => pdf.toString("latin1").match(/\/Type\s*\/Page\b(?!s)/g).length;

// The words that are seen: of a menu the chosen one, and with `above` those of the first screen alone.
const countWords = (page, above = Infinity) => page.evaluate((most) => {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), range = document.createRange();
  let count = 0;
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const option = node.parentElement.closest("option"), holder = option ? option.closest("select") : node.parentElement;
    if (option && !option.selected) continue;
    if (!holder.checkVisibility({ visibilityProperty: true }) || /^(SCRIPT|STYLE)$/.test(holder.tagName)) continue;
    range.selectNodeContents(option ? holder : node);
    const { top, width } = option ? holder.getBoundingClientRect() : range.getBoundingClientRect();
    if (width > 0 && top < most) count += node.textContent.split(/\s+/).filter((word) => /[\p{L}\p{N}]/u.test(word)).length;
  }
  return count;
}, above === Infinity ? 1e9 : above);

for (const run of kRunPages)
  testPage(`ThePage_IsShort_AndItsFirstScreenHasTheAnswerAndShadows: ${run}`, () => openRun(run), async ({ page }, context) => {
    const words = await countWords(page), first = await countWords(page, kWide.height);
    const [bottom, top] = await page.evaluate(() => [".picks", ".answer > figure"].map((name, i) => document.querySelector(name).getBoundingClientRect()[i === 0 ? "bottom" : "top"]));
    context.diagnostic(`${words} words, ${first} of them on the first screen; the answer ends at ${Math.round(bottom)} px, the picture begins at ${Math.round(top)} px`);
    assert.ok(words <= kMostWords, `${words} words`);
    assert.ok(first <= kMostFirst, `${first} words on the first screen`);
    assert.ok(bottom > 0 && bottom < kChoiceAbove && top < kChoiceAbove, `${bottom} and ${top} px`);
  });

const lengthenNames = ({ scopes, places }) => {
  for (const each of [...scopes, ...places]) if (each.scene) each.scene = each.title = `underthegreatwallofstairs_${each.scene}.spot`;
  for (const each of scopes) each.left_out = each.scene && "not tested";  // else what is answered alike has no row
};
for (const viewport of [kNarrow, kWide, { width: 1920, height: 1080 }])
  testPage(`LongNamesOfScenes_StayInTheirColumnOfTheAnswer: ${viewport.width}`, () => open(changePage("several", lengthenNames), { viewport }), async ({ page }) => {
    const heads = await page.locator(".picks tbody th").evaluateAll((all) => all.map((head) => [head.textContent, head.scrollWidth - head.clientWidth]));
    assert.ok(heads.some(([text]) => text === "underthegreatwallofstairs_cubes.spot"), heads.join());
    for (const [text, over] of heads) assert.ok(over <= 0, `${text} is ${over} px too wide`);
  });

testPage("NothingMoves_WhileThePageOpens_AndThePictureIsThereAtOnce", () => openRun("several", { waits: false }), async ({ page }, context) => {
  await page.addInitScript(() => {
    window.shifts = [];
    new PerformanceObserver((list) => window.shifts.push(...list.getEntries().map(({ value }) => value))).observe({ type: "layout-shift", buffered: true });
  });
  await page.goto(page.url() + "#again");
  await page.reload();
  const begin = Date.now();
  await page.waitForFunction(() => [...document.querySelectorAll(".stage img")].every((image) => image.complete && image.naturalWidth > 0));
  const seconds = (Date.now() - begin) / 1000;
  await settle(page);
  const shifts = await page.evaluate(() => window.shifts);
  context.diagnostic(`layout shifts: ${shifts.join(", ") || "none"}; the picture is there ${seconds} s after the page`);
  assert.ok(shifts.reduce((sum, value) => sum + value, 0) < 0.01, shifts.join());
  assert.ok(seconds < 0.5, `${seconds} s`);
});

for (const [name, find] of [...kRunPages.map((run) => [run, () => pageOf(run)]), ["many", () => changePage("several", (data) => multiply(data, 300))]])
  testPage(`Paper_TakesTwoPages_HoweverManyConfigurations: ${name}`, () => open(find()), async ({ page }, context) => {
    await settle(page);
    const count = countPaper(await page.pdf());
    context.diagnostic(`${count} pages`);
    assert.ok(count <= kMostPaper, `${count} pages`);
  });

testPage("AClickOnAMark_OpensTheViewerWithThatFilterAndTheTruth", () => openRun("several"), async ({ page, data }) => {
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
    if ((await figure.locator("svg").evaluate((svg) => svg.style.cursor)) !== "pointer") continue;
    await page.evaluate(() => history.replaceState(null, "", "#"));
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await page.waitForFunction(() => location.hash.startsWith("#view="));
    // Marks lie a pixel apart, and a page that still settles moves by a quarter: the tip says what the click opened.
    const said = await figure.locator(".tip").textContent();
    const [place, left, right] = new URL(page.url()).hash.slice(6).split(",").map(decodeURIComponent);
    assert.ok(data.places.some(({ title }) => title === place));
    assert.equal(left, "truth");
    assert.ok(said.includes(right), `${said} opens ${right}`);
    assert.ok(await page.locator(".viewer .panes").evaluate((panes) => panes.getBoundingClientRect().top < innerHeight && panes.getBoundingClientRect().bottom > 0), "the viewer is seen");
    opened.add(right);
    await figure.locator("svg").scrollIntoViewIfNeeded();
  }
  assert.ok(opened.size > 2, [...opened].join());
});

testPage("TheTrade_NamesItsMarks_WithoutAKey_AndRingsTheAnswers", () => openRun("several"), async ({ page, data }) => {
  const picks = await page.evaluate(() => shadowbench.answer.picks());
  const classes = [...new Set(data.configurations.map((configuration) => configuration.class).filter(Boolean))], front = page.locator("#front svg");
  const readLabels = () => front.locator("text[stroke]").allTextContents(), rings = front.locator(":scope > path[transform]");
  assert.ok(classes.length > 1);
  assert.equal(await front.locator(".key").count(), 0);
  assert.equal(await rings.count(), picks.length);
  const named = await readLabels();
  for (const { index } of picks) assert.ok(named.some((text) => text.startsWith(`${data.configurations[index].label} · `)), `${named}`);
  assert.deepEqual(named.filter((text) => !data.configurations.some(({ label }) => text.split(" · ")[0] === label)), []);
  assert.deepEqual(await listOverlaps(front), []);
  const select = page.locator("#front label:has-text('width') select");
  for (const name of classes) {
    await select.selectOption(name);
    const labels = data.configurations.filter((configuration) => configuration.class === name).map(({ label }) => label), shown = await readLabels();
    assert.ok(shown.length > 0 && shown.every((text) => labels.includes(text.split(" · ")[0])), `${name}: ${shown}`);
  }
  await page.locator(".reasons").evaluate((each) => { each.open = true; });
  await select.selectOption("");
  await page.locator('.sliders input[name="error.rmse"]').fill("1");
  assert.equal(await rings.count(), (await page.evaluate(() => shadowbench.answer.picks())).length, "of the limits that are set");
});
