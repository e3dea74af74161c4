// How a frame that is drawn here is held against the run, and which of its steps are which part of its cost.
const kVisibility = "visibility_image"; // the sampler of the shading, which reads what the lookup wrote
const kGoals = { comparison: 1e-5, stored: 1e-3 }; // RMSE to the run's visibility
const kFarthestTap = 16; // texels

const compareValues = (values, plane, mask, width, { x, y, width: columns, height: rows }, leftOut) => {
  const gaps = [];
  for (let row = y; row < y + rows; ++row)
    for (let column = x, i = row * width + x; column < x + columns; ++column, ++i)
      if ((!mask || mask[i]) && Number.isFinite(plane[i])) gaps.push(Math.abs(values[i] - plane[i]));
  gaps.sort((a, b) => a - b);
  const kept = gaps.slice(0, gaps.length - Math.floor(leftOut * gaps.length));
  return {
    rmse: Math.sqrt(kept.reduce((sum, gap) => sum + gap * gap, 0) / Math.max(kept.length, 1)),
    worst: gaps.at(-1) ?? 0,
  };
};
// How far a filter's visibility is from what the run drew of it: where receivers and map are those of the run, less the
// outermost pixels, whose neighbours are not; and everywhere, where they are this GPU's own. What this GPU's own
// arithmetic may make of it is allowed for: its weights in each of two directions, its cosines where taps are turned, and
// receivers so near to the border of two texels that it takes the other one. These are left out, as many as there may be.
const checkFrame = ({ player, picture, frames }, plane, mask, { weight, shift, turn }) => {
  const visibility = player.inputOf(picture, kVisibility);
  const read = () => {
    player.draw(visibility);
    return player.read(visibility);
  };
  const same = player.withKnown(read);
  const own = read();
  const { width, height } = player.textureOf(visibility);
  const [x, y, columns, rows] = frames.check.rect;
  const inner = { x: x + 1, y: y + 1, width: columns - 2, height: rows - 2 };
  const gap = compareValues(same, plane, mask, width, inner, 4 * shift);
  const all = compareValues(own, plane, mask, width, { x: 0, y: 0, width, height }, 0);
  const isStored = frames.steps[visibility].inputs.some(({ sampler }) => /^map_(?!depth$|compare)/.test(sampler));
  const goal = (isStored ? kGoals.stored : kGoals.comparison) + 2 * (weight + kFarthestTap * turn);
  return { ...gap, all: all.rmse, isSame: gap.rmse <= goal };
};

// The steps of a frame by the part of the cost that they are.
const stepsOf = ({ player, picture, empty, frames }) => {
  const visibility = player.inputOf(picture, kVisibility);
  const all = [...player.listSteps(visibility)];
  const labelled = (label) => {
    const isOf = ({ op, program }) => op === "draw" && frames.programs[program].label.startsWith(label);
    return all.filter((index) => isOf(frames.steps[index]));
  };
  const textureOf = (index) => frames.steps[index].targets[0].texture;
  const into = (indices, among) => among.filter((index) => indices.map(textureOf).includes(textureOf(index)));
  const lookupOf = (last) => (last === null ? [] : into([last], [...player.listSteps(last)]));
  const map = into([...labelled("depth"), ...labelled("midpoint")], all);
  const lookup = lookupOf(visibility);
  const shared = [...map, ...lookup, ...labelled("gbuffer"), ...labelled("prepare_receivers")];
  const isOwn = (index) => frames.steps[index].op === "draw" && !shared.includes(index);
  return { map: frames.check.whole ? [] : map, lookup, prefilter: all.filter(isOwn), empty: lookupOf(empty) };
};

// The lookup less its empty one, whose intervals add up.
const subtractTimes = (lookup, empty) => {
  if (!empty) return lookup;
  const interval =
    lookup.interval && empty.interval
      ? [lookup.interval[0] - empty.interval[1], lookup.interval[1] - empty.interval[0]]
      : null;
  const queries = lookup.queries && empty.queries && subtractTimes(lookup.queries, empty.queries);
  return { median: lookup.median - empty.median, interval, rounds: lookup.rounds, ...(queries && { queries }) };
};
// Whether timer queries say something else, by more than both intervals.
const areQueriesApart = ({ interval, queries }) =>
  Boolean(interval && queries?.interval) && (queries.interval[0] > interval[1] || queries.interval[1] < interval[0]);
