// What the tests of the pages share. CTest puts into the environment where the program, the runs and the packages are.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, join } from "node:path";
import test, { after } from "node:test";
import { pathToFileURL } from "node:url";

const { SHADOWBENCH_PROGRAM: kProgram, SHADOWBENCH_BROWSER: kFolder, SHADOWBENCH_CHROMIUM: kChromium, SHADOWBENCH_SHOTS: kShots } = process.env;
if (!kProgram || !kFolder || !kChromium) throw new Error("Run these tests with 'ctest -L browser': it names the program, its runs and the browser.");
const require = createRequire(join(kFolder, "package.json"));
const { PNG } = require("pngjs"), kAxe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
export const kWide = { width: 1400, height: 900 }, kNarrow = { width: 400, height: 800 };

// One browser per list of arguments serves all tests of a file.
const browsers = new Map();
const launch = (args) => {
  const key = args.join(" ");
  if (!browsers.has(key)) browsers.set(key, require("playwright-core").chromium.launch({ executablePath: kChromium, args }));
  return browsers.get(key);
};
after(async () => { for (const each of browsers.values()) await (await each).close(); });

export const folderOf = (run) => join(kFolder, "runs", run);
export const pageOf = (run, file = "index.html") => join(folderOf(run), file);
export const readResults = (run) => JSON.parse(readFileSync(pageOf(run, "results.json"), "utf8"));
// Where the commands that pages show are given.
export const runProgram = (words, options = {}) => spawnSync(kProgram, words, { encoding: "utf8", cwd: join(kFolder, "runs"), ...options });
// The words of a command of the program as a shell reads them.
export const splitWords = (command) => execFileSync("sh", ["-c", command.replace("shadowbench", "printf '%s\\n'")], { encoding: "utf8" }).trimEnd().split("\n");

// Opens a page from disk in a profile of its own; gives the console's messages, and the data of a run's page. `init` runs in
// the page before its own scripts.
export const open = async (file, { hash = "", waits = true, args = ["--disable-gpu"], init, ...options } = {}) => {
  const context = await (await launch(args)).newContext({ viewport: kWide, ...options }), page = await context.newPage(), messages = [];
  page.setDefaultTimeout(60000);  // a busy machine opens pages slowly
  if (init) await page.addInitScript(init);
  // Chromium's own word on its software rasteriser, which draws the section Live wherever that is near, is no fault of a page.
  page.on("console", (message) => /GL Driver Message \(OpenGL, Performance/.test(message.text()) || messages.push(message.text()));
  page.on("pageerror", (error) => messages.push(String(error)));
  await page.goto(pathToFileURL(file).href + hash);
  if (waits) await page.waitForFunction(() => document.querySelector(".viewer figcaption bdi"));
  // Screenshots are for people: they are taken where SHADOWBENCH_SHOTS names a folder.
  const shoot = async (name) => kShots && page.screenshot({ path: join(kShots, name.replaceAll(/\W+/g, "_") + ".png"), fullPage: true });
  const data = await page.evaluate(() => JSON.parse(document.getElementById("run")?.textContent ?? "null"));
  return { page, messages, data, shoot, close: () => context.close() };
};
export const openRun = (run, options) => open(pageOf(run), options);
// Tests a page: `opens` opens it, `act` uses it. Its console must stay empty, except for messages that match `allows`.
export const testPage = (name, opens, act, allows = /$^/) => test(name, async (context) => {
  const opened = await opens();
  try {
    await act(opened, context);
    await opened.shoot(name);
    assert.deepEqual(opened.messages.filter((text) => !allows.test(text)), []);
  } finally {
    await opened.close();
  }
});
// What stands below the screen is made when it is scrolled to.
export const openViewer = async (file, options) => {
  const opened = await open(file, options);
  await opened.page.locator("#viewer").evaluate((section) => section.scrollIntoView());
  return opened;
};
export const showCrops = async (page) => {
  await page.locator(".viewer .strip [data-who]").first().scrollIntoViewIfNeeded();
  await page.waitForSelector(".viewer .strip [data-who] canvas");
};
const kLinkAfterMs = 310; // base.js writes links 300 ms after the last change
// Until what was asked for is loaded and drawn, in the viewer and live, which say that they are busy, and its link is written:
// timers of a page end in the order of their times.
const nextFrame = (page) => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
export const settle = async (page, timeout = 60000) => {
  await nextFrame(page);
  await page.waitForFunction(() => !document.querySelector("[aria-busy=true]"), null, { timeout });
  await page.evaluate((ms) => new Promise((resolve) => setTimeout(resolve, ms)), kLinkAfterMs);
  await nextFrame(page);
};
export const measureOverflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);

