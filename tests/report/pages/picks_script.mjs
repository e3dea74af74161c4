// Asks picks.js what the program was asked: node picks_script.mjs PICKS.JS RUNS, a run with its questions a line.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const [script, runs] = process.argv.slice(2).map((path) => readFileSync(path, "utf8"));
const load = new Function("run", `${script}\nreturn judgeScope;`);
const kNames = ["fast", "balanced", "best"];
let asked = 0;
for (const line of runs.trim().split("\n")) {
  const { data, questions } = JSON.parse(line), judgeScope = load(data), cost = data.costs.find(({ id }) => id === data.cost);
  for (const { limits, keeping, failing, beaten, picks } of questions) {
    const judged = judgeScope(data.scopes[0], cost, { wide: "", soft: false, limits });
    const names = ({ columns }) => columns.map((column) => kNames[column]);
    const said = { keeping: judged.keeping.map(({ index }) => index), failing: judged.failing.length, beaten: judged.beaten.length,
      picks: judged.picks.map((pick) => ({ names: names(pick), index: pick.index })) };
    assert.deepEqual(said, { keeping, failing, beaten, picks }, JSON.stringify(limits));
    ++asked;
  }
}
assert.ok(asked > 500, `${asked} questions`);
