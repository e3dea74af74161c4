// Compares pictures of one place: two filters, or a filter and the truth, beside each other, by a slider, by flipping
// or as a difference. Here are its controls, its panes and where they look; viewer_content.js fills them.
const section = document.getElementById("viewer");
const kMostZoom = 64;
const kModes = [
  ["side", "Side by side"],
  ["slider", "Slider"],
  ["flip", "Flip"],
  ["difference", "Difference"],
];
const kKeysHelp = `F flips; 1 to 9 put the first nine filters of the scene, and T the truth, into the right pane; +
  and - zoom and 0 fits, as the wheel and two fingers do; a drag and, with the focus on a pane, the arrow keys move the
  picture; a drag with Shift draws the crop.`;
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
// What is shown. The view's middle is in pixels of the picture; a zoom of 1 fits the pane.
const state = { place: 0, left: kTruth, right: 0, layer: "picture", mode: "side", x: 0, y: 0, zoom: 1, crop: null };
let size = { width: 16, height: 9 };
let sides = [{}, {}];
let split = 0.5;
let isRight = false;
let isCropping = false;
let cursor = null;
let frame = 0;

// Controls.
const root = section.querySelector(".viewer");
const said = element(root, "p", { className: "note said", role: "status" });
const controls = element(root, "div", { className: "controls" });
const listOptions = (whos) => whos.map((who) => [who, nameOf(who)]);
const addChoice = (title, name, options, read) =>
  addSelect(controls, title, options, { dir: "auto" }, (value) => change({ [name]: read(value) }));
const whos = listOptions([kTruth, ...run.configurations.keys()]);
const selects = {
  place: addChoice(
    "Scene",
    "place",
    [...run.places.entries()].map(([i, { title }]) => [i, title]),
    Number,
  ),
  left: addChoice("Left", "left", whos, Number),
  right: addChoice("Right", "right", whos, Number),
  layer: addChoice("Layer", "layer", [], String),
};
const fillLayers = () => selects.layer.replaceChildren(...layers.map(({ name, title }) => new Option(title, name)));
fillLayers();
const addGroup = (parent, className, title, properties) =>
  element(parent, "div", { className, role: "group", "aria-label": title, ...properties });
const modeButtons = addGroup(controls, "modes", "How the two are compared");
for (const [mode, title] of kModes) addButton(modeButtons, title, () => change({ mode })).dataset.mode = mode;
const flipButton = addButton(controls, "Show the other", () => flip(), "Key F");
const splitLabel = element(controls, "label", {}, "Split ");
const splitter = element(splitLabel, "input", { type: "range", min: 0, max: 100, step: 1 });
splitter.addEventListener("input", () => {
  split = splitter.value / 100;
  schedule();
});
const toggleCrop = () => {
  isCropping = !isCropping;
  label();
};
const partButtons = addGroup(controls, "modes", "Which part is seen");
addButton(partButtons, "Fit", () => fit(), "Key 0");
addButton(partButtons, "+", () => zoomBy(1.5), "Key +").setAttribute("aria-label", "Zoom in");
addButton(partButtons, "\u2212", () => zoomBy(1 / 1.5), "Key -").setAttribute("aria-label", "Zoom out");
const cropButton = addButton(partButtons, "Crop", toggleCrop, "Then drag a rectangle; or shift and drag");
const bar = element(root, "div", { className: "scale", hidden: true });
const paneBox = element(root, "div", { className: "panes" });
const makePane = () => {
  const figure = element(paneBox, "figure");
  const caption = element(figure, "figcaption");
  const frameBox = element(figure, "div", { className: "frame" });
  const canvas = element(frameBox, "canvas", { tabIndex: 0, role: "img" });
  const message = element(frameBox, "p", { className: "message" });
  return { figure, caption, canvas, context: canvas.getContext("2d"), message };
};
const panes = [makePane(), makePane()];
const hiddenScroll = { tabIndex: 0, hidden: true };
const tableBox = addGroup(root, "values scroll", "Visibility at the pixel under the pointer", hiddenScroll);
const table = element(tableBox, "table");
const crops = element(root, "div", { className: "strip", hidden: true });
const help = element(root, "details");
element(help, "summary", {}, "Keys and gestures");
element(help, "p", { className: "note" }, kKeysHelp);

