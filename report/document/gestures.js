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

const moveCross = (dx, dy) => {
  const from = cursor || { x: Math.floor(state.x), y: Math.floor(state.y) };
  point({ x: from.x + dx, y: from.y + dy });
  const read = (who) => {
    const texts = known.get(who)?.cells.map((cell) => cell.textContent) ?? [];
    return `${tell(who)} ${texts.filter(Boolean).join(", error ") || "not known"}`;
  };
  const whos = [...new Set([kTruth, state.left, state.right])];
  live.textContent = `x ${cursor.x}, y ${cursor.y}: ${whos.map(read).join("; ")}`;
};
const moveByArrow = ([dx, dy], isCross) => {
  if (isCross) return moveCross(dx, dy);
  pan((dx * size.width) / state.zoom / 10, (dy * size.height) / state.zoom / 10);
};
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
  if (event.ctrlKey || event.metaKey || (event.altKey && !arrow) || target.matches("input, select, textarea")) return;
  if (!section.contains(target) && !(target === document.body && isOnScreen())) return;
  const who = /^[1-9]$/.test(key) ? listFilters(state.place)[key - 1] : undefined;
  const act = kKeys[key.toLowerCase()];
  if (!arrow && !act && who === undefined) return;
  event.preventDefault();
  if (arrow) moveByArrow(arrow, event.altKey);
  else if (act) act();
  else change({ right: who });
});
