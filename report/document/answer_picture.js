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
// The picture of the answer: the truth at the left of a line that the reader moves, a filter at the right, where the
// filter's picture differs most.
const startPicture = (holder) => {
  const figure = element(holder, "figure", { className: "split" });
  const stage = element(figure, "div", { className: "stage" });
  const images = [0, 1].map(() => element(stage, "img", { alt: "" }));
  const line = element(stage, "i");
  const slider = element(stage, "input", { type: "range", min: 0, max: 100, value: 50 });
  slider.addEventListener("input", () => stage.style.setProperty("--split", `${slider.value}%`));
  const caption = element(figure, "figcaption");
  let shown = null;
  const button = addButton(figure, "Look closer", () => shadowbench.openViewer(shown));
  let isSmooth = true;
  const toggle = () => {
    isSmooth = !isSmooth;
    show(shown.right, shown.place);
  };
  const smooth = addButton(figure, "", toggle, "The errors are of one sample a pixel");
  const say = (text) => (message.textContent = text);
  const sayTruth = (text) => shown && shown.left === kTruth && (caption.firstChild.textContent = text);
  const live = startLivePicture({ figure, stage, slider, line, sayTruth, say });
  const message = element(figure, "p", { className: "note" });

  const show = (index, place) => {
    const cell = cellAt(index, place);
    const measured = { picture: cell.picture, truth: run.truths[place]?.picture };
    const { picture, truth } = cell.smooth && isSmooth ? cell.smooth : measured;
    smooth.hidden = !cell.smooth;
    smooth.textContent = `${cell.smooth?.samples} samples a pixel`;
    smooth.setAttribute("aria-pressed", isSmooth);
    const [wholeWidth] = run.configurations[index].size;
    const [x, y, width, height] = cell.part;
    const hasBoth = Boolean(truth && picture);
    shown = { place, left: truth ? kTruth : index, right: index, layer: "picture", rect: { x, y, width, height } };
    stage.style.aspectRatio = `${width}/${height}`;
    stage.style.setProperty("--before", `${(100 * x) / wholeWidth}%`); // what the stage hides at its left
    stage.style.setProperty("--share", width / wholeWidth);
    [truth, picture].forEach((path, i) => {
      images[i].hidden = !path;
      if (path && images[i].getAttribute("src") !== path) images[i].src = path;
      images[i].alt = `${i === 0 ? "truth" : nameOf(index)} on ${run.places[place].title}`;
    });
    for (const { style } of [...images, ...live.canvases]) {
      style.width = `${(100 * wholeWidth) / width}%`;
      style.left = `${(-100 * x) / width}%`;
      style.top = `${(-100 * y) / height}%`;
    }
    stage.classList.toggle("single", !hasBoth);
    slider.hidden = line.hidden = !hasBoth;
    stage.hidden = caption.hidden = button.hidden = !truth && !picture;
    const name = `${nameOf(index)} on ${run.places[place].title}`;
    slider.setAttribute("aria-label", `How much of the truth is seen beside ${name}`);
    caption.replaceChildren();
    for (const text of hasBoth ? ["truth", name] : [truth ? "truth" : name]) element(caption, "bdi", {}, text);
    message.textContent = truth || picture ? "" : "This run stored no pictures.";
    live.show(index, place, Boolean(hasBoth && cell.frames && run.truths[place]?.values));
  };
  images.forEach((image) =>
    image.addEventListener("error", () => {
      message.textContent = `${image.getAttribute("src")} cannot be read: the file is not beside this page.`;
    }),
  );
  return { figure, show };
};

// A command that can be copied; gives the element that it stands in.
const addCommand = (holder, lead) => {
  const line = element(holder, "p", { className: "note" }, lead);
  const code = element(line, "code");
  line.append(" ");
  addButton(line, "Copy", () => navigator.clipboard?.writeText(code.textContent));
  return code;
};

// The commands that say and show the same: the run's folder is that of the page, seen from beside it.
const writeWord = (word) => (/^[\w./+:,=-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
const folderOfPage = () =>
  writeWord(location.protocol === "file:" ? decodeURI(location.pathname).split("/").at(-2) : "RUN");
// Empty where it is not known how the scene, or the file of a filter, was given.
const writeView = (index, place) => {
  const { filter, request, map } = run.configurations[index];
  const { view } = run.places[place];
  const file = run.files[filter];
  if (view.length === 0 || file === null) return "";
  const own = file ? ["--filter-file", file] : [];
  const words = [...view, ...own, "--left", "truth", "--right", request, "--map-size", map];
  return `shadowbench view ${words.map((word) => writeWord(`${word}`)).join(" ")}`;
};
