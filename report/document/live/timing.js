// Times draws on the reader's GPU: of two batches of different length, what the longer one takes more. That leaves out
// what waiting for the GPU costs, and works where the browser's clock is coarse and has no timers of the GPU.
const kLeastBatchMs = 30;
const kGrainsInBatch = 50; // the clock's grain is 2 % of a batch at most
const kMostDraws = 4096;
const kMostQueryMs = 2000;
const median = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
};
// The median with its 95 % interval from the ranks of the values (binomial, by its normal approximation); null where
// there are too few of them for one.
const summarise = (values) => {
  const sorted = [...values].sort((a, b) => a - b);
  const reach = 0.98 * Math.sqrt(sorted.length);
  const [low, high] = [Math.floor(sorted.length / 2 - reach), Math.ceil(sorted.length / 2 + reach)];
  const interval = low < 0 || high >= sorted.length ? null : [sorted[low], sorted[high]];
  return { median: median(sorted), interval, rounds: sorted.length };
};
const shuffle = (list) => {
  for (let i = list.length - 1; i > 0; --i) {
    const j = Math.floor(Math.random() * (i + 1));
    [list[i], list[j]] = [list[j], list[i]];
  }
  return list;
};
// The least step of the browser's clock, ms.
const measureGrain = () => {
  let grain = Infinity;
  for (let i = 0; i < 5; ++i) {
    const start = performance.now();
    let now = start;
    while (now === start) now = performance.now();
    grain = Math.min(grain, now - start);
  }
  return grain;
};
// A page that is not seen is drawn rarely, and its times say nothing.
const whenSeen = async () => {
  while (document.hidden)
    await new Promise((resolve) => document.addEventListener("visibilitychange", resolve, { once: true }));
};
const pause = () => new Promise((resolve) => setTimeout(resolve));

// Asks the browser's own timer of the GPU: what a draw takes by it, ms; null where there is none, or it was disturbed.
// It is a cross-check: a browser may round such times, and a CPU that draws may have done nothing yet when it ends.
const makeQueryTimer = (gl) => {
  const timers = gl.getExtension("EXT_disjoint_timer_query_webgl2");
  let isSilent = !timers; // a query that never came is the last one
  return async ({ draw, count }) => {
    if (isSilent) return null;
    const query = gl.createQuery();
    gl.getParameter(timers.GPU_DISJOINT_EXT); // forgets what was disturbed before
    gl.beginQuery(timers.TIME_ELAPSED_EXT, query);
    draw(count);
    gl.endQuery(timers.TIME_ELAPSED_EXT);
    gl.flush();
    const end = performance.now() + kMostQueryMs;
    const isThere = () => gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE);
    do await pause();
    while (!isThere() && performance.now() < end);
    isSilent = !isThere();
    const isSound = !isSilent && !gl.getParameter(timers.GPU_DISJOINT_EXT);
    const value = isSound ? gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6 / count : null;
    gl.deleteQuery(query);
    return value;
  };
};

const makeTimer = (gl) => {
  const ask = makeQueryTimer(gl);
  const pixel = new Uint8Array(4);
  const { framebuffer } = makeTarget(gl, gl.RGBA8, 1, 1);
  // A pixel that is written after all that was drawn, and read back, comes when that is done.
  const finish = () => {
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  };
  const timeBatch = (draw, count) => {
    finish();
    const start = performance.now();
    draw(count);
    finish();
    return performance.now() - start;
  };
  const batchMs = Math.max(kLeastBatchMs, kGrainsInBatch * measureGrain());
  // So many draws that a batch takes long enough for the clock.
  const countDraws = (draw) => {
    let count = 1;
    while (count < kMostDraws && timeBatch(draw, count) < batchMs) count *= 2;
    return count;
  };
  const timeOnce = ({ draw, count }) => (timeBatch(draw, 2 * count) - timeBatch(draw, count)) / count;

  // Promises what each of some functions, which draw so many times, takes for once, ms, with what timer queries say of it:
  // in rounds, each in an order of its own. `isStopped` ends it early.
  return async (draws, rounds, onRound, isStopped) => {
    const timed = [];
    for (const draw of draws) {
      draw(1);
      timed.push({ draw, count: countDraws(draw), values: [], queries: [] });
      await pause();
    }
    for (let round = 0; round < rounds && !isStopped(); ++round) {
      for (const each of shuffle([...timed])) {
        if (isStopped()) break;
        await whenSeen();
        const value = timeOnce(each);
        if (!document.hidden) each.values.push(value);
        const asked = await ask(each);
        if (!document.hidden && asked !== null) each.queries.push(asked);
        await pause();
      }
      onRound(round + 1);
    }
    const sum = ({ values, queries }) => ({
      ...summarise(values),
      ...(queries.length > 0 && { queries: summarise(queries) }),
    });
    return timed.map((each) => (each.values.length > 0 ? sum(each) : null));
  };
};
