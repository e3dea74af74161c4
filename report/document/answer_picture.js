// The picture of the answer drawn by this GPU, over the two that the run stored: a drag turns camera or sun. Nothing is
// loaded before a pointer comes to the picture; where a CPU draws for the browser, not before the reader asks.
const startLivePicture = ({ figure, stage, slider, line, sayTruth, say }) => {
  const view = { id: "answer", place: -1, camera: [0, 0], light: [0, 0], parameters: new Map() };
  const canvases = [0, 1].map(() => {
    const canvas = Object.assign(makeCanvas(1, 1), { hidden: true, ariaHidden: "true" });
    line.before(canvas);
    return canvas;
  });
  let right = 0;
  let isWanted = false;
  let isHeld = false; // a pointer is down
  let isDrawing = false;
  let isStale = false;
  let drags = "camera";

  const isLive = () => stage.classList.contains("turns");
  const toggle = () => (isLive() ? end("") : begin(true));
  const button = addButton(figure, "Live", toggle, "Drawn by this GPU; a drag turns it");
  const choice = addSelect(figure, "A drag turns", Object.entries(kDrags), {}, (value) => (drags = value)).parentNode;
  const reveal = (isShown) => {
    canvases.forEach((canvas) => (canvas.hidden = !isShown));
    stage.classList.toggle("turns", isShown);
    choice.style.visibility = isShown ? "" : "hidden";
    button.setAttribute("aria-pressed", isShown);
    if (!isShown) sayTruth("truth");
  };
  const end = (why) => {
    isWanted = false;
    Object.assign(view, { camera: [0, 0], light: [0, 0] });
    reveal(false);
    say(why);
  };
  const draw = async () => {
    const engine = getEngine();
    if (engine.isBusy) throw new Error("This GPU is being timed.");
    const who = right;
    const [truth] = await Promise.all([kTruth, who].map((each, i) => engine.draw(view, each, canvases[i])));
    while (isHeld && canvases[0].hidden) await new Promise((resolve) => setTimeout(resolve, 50));
    if (!isWanted || who !== right) return;
    sayTruth(truth.maps ? `mean of ${truth.maps} maps, no rays traced` : "truth");
    if (canvases[0].hidden) reveal(true);
    isStale ||= truth.isUnfinished;
  };
  // Promises why nothing can be drawn.
  const redraw = async () => {
    isStale = true;
    if (isDrawing) return "";
    isDrawing = true;
    let why = "";
    while (isStale && isWanted && !why) {
      isStale = false;
      why = (await attempt(draw())).message ?? "";
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
    isDrawing = false;
    return why;
  };
  const begin = async (isAsked) => {
    if (isWanted || button.hidden) return;
    const { value: engine, message } = await attempt((async () => getEngine())());
    if (message || (!isAsked && engine.isSoftware)) return isAsked && say(message);
    isWanted = true;
    const why = await redraw();
    if (why) end(isAsked ? why : "");
  };

  const hold = (isDown) => () => (isHeld = isDown);
  stage.addEventListener("pointerdown", hold(true), true);
  ["pointerup", "pointercancel"].forEach((name) => window.addEventListener(name, hold(false), true));
  stage.addEventListener("pointerenter", () => begin(false), { once: true });
  followDrags(
    stage,
    (yaw, pitch) => {
      turnView(view, drags, yaw, pitch);
      redraw();
    },
    ({ target }) => isLive() && target !== line,
  );
  const moveSlider = ({ clientX }) => {
    const { left, width } = stage.getBoundingClientRect();
    slider.value = (100 * (clientX - left)) / width;
    slider.dispatchEvent(new Event("input"));
  };
  line.addEventListener("pointerdown", ({ pointerId }) => line.setPointerCapture(pointerId));
  line.addEventListener("pointermove", (event) => line.hasPointerCapture(event.pointerId) && moveSlider(event));
  gpuEvents.addEventListener("lost", () => isWanted && end(kGpuIsGone));
  reveal(false);
  return {
    canvases,
    // Another filter, or another place, whose camera and sun are as the run had them.
    show: (index, place, canDraw) => {
      button.hidden = choice.hidden = !canDraw;
      right = index;
      if (place !== view.place) Object.assign(view, { place, camera: [0, 0], light: [0, 0] });
      reveal(false);
      if (isWanted && canDraw) redraw().then((why) => why && end(why));
    },
  };
};
