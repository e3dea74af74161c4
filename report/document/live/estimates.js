// Holds estimates for GPUs against what such a GPU took, where its times are there.

// The ranks of values, from 1; equal ones share the mean of theirs.
const rankAll = (values) =>
  values.map((value) => {
    const below = values.filter((other) => other < value).length;
    const same = values.filter((other) => other === value).length;
    return below + (same + 1) / 2;
  });
// Spearman's rank correlation, which is Pearson's of the ranks; null where there are fewer than three, or all are equal.
const correlateRanks = (a, b) => {
  if (a.length < 3) return null;
  const middle = (a.length + 1) / 2;
  const [x, y] = [a, b].map((values) => rankAll(values).map((rank) => rank - middle));
  const spread = Math.sqrt(dot(x, x) * dot(y, y));
  return spread > 0 ? dot(x, y) / spread : null;
};

// The estimate that is of the GPU whose driver names it so, "AMD Radeon RX 6900 XT (RADV NAVI21)".
const findEstimate = (renderer) => {
  const words = renderer.toLowerCase().split(/[^a-z0-9]+/);
  return run.costs.find(({ gpu }) => gpu && words.includes(gpu.toLowerCase()));
};
// Both of each configuration that has both, the cheapest estimate first.
const pairCosts = (estimate, measured) =>
  run.configurations
    .map(({ label, ...costs }) => ({ label, estimated: costs[estimate], taken: costs[measured] }))
    .filter(({ estimated, taken }) => Number.isFinite(estimated) && Number.isFinite(taken))
    .sort((a, b) => a.estimated - b.estimated);

// How alike their orders are, in a sentence; empty where there is no estimate for a machine.
const sayEstimates = (renderer) => {
  const estimate = findEstimate(renderer);
  if (!estimate) return "";
  const pairs = pairCosts(estimate.field, `machine${machines.findIndex((each) => each.renderer === renderer)}.moving`);
  const [a, b] = ["estimated", "taken"].map((name) => pairs.map((pair) => pair[name]));
  const correlation = correlateRanks(a, b);
  const lead = `Over ${pairs.length} configurations, the rank correlation of the estimates for ${estimate.gpu} and`;
  const value = correlation === null ? "not known: fewer than three differ" : correlation.toFixed(2);
  return `${lead} the times of ${renderer} (moving light) is ${value}.`;
};
// Shows both of each machine that has an estimate, in the section of the GPUs.
const showEstimates = () => {
  const section = document.getElementById("gpus");
  section?.querySelectorAll(".measured").forEach((each) => each.remove());
  machines.forEach(({ renderer }, at) => {
    const estimate = findEstimate(renderer);
    if (!estimate || !section) return;
    const box = element(section, "div", { className: "measured" });
    element(box, "p", {}, sayEstimates(renderer));
    const title = `Estimates for ${estimate.gpu} and times of ${renderer}`;
    const scroll = element(box, "div", { className: "scroll", tabIndex: 0, role: "group", "aria-label": title });
    const table = element(scroll, "table");
    const head = element(element(table, "thead"), "tr");
    const columns = ["filter", "estimate, ms", "measured, ms"];
    columns.forEach((column, i) => element(head, "th", { scope: "col", className: i > 0 ? "n" : "s" }, column));
    const body = element(table, "tbody");
    for (const { label, estimated, taken } of pairCosts(estimate.field, `machine${at}.moving`)) {
      const row = element(body, "tr");
      element(row, "th", { scope: "row", dir: "auto" }, label);
      for (const value of [estimated, taken]) element(row, "td", { className: "n" }, format(value));
    }
  });
};
