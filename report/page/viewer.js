"use strict";
// Compares pictures of one place: two filters, or a filter and the truth, beside each other, by a slider, by flipping or as a difference.
(() => {
  const section = document.getElementById("viewer"), { numbers, data, element, onceSeen, link } = window.shadowbench;
  if (!section || !data) return;
  const { makeStore, subtract, findScale, kPalettes, paint, addSquares, findTiles } = numbers;
  const { run, kTruth, findEntry, listFilters, listAll, nameOf, quote, tell } = data;
  const { loadFile, namePlane, nameShown, getNumbers, getMask, getPicture, cut, attempt, layers, layerOf, addLayer } = data;
  const kLoadedFirst = 12, kMostZoom = 64, keepColours = makeStore(24e6);
  const white = Number((run.white || 1).toPrecision(2)), digits = Math.max(3, 2 - Math.floor(Math.log10(white)));
  const kModes = [["side", "Side by side"], ["slider", "Slider"], ["flip", "Flip"], ["difference", "Difference"]];
  const kNote = " (its visibility: only filters have this layer)";
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
  // What is shown. The view's middle is in pixels of the picture; a zoom of 1 fits the pane.
  const state = { place: 0, left: kTruth, right: 0, layer: "picture", mode: "side", x: 0, y: 0, zoom: 1, crop: null };
  let size = { width: 16, height: 9 }, sides = [{}, {}], scale = 1, split = 0.5, isRight = false, isCropping = false;
  let cursor = null, turn = 0, frame = 0, wanted = null;
  const known = new Map();  // the visibility of the place's filters and of its truth

  // Controls.
  const root = section.querySelector(".viewer");
  if (run.cells.every((cell) => !cell.picture && !cell.values)) {
    section.hidden = true;
    return;
  }
  const said = element(root, "p", { className: "note said" });
  said.setAttribute("role", "status");
  const controls = element(root, "div", { className: "controls" });
  const addSelect = (title, onPick) => {
    const select = element(element(controls, "label", {}, title + " "), "select", { dir: "auto" });
    select.addEventListener("change", () => onPick(select.value));
    return select;
  };
  const addButton = (parent, title, onclick, hint) => element(parent, "button", { type: "button", onclick, title: hint || "" }, title);
  const selects = {
    place: addSelect("Scene", (value) => change({ place: Number(value) })),
    left: addSelect("Left", (value) => change({ left: Number(value) })),
    right: addSelect("Right", (value) => change({ right: Number(value) })), layer: addSelect("Layer", (value) => change({ layer: value })),
  };
  run.places.forEach(({ title }, i) => selects.place.add(new Option(title, i)));
  for (const select of [selects.left, selects.right]) {
    for (const who of [kTruth, ...run.configurations.keys()]) select.add(new Option(nameOf(who), who));
  }
  const fillLayers = () => selects.layer.replaceChildren(...layers.map(({ name, title }) => new Option(title, name)));
  fillLayers();
  const addGroup = (parent, className, title, properties) => {
    const made = element(parent, "div", { className, ...properties });
    for (const [key, value] of [["role", "group"], ["aria-label", title]]) made.setAttribute(key, value);
    return made;
  };
  const modeButtons = addGroup(controls, "modes", "How the two are compared");
  for (const [mode, title] of kModes) addButton(modeButtons, title, () => change({ mode })).dataset.mode = mode;
  const flipButton = addButton(controls, "Show the other", () => flip(), "Key F");
  const splitLabel = element(controls, "label", {}, "Split ");
  const splitter = element(splitLabel, "input", { type: "range", min: 0, max: 100, step: 1 });
  splitter.addEventListener("input", () => { split = splitter.value / 100; schedule(); });
  addButton(controls, "Fit", () => fit(), "Key 0");
  addButton(controls, "+", () => zoomBy(1.5), "Key +").setAttribute("aria-label", "Zoom in");
  addButton(controls, "\u2212", () => zoomBy(1 / 1.5), "Key -").setAttribute("aria-label", "Zoom out");
  const cropButton = addButton(controls, "Crop", () => { isCropping = !isCropping; label(); }, "Then drag a rectangle; or shift and drag");
  const paneBox = element(root, "div", { className: "panes" });
  const panes = [0, 1].map(() => {
    const figure = element(paneBox, "figure", {}), caption = element(figure, "figcaption", {});
    const frameBox = element(figure, "div", { className: "frame" });
    const canvas = element(frameBox, "canvas", { tabIndex: 0 });
    canvas.setAttribute("role", "img");
    return { figure, caption, canvas, context: canvas.getContext("2d"), message: element(frameBox, "p", { className: "message" }) };
  });
  const bar = element(root, "div", { className: "scale", hidden: true });
  const live = element(root, "p", { className: "unseen" });
  live.setAttribute("aria-live", "polite");
  const below = element(root, "div", { className: "below" });
  const tableBox = addGroup(below, "values scroll", "Visibility at the pixel under the pointer", { tabIndex: 0, hidden: true });
  const table = element(tableBox, "table", {});
  const [hardest, crops] = [below, root].map((parent) => element(parent, "div", { className: "strip", hidden: true }));
  element(element(root, "details", {}), "p", { className: "note" }, `F flips; 1 to 9 put the first nine filters of the scene, and T the
    truth, into the right pane; + and - zoom and 0 fits, as the wheel and two fingers do; a drag and, with the focus on a pane, the arrow
    keys move the picture, and Alt with an arrow moves the cross by a pixel and reads its values aloud; a drag with Shift draws the crop.`);
  root.lastChild.prepend(element(root, "summary", {}, "Keys and gestures"));

  // Drawing: per frame one drawImage for each picture.
  const schedule = () => { frame = frame || requestAnimationFrame(draw); };
  const shownIn = (pane) => ({ side: [panes.indexOf(pane)], slider: [1, 0], flip: [isRight ? 1 : 0], difference: [0] })[state.mode];
  const drawMarks = ({ context, canvas }, ratio, left, top) => {
    const outline = (x, y, width, height, dashes) => [["#000", 3], ["#fff", 1]].forEach(([color, thick]) => {
      Object.assign(context, { strokeStyle: color, lineWidth: thick });
      context.setLineDash(thick === 1 ? dashes : []);
      context.strokeRect(x, y, width, height);
    });
    const { crop } = state, far = Math.max(ratio, 9);
    if (crop) outline(left + crop.x * ratio, top + crop.y * ratio, crop.width * ratio, crop.height * ratio, [6, 4]);
    if (cursor) outline(left + (cursor.x + 0.5) * ratio - far / 2, top + (cursor.y + 0.5) * ratio - far / 2, far, far, []);
    if (state.mode === "slider") outline(split * canvas.width, -2, 0, canvas.height + 4, []);
  };
  const drawPane = (pane) => {
    const { context, canvas } = pane, ratio = (canvas.width / size.width) * state.zoom;
    const left = canvas.width / 2 - state.x * ratio, top = canvas.height / 2 - state.y * ratio;
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
  new ResizeObserver(() => requestAnimationFrame(fitCanvases)).observe(paneBox);

  const settleView = () => {
    state.zoom = clamp(state.zoom, 1, kMostZoom);
    for (const [axis, extent] of [["x", size.width], ["y", size.height]]) {
      state[axis] = clamp(state[axis], extent / 2 / state.zoom, extent - extent / 2 / state.zoom);
    }
    for (const { canvas } of panes) canvas.style.touchAction = state.zoom > 1 || isCropping ? "none" : "pan-y";
  };
  const moved = () => {
    settleView();
    schedule();
    save();
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
    if (state.mode === "flip") label(), schedule();
    else change({ mode: "flip" });
  };

  // From the state to what the panes hold.
  const makeSides = async (place, layer, mode) => {
    const whos = [state.left, state.right];
    const differs = mode === "difference", name = layer === "picture" ? "visibility" : layer, look = layerOf(name);
    if (layer === "picture" && !differs) return { made: await Promise.all(whos.map((who) => attempt(getPicture(who, place)))) };
    const names = await Promise.all(whos.map((who) => (differs ? name : nameShown(who, place, name))));
    let found = await Promise.all(whos.map((who, i) => attempt(getNumbers(who, place, names[i]))));
    const message = found.map((each) => each.message).filter(Boolean).join(" ");
    if (differs) found = [message ? { message } : await attempt((async () => subtract(found[1].value, found[0].value))())];
    const mask = name === "visibility" && !differs ? undefined : (await attempt(getMask(place))).value;
    const planes = found.filter(({ value }, i) => value && names[i] === name).map(({ value }) => value);
    const palette = differs ? "diverging" : look.palette;
    const top = palette === "grey" ? white : findScale(planes, mask, white * Math.min(0.05, look.least));
    const file = (await Promise.all(whos.map((who) => attempt(loadFile(who, place))))).find(({ value }) => value)?.value;
    const colour = (value, i) => {
      const [counts, shades, most] = names[i] === name ? [mask, palette, top] : [undefined, "grey", white], { width, height } = file;
      return keepColours([place, whos[i], differs && whos[1], names[i], shades, most].join(), value.length,
        () => paint(value, counts, width, { x: 0, y: 0, width, height }, shades, most));
    };
    const made = found.map((each, i) => (each.value ? { value: colour(each.value, i), note: names[i] === name ? "" : kNote } : each));
    return { made, top, palette, look, differs };
  };
  const showScale = ({ top, palette, look, differs }) => {
    bar.hidden = !top;
    bar.replaceChildren();
    if (!top) return;
    const words = differs ? ["right is lower", "right is higher"] : [look.low, look.high], signed = palette === "diverging";
    const say = (value, word) => element(bar, "span", {}, word ? `${value} (${word})` : value);
    say(signed ? `\u2212${top}` : "0", words[0]);
    element(bar, "i", {}).style.background = `linear-gradient(to right,${kPalettes[palette].map((stop) => `rgb(${stop})`)})`;
    say(signed ? `+${top}` : String(top), words[1]);
    if (palette !== "grey") element(bar, "span", { className: "hatch" }, "hatched: " + (run.hatched || "not a receiver"));
  };
  const label = () => {
    const titles = [["Left", state.left], ["Right", state.right]].map(([side, who]) => [side + ": ", nameOf(who)]);
    const layer = selects.layer.selectedOptions[0]?.text, notes = [0, 1].map((side) => sides[side].note || "");
    for (const [i, pane] of panes.entries()) {
      pane.figure.hidden = i === 1 && state.mode !== "side";
      const shown = [...shownIn(pane)].sort(), parts = state.mode === "difference" ? [0, 1] : shown;
      pane.caption.replaceChildren();
      if (state.mode === "difference") pane.caption.append("Right \u2212 left. ");
      for (const side of parts) {
        const text = element(pane.caption, "span", {}, titles[side][0]);
        element(text, "bdi", {}, titles[side][1]);
        text.append(notes[side]);
      }
      pane.message.textContent = shown.map((side) => sides[side].message).filter(Boolean).join(" ");
      pane.message.hidden = !pane.message.textContent;
      const names = parts.map((side) => titles[side][0] + quote(titles[side][1]) + notes[side]).join("; ");
      const scene = quote(run.places[state.place].title), [, mode] = kModes.find(([name]) => name === state.mode);
      pane.canvas.setAttribute("aria-label", `${layer} of ${scene}, ${mode}. ${names}`);
      pane.canvas.style.cursor = isCropping ? "crosshair" : "grab";
    }
    for (const button of modeButtons.children) button.setAttribute("aria-pressed", button.dataset.mode === state.mode);
    cropButton.setAttribute("aria-pressed", isCropping);
    flipButton.hidden = state.mode !== "flip";
    splitLabel.hidden = state.mode !== "slider";
    for (const button of crops.querySelectorAll("button")) button.setAttribute("aria-pressed", Number(button.dataset.who) === state.right);
  };
  const refresh = async () => {
    const mine = ++turn, { place, layer, mode } = state;
    for (const name of ["place", "left", "right", "layer"]) selects[name].value = state[name];
    for (const option of [...selects.left, ...selects.right]) option.disabled = !findEntry(Number(option.value), place);
    const result = await makeSides(place, layer, mode);
    if (mine !== turn) return;
    sides = mode === "difference" ? [result.made[0], {}] : result.made;
    const source = sides.find(({ value }) => value)?.value;
    if (source) size = { width: source.width, height: source.height };
    if (wanted) Object.assign(state, wanted);
    wanted = null;
    settleView();
    state.crop = state.crop && makeCrop(state.crop, { x: state.crop.x + state.crop.width, y: state.crop.y + state.crop.height });
    scale = result.top || 1;
    showScale(result);
    label();
    fitCanvases();
    showCrops();
    listKnownLayers(mine);
  };
  const change = (changes) => {
    const moves = "place" in changes && changes.place !== state.place;
    Object.assign(state, changes);
    if (moves) {
      Object.assign(state, { zoom: 1, crop: null });
      for (const [side, nth] of [["left", 0], ["right", -1]]) {
        if (!findEntry(state[side], state.place)) state[side] = listAll(state.place).at(nth) ?? kTruth;
      }
      wanted = changes.zoom ? changes : null;
      readPlace();
    }
    save();
    return refresh();
  };
  // A layer that neither side has is greyed out, once the files have told.
  const listKnownLayers = async (mine) => {
    const whos = [state.left, state.right], files = await Promise.all(whos.map((who) => attempt(loadFile(who, state.place))));
    if (mine !== turn) return;
    for (const { value } of files) for (const name of value?.planes.keys() || []) if (addLayer(name)) fillLayers();
    selects.layer.value = state.layer;
    for (const option of selects.layer) {
      const has = (i) => files[i].value && namePlane(files[i].value, whos[i], option.value);
      option.disabled = option.value !== "picture" && !has(0) && !has(1);
    }
    whos.forEach((who) => learn(who, state.place));
  };

  // The values under the pointer, and the hardest tiles.
  const learn = async (who, place) => {
    const { value } = await attempt(getNumbers(who, place, "visibility"));
    if (!value || place !== state.place || known.has(who)) return;
    known.set(who, { value, row: null });
    table.replaceChildren();
    const head = element(element(table, "thead", {}), "tr", {}), body = element(table, "tbody", {});
    for (const [title, className] of [["Filter", ""], ["Visibility", "n"], ["Error", "n"]]) {
      element(head, "th", { scope: "col", className }, title);
    }
    for (const each of [...known.keys()].sort((a, b) => a - b)) {
      const row = element(body, "tr", {});
      element(row, "th", { scope: "row", dir: "auto" }, nameOf(each));
      known.get(each).cells = ["n", "n"].map((className) => element(row, "td", { className }));
    }
    element(table, "caption", {});
    tableBox.hidden = false;
    readPixel();
  };
  const signed = (value) => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(digits);
  const readPixel = () => {
    if (!table.caption) return;
    table.caption.textContent = cursor ? `Pixel x ${cursor.x}, y ${cursor.y}` : "Point at a pixel to read its values";
    const at = cursor && cursor.y * size.width + cursor.x, truth = known.get(kTruth)?.value[at ?? -1];
    for (const [who, { value, cells: [visibility, error] }] of known) {
      const here = value[at ?? -1];
      visibility.textContent = here === undefined ? "" : here.toFixed(digits);
      error.textContent = here === undefined || truth === undefined || who === kTruth ? "" : signed(here - truth);
    }
  };
  const point = ({ x, y }) => {
    cursor = { x: clamp(Math.floor(x), 0, size.width - 1), y: clamp(Math.floor(y), 0, size.height - 1) };
    readPixel();
    schedule();
  };
  const pause = () => new Promise((resolve) => setTimeout(resolve));
  const readPlace = async () => {
    const { place } = state;
    known.clear();
    [table, hardest].forEach((each) => each.replaceChildren());
    [tableBox.hidden, hardest.hidden, cursor] = [true, true, null];
    await new Promise((resolve) => onceSeen(section, resolve));
    for (const who of [kTruth, ...listFilters(place).slice(0, kLoadedFirst)]) {
      await learn(who, place);
      if (place !== state.place) return;
    }
    showHardest(place);
  };
  const showHardest = async (place) => {
    const mask = (await attempt(getMask(place))).value, truth = known.get(kTruth)?.value;
    let sums = null, count = 0;
    for (const [who, { value }] of known) {
      if (who === kTruth || !truth || value.length !== truth.length) continue;
      sums = addSquares(sums, subtract(value, truth), mask);
      ++count;
      await pause();
      if (place !== state.place) return;
    }
    if (!sums) return;
    const picture = await attempt(getPicture(kTruth, place)), file = await loadFile(kTruth, place);
    const tiles = findTiles(sums, file.width, file.height, 6), all = listFilters(place).length;
    fillStrip(hardest, `Hardest tiles: where ${count < all ? count + " of " : ""}${all} filters have most of their squared error`);
    for (const { rect, share } of tiles) {
      addThumb(hardest, `${(100 * share).toFixed(0)} % at x\u00a0${rect.x}, y\u00a0${rect.y}`, () => showRect(rect), async () =>
        picture.value ? cut(picture.value, rect, 1) : paint(truth, null, file.width, rect, "grey", white));
    }
  };
  const fillStrip = (strip, title) => {
    strip.replaceChildren();
    strip.hidden = false;
    element(strip, "h3", {}, title);
  };
  const addThumb = (strip, caption, onclick, make) => {
    const button = element(strip, "button", { type: "button", onclick, title: caption });
    const text = element(button, "span", { dir: "auto" }, caption);
    onceSeen(button, async () => {
      const { value, message } = await attempt(make());
      if (value) button.prepend(value);
      else text.textContent += ": " + message;
    });
    return button;
  };
  let cropsShown = "";
  const showCrops = () => {
    const { crop, place, layer } = state, look = layerOf(layer), key = JSON.stringify([crop, place, layer, scale]);
    if (key === cropsShown) return;
    cropsShown = key;
    crops.hidden = !crop;
    if (!crop) return;
    fillStrip(crops, `Crop of ${look.title.toLowerCase()}: ${crop.width} by ${crop.height} pixels at x ${crop.x}, y ${crop.y}`);
    addButton(crops.firstChild, "Remove", () => change({ crop: null }));
    for (const who of listAll(place)) {
      addThumb(crops, nameOf(who), () => change({ right: who }), async () => {
        if (layer === "picture") return cut(await getPicture(who, place), crop, 1);
        const name = await nameShown(who, place, layer), values = await getNumbers(who, place, name), { palette } = layerOf(name);
        return paint(values, name === "visibility" ? null : (await attempt(getMask(place))).value, size.width, crop, palette, palette === "grey" ? white : scale);
      }).dataset.who = who;
    }
    label();
  };

  // Gestures and keys.
  const locate = (canvas, { clientX, clientY }) => {
    const box = canvas.getBoundingClientRect(), step = size.width / box.width / state.zoom;
    return { x: state.x + (clientX - box.left - box.width / 2) * step, y: state.y + (clientY - box.top - box.height / 2) * step, step };
  };
  const makeCrop = (from, to) => {
    const [x, y] = ["x", "y"].map((axis) => Math.max(0, Math.floor(Math.min(from[axis], to[axis]))));
    const end = (axis, extent) => Math.min(extent, Math.ceil(Math.max(from[axis], to[axis])));
    const width = end("x", size.width) - x, height = end("y", size.height) - y;
    return width > 3 && height > 3 ? { x, y, width, height } : null;
  };
  let cropBefore = null;
  const partOf = (canvas, { clientX }) => {
    const box = canvas.getBoundingClientRect();
    return (clientX - box.left) / box.width;
  };
  window.shadowbench.listenToPointers(panes.map(({ canvas }) => canvas), {
    locate, point, zoomBy, isFitted: () => state.zoom === 1,
    pan: (dx, dy) => {
      state.x += dx;
      state.y += dy;
      moved();
    },
    hitsSplit: (canvas, event) => state.mode === "slider" && Math.abs(partOf(canvas, event) - split) * canvas.clientWidth < 16,
    setSplit: (canvas, event) => {
      split = clamp(partOf(canvas, event), 0, 1);
      splitter.value = 100 * split;
      schedule();
    },
    wantsCrop: (event) => {
      cropBefore = state.crop;
      return isCropping || event.shiftKey;
    },
    drawCrop: (from, now) => {
      state.crop = makeCrop(from, now);
      schedule();
    },
    endCrop: () => {
      isCropping = false;
      change({ crop: state.crop || cropBefore });
    },
  });
  const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const moveByArrow = ([dx, dy], isCross) => {
    if (!isCross) {
      state.x += (dx * size.width) / state.zoom / 10;
      state.y += (dy * size.height) / state.zoom / 10;
      return moved();
    }
    const from = cursor || { x: Math.floor(state.x), y: Math.floor(state.y) };
    point({ x: from.x + dx, y: from.y + dy });
    const read = (who) => known.get(who)?.cells.map((cell) => cell.textContent).filter(Boolean).join(", error ") || "not known";
    const whos = [...new Set([kTruth, state.left, state.right])];
    live.textContent = `x ${cursor.x}, y ${cursor.y}: ${whos.map((who) => `${tell(who)} ${read(who)}`).join("; ")}`;
  };
  const isOnScreen = () => {
    const { top, bottom } = paneBox.getBoundingClientRect();
    return bottom > 0 && top < innerHeight;
  };
  const zoomIn = () => zoomBy(1.5), showTruth = () => findEntry(kTruth, state.place) && change({ right: kTruth });
  const kKeys = { f: flip, t: showTruth, 0: fit, "+": zoomIn, "=": zoomIn, "-": () => zoomBy(1 / 1.5) };
  document.addEventListener("keydown", (event) => {
    const { target, key } = event, arrow = panes.some(({ canvas }) => canvas === target) && kArrows[key];
    if (event.ctrlKey || event.metaKey || (event.altKey && !arrow) || target.matches("input, select, textarea")) return;
    if (!section.contains(target) && !(target === document.body && isOnScreen())) return;
    const who = /^[1-9]$/.test(key) ? listFilters(state.place)[key - 1] : undefined, act = kKeys[key.toLowerCase()];
    if (!arrow && !act && who === undefined) return;
    event.preventDefault();
    if (arrow) moveByArrow(arrow, event.altKey);
    else if (act) act();
    else change({ right: who });
  });

  // The link.
  const save = () => {
    const { place, left, right, layer, mode, x, y, zoom, crop } = state, short = (value) => Number(value.toFixed(3));
    link.write("view", [run.places[place].title, nameOf(left), nameOf(right), layer, mode, short(x), short(y), short(zoom),
      ...(crop ? [[crop.x, crop.y, crop.width, crop.height].join("-")] : [])]);
  };
  const openLink = () => {
    const fields = link.read("view"), unknown = [];
    if (!fields) return false;
    const [title, left, right, layer = "", mode, x, y, zoom, crop = ""] = fields;
    if (addLayer(layer)) fillLayers();
    const pick = (name, found, fallback) => {
      if (found >= 0) return found;
      if (name) unknown.push(quote(name));
      return fallback;
    };
    const place = pick(title, run.places.findIndex((each) => each.title === title), 0);
    const findWho = (name, fallback) => (name === "truth" && findEntry(kTruth, place) ? kTruth
      : pick(name, run.configurations.findIndex((each, who) => each.label === name && findEntry(who, place)), fallback));
    const numbers = [x, y, zoom].map((text) => (text && Number.isFinite(Number(text)) ? Number(text) : NaN));
    const view = numbers.every((value) => !Number.isNaN(value)) ? { x: numbers[0], y: numbers[1], zoom: numbers[2] } : { zoom: 1 };
    const rect = /^(\d{1,5})-(\d{1,5})-([1-9]\d{0,4})-([1-9]\d{0,4})$/.exec(crop)?.slice(1).map(Number);
    wanted = view;
    start({ place, left: findWho(left, listAll(place)[0]), right: findWho(right, listAll(place).at(-1)),
      layer: layers[pick(layer, layers.findIndex(({ name }) => name === layer), 0)].name,
      mode: kModes[pick(mode, kModes.findIndex(([name]) => name === mode), 0)][0],
      crop: rect ? { x: rect[0], y: rect[1], width: rect[2], height: rect[3] } : null });
    said.textContent = unknown.length === 0 ? ""
      : `The link names what this page does not have: ${unknown.join(", ")}. Something else is shown instead.`;
    section.scrollIntoView();
    return true;
  };
  const start = (changes) => {
    Object.assign(state, changes);
    readPlace();
    refresh();
  };
  window.addEventListener("hashchange", openLink);

  // For the charts and the table of the page.
  window.shadowbench.openViewer = async ({ rect, ...changes }) => {
    section.scrollIntoView();
    await change(Object.fromEntries(Object.entries(changes).filter(([, value]) => value !== undefined)));
    if (rect) showRect(rect);
  };
  window.shadowbench.openCell = (key) => {
    const cell = run.cells.find((each) => each.key === key);
    if (cell) window.shadowbench.openViewer({ place: cell.place, right: cell.configuration });
  };
  if (!openLink()) start({ place: 0, left: listAll(0)[0] ?? kTruth, right: listAll(0)[1] ?? listAll(0)[0] ?? kTruth });
})();
