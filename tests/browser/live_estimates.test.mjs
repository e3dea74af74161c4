// Estimates for a GPU that was not there are held against the times of one that is.
import assert from "node:assert/strict";
import { cpSync, existsSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { kMesa, loadTimes, openLive, withBrowser } from "./live_support.mjs";
import { folderOf, kNarrow, listViolations, measureOverflow, open, pageOf, readData, runProgram } from "./support.mjs";

const kRenderer = "AMD Radeon RX 6900 XT (RADV NAVI21)", kEstimate = "gpu.navi21.frame_ms.moving";
// Times of all cells of a run, of which a function says what those of a configuration take.
const forge = (data, renderer, takes) => {
  const time = (median) => ({ median, interval: null, rounds: 11 });
  const cells = data.cells.map(({ key, configuration }) => [key, { map: time(0), prefilter: null, filter: time(takes(data.configurations[configuration])) }]);
  return JSON.stringify({ schema: "shadowbench gpu-times 1", renderer, browser: "none", isSoftware: false, cells: Object.fromEntries(cells) });
};
const load = (page, text) => loadTimes(page, "gpu-times.json", text);
const readCorrelation = (text) => /Over (\d+) configurations, the rank correlation .* is (-?[\d.]+)\./.exec(text)?.slice(1).map(Number);

test("EstimatesMeetTimes_OfTheGpuThatTheyAreFor", () => withBrowser(kMesa, async (browser) => {
  const { page, messages, shoot, close } = await openLive(pageOf("several"), browser, { viewport: kNarrow });
  const data = await readData(page);
  const count = data.configurations.filter((each) => each[kEstimate] !== null).length, measured = page.locator("#gpus .measured");
  assert.ok(count > 4);
  assert.equal(readCorrelation(await load(page, forge(data, "Another GPU", (each) => each[kEstimate]))), undefined);
  assert.equal(await measured.count(), 0);
  for (const [sign, wanted] of [[1, 1], [-1, -1]]) {
    const said = await load(page, forge(data, kRenderer, (each) => 1000 + sign * each[kEstimate]));
    assert.deepEqual(readCorrelation(said), [count, wanted], said);
    assert.ok(said.includes(wanted.toFixed(2)), said);
    assert.deepEqual(readCorrelation(await measured.locator("p").textContent()), [count, wanted]);
  }
  const rows = await measured.locator("tbody tr").evaluateAll((all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
  assert.equal(rows.length, count);
  await shoot("live.estimates");
  assert.ok((await measureOverflow(page)) <= 0);
  assert.deepEqual(await listViolations(page), []);
  // The run's own times are a CPU's, which the program holds no estimate against.
  assert.deepEqual((await page.locator("#gpus li").allTextContents()).filter((text) => text.includes("rank correlation")), []);
  const level = readCorrelation(await load(page, forge(data, kRenderer, () => 1)));
  assert.equal(level, undefined, "all alike have no order");
  assert.deepEqual(messages, []);
  await close();
}));

test("AReportIsGivenTimesOfOtherMachines_ForItsPageAndItsFronts", async () => {
  const report = join(folderOf("several"), "..", "several times"), markup = "<img src=x onerror=alert(1)>";
  rmSync(report, { recursive: true, force: true });
  cpSync(folderOf("several"), report, { recursive: true });
  let opened = await open(join(report, "index.html"));
  const data = await readData(opened.page), costs = () => opened.page.locator("select[name=cost]"), before = await costs().locator("option").allTextContents();
  await opened.close();
  const write = (name, renderer, edit = () => {}) => {
    const times = JSON.parse(forge(data, renderer, ({ label }) => label.length));
    edit(times.cells);
    writeFileSync(join(report, name), JSON.stringify(times));
    return join(report, name);
  };
  const merge = (...files) => runProgram(["merge", report, ...files.flatMap((file) => ["--times", file])]);
  const good = write("a.json", "Another GPU"), [{ key, configuration }] = data.cells;
  for (const [file, words] of [
    [write("b.json", "Another GPU"), /both times of Another GPU: name one/],
    [write("c.json", "A third", (cells) => { for (const own of Object.keys(cells)) delete cells[own]; }), /c.json.*of another run/],
    [write("d.json", "A third", (cells) => { cells[key].map.median = null; }), /d.json.*is no time/],
    [join(report, "none.json"), /none.json/],
  ]) {
    const refused = merge(good, file);
    assert.notEqual(refused.status, 0);
    assert.match(refused.stderr, words);
    assert.ok(!existsSync(join(report, "times")), "nothing is half done");
  }
  const merged = merge(good, write("e.json", markup));
  assert.equal(merged.status, 0, merged.stderr);
  assert.equal(merge(write("f.json", "Another GPU", (cells) => { cells[key].filter.median = 77; })).status, 0, "newer times take the place of older ones");
  opened = await open(join(report, "index.html"));
  assert.deepEqual((await costs().locator("option").allTextContents()).filter((title) => !before.includes(title)).sort(), [
    `moving light, ${markup}`, `static light, ${markup}`, "moving light, Another GPU", "static light, Another GPU",
  ].sort());
  await costs().selectOption({ label: "static light, Another GPU" });
  assert.ok((await opened.page.evaluate(() => shadowbench.answer.judge().keeping.length)) > 0);
  // The command of that choice names the file that the report keeps.
  const [, words] = /^shadowbench (advise .*)$/.exec(await opened.page.locator(".answer code").first().textContent());
  const said = runProgram([...words.match(/(?:'[^']*'|\S)+/g).map((word) => word.replaceAll("'", "")), "--json"]);
  assert.equal(said.status, 0, said.stderr);
  assert.ok((await opened.page.locator(".picks tbody tr").first().locator("td").first().textContent()).startsWith(JSON.parse(said.stdout).picks[0].label), words);
  assert.deepEqual(opened.messages, []);
  await opened.close();
  const [head, ...rows] = readFileSync(join(report, "fronts.csv"), "utf8").trim().split("\r\n").map((row) => row.split(","));
  const own = rows.filter((row) => row.at(-1) === "Another GPU" && row[head.indexOf("cost")] === "static" && row[head.indexOf("error")] === "rmse");
  const costOf = (each) => Number(own.find((row) => row[head.indexOf("cell")] === each).at(head.indexOf("cost_value") - head.length));
  assert.equal(costOf(key), 77);
  const other = data.cells.find((each) => each.configuration !== configuration && costOf(each.key) > 0);
  assert.equal(costOf(other.key), data.configurations[other.configuration].label.length);
});
