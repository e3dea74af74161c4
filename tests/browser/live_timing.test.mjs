// What times a browser's GPU, without a browser: the page stays alive meanwhile.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";

const file = new URL("../../report/document/live/timing.js", import.meta.url);
const makeTimer = new Function("makeTarget", "document", `${readFileSync(file, "utf8")}; return makeTimer;`)(() => ({ framebuffer: 0 }), { hidden: false });
const draw = (count) => {
  const end = performance.now() + 0.02 * count;
  while (performance.now() < end);
};

test("ThePageIsAliveBetweenAllTimes", async () => {
  const gl = new Proxy({}, { get: (own, name) => own[name] ?? (() => 0) });
  const seen = [];
  let ticks = 0, isOver = false;
  const tick = () => {
    ++ticks;
    if (!isOver) setTimeout(tick);
  };
  tick();
  const times = await makeTimer(gl)([draw, draw, draw], 3, () => seen.push(ticks), () => false);
  isOver = true;
  assert.equal(times.length, 3);
  for (const [i, count] of seen.entries()) assert.ok(count >= (i > 0 ? seen[i - 1] : 0) + 3, `the page did something else so often by the end of the rounds: ${seen}`);
});
