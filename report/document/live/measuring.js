// How a frame that is drawn here is held against the run, and which of its steps are which part of its cost.
const kVisibility = "visibility_image"; // the sampler of the shading, which reads what the lookup wrote
const kGoals = { comparison: 1e-5, stored: 1e-3 }; // RMSE to the run's visibility
const kFarthestTap = 16; // texels
const kScreen = "screen_image"; // the sampler of screen passes
const kScreenReach = 8; // pixels that one of them is taken to read

// The steps of a filter's screen passes, of those that lead to a step.
const listScreens = (player, frames, last) =>
  [...player.listSteps(last)].filter((index) => frames.steps[index].inputs?.some(({ sampler }) => sampler === kScreen));

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
  const margin = 1 + kScreenReach * listScreens(player, frames, visibility).length;
  const inner = { x: x + margin, y: y + margin, width: columns - 2 * margin, height: rows - 2 * margin };
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
  // With the filter's screen passes, which read what the lookup or a pass before has drawn.
  const lookupOf = (last) => {
    if (last === null) return [];
    const read = listScreens(player, frames, last).map((index) => player.inputOf(index, kScreen));
    return into([last, ...read], [...player.listSteps(last)]);
  };
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
  return { median: lookup.median - empty.median, interval, rounds: lookup.rounds };
};
// Checks and times the filters of a place as the run measured them: how far each is from the run, and what its parts take.
const kRounds = 11;
const kShownEveryMs = 500; // a table of many rows takes a while to lay out
const makeMeasuring = (engine) => {
  const { gl } = engine;
  const time = makeTimer(gl);
  const found = new Map(); // by a cell's key
  const samplings = new Map(); // by a map's size
  const references = new Map(); // by place: the RMSE of the mean of many maps to the truth; undefined: there is none
  let whyStopped = "";
  const isStopped = () => whyStopped !== "";

  const samplingAt = (size) => {
    if (!samplings.has(size)) samplings.set(size, measureSampling(gl, size));
    return samplings.get(size);
  };
  const loadAsRun = async (who, place) => {
    const frame = await engine.load(who, place);
    engine.pose(frame, kAsRun);
    return frame;
  };
  const check = async (who, place) => {
    const frame = await engine.load(who, place);
    const [plane, mask] = [await getPlane(who, place, "visibility"), await getMask(place)];
    engine.pose(frame, kAsRun);
    const result = checkFrame(frame, plane, mask, samplingAt(run.configurations[who].map));
    found.set(frame.cell.key, { ...found.get(frame.cell.key), ...result, refused: undefined });
  };
  const checkPlace = async (place, show) => {
    let next = 0;
    for (const who of listFiltersAt(place)) {
      if (isStopped()) return;
      const { message: why } = await attempt(check(who, place));
      if (why) found.set(cellAt(who, place).key, { refused: why });
      if (performance.now() > next) {
        show();
        next = performance.now() + kShownEveryMs;
      }
      await pause();
    }
  };
  // How far the reference is from the traced truth.
  const checkReference = async (place) => {
    references.set(place, references.get(place)); // asked for once, and undefined until it is known
    const reference = await engine.findReference(kAsRun, place);
    if (!reference || !run.truths[place]) return;
    while (engine.refine(reference, kAsRun) && !isStopped()) await pause();
    if (isStopped()) return;
    const [plane, mask] = [await getPlane(kTruth, place, "visibility"), await getMask(place)];
    const { width, height } = await loadFile(kTruth, place);
    const { rmse } = compareValues(reference.read(), plane, mask, width, { x: 0, y: 0, width, height }, 0);
    references.set(place, rmse);
  };
  // Times the filters of a place that draw as the run did; what they share is timed once.
  const timePlace = async (place, onRound) => {
    const drawn = new Map();
    const keys = [];
    for (const who of listFiltersAt(place)) {
      const { value: frame } = await attempt(loadAsRun(who, place));
      if (!frame || !found.get(frame.cell.key)?.isSame) continue;
      const { player, empty } = frame;
      [frame.picture, empty].filter((step) => step !== null).forEach((step) => player.draw(step));
      const parts = stepsOf(frame);
      const names = Object.keys(parts).filter((name) => parts[name].length > 0);
      const idOf = (name) => `${frame.cell.frames} ${parts[name].join()}`;
      for (const name of names) drawn.set(idOf(name), (count) => player.repeat(parts[name], count));
      keys.push({ key: frame.cell.key, ids: Object.fromEntries(names.map((name) => [name, idOf(name)])) });
    }
    const times = await time([...drawn.values()], kRounds, onRound, isStopped);
    const byId = new Map([...drawn.keys()].map((id, i) => [id, times[i]]));
    for (const { key, ids } of keys) {
      const [map, lookup, prefilter, empty] = ["map", "lookup", "prefilter", "empty"].map((name) =>
        byId.get(ids[name]),
      );
      const filter = lookup && subtractTimes(lookup, empty);
      if (filter && (map || !ids.map))
        found.set(key, { ...found.get(key), map: map ?? null, prefilter: prefilter ?? null, filter });
    }
  };
  // Throws why there are none that could be costs.
  const collectTimes = () => {
    if (isStopped()) throw new Error(whyStopped);
    const timed = [...found].filter(([, { filter }]) => filter);
    if (timed.length === 0) throw new Error("Nothing that is drawn here agrees with the run, so nothing was timed.");
    const parts = ([key, { map, prefilter, filter }]) => [key, { map, prefilter, filter }];
    return {
      schema: kTimesSchema,
      renderer: engine.renderer,
      browser: navigator.userAgent,
      isSoftware: engine.isSoftware,
      cells: Object.fromEntries(timed.map(parts)),
    };
  };
  return {
    found,
    samplingAt,
    knowsReference: (place) => references.has(place),
    errorOfReference: (place) => references.get(place),
    begin: () => (whyStopped = ""),
    stop: (why) => (whyStopped ||= why),
    isStopped,
    checkPlace,
    checkReference,
    timePlace,
    collectTimes,
  };
};