// Drags the mouse over the page, and over what a locator finds: from a place in it, so far.
export const drag = async (page, from, to) => {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(...to, { steps: 4 });
  await page.mouse.up();
};
export const dragOver = async (locator, [left, top], [across, down]) => {
  const { x, y } = await locator.boundingBox();
  await drag(locator.page(), [x + left, y + top], [x + left + across, y + top + down]);
};

// The viewer's controls, the names of its panes, and what stands in the address.
export const pick = (page, title, value, within = ".viewer") =>
  page.locator(within).getByRole("combobox", { name: title, exact: true }).selectOption(value);
export const labels = (page) => page.locator(".viewer .panes canvas:visible").evaluateAll((all) => all.map((each) => each.getAttribute("aria-label")));
// The page's address with all that the reader chose.
export const linkOf = async (page) => {
  await settle(page);
  return page.evaluate(() => location.hash);
};
// Opens the link that a page has come to, as one who was sent it does.
export const reopen = async (page) => {
  const link = await page.evaluate(() => location.href);
  await page.goto("about:blank");
  await page.goto(link);
};
export const hashOf = async (page) => decodeURIComponent(await linkOf(page));
// Four channels of 8 bits a pixel.
export const readPng = (png) => PNG.sync.read(png);
// How often each colour is in one pane.
export const colours = async (page, index = 0) => {
  const canvas = page.locator(".viewer .panes canvas").nth(index);
  // At a whole pixel: elsewhere the screenshot mixes rows.
  await canvas.evaluate((drawn) => {
    const { style } = drawn.closest(".viewer");
    Object.assign(style, { position: "relative", top: "0px" });
    const top = drawn.getBoundingClientRect().top + scrollY;
    style.top = `${Math.ceil(top) - top}px`;
  });
  const { data } = readPng(await canvas.screenshot()), counts = new Map();
  for (let i = 0; i < data.length; i += 4) {
    const colour = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  return Object.fromEntries([...counts].map(([colour, count]) => [[colour >> 16, (colour >> 8) & 255, colour & 255].join(), count]));
};

// Writes a page beside a run's own, whose data a function has changed.
let changed = 0;
export const changePage = (run, edit) => {
  const html = readFileSync(pageOf(run), "utf8"), pattern = /(id="run">)([^]*?)(<\/script>)/, data = JSON.parse(pattern.exec(html)[2]);
  edit(data);
  const file = pageOf(run, `${basename(process.argv[1])}.${++changed}.html`), text = JSON.stringify(data).replaceAll("<", "\\u003c");
  writeFileSync(file, html.replace(pattern, (_, begin, old, end) => begin + text + end));
  return file;
};
// Lists the texts of a chart that overlap.
export const listOverlaps = (svg) => svg.evaluate((chart) => {
  const boxes = [...chart.querySelectorAll("text")].map((text) => [text.textContent, text.getBBox()]);
  const isOver = (p, q) => p.x + 1 < q.x + q.width && q.x + 1 < p.x + p.width && p.y + 4 < q.y + q.height && q.y + 4 < p.y + p.height;
  return boxes.flatMap(([a, p], i) => boxes.slice(i + 1).filter(([, q]) => isOver(p, q)).map(([b]) => `${a} over ${b}`));
});
// Repeats the configurations of a page, each with its cells, until there are as many as wanted.
export const multiply = (data, count) => {
  const { configurations, cells, scopes } = data;
  data.cells = [];
  for (const scope of scopes) scope.rows = Array.from({ length: count }, (_, i) => scope.rows[i % configurations.length]);
  data.configurations = Array.from({ length: count }, (_, i) => {
    const at = i % configurations.length, twin = i >= configurations.length ? ` (twin ${i})` : "";
    for (const cell of cells) if (cell.configuration === at) data.cells.push({ ...cell, configuration: i, key: cell.key + twin });
    return { ...configurations[at], label: configurations[at].label + twin, full: configurations[at].full + twin };
  });
};

// What axe-core finds wrong, in a line each.
export const listViolations = async (page) => {
  await page.evaluate(kAxe);
  const { violations } = await page.evaluate(() => axe.run({ resultTypes: ["violations"], preload: false }));
  return violations.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id} at ${target}: ${failureSummary.replaceAll(/\s+/g, " ")}`));
};
