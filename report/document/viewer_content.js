// What the viewer's panes hold, the values and crops below them, and the link to a view.
const kLoadedFirst = 12;
const kNote = " (its visibility: only filters have this layer)";
const keepColours = makeStore(24e6);
const known = new Map(); // the visibility of the place's filters and of its truth
let scale = 1;
let turn = 0;
let wanted = null;

// The least and the greatest value of a pane's receivers.
const sayRange = (values, mask, palette) => {
  let [least, most] = [Infinity, -Infinity];
  values.forEach((value, i) => {
    if ((mask && !mask[i]) || !Number.isFinite(value)) return;
    [least, most] = [Math.min(least, value), Math.max(most, value)];
  });
  const plus = palette === "diverging" ? "+" : "";
  const say = (value) => (value < 0 ? "\u2212" : value > 0 ? plus : "") + format(Math.abs(value));
  return least > most ? "" : `, ${say(least)} to ${say(most)}`;
};

// From the state to what the panes hold.
const makeSides = async (place, layer, mode) => {
  const whos = [state.left, state.right];
  const differs = mode === "difference";
  const name = layer === "picture" ? "visibility" : layer;
  const look = layerOf(name);
  if (layer === "picture" && !differs) return { made: await attemptAll(whos.map((who) => getPicture(who, place))) };
  const names = await Promise.all(whos.map((who) => (differs ? name : nameShown(who, place, name))));
  let found = await attemptAll(whos.map((who, i) => getNumbers(who, place, names[i])));
  if (differs) {
    const message = found.flatMap((each) => each.message ?? []).join(" ");
    const gap = async () => subtract(found[1].value, found[0].value);
    found = [message ? { message } : await attempt(gap())];
  }
  const mask = await getMask(place);
  const planes = found.filter(({ value }, i) => value && names[i] === name).map(({ value }) => value);
  const palette = differs ? "diverging" : look.palette;
  const top = palette === "grey" ? 1 : findScale(planes, mask, Math.min(0.05, look.least));
  const files = await attemptAll(whos.map((who) => loadFile(who, place)));
  const file = files.find(({ value }) => value)?.value;
  const colour = ({ value, message }, i) => {
    if (!value) return { message };
    const isOwn = names[i] === name;
    const [counts, shades, most] = isOwn ? [mask, palette, top] : [undefined, "grey", 1];
    const rect = { x: 0, y: 0, width: file.width, height: file.height };
    const key = [place, whos[i], differs && whos[1], names[i], shades, most].join();
    const make = () => paint(value, counts, file.width, rect, shades, most);
    return { value: keepColours(key, value.length, make), note: isOwn ? sayRange(value, counts, shades) : kNote };
  };
  return { made: found.map(colour), top, palette, look, differs };
};
const showScale = ({ top, palette, look, differs }) => {
  bar.hidden = !top;
  bar.replaceChildren();
  if (!top) return;
  const [low, high] = differs ? ["right is lower", "right is higher"] : [look.low, look.high];
  const signed = palette === "diverging";
  element(bar, "strong", {}, look.title);
  const say = (value, word) => element(bar, "span", {}, word ? `${value} (${word})` : value);
  say(signed ? `\u2212${top}` : "0", low);
  element(bar, "i").style.background = `linear-gradient(to right,${kPalettes[palette]})`;
  say(signed ? `+${top}` : String(top), high);
  element(bar, "span", { className: "hatch" }, "hatched: not a receiver");
};
const labelPane = (pane, titles) => {
  const isDifference = state.mode === "difference";
  pane.figure.hidden = pane === panes[1] && state.mode !== "side";
  const shown = shownIn(pane).sort();
  const notes = sides.map(({ note = "" }) => note);
  const parts = (isDifference ? [0, 1] : shown).map((i) => ({ ...titles[i], note: isDifference ? "" : notes[i] }));
  const gap = isDifference ? `Right \u2212 left${notes[0]}. ` : "";
  pane.caption.replaceChildren(gap);
  for (const { side, name, note } of parts) {
    const text = element(pane.caption, "span", {}, side);
    element(text, "bdi", {}, name);
    text.append(note);
  }
  pane.message.textContent = shown.flatMap((side) => sides[side].message ?? []).join(" ");
  pane.message.hidden = !pane.message.textContent;
  const names = parts.map(({ side, name, note }) => side + quote(name) + note).join("; ");
  const [, mode] = kModes.find(([name]) => name === state.mode);
  const layer = selects.layer.selectedOptions[0]?.text;
  const scene = quote(run.places[state.place].title);
  pane.canvas.setAttribute("aria-label", `${layer} of ${scene}, ${mode}. ${gap}${names}`);
  pane.canvas.style.cursor = isCropping ? "crosshair" : "grab";
};
const label = () => {
  const titles = [
    { side: "Left: ", name: nameOf(state.left) },
    { side: "Right: ", name: nameOf(state.right) },
  ];
  for (const pane of panes) labelPane(pane, titles);
  const press = (button, isPressed) => button.setAttribute("aria-pressed", isPressed);
  for (const button of modeButtons.children) press(button, button.dataset.mode === state.mode);
  for (const button of crops.querySelectorAll("button")) press(button, Number(button.dataset.who) === state.right);
  press(cropButton, isCropping);
  flipButton.hidden = state.mode !== "flip";
  splitLabel.hidden = state.mode !== "slider";
};
const refresh = async () => {
  const mine = ++turn;
  root.ariaBusy = true;
  const { place, layer, mode } = state;
  for (const name of Object.keys(selects)) selects[name].value = state[name];
  for (const option of [...selects.left, ...selects.right]) option.disabled = !findEntry(Number(option.value), place);
  const result = await makeSides(place, layer, mode);
  if (mine !== turn) return;
  sides = mode === "difference" ? [result.made[0], {}] : result.made;
  const source = sides.find(({ value }) => value)?.value;
  if (source) size = { width: source.width, height: source.height };
  Object.assign(state, wanted);
  wanted = null;
  settleView();
  const { crop } = state;
  state.crop = crop && makeCrop(crop, { x: crop.x + crop.width, y: crop.y + crop.height });
  scale = result.top || 1;
  showScale(result);
  label();
  fitCanvases();
  showCrops();
  await listKnownLayers(mine);
  if (mine === turn) root.ariaBusy = false;
};
const change = (changes) => {
  const moves = "place" in changes && changes.place !== state.place;
  Object.assign(state, changes);
  if (moves) {
    const all = listAll(state.place);
    Object.assign(state, { zoom: 1, crop: null });
    if (!findEntry(state.left, state.place)) state.left = all.at(0) ?? kTruth;
    if (!findEntry(state.right, state.place)) state.right = all.at(-1) ?? kTruth;
    wanted = changes.zoom ? changes : null;
    readPlace();
  }
  save();
  return refresh();
};
// A layer that neither side has is greyed out, once the files have told.
const listKnownLayers = async (mine) => {
  const whos = [state.left, state.right];
  const files = await attemptAll(whos.map((who) => loadFile(who, state.place)));
  if (mine !== turn) return;
  for (const { value } of files) for (const name of value?.planes.keys() ?? []) if (addLayer(name)) fillLayers();
  selects.layer.value = state.layer;
  for (const option of selects.layer) {
    const has = ({ value }, i) => value && namePlane(value, whos[i], option.value);
    option.disabled = option.value !== "picture" && !files.some(has);
  }
  whos.forEach((who) => learn(who, state.place));
};