const kResultColumns = [
  "filter",
  "RMSE to the run, same map",
  "farthest pixel",
  "RMSE to the run, own map",
  "filter, ms",
  "prefilter, ms",
];
// Shows what is known of the filters of a place.
const fillResults = (box, place, { found, samplingAt, errorOfReference }) => {
  const whos = listFiltersAt(place);
  const rows = whos.map((who) => [who, found.get(cellAt(who, place).key) ?? {}]);
  box.replaceChildren();
  if (rows.every(([, { rmse, refused }]) => rmse === undefined && !refused)) return;
  const { weight, shift, turn } = samplingAt(run.configurations[whos[0]].map);
  const isExact = weight < 1e-5 && shift === 0 && turn < 1e-6;
  const parts = `2x2 weights ${format(weight)}, nearest texels ${format(shift)}, cosines ${format(turn)}`;
  const sampling = isExact
    ? "Its sampling is exact."
    : `Its measured deviations, which the check allows for: ${parts}.`;
  const [, { map } = {}] = rows.find(([, { map }]) => map) ?? [];
  const ofMap = map ? ` The map takes ${format(map.median)} ms.` : "";
  const title = `Drawn by this GPU on ${run.places[place].title}.`;
  const off = errorOfReference(place);
  const ofMaps =
    off === undefined
      ? ""
      : ` The mean of ${kReferenceMaps} maps from points of the light has an RMSE of ${format(off)} to the traced truth.`;
  // As a caption it would be as wide as the table, and be cut where the table is.
  element(box, "p", { className: "note results" }, `${title} ${sampling}${ofMap}${ofMaps}`);
  const table = element(element(box, "div", { className: "scroll", tabIndex: 0 }), "table", { ariaLabel: title });
  const head = element(element(table, "thead"), "tr");
  for (const column of kResultColumns) element(head, "th", { scope: "col" }, column);
  const body = element(table, "tbody");
  const say = (each) => (each ? format(each.median) : "");
  const sayInterval = (each) =>
    each?.interval ? `95 %: ${each.interval.map((end) => format(end)).join(" to ")}, of ${each.rounds} rounds` : "";
  for (const [who, { rmse, worst, all, isSame, refused, filter, prefilter }] of rows) {
    const row = element(body, "tr");
    element(element(row, "th", { scope: "row" }), "bdi", {}, nameOf(who));
    if (refused) {
      element(row, "td", { colSpan: kResultColumns.length - 1, className: "text" }, refused);
      continue;
    }
    const isKnown = rmse !== undefined;
    const verdict = isKnown ? (isSame ? "" : "✗ ") + format(rmse) : "";
    element(row, "td", { className: isKnown && !isSame ? "bad" : "" }, verdict);
    for (const value of [worst, all]) element(row, "td", {}, isKnown ? format(value) : "");
    for (const each of [filter, prefilter]) element(row, "td", { title: sayInterval(each) }, say(each));
  }
};
