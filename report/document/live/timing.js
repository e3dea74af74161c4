// Times draws on the reader's GPU: of two batches of different length, what the longer one takes more. That leaves out
// what waiting for the GPU costs, and works where the browser's clock is coarse and has no timers of the GPU.
const kLeastBatchMs = 30;
const kGrainsInBatch = 50; // the clock's grain is 2 % of a batch at most
const kMostDraws = 4096;
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

const makeTimer = (gl) => {
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

  // Promises what each of some functions, which draw so many times, takes for once, ms: in rounds, each in an order of its
  // own. `isStopped` ends it early.
  return async (draws, rounds, onRound, isStopped) => {
    const timed = [];
    for (const draw of draws) {
      draw(1);
      timed.push({ draw, count: countDraws(draw), values: [] });
      await pause();
    }
    for (let round = 0; round < rounds && !isStopped(); ++round) {
      for (const each of shuffle([...timed])) {
        if (isStopped()) break;
        await whenSeen();
        const value = timeOnce(each);
        if (!document.hidden) each.values.push(value);
        await pause();
      }
      onRound(round + 1);
    }
    return timed.map(({ values }) => (values.length > 0 ? summarise(values) : null));
  };
};