// Drawing: per frame one drawImage for each picture.
const schedule = () => {
  frame = frame || requestAnimationFrame(draw);
};
const shownIn = (pane) => {
  if (state.mode === "side") return [panes.indexOf(pane)];
  if (state.mode === "slider") return [1, 0];
  return [state.mode === "flip" && isRight ? 1 : 0];
};
const drawMarks = ({ context, canvas }, ratio, left, top) => {
  const stroke = (color, thick, dashes, rect) => {
    Object.assign(context, { strokeStyle: color, lineWidth: thick });
    context.setLineDash(dashes);
    context.strokeRect(...rect);
  };
  const outline = (rect, dashes) => {
    stroke("#000", 3, [], rect);
    stroke("#fff", 1, dashes, rect);
  };
  const { crop } = state;
  const far = Math.max(ratio, 9);
  if (crop) outline([left + crop.x * ratio, top + crop.y * ratio, crop.width * ratio, crop.height * ratio], [6, 4]);
  const at = cursor && [left + (cursor.x + 0.5) * ratio, top + (cursor.y + 0.5) * ratio];
  if (cursor) outline([at[0] - far / 2, at[1] - far / 2, far, far], []);
  if (state.mode === "slider") outline([split * canvas.width, -2, 0, canvas.height + 4], []);
};
const drawPane = (pane) => {
  const { context, canvas } = pane;
  const ratio = (canvas.width / size.width) * state.zoom;
  const left = canvas.width / 2 - state.x * ratio;
  const top = canvas.height / 2 - state.y * ratio;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingEnabled = ratio < 1;
  for (const i of shownIn(pane)) {
    context.save();
    if (state.mode === "slider" && i === 0) {
      context.beginPath();
      context.rect(0, 0, split * canvas.width, canvas.height);
      context.clip();
      context.clearRect(0, 0, canvas.width, canvas.height);
    }
    context.setTransform(ratio, 0, 0, ratio, left, top);
    if (sides[i].value) context.drawImage(sides[i].value, 0, 0, size.width, size.height);
    context.restore();
  }
  drawMarks(pane, ratio, left, top);
};
const draw = () => {
  frame = 0;
  panes.filter(({ figure }) => !figure.hidden).forEach(drawPane);
};
const fitCanvases = () => {
  for (const { canvas } of panes) {
    canvas.style.aspectRatio = `${size.width} / ${size.height}`;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
    canvas.height = Math.max(1, Math.round((canvas.width * size.height) / size.width));
  }
  draw();
};

// Where the panes look.
const settleView = () => {
  const keepInside = (middle, extent) => clamp(middle, extent / 2 / state.zoom, extent - extent / 2 / state.zoom);
  state.zoom = clamp(state.zoom, 1, kMostZoom);
  state.x = keepInside(state.x, size.width);
  state.y = keepInside(state.y, size.height);
  for (const { canvas } of panes) canvas.style.touchAction = state.zoom > 1 || isCropping ? "none" : "pan-y";
};
const moved = () => {
  settleView();
  schedule();
  save();
};
const pan = (dx, dy) => {
  state.x += dx;
  state.y += dy;
  moved();
};
const zoomBy = (factor, point = state) => {
  const before = state.zoom;
  state.zoom = clamp(before * factor, 1, kMostZoom);
  state.x = point.x + ((state.x - point.x) * before) / state.zoom;
  state.y = point.y + ((state.y - point.y) * before) / state.zoom;
  moved();
};
const fit = () => zoomBy(1 / state.zoom);
const showRect = (rect) => {
  state.zoom = 0.9 * Math.min(size.width / rect.width, size.height / rect.height);
  [state.x, state.y] = [rect.x + rect.width / 2, rect.y + rect.height / 2];
  moved();
};
const flip = () => {
  isRight = state.mode === "flip" && !isRight;
  if (state.mode !== "flip") return change({ mode: "flip" });
  label();
  schedule();
};
