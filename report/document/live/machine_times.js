// A short title of a GPU from what a browser says draws for it. That is the driver's own word, or "ANGLE (vendor, word,
// driver)", in which the word may be "Vulkan 1.3 (word (device))" and names the API that it is drawn by.
const titleGpu = (renderer) => {
  const plain = renderer.trim().replace(/\s*\((R|TM|C)\)|, or similar$/gi, "");
  const inner = /^ANGLE \((.*)\)$/.exec(plain)?.[1];
  const nested = /(?:ANGLE|Vulkan [\d.]+) \(([^()]+)/.exec(inner ?? plain)?.[1];
  const own = nested ?? inner?.replace(/^[^,]*, /, "") ?? plain;
  const [title] = own.replace(/^(ANGLE Metal Renderer: |Mesa (DRI )?)/, "").split(/ \(| Direct3D| OpenGL|[,/]/);
  return title.replace(/^(\w+) \1\b/, "$1").trim() || renderer;
};

// Times that a GPU took, here or elsewhere, as costs beside those of the run. A file of them, gpu-times.json, has for
// each cell, by its key, what its parts take: `map`, `prefilter` and `filter` (the lookup less its empty one), each with
// the median, a 95 % interval or null, and how many rounds they are of, ms (the map null where it could not be drawn).
const kTimesSchema = "shadowbench gpu-times 1";
const kTimedParts = ["map", "prefilter", "filter"];
const machines = []; // as files have them

const isTime = (part) => {
  const isSound = (value) => Number.isFinite(value) && Math.abs(value) < 1e9;
  const { median, interval, rounds } = part ?? {};
  const hasInterval =
    interval === null || (Array.isArray(interval) && interval.length === 2 && interval.every(isSound));
  const hasRounds = Number.isInteger(rounds) && rounds > 0;
  return isSound(median) && hasInterval && hasRounds;
};
// Takes the text of a file of this run's times apart; throws where it is none.
const readTimes = (text) => {
  const parse = () => {
    try {
      return JSON.parse(text);
    } catch {
      return null;
    }
  };
  const file = parse();
  const known = Object.entries(file?.cells ?? {}).filter(([key]) => run.cells.some((cell) => cell.key === key));
  const isSound = (parts) =>
    kTimedParts.every((name) => isTime(parts?.[name]) || (name !== "filter" && parts?.[name] === null));
  const areSound = known.length > 0 && known.every(([, parts]) => isSound(parts));
  if (file?.schema !== kTimesSchema || typeof file.renderer !== "string" || !areSound)
    throw new Error("This is no gpu-times.json that a page of this run saved.");
  return { ...file, cells: Object.fromEntries(known) };
};

const sumParts = (parts) => ({
  value: parts.reduce((sum, { median }) => sum + median, 0),
  low: parts.reduce((sum, { median, interval }) => sum + (interval?.[0] ?? median), 0),
  high: parts.reduce((sum, { median, interval }) => sum + (interval?.[1] ?? median), 0),
});
// What a cell's frame takes: of a static light its lookup alone.
const timeOfFrame = (parts, isStatic) =>
  parts &&
  (isStatic || parts.map) &&
  sumParts(isStatic ? [parts.filter] : kTimedParts.map((name) => parts[name]).filter(Boolean));

// The mean over the cells of a configuration that a scope counts, and its largest; null where one has no time.
const combineTimes = (times, isStatic, index, scope) => {
  const leftOut = run.scopes.filter((each) => each.left_out).map(({ scene }) => scene);
  const counts = ({ place }) =>
    scope.scene ? run.places[place].scene === scope.scene : !leftOut.includes(run.places[place].scene);
  const own = run.cells.filter((cell) => cell.configuration === index && counts(cell));
  const all = own.map(({ key, place }) => ({ place, ...timeOfFrame(times.cells[key], isStatic) }));
  if (all.length === 0 || all.some(({ value }) => value === undefined)) return null;
  const value = all.reduce((sum, each) => sum + each.value, 0) / all.length;
  const reach = (end) => Math.sqrt(all.reduce((sum, each) => sum + (each[end] - each.value) ** 2, 0)) / all.length;
  const worst = all.reduce((a, b) => (b.value > a.value ? b : a));
  return { value, low: value - reach("low"), high: value + reach("high"), worst };
};
// The ranks behind each that cannot be told from it, as pairs of the first and the one after the last.
const listTies = (order) =>
  order.map(({ index, cost }, rank) => {
    const tied = order.map((other, at) => (at > rank && other.cost.low <= cost.high ? [at, at + 1] : null));
    return { index, tied: tied.filter(Boolean) };
  });
const addScopeTimes = (times, { id, field, isStatic, title }, scope) => {
  const costs = scope.rows.map((row, index) => row && combineTimes(times, isStatic, index, scope));
  costs.forEach((cost, index) => {
    const row = scope.rows[index];
    if (!row) return;
    const limit = cost && Number(cost.worst.value.toPrecision(3));
    row[field] = cost?.value ?? null;
    row.worst[field] = cost
      ? { value: cost.worst.value, limit: Math.max(limit, cost.worst.value), place: cost.worst.place, unseen: [] }
      : `no time by ${title}`;
  });
  const advice = {};
  const [{ id: own }] = run.costs.filter(({ gpu }) => !gpu); // those that were timed, estimates or not
  for (const [wide, { order, unjudged }] of Object.entries(scope.advice[own])) {
    const timed = order.map(({ index }) => ({ index, cost: costs[index] }));
    const rmseOf = ({ index }) => scope.rows[index].rmse?.value ?? Infinity;
    const compare = (a, b) => a.cost.value - b.cost.value || rmseOf(a) - rmseOf(b);
    const ranked = timed.filter(({ cost }) => cost).sort(compare);
    const missing = timed.filter(({ cost }) => !cost).map(({ index }) => ({ index, gap: `no time by ${title}` }));
    advice[wide] = { order: listTies(ranked), unjudged: [...unjudged, ...missing] };
  }
  scope.advice[id] = advice;
};
// Puts a machine's times among the costs, in the place of older ones of the same renderer; gives the id of that of a
// moving light.
const addMachine = (times, isHere) => {
  const old = machines.findIndex(({ renderer }) => renderer === times.renderer);
  const at = old < 0 ? machines.push(times) - 1 : old;
  machines[at] = times;
  for (const isStatic of [false, true]) {
    const id = `machine${at}.${isStatic ? "static" : "moving"}`;
    const name = isHere ? "this GPU" : titleGpu(times.renderer).slice(0, 80);
    const title = `${isStatic ? "static" : "moving"} light, ${name}`;
    const option = `--times gpu-times.json${isStatic ? " --light-motion static" : ""}`;
    const parts = isStatic ? "lookups" : "map, prefilter and lookups";
    const left = "left out: what every lookup pays";
    const text = `ms of a frame with one map, timed in a browser on ${times.renderer}, ${title}: ${parts}; ${left}`;
    const choice = { id, field: id, title, unit: "ms", option, text, gpu: "" };
    const known = run.costs.findIndex((each) => each.id === id);
    if (known < 0) {
      run.costs.push(choice);
      run.measures.push({ id, title, text, unit: "ms", option: "", group: "cost", better: "" });
    } else run.costs[known] = choice;
    run.scopes.forEach((scope) => addScopeTimes(times, { id, field: id, isStatic, title }, scope));
    run.configurations.forEach((each, index) => (each[id] = run.scopes[0]?.rows[index]?.[id] ?? null));
    for (const cell of run.cells) cell.values_of[id] = timeOfFrame(times.cells[cell.key], isStatic)?.value ?? null;
  }
  shadowbench.listCosts?.();
  return `machine${at}.moving`;
};

// What was timed here, now or before: it is kept by the browser, by the place of the page.
const kTimesKey = `shadowbench gpu-times ${location.pathname}`;
let heldTimes = null;
const keepTimes = (times) => {
  heldTimes = times;
  try {
    localStorage.setItem(kTimesKey, JSON.stringify(times));
  } catch {
    // A browser without storage times anew.
  }
};
const timesHere = () => {
  try {
    heldTimes ??= readTimes(localStorage.getItem(kTimesKey));
  } catch {
    // Nothing is held, or times of a run that was here before.
  }
  return heldTimes;
};