// The values under the pointer.
const learn = async (who, place) => {
  const { value } = await attempt(getNumbers(who, place, "visibility"));
  if (!value || place !== state.place || known.has(who)) return;
  known.set(who, { value });
  table.replaceChildren();
  const head = element(element(table, "thead"), "tr");
  const body = element(table, "tbody");
  element(head, "th", { scope: "col" }, "Filter");
  for (const title of ["Visibility", "Error"]) element(head, "th", { scope: "col", className: "n" }, title);
  for (const each of [...known.keys()].sort((a, b) => a - b)) {
    const row = element(body, "tr");
    element(row, "th", { scope: "row", dir: "auto" }, nameOf(each));
    known.get(each).cells = [0, 1].map(() => element(row, "td", { className: "n" }));
  }
  element(table, "caption");
  tableBox.hidden = false;
  readPixel();
};
const readPixel = () => {
  if (!table.caption) return;
  table.tHead.hidden = table.tBodies[0].hidden = !cursor;
  table.caption.textContent = cursor ? `Pixel x ${cursor.x}, y ${cursor.y}` : "Values under the pointer";
  const at = cursor ? cursor.y * size.width + cursor.x : -1;
  const truth = known.get(kTruth)?.value[at];
  for (const [who, { value, cells }] of known) {
    const here = value[at];
    const gap = who === kTruth ? undefined : here - truth;
    const sign = gap < 0 ? "\u2212" : "+";
    cells[0].textContent = here === undefined ? "" : here.toFixed(3);
    cells[1].textContent =
      here === undefined || truth === undefined || gap === undefined ? "" : sign + Math.abs(gap).toFixed(3);
  }
};
const point = ({ x, y }) => {
  cursor = { x: clamp(Math.floor(x), 0, size.width - 1), y: clamp(Math.floor(y), 0, size.height - 1) };
  readPixel();
  schedule();
};
const readPlace = async () => {
  const { place } = state;
  known.clear();
  table.replaceChildren();
  [tableBox.hidden, cursor] = [true, null];
  await new Promise((resolve) => onceSeen(section, resolve));
  for (const who of [kTruth, ...listFilters(place).slice(0, kLoadedFirst)]) {
    await learn(who, place);
    if (place !== state.place) return;
  }
};
const fillStrip = (strip, title) => {
  strip.replaceChildren();
  strip.hidden = false;
  element(strip, "h3", {}, title);
};
const addThumb = (strip, caption, onclick, make) => {
  const button = addButton(strip, "", onclick, caption);
  const text = element(button, "span", { dir: "auto" }, caption);
  onceSeen(button, async () => {
    const { value, message } = await attempt(make());
    if (value) button.prepend(value);
    else text.textContent += `: ${message}`;
  });
  return button;
};
let cropsShown = "";
const showCrops = () => {
  const { crop, place, layer } = state;
  const key = JSON.stringify([crop, place, layer, scale]);
  if (key === cropsShown) return;
  cropsShown = key;
  crops.hidden = !crop;
  if (!crop) return;
  const title = layerOf(layer).title.toLowerCase();
  fillStrip(crops, `Crop of ${title}: ${crop.width} by ${crop.height} pixels at x ${crop.x}, y ${crop.y}`);
  addButton(crops.firstChild, "Remove", () => change({ crop: null }));
  const make = async (who) => {
    if (layer === "picture") return cut(await getPicture(who, place), crop, 1);
    const name = await nameShown(who, place, layer);
    const values = await getNumbers(who, place, name);
    const mask = await getMask(place);
    const { palette } = layerOf(name);
    return paint(values, mask, size.width, crop, palette, palette === "grey" ? 1 : scale);
  };
  for (const who of listAll(place))
    addThumb(
      crops,
      nameOf(who),
      () => change({ right: who }),
      () => make(who),
    ).dataset.who = who;
  label();
};

