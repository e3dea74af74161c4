// Estimates for a GPU that was not there are held against the times of one that is.
import assert from "node:assert/strict";
import test from "node:test";
import { kMesa, loadTimes, openLive, withBrowser } from "./live_support.mjs";
import { kNarrow, listViolations, measureOverflow, pageOf, readData } from "./support.mjs";

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
