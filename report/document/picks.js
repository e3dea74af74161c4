// Fast, balanced and best of what keeps the limits that the reader moves, as advise() and list_picks() of the program
// find them: the page's data has what they judged, the order by cost with its ties, worst values, and errors.
const kTime = "time_ms";
const isErrorLess = (a, b) => {
  const gaps = b.replicates.map((value, i) => value - a.replicates[i]);
  const count = gaps.length;
  if (count < 2 || count !== a.replicates.length) return b.value - a.value > Math.max(a.reach, b.reach);
  const mean = gaps.reduce((sum, each) => sum + each) / count;
  const squares = gaps.reduce((sum, each) => sum + (each - mean) ** 2, 0);
  return b.value - a.value > a.t * Math.sqrt(squares / (count - 1) / count);
};
const areErrorsTied = (a, b) => !isErrorLess(a, b) && !isErrorLess(b, a);
const areCostsTied = (a, b) => {
  const [cheaper, dearer] = a.rank < b.rank ? [a, b] : [b, a];
  return cheaper.tied.some(([from, end]) => from <= dearer.rank && dearer.rank < end);
};
const pickThree = (keeping, hasOthers) => {
  const [fast] = keeping;
  const isKnown = hasOthers && keeping.every(({ rmse }) => rmse);
  const least = isKnown && keeping.reduce((a, b) => (b.rmse.value < a.rmse.value ? b : a));
  const cheapest = isKnown && keeping.find(({ rmse }) => !isErrorLess(least.rmse, rmse));
  if (!cheapest || cheapest.rmse.value > run.most_of_tie * least.rmse.value) return [{ columns: [0], ...fast }];
  const areAlike = (a, b) => a === b || (areErrorsTied(a.rmse, b.rmse) && areCostsTied(a, b));
  const avoidSeam = (own) => keeping.reduce((a, b) => (b.seam < a.seam && areAlike(own, b) ? b : a), own);
  const best = avoidSeam(cheapest);
  if (best === fast) return [{ columns: [0, 2], ...fast }];
  const ofCost = ({ cost }) => (cost - fast.cost) / (cheapest.cost - fast.cost);
  const ofGain = ({ rmse }) => (fast.rmse.value - rmse.value) / (fast.rmse.value - cheapest.rmse.value);
  const below = (each) => ofGain(each) - ofCost(each); // the straight line from fast to best
  const isKnee = (each) => !areCostsTied(each, cheapest) && isErrorLess(each.rmse, fast.rmse) && below(each) > 0;
  const knees = areCostsTied(fast, cheapest) ? [] : keeping.slice(1, keeping.indexOf(cheapest)).filter(isKnee);
  const knee = knees.length > 0 && avoidSeam(knees.reduce((a, b) => (below(b) > below(a) ? b : a)));
  const times = fast.cost > 0 && !areCostsTied(fast, best) ? best.cost / fast.cost : null;
  return [
    { columns: [0], ...fast },
    ...(knee && knee !== best ? [{ columns: [1], ...knee, gain: ofGain(knee), extra: ofCost(knee) }] : []),
    { columns: [2], ...best, times },
  ];
};
// What keeps the limits in a scope, cheapest first: what nothing beats, and, where nothing that is seen is limited, what
// is clearly better than the cheapest without a filter.
const judgeScope = (scope, { id, field }, { wide, soft, limits }) => {
  const { order, unjudged } = scope.advice[id][wide] ?? { order: [], unjudged: [] };
  const asked = Object.entries(limits).map(([name, most]) => [name === kTime ? field : name, most]);
  const all = order.map(({ index, tied }, rank) => {
    const { worst, rmse, seam, [field]: cost } = scope.rows[index];
    const gap = asked.map(([name]) => worst[name]).find((each) => typeof each === "string");
    const isKept = asked.every(([name, most]) => worst[name].value <= most);
    return { index, rank, tied, cost, rmse, seam, gap, keeps: isKept && (!soft || run.configurations[index].hardens) };
  });
  const judged = all.filter(({ gap }) => !gap);
  const kept = judged.filter(({ keeps }) => keeps);
  const beats = (a, b) => a.rmse?.value <= b.rmse?.value && a.seam <= b.seam;
  const isBeaten = (each, i) => kept.slice(0, i).some((other) => beats(other, each));
  const front = kept.filter((...each) => !isBeaten(...each));
  const unfiltered = scope.advice[id][""]?.order.find(({ index }) => run.configurations[index].filter === "none");
  const none = unfiltered && scope.rows[unfiltered.index].rmse;
  const isSeen = ([name]) => run.measures.some((each) => each.id === name && each.group !== "cost");
  const isGain = ({ rmse }) => none && rmse && isErrorLess(rmse, none);
  const gains = asked.some(isSeen) ? [] : front.filter(isGain);
  const keeping = gains.length > 0 ? gains : front;
  return {
    keeping,
    none,
    beaten: kept.filter(isBeaten),
    noGain: front.filter((each) => !keeping.includes(each)),
    failing: judged.filter(({ keeps }) => !keeps),
    unjudged: [...unjudged, ...all.filter(({ gap }) => gap)],
    picks: keeping.length > 0 ? pickThree(keeping, kept.length > 1) : [],
  };
};
