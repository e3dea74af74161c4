// What a run holds: a filter is the index of its configuration, and the truth is -1.
const block = document.getElementById("run");
const run = JSON.parse(block.textContent);
const kTruth = -1;
const kOfTruth = { visibility: "area", uncertainty: "standard_error" };
const kOtherNames = { uncertainty: "rounding" };
shadowbench.cost = run.cost; // which of the costs the answer, the table and the charts have
const costChoice = () => run.costs.find(({ id }) => id === shadowbench.cost);
// The unit in which all costs of the choice are shown, and how many of them are one of its own.
const costScale = () => {
  const { field, unit } = costChoice();
  const isShort = unit === "ms" && run.configurations.every((each) => !(each[field] >= 1));
  return isShort ? { unit: "µs", factor: 1000 } : { unit, factor: 1 };
};
const showCost = () => {
  shadowbench.drawTable?.();
  shadowbench.drawCharts?.();
};

const cells = new Map(run.cells.map((cell) => [`${cell.configuration} ${cell.place}`, cell]));
const cellAt = (who, place) => cells.get(`${who} ${place}`);
const findEntry = (who, place) => {
  const entry = who === kTruth ? run.truths[place] : cellAt(who, place);
  return entry && (entry.picture || entry.values) ? entry : null;
};
const listFilters = (place) => [...run.configurations.keys()].filter((who) => findEntry(who, place));
const listAll = (place) => [kTruth, ...listFilters(place)].filter((who) => findEntry(who, place));
const nameOf = (who) => (who === kTruth ? "truth" : run.configurations[who].label);
const quote = (text) => `\u2068${text}\u2069`; // a name of the other direction leaves its sentence in order
const tell = (who) => (who === kTruth ? "the truth" : quote(nameOf(who))); // a name inside a sentence
const attempt = async (promise) => {
  try {
    return { value: await promise };
  } catch ({ message }) {
    return { message };
  }
};
const attemptAll = (promises) => Promise.all(promises.map(attempt));

const loadFile = async (who, place) => {
  const path = findEntry(who, place)?.values;
  if (!path) throw new Error(`No values are stored for ${tell(who)}.`);
  return loadValues(path);
};
const namePlane = (file, who, layer) => {
  const names = who === kTruth ? [kOfTruth[layer]] : [layer === "error" ? "visibility" : layer, kOtherNames[layer]];
  return names.find((name) => file.planes.has(name));
};
const getPlane = async (who, place, layer) => {
  const file = await loadFile(who, place);
  const name = namePlane(file, who, layer);
  if (!name) throw new Error(`This layer is not stored for ${tell(who)}.`);
  return file.planes.get(name)();
};
// The layer that a side shows: its visibility where the truth has no such layer.
const nameShown = async (who, place, layer) => {
  const { value } = await attempt(loadFile(who, place));
  return who === kTruth && value && !namePlane(value, who, layer) ? "visibility" : layer;
};
const getNumbers = async (who, place, layer) => {
  if (layer !== "error" || who === kTruth) return getPlane(who, place, layer);
  return subtract(await getPlane(who, place, "visibility"), await getPlane(kTruth, place, "visibility"));
};
const getMask = async (place) => {
  const { value } = await attempt(loadFile(kTruth, place));
  return (await attempt(value?.planes.get("mask")?.())).value;
};

const keepPicture = makeStore(24);
const loadPicture = async (path) => {
  const image = new Image();
  image.src = path;
  await image.decode().catch(() => {
    throw new Error(`${path} cannot be read: the picture is not beside this page.`);
  });
  const canvas = makeCanvas(image.naturalWidth, image.naturalHeight);
  canvas.getContext("2d").drawImage(image, 0, 0);
  return canvas;
};
const getPicture = async (who, place) => {
  const path = findEntry(who, place)?.picture;
  if (!path) throw new Error(`No picture is stored for ${tell(who)}.`);
  return keepPicture(path, 1, () => loadPicture(path));
};
const cut = (source, rect, factor) => {
  const canvas = makeCanvas(Math.round(rect.width * factor), Math.round(rect.height * factor));
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = factor < 1;
  context.drawImage(source, rect.x, rect.y, rect.width, rect.height, 0, 0, canvas.width, canvas.height);
  return canvas;
};
// What the viewer can show of a side; a plane of a family joins them as it is met.
const kSigned = { palette: "diverging", least: 0.05, low: "darkens", high: "lightens" };
const kHeat = { palette: "heat", low: "", high: "" };
const kOfError = { low: "darker than the truth", high: "lighter than the truth" };
const layers = [
  { name: "picture", title: "Picture" },
  { name: "visibility", title: "Visibility", palette: "grey", least: 1, low: "shadow", high: "lit" },
  { ...kSigned, ...kOfError, name: "error", title: "Error (visibility \u2212 truth)" },
  { ...kSigned, name: "numeric", title: "Error part: numeric" },
  { ...kSigned, name: "estimator", title: "Error part: estimator" },
  { ...kSigned, name: "discretisation", title: "Error part: discretisation" },
  { ...kSigned, name: "model", title: "Error part: model" },
  { ...kHeat, name: "flip", title: "FLIP", least: 0.05 },
  { ...kHeat, name: "stability", title: "Stability", least: 0.01 },
  { ...kHeat, name: "uncertainty", title: "Uncertainty", least: 1e-4 },
];
const layerOf = (name) => layers.find((each) => each.name === name);
// A family of planes ("stability.min") becomes layers as its planes are met. Says whether the plane is new.
const addLayer = (name) => {
  const family = /^(stability|uncertainty)\../.test(name) && layerOf(name.split(".")[0]);
  if (!family || layerOf(name)) return false;
  const title = `${family.title}: ${name.slice(family.name.length + 1)}`;
  layers.splice(layers.indexOf(family) + 1, 0, { ...family, name, title });
  return true;
};
