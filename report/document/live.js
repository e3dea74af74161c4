// The section "Live": the run's filters drawn by the reader's own GPU, held against what the run drew, and timed.
const startLive = (holder) => onceSeen(holder, () => openLive(holder));
// A context that was lost has lost all that was made with it: the section begins anew.
const followLoss = (holder, canvas, say) => {
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    say("Nothing is drawn now: the browser has taken the GPU away from this page, and may give it back.");
  });
  canvas.addEventListener("webglcontextrestored", () => openLive(holder));
};
const openLive = (holder) => {
  const kDrags = { camera: "the camera", light: "the sun" };
  const kRounds = 11;
  const kMapsAtOnce = 4; // of a reference, in each frame
  const kColumns = [
    "filter",
    "RMSE to the run, same map",
    "farthest pixel",
    "RMSE to the run, own map",
    "filter, ms",
    "prefilter, ms",
  ];
  holder.replaceChildren();
  const status = element(holder, "p", { className: "note", role: "status" });
  const controls = element(holder, "div", { className: "controls" });
  const stage = element(holder, "div", { className: "live-stage" });
  const canvas = element(stage, "canvas", { role: "img" });
  const slider = element(stage, "input", {
    type: "range",
    min: 0,
    max: 100,
    value: 50,
    "aria-label": "Where the right side begins",
  });
  const message = element(holder, "p", { className: "note" });
  const parameters = element(holder, "div", { className: "controls" });
  const results = element(element(holder, "div", { className: "scroll", tabIndex: 0 }), "table");
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, preserveDrawingBuffer: true });
  if (!gl) {
    status.textContent = "This browser gives no WebGL 2, with which filters would be drawn here.";
    return;
  }
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const renderer = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  const isSoftware = /swiftshader|llvmpipe|software|basic render/i.test(renderer);
  const time = makeTimer(gl);
  const places = run.places
    .map((_, place) => place)
    .filter((place) => run.cells.some((cell) => cell.place === place && cell.frames));
  const state = {
    place: places[0],
    left: kTruth,
    right: 0,
    split: 0.5,
    camera: [0, 0],
    light: [0, 0],
    drags: "camera",
  };
  const found = new Map(); // by a cell's key: how far it is from the run, and its times
  const truths = new Map();
  const samplings = new Map(); // by a map's size
  const motions = new Map(); // by what they move
  const references = new Map(); // by place
  let turn = 0; // counts the changes of camera and light
  let display = null;
  let isBusy = false;
  let isStopped = false;

  const { open, reset } = makeLoader(gl);
  const listFiltersAt = (place) => [...run.configurations.keys()].filter((who) => cellAt(who, place)?.frames);

  // How a side is drawn: the truth by the shading of another one's frame.
  const findFrame = async (who) => {
    const shown = who === kTruth ? listFiltersAt(state.place)[0] : who;
    const cell = cellAt(shown, state.place);
    if (!cell?.frames) throw new Error(`${nameOf(shown)} was not measured there.`);
    const { frames, blobs, player } = await open(cell.frames);
    const frame = { ...frames.cells[cell.key], frames, player, cell };
    const key = `${cell.frames} ${frame.picture}`;
    if (!motions.has(key)) motions.set(key, { ...makeMotion(player, frames, blobs, frame.picture), turn: 0 });
    const motion = motions.get(key);
    if (motion.turn !== turn) {
      motion.turn = turn;
      motion.moveCamera(state.camera);
      if (motion.isSun) motion.moveLight(state.light);
    }
    return { ...frame, motion };
  };
  const isMoved = () => [...state.camera, ...state.light].some((angle) => angle !== 0);
  // The mean over many maps, of the frame without a filter; null where there is none, or no sun that could be moved.
  const referenceAt = async (place) => {
    const who = run.configurations.findIndex(({ request }) => /^none\b/.test(request));
    if (who < 0 || !cellAt(who, place)?.frames) return null;
    const frame = await findFrame(who);
    if (!frame.motion.isSun) return null;
    const visibility = frame.player.inputOf(frame.picture, kVisibility);
    if (!references.has(place)) references.set(place, { ...makeReference(gl, frame, frame.motion, visibility), turn });
    const reference = references.get(place);
    if (reference.turn !== turn) reference.restart();
    reference.turn = turn;
    return reference;
  };
  const truthAt = async (place) => {
    if (truths.has(place)) return truths.get(place);
    const { width, height } = await loadFile(kTruth, place);
    const values = await getPlane(kTruth, place, "visibility");
    const rows = new Float32Array(values.length);
    for (let y = 0; y < height; ++y) rows.set(values.subarray(y * width, (y + 1) * width), (height - 1 - y) * width);
    const texture = makeTexture(gl, gl.R32F, width, height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RED, gl.FLOAT, rows);
    truths.set(place, texture);
    return texture;
  };

  const showSide = async (who, from, to) => {
    const { player, picture } = await findFrame(who);
    const reference = who === kTruth && isMoved() ? await referenceAt(state.place) : null;
    if (who === kTruth && isMoved() && !reference)
      throw new Error("no rays were traced there; let the scene be as it was.");
    if (reference?.refine(state.light, kMapsAtOnce)) requestAnimationFrame(show);
    if (who === kTruth) player.standIn(kVisibility, reference ? reference.texture() : await truthAt(state.place));
    try {
      player.draw(picture);
    } finally {
      if (who === kTruth) player.standIn(kVisibility, null);
    }
    display ??= makeDisplay(gl, canvas);
    display(player.textureOf(picture), from, to);
  };
  const show = async () => {
    if (isBusy) return;
    const sides = [
      [state.left, 0, state.split],
      [state.right, state.split, 1],
    ];
    const messages = [];
    for (const [who, from, to] of sides) {
      const { message: why } = await attempt(showSide(who, from, to));
      if (why) messages.push(`${nameOf(who)} cannot be drawn: ${why}`);
    }
    const reference = references.get(state.place);
    if (isMoved() && [state.left, state.right].includes(kTruth) && reference)
      messages.push(`No rays were traced there: instead of the truth this is the mean of ${reference.count()} maps.`);
    message.textContent = messages.join(" ");
    canvas.setAttribute(
      "aria-label",
      `Left ${nameOf(state.left)}, right ${nameOf(state.right)}, on ${run.places[state.place].title}`,
    );
  };

  const check = async (who) => {
    const frame = await findFrame(who);
    const [plane, mask] = [await getPlane(who, state.place, "visibility"), await getMask(state.place)];
    const result = checkFrame(frame, plane, mask, samplingAt(run.configurations[who].map));
    found.set(frame.cell.key, { ...found.get(frame.cell.key), ...result, refused: undefined });
  };
  // Times the filters of a place that draw as the run did; what they share is timed once.
  const timePlace = async (whos, say) => {
    const drawn = new Map();
    const keys = [];
    for (const who of whos) {
      const { value: frame } = await attempt(findFrame(who));
      if (!frame || !found.get(frame.cell.key)?.isSame) continue;
      const { player, empty } = frame;
      [frame.picture, empty].filter((step) => step !== null).forEach((step) => player.draw(step));
      const parts = stepsOf(frame);
      const names = Object.keys(parts).filter((name) => parts[name].length > 0);
      const idOf = (name) => `${frame.cell.frames} ${parts[name].join()}`;
      for (const name of names) drawn.set(idOf(name), (count) => player.repeat(parts[name], count));
      keys.push({ key: frame.cell.key, ids: Object.fromEntries(names.map((name) => [name, idOf(name)])) });
    }
    const onRound = (round) => say(`round ${round} of ${kRounds}`);
    const times = await time([...drawn.values()], kRounds, onRound, () => isStopped);
    const byId = new Map([...drawn.keys()].map((id, i) => [id, times[i]]));
    for (const { key, ids } of keys) {
      const [map, lookup, prefilter, empty] = ["map", "lookup", "prefilter", "empty"].map((name) =>
        byId.get(ids[name]),
      );
      if (map && lookup)
        found.set(key, { ...found.get(key), map, prefilter: prefilter ?? null, filter: subtractTimes(lookup, empty) });
    }
  };
  const collectTimes = () => {
    const timed = [...found].filter(([, { map, filter }]) => map && filter);
    const parts = ([key, { map, prefilter, filter }]) => [key, { map, prefilter, filter }];
    return {
      schema: kTimesSchema,
      renderer,
      browser: navigator.userAgent,
      isSoftware,
      cells: Object.fromEntries(timed.map(parts)),
    };
  };
  const timeAll = async () => {
    for (const place of places) {
      if (isStopped) break;
      state.place = selects.place.value = place;
      fillSides();
      const say = (what) => (status.textContent = `${sayRenderer()} ${run.places[place].title}: ${what}.`);
      say("checking");
      await checkAll();
      await timePlace(listFiltersAt(place), say);
      fillTable();
    }
    const times = collectTimes();
    if (Object.keys(times.cells).length === 0) return;
    keepTimes(times);
    addMachine(times, true);
  };
  const saveTimes = () => {
    if (!timesHere()) return (message.textContent = "Nothing was timed here yet: begin with 'Time on this GPU'.");
    const link = element(holder, "a", { download: "gpu-times.json" });
    link.href = URL.createObjectURL(new Blob([JSON.stringify(timesHere(), null, 1)], { type: "application/json" }));
    link.click();
    link.remove();
  };
  const loadTimes = async (files) => {
    for (const file of files) {
      const { message: why } = await attempt(file.text().then((text) => addMachine(readTimes(text), false)));
      message.textContent = why ? `${file.name}: ${why}` : `${file.name}: its times are among the costs.`;
    }
  };

  const sayRenderer = () =>
    `Drawn here by ${renderer}.` + (isSoftware ? " That is a CPU: its times are not those of a GPU." : "");
  const samplingAt = (size) => {
    if (!samplings.has(size)) samplings.set(size, measureSampling(gl, size));
    return samplings.get(size);
  };
  const saySampling = () => {
    const { weight, shift, turn } = samplingAt(run.configurations[listFiltersAt(state.place)[0]].map);
    const exact = weight < 1e-5 && shift === 0 && turn < 1e-6;
    const parts = `weights of 2x2 texels ${format(weight)}, nearest texels ${format(shift)}, cosines ${format(turn)}`;
    return exact ? "Its sampling is exact." : `It may be off, by its own measure, in ${parts}: as much is allowed for.`;
  };
  const sayMap = (rows) => {
    const [, { map } = {}] = rows.find(([, { map }]) => map) ?? [];
    return map ? ` The map takes ${format(map.median)} ms.` : "";
  };
  const fillTable = () => {
    const rows = listFiltersAt(state.place).map((who) => [who, found.get(cellAt(who, state.place).key) ?? {}]);
    results.replaceChildren();
    if (rows.every(([, { rmse, refused }]) => rmse === undefined && !refused)) return;
    element(
      results,
      "caption",
      {},
      `What this GPU draws on ${run.places[state.place].title}. ${saySampling()}${sayMap(rows)}${references.get(state.place)?.said ?? ""}`,
    );
    const head = element(element(results, "thead"), "tr");
    for (const title of kColumns) element(head, "th", { scope: "col" }, title);
    const body = element(results, "tbody");
    const say = (each) => (each ? format(each.median) : "");
    const sayInterval = (each) =>
      each?.interval ? `95 %: ${each.interval.map((end) => format(end)).join(" to ")}, of ${each.rounds} rounds` : "";
    for (const [who, { rmse, worst, all, isSame, refused, filter, prefilter }] of rows) {
      const row = element(body, "tr");
      element(element(row, "th", { scope: "row" }), "bdi", {}, nameOf(who));
      if (refused) {
        element(row, "td", { colSpan: kColumns.length - 1, className: "text" }, refused);
        continue;
      }
      const isKnown = rmse !== undefined;
      element(
        row,
        "td",
        { className: isKnown && !isSame ? "bad" : "" },
        isKnown ? (isSame ? "" : "✗ ") + format(rmse) : "",
      );
      element(row, "td", {}, isKnown ? format(worst) : "");
      element(row, "td", {}, isKnown ? format(all) : "");
      element(row, "td", { title: sayInterval(filter) }, say(filter));
      element(row, "td", { title: sayInterval(prefilter) }, say(prefilter));
    }
  };
  const fillParameters = async () => {
    parameters.replaceChildren();
    const { value: frame } = await attempt(findFrame(state.right));
    if (!frame || state.right === kTruth) return;
    const steps = [...frame.player.listSteps(frame.picture)];
    for (const { name, value, min, max, whole, unit, text } of frame.parameters) {
      const own = steps.filter((index) => frame.frames.steps[index].uniforms?.[name]);
      if (own.length === 0) continue;
      const title = element(parameters, "label", { title: text }, `${name}${unit ? `, ${unit}` : ""} `);
      const input = element(title, "input", { type: "range", min, max, step: whole ? 1 : (max - min) / 200, value });
      const shown = element(title, "output", {}, format(value));
      input.addEventListener("input", () => {
        shown.textContent = format(Number(input.value));
        for (const index of own) frame.player.setUniforms(index, { [name]: [Number(input.value)] });
        show();
      });
    }
  };

  const checkAll = async () => {
    for (const who of listFiltersAt(state.place)) {
      if (isStopped) return;
      const { message: why } = await attempt(check(who));
      if (why) found.set(cellAt(who, state.place).key, { refused: why });
      fillTable();
      await pause();
    }
  };
  // How far the reference is from the traced truth.
  const checkReference = async () => {
    const reference = await referenceAt(state.place);
    if (!reference || isStopped || !run.truths[state.place]) return;
    while (reference.refine(state.light, kMapsAtOnce) && !isStopped) await pause();
    const [plane, mask] = [await getPlane(kTruth, state.place, "visibility"), await getMask(state.place)];
    const { width, height } = await loadFile(kTruth, state.place);
    const { rmse } = compareValues(reference.read(), plane, mask, width, { x: 0, y: 0, width, height }, 0);
    reference.said = ` The mean of ${reference.count()} maps from points of the sun has an RMSE of ${format(rmse)} to the traced truth.`;
  };
  const move = (camera, light) => {
    Object.assign(state, { camera, light });
    ++turn;
    show();
  };
  // Camera, sun and parameters are the run's own again.
  const restore = async () => {
    await reset();
    fillParameters();
    move([0, 0], [0, 0]);
  };
  const work = async (action) => {
    isBusy = true;
    isStopped = false;
    stopButton.hidden = false;
    await restore(); // what is checked and timed is what the run measured
    const { message: why } = await attempt(action());
    isBusy = false;
    stopButton.hidden = true;
    status.textContent = sayRenderer();
    fillTable();
    await show();
    if (why) message.textContent = why;
  };
  const options = () => [kTruth, ...listFiltersAt(state.place)].map((who) => [who, nameOf(who)]);
  const addChoice = (title, name, list) =>
    addSelect(controls, title, list, { dir: "auto" }, (value) => {
      state[name] = Number(value);
      if (name === "place") fillSides();
      fillParameters();
      fillTable();
      show();
    });
  const selects = {
    place: addChoice(
      "Scene",
      "place",
      places.map((place) => [place, run.places[place].title]),
    ),
    left: addChoice("Left", "left", options()),
    right: addChoice("Right", "right", options()),
  };
  const fillSides = () => {
    for (const name of ["left", "right"]) {
      const select = selects[name];
      select.replaceChildren(...options().map(([who, title]) => new Option(title, who)));
      if (!options().some(([who]) => who === state[name])) state[name] = options().at(-1)[0];
      select.value = state[name];
    }
  };
  addSelect(controls, "A drag turns", Object.entries(kDrags), {}, (value) => (state.drags = value));
  addButton(controls, "As it was", restore);
  addButton(controls, "Check against the run", () =>
    work(async () => {
      await checkAll();
      await checkReference();
    }),
  );
  addButton(controls, "Time on this GPU", () => work(timeAll));
  const stopButton = addButton(controls, "Stop", () => (isStopped = true));
  stopButton.hidden = true;
  addButton(controls, "Save times", saveTimes, "As gpu-times.json");
  const chooser = element(controls, "input", { type: "file", accept: ".json", multiple: true, hidden: true });
  chooser.addEventListener("change", () => loadTimes(chooser.files));
  addButton(controls, "Load times", () => chooser.click(), "Of other machines, as their pages saved them");
  slider.addEventListener("input", () => {
    state.split = slider.value / 100;
    show();
  });
  state.right = listFiltersAt(state.place)[0];
  fillSides();
  status.textContent = sayRenderer();
  followLoss(holder, canvas, (text) => {
    isStopped = true;
    status.textContent = text;
  });
  followDrags(canvas, (yaw, pitch) => {
    if (isBusy) return;
    const turned = { camera: state.camera, light: state.light };
    turned[state.drags] = [turned[state.drags][0] + yaw, clamp(turned[state.drags][1] + pitch, -1, 1)];
    move(turned.camera, turned.light);
  });
  fillParameters();
  show();
};
