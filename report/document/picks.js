// Fast, balanced and best of the configurations that keep the limits, as name_picks() of the program has them: each with
// the columns of the answer where it stands. `keeping` has the cheapest first.
const pickThree = (keeping, { hasOthers, rmseOf, costOf, areTied, why }) => {
  const share = (part) => `${Math.round(100 * part)} %`;
  const [fast] = keeping;
  const known = keeping.every((each) => rmseOf(each));
  const least = known && keeping.reduce((a, b) => (rmseOf(b).value < rmseOf(a).value ? b : a));
  const best = known && keeping.find((each) => !isErrorLess(rmseOf(least), rmseOf(each)));
  if (!best || best === fast) return [{ columns: best && hasOthers ? [0, 2] : [0], ...fast, why }];
  const isDearer = !areTied(fast, best);
  const times = isDearer && costOf(fast) > 0 ? `, ${format(costOf(best) / costOf(fast))} × fast's cost` : "";
  const ofCost = (each) => (costOf(each) - costOf(fast)) / (costOf(best) - costOf(fast));
  const ofGain = (each) => (rmseOf(fast).value - rmseOf(each).value) / (rmseOf(fast).value - rmseOf(best).value);
  const below = (each) => ofGain(each) - ofCost(each); // the straight line from fast to best
  const between = keeping
    .slice(1, keeping.indexOf(best))
    .filter((each) => !areTied(each, best) && isErrorLess(rmseOf(each), rmseOf(fast)));
  const knee = isDearer && between.reduce((a, b) => (below(b) > (a ? below(a) : 0) ? b : a), null);
  const gain = knee && `${share(ofGain(knee))} of the quality gain for ${share(ofCost(knee))} of the extra cost`;
  return [
    { columns: [0], ...fast, why },
    ...(knee ? [{ columns: [1], ...knee, why: gain }] : []),
    { columns: [2], ...best, why: `least RMSE${times}` },
  ];
};

// What a sweep of the bias recommends for picks, as a row of their table; none where none was swept.
const addBiasRow = (body, picks) => {
  const biasOf = (column) => run.configurations[picks.find(({ columns }) => columns.includes(column))?.index]?.bias;
  const biases = [0, 1, 2].map(biasOf);
  if (!biases.some(Boolean)) return;
  const row = element(body, "tr");
  element(row, "th", { scope: "row" }, "bias to ship");
  for (const bias of biases) element(row, "td", {}, bias || "–");
};