// The link.
const save = () => {
  const { place, left, right, layer, mode, x, y, zoom, crop } = state;
  const shown = [run.places[place].title, nameOf(left), nameOf(right), layer, mode];
  const rect = crop ? [[crop.x, crop.y, crop.width, crop.height].join("-")] : [];
  writeLink("view", [...shown, ...[x, y, zoom].map((value) => Number(value.toFixed(3))), ...rect]);
};
const openLink = () => {
  const fields = readLink("view");
  if (!fields) return false;
  const unknown = [];
  const [title, left, right, layer = "", mode, x, y, zoom, crop = ""] = fields;
  if (addLayer(layer)) fillLayers();
  const pick = (name, list, isIt, fallback = 0) => {
    const found = list.findIndex(isIt);
    if (found < 0 && name) unknown.push(quote(name));
    return found < 0 ? fallback : found;
  };
  const place = pick(title, run.places, (each) => each.title === title);
  const findWho = (name, fallback) => {
    if (name === "truth" && findEntry(kTruth, place)) return kTruth;
    const isIt = (each, who) => each.label === name && findEntry(who, place);
    return pick(name, run.configurations, isIt, fallback);
  };
  const numbers = [x, y, zoom].map((text) => (text ? Number(text) : NaN));
  wanted = numbers.every(Number.isFinite) ? { x: numbers[0], y: numbers[1], zoom: numbers[2] } : { zoom: 1 };
  const rect = /^(\d{1,5})-(\d{1,5})-([1-9]\d{0,4})-([1-9]\d{0,4})$/.exec(crop)?.slice(1).map(Number);
  start({
    place,
    left: findWho(left, listAll(place)[0]),
    right: findWho(right, listAll(place).at(-1)),
    layer: layers[pick(layer, layers, ({ name }) => name === layer)].name,
    mode: kModes[pick(mode, kModes, ([name]) => name === mode)][0],
    crop: rect ? { x: rect[0], y: rect[1], width: rect[2], height: rect[3] } : null,
  });
  const named = `The link names what this page does not have: ${unknown.join(", ")}. Something else is shown instead.`;
  said.textContent = unknown.length === 0 ? "" : named;
  section.scrollIntoView();
  return true;
};
const start = (changes) => {
  Object.assign(state, changes);
  readPlace();
  refresh();
};

