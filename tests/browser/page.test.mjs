// What holds for a run's page as a whole: its length, paper, charts and the time to open.
import assert from "node:assert/strict";
import { test } from "node:test";
import { changePage, kNarrow, kWide, multiply, open, openRun, openViewer, pageOf, readData, settle } from "./support.mjs";

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

test("ThePage_IsShort_AndItsFirstScreenHasTheAnswerAndShadows", async (context) => {
  for (const run of kRunPages) {
    const { page, close } = await openRun(run);
    const words = await countWords(page), first = await countWords(page, kWide.height);
    const [bottom, top] = await page.evaluate(() => [".picks", ".answer > figure"].map((name, i) => document.querySelector(name).getBoundingClientRect()[i === 0 ? "bottom" : "top"]));
    context.diagnostic(`${run}: ${words} words, ${first} of them on the first screen; the answer ends at ${Math.round(bottom)} px, the picture begins at ${Math.round(top)} px`);
    assert.ok(words <= kMostWords, `${run}: ${words} words`);
    assert.ok(first <= kMostFirst, `${run}: ${first} words on the first screen`);
    assert.ok(bottom > 0 && bottom < kChoiceAbove && top < kChoiceAbove, `${run}: ${bottom} and ${top} px`);
    await close();
  }
});

test("LongNamesOfScenes_StayInTheirColumnOfTheAnswer", async () => {
  const file = changePage("several", "long.html", ({ scopes, places }) => {
    for (const each of [...scopes, ...places]) if (each.scene) each.scene = each.title = `underthegreatwallofstairs_${each.scene}.spot`;
    for (const each of scopes) each.left_out = each.scene && "not tested";  // else what is answered alike has no row
  });
  for (const viewport of [kNarrow, kWide, { width: 1920, height: 1080 }]) {
    const { page, close } = await open(file, { viewport });
    const heads = await page.locator(".picks tbody th").evaluateAll((all) => all.map((head) => [head.textContent, head.scrollWidth - head.clientWidth]));
    assert.ok(heads.some(([text]) => text === "underthegreatwallofstairs_cubes.spot"), heads.join());
    for (const [text, over] of heads) assert.ok(over <= 0, `${text} is ${over} px too wide at ${viewport.width}`);
    await close();
  }
});

test("NothingMoves_WhileThePageOpens_AndThePictureIsThereAtOnce", async (context) => {
  const { page, close } = await openRun("several", { waits: false });
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
  await close();
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
  await page.locator(".reasons").evaluate((each) => { each.open = true; });
  const slider = page.locator('.sliders input[name="error.rmse"]'), before = await page.locator(".reasons code").first().textContent();
  await slider.fill("1");
  assert.notEqual(await page.locator(".reasons code").first().textContent(), before);
  await page.locator('.numbers input[type="search"]').fill("vsm");
  assert.equal(await page.locator(".numbers tbody tr").count(), 2);
  assert.ok(messages.every((text) => text.includes("ERR_FILE_NOT_FOUND")), "nothing but the browser's own word on missing files: " + messages);
  await close();
});

test("TheTrade_NamesItsMarks_WithoutAKey_AndRingsTheAnswers", async () => {
  const { page, messages, close } = await openRun("several"), data = await readData(page), picks = await page.evaluate(() => shadowbench.answer.picks());
  const classes = [...new Set(data.configurations.map((configuration) => configuration.class).filter(Boolean))], front = page.locator("#front svg");
  const readLabels = () => front.locator("text[stroke]").allTextContents(), rings = front.locator(":scope > path[transform]");
  assert.ok(classes.length > 1);
  assert.equal(await front.locator(".key").count(), 0);
  assert.equal(await rings.count(), picks.length);
  const named = await readLabels();
  for (const { index } of picks) assert.ok(named.some((text) => text.startsWith(`${data.configurations[index].label} · `)), `${named}`);
  assert.deepEqual(named.filter((text) => !data.configurations.some(({ label }) => text.split(" · ")[0] === label)), []);
  const overlaps = await front.evaluate((svg) => {
    const boxes = [...svg.querySelectorAll("text")].map((text) => [text.textContent, text.getBBox()]);
    const isOver = (p, q) => p.x + 1 < q.x + q.width && q.x + 1 < p.x + p.width && p.y + 4 < q.y + q.height && q.y + 4 < p.y + p.height;
    return boxes.flatMap(([a, p], i) => boxes.slice(i + 1).filter(([, q]) => isOver(p, q)).map(([b]) => `${a} over ${b}`));
  });
  assert.deepEqual(overlaps, []);
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
  assert.deepEqual(messages, []);
  await close();
});
