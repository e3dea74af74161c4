// Fast, balanced and best of the configurations that keep the limits, as name_picks() of the program has them: each with
// the columns of the answer where it stands. `keeping` has the cheapest first.
const pickThree = (keeping, { hasOthers, rmseOf, costOf, areTied, seamOf, why }) => {
  const share = (part) => `${Math.round(100 * part)} %`;
  const [fast] = keeping;
  const known = hasOthers && keeping.every((each) => rmseOf(each));
  const least = known && keeping.reduce((a, b) => (rmseOf(b).value < rmseOf(a).value ? b : a));
  const cheapest = known && keeping.find((each) => !isErrorLess(rmseOf(least), rmseOf(each)));
  const isVague = cheapest && rmseOf(cheapest).value > 1.1 * rmseOf(least).value;
  const vague = isVague ? "; no best one is named, as RMSEs are too uncertain: take more --phases" : "";
  if (!cheapest || isVague) return [{ columns: [0], ...fast, why: why + vague }];
  const areAlike = (a, b) =>
    a === b ||
    (!isErrorLess(rmseOf(a), rmseOf(b)) &&
      !isErrorLess(rmseOf(b), rmseOf(a)) &&
      (a.rank < b.rank ? areTied(a, b) : areTied(b, a)));
  // Of those whose cost and RMSE cannot be told from a pick's, the one with the smallest seam.
  const avoidSeam = (own) =>
    keeping.filter((each) => areAlike(own, each)).reduce((a, b) => (seamOf(b) < seamOf(a) ? b : a), own);
  const best = avoidSeam(cheapest);
  if (best === fast) return [{ columns: [0, 2], ...fast, why }];
  const isDearer = !areTied(fast, cheapest);
  const times =
    !areTied(fast, best) && costOf(fast) > 0 ? `, ${format(costOf(best) / costOf(fast))} × fast's cost` : "";
  const ofCost = (each) => (costOf(each) - costOf(fast)) / (costOf(cheapest) - costOf(fast));
  const ofGain = (each) => (rmseOf(fast).value - rmseOf(each).value) / (rmseOf(fast).value - rmseOf(cheapest).value);
  const below = (each) => ofGain(each) - ofCost(each); // the straight line from fast to best
  const between = keeping
    .slice(1, Math.max(1, keeping.indexOf(cheapest)))
    .filter((each) => !areTied(each, cheapest) && isErrorLess(rmseOf(each), rmseOf(fast)));
  const found = isDearer && between.reduce((a, b) => (below(b) > (a ? below(a) : 0) ? b : a), null);
  const knee = found && avoidSeam(found);
  const gain = knee && `${share(ofGain(knee))} of the quality gain for ${share(ofCost(knee))} of the extra cost`;
  return [
    { columns: [0], ...fast, why },
    ...(knee && knee !== best ? [{ columns: [1], ...knee, why: gain }] : []),
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