// Pointers, fingers, the wheel and keys over the viewer's panes.
const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const fingers = new Map();
let gesture = null;
let cropBefore = null;

const locate = (canvas, { clientX, clientY }) => {
  const box = canvas.getBoundingClientRect();
  const step = size.width / box.width / state.zoom;
  const x = state.x + (clientX - box.left - box.width / 2) * step;
  return { x, y: state.y + (clientY - box.top - box.height / 2) * step, step };
};
const partOf = (canvas, { clientX }) => {
  const box = canvas.getBoundingClientRect();
  return (clientX - box.left) / box.width;
};
const makeCrop = (from, to) => {
  const begin = (axis) => Math.max(0, Math.floor(Math.min(from[axis], to[axis])));
  const end = (axis, extent) => Math.min(extent, Math.ceil(Math.max(from[axis], to[axis])));
  const [x, y] = [begin("x"), begin("y")];
  const [width, height] = [end("x", size.width) - x, end("y", size.height) - y];
  return width > 3 && height > 3 ? { x, y, width, height } : null;
};
const pinch = (canvas) => {
  const [a, b] = [...fingers.values()];
  const apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  const middle = { clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 };
  if (gesture.apart) zoomBy(apart / gesture.apart, locate(canvas, middle));
  gesture = { kind: "pinch", apart };
};
const chooseGesture = (canvas, event) => {
  if (isCropping || event.shiftKey) return "crop";
  const hits = Math.abs(partOf(canvas, event) - split) * canvas.clientWidth < 16;
  return state.mode === "slider" && hits ? "split" : "pan";
};
const moveSplit = (canvas, event) => {
  split = clamp(partOf(canvas, event), 0, 1);
  splitter.value = 100 * split;
  schedule();
};
const onMove = (canvas, event) => {
  const now = locate(canvas, event);
  if (!gesture) return point(now);
  if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event);
  if (fingers.size === 2) return pinch(canvas);
  const { kind, at, from } = gesture;
  if (kind === "split") moveSplit(canvas, event);
  if (kind === "crop") {
    state.crop = makeCrop(from, now);
    schedule();
  }
  if (kind !== "pan") return;
  pan((at.clientX - event.clientX) * now.step, (at.clientY - event.clientY) * now.step);
  gesture.at = event;
};
const onEnd = (event) => {
  fingers.delete(event.pointerId);
  const isCrop = gesture?.kind === "crop";
  gesture = fingers.size > 0 ? { kind: "rest" } : null;
  if (!isCrop) return;
  isCropping = false;
  change({ crop: state.crop || cropBefore });
};
const onWheel = (canvas, event) => {
  if (state.zoom === 1 && event.deltaY > 0) return; // the page scrolls on
  event.preventDefault();
  const step = event.deltaMode ? 0.05 : event.ctrlKey ? 0.01 : 0.002;
  zoomBy(Math.exp(-event.deltaY * step), locate(canvas, event));
};
for (const { canvas } of panes) {
  canvas.addEventListener("pointerdown", (event) => {
    const from = locate(canvas, event);
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
    gesture = { kind: chooseGesture(canvas, event), at: event, from };
    cropBefore = state.crop;
    point(from);
  });
  canvas.addEventListener("pointermove", (event) => onMove(canvas, event));
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, onEnd);
  canvas.addEventListener("wheel", (event) => onWheel(canvas, event), { passive: false });
}

const moveByArrow = ([dx, dy]) => pan((dx * size.width) / state.zoom / 10, (dy * size.height) / state.zoom / 10);
const isOnScreen = () => {
  const { top, bottom } = paneBox.getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
};
const zoomIn = () => zoomBy(1.5);
const showTruth = () => findEntry(kTruth, state.place) && change({ right: kTruth });
const kKeys = { f: flip, t: showTruth, 0: fit, "+": zoomIn, "=": zoomIn, "-": () => zoomBy(1 / 1.5) };
document.addEventListener("keydown", (event) => {
  const { target, key } = event;
  const arrow = panes.some(({ canvas }) => canvas === target) && kArrows[key];
  if (event.ctrlKey || event.metaKey || event.altKey || target.matches("input, select, textarea")) return;
  if (!section.contains(target) && !(target === document.body && isOnScreen())) return;
  const who = /^[1-9]$/.test(key) ? listFilters(state.place)[key - 1] : undefined;
  const act = kKeys[key.toLowerCase()];
  if (!arrow && !act && who === undefined) return;
  event.preventDefault();
  if (arrow) moveByArrow(arrow);
  else if (act) act();
  else change({ right: who });
});
