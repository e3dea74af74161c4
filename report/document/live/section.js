// What the section Live shows, in the page's address; and as the command that measures its right side.
const saveLive = ({ place, left, right, split, camera, light, parameters, layer }) => {
  const changes = { left, ...(right !== left && { right }) };
  const own = Object.entries(changes).flatMap(([side, who]) =>
    Object.entries(parameters.get(who) ?? {}).map(([name, value]) => [side, name, value].join(":")),
  );
  if (layer !== "picture") own.push(`layer:${layer}`);
  writeLink("live", [run.places[place].title, nameOf(left), nameOf(right), split, ...camera, ...light, ...own]);
};
// What the address says of a view, as far as this run has it; null where it says nothing.
const readLive = (places) => {
  const fields = readLink("live");
  if (!fields) return null;
  const [title, left, right, ...rest] = fields;
  const numbers = rest.splice(0, 5).map((text) => (text === "" ? NaN : Number(text)));
  const found = { place: places.find((each) => run.places[each].title === title), parameters: new Map() };
  if (found.place === undefined) return null;
  const findWho = (name) =>
    name === nameOf(kTruth) && run.truths[found.place]
      ? kTruth
      : listFiltersAt(found.place).find((who) => nameOf(who) === name);
  const sides = { left: findWho(left), right: findWho(right) };
  for (const [side, who] of Object.entries(sides)) if (who !== undefined) found[side] = who;
  if (numbers.length === 5 && numbers.every((value) => Number.isFinite(value) && Math.abs(value) < 1e3)) {
    const [split, yaw, pitch, lightYaw, lightPitch] = numbers;
    Object.assign(found, { split: clamp(split, 0, 1), camera: [yaw, clamp(pitch, -1, 1)] });
    found.light = [lightYaw, clamp(lightPitch, -1, 1)];
  }
  for (const [side, name, value] of rest.map((text) => text.split(":")))
    if (side === "layer" && kLiveLayers.some(([layer]) => layer === name)) found.layer = name;
    else if (sides[side] !== undefined && value && Number.isFinite(Number(value)))
      found.parameters.set(sides[side], { ...found.parameters.get(sides[side]), [name]: Number(value) });
  return found;
};
// Whether this part of the address was changed after that one.
const isNewerInLink = (name, other) => {
  const names = [...readParts().keys()];
  return names.indexOf(name) > names.indexOf(other);
};

const writeChanges = (request, changes) =>
  Object.entries(changes ?? {}).reduce(
    (text, [name, value]) => text.replace(new RegExp(`([:,]${name}=)[^,]*`), `$1${value}`),
    request,
  );
// Azimuth and elevation, degrees, of a sun whose light travels so: azimuth 0 is +z, 90 is +x.
const findSkyAngles = ([x, y, z]) =>
  [Math.atan2(-x, -z), Math.asin(clamp(-y, -1, 1))].map((angle) => Number(((180 / Math.PI) * angle).toFixed(4)));
// A map's format in the program's words, "d16 perspective 30.5 reversed hashed", as the options that it stands for.
const writeFormat = (text) =>
  text
    .replace("perspective", "--perspective-depth")
    .replace("reversed", "--reversed-depth")
    .replace(/hashed|dither/, "--blend-casters $&")
    .split(" ");
const readSettings = (who) => JSON.parse(run.configurations[who].surroundings);
// The bias as the command has it; empty where it is the program's default.
const writeBias = ({ bias: rule }) => {
  const amounts = (name, list) => {
    const given = list.filter(([, value]) => value).map(([key, value]) => `${key}=${value}`);
    return given.length > 0 ? [`${name}:${given.join()}`] : [];
  };
  const unitsOf = (name) => ["depth", "texels", "world"].map((unit) => [unit, rule[`${name}_${unit}`]]);
  const words = [
    ...amounts("constant", unitsOf("constant")),
    ...amounts("slope", unitsOf("slope")),
    ...amounts("plane", Object.entries({ kernels: rule.plane_kernels, texels: rule.plane_texels })),
    ...amounts("normal-offset", unitsOf("normal_offset")),
    ...amounts("polygon-offset", Object.entries({ factor: rule.polygon_factor, units: rule.polygon_units })),
    ...["receiver_plane", "front_cull", "midpoint"]
      .filter((flag) => rule[flag])
      .map((flag) => `${flag.replace("_", "-")}:depth=0`),
  ];
  const isDefault = words.join() === "constant:depth=0.00002,plane:kernels=1";
  return isDefault ? [] : (words.length > 0 ? words : ["none"]).flatMap((word) => ["--bias", word]);
};
// Empty where it is not known how the scene, or the file of the filter, was given.
const writeRun = ({ place, right, light, parameters }, { motion, settings }) => {
  const { filter, request, map, size } = run.configurations[right];
  const [scene, ...of] = run.places[place].view;
  const file = run.files[filter];
  if (scene === undefined || file === null) return "";
  const sky = motion.isSun && isTurned(light) ? findSkyAngles(motion.directionOf(light)).join() : settings.light;
  const words = [
    ...["--scene", scene, ...of, ...(file ? ["--filter-file", file] : [])],
    ...["--filters", writeChanges(request, parameters.get(right)), "--map-size", map],
    ...["--size", size.join("x"), "--fit", settings.fit, "--map-format", ...writeFormat(settings.map_format)],
    ...writeBias(settings),
    ...(/^-?[\d.]+,/.test(sky) ? ["--light", sky] : []),
  ];
  return `shadowbench run ${words.map((word) => writeWord(`${word}`)).join(" ")}`;
};
// What the command leaves out, or makes otherwise.
const sayUnsaid = ({ place, camera, light }, { motion } = {}) => {
  const { view } = run.places[place];
  const isModel = view.includes("--ground") || /\.(obj|gltf|glb)$/i.test(view[0]);
  const isMoved = isTurned(light) && motion && !motion.stays;
  return [
    isTurned(camera) && "It has the scene's own camera, not the turned one.",
    isMoved && !motion.isSun && "It has the scene's own lamp, not the moved one.",
    isMoved && motion.isSun && !motion.isFitted && "Its map, which follows the view, covers a little less.",
    isMoved && isModel && "A model's camera and floor, where it has none, follow its light.",
  ]
    .filter(Boolean)
    .join(" ");
};

// The section "Live": the run's filters drawn by the reader's own GPU, held against what the run drew, and timed.
const startLive = (holder) => {
  let opened = null;
  const open = () => (opened ??= openLive(holder));
  const still = findEntry(kTruth, 0)?.picture ?? run.cells.find(({ picture }) => picture)?.picture;
  element(holder, "p", { className: "note" }, "This GPU draws the filters here once you scroll to this section.");
  if (still)
    element(element(holder, "div", { className: "live-stage" }), "img", { src: still, alt: "As the run drew it" });
  onceSeen(holder, open);
  const followLink = () => {
    if (!readLink("live")) return;
    if (opened) opened.openLink();
    else open();
    if (isNewerInLink("live", "view")) holder.closest("section").scrollIntoView();
  };
  window.addEventListener("hashchange", followLink);
  whenGpuIsLost = () => opened?.lose();
  // Times all scenes, and promises the id of the cost that they became; `say` hears how far that is.
  shadowbench.timeHere = (say) => open().timeHere(say);
  shadowbench.stopTiming = () => opened?.stop();
  // A side against the truth, from the answer.
  shadowbench.showLive = ({ place, left, right }) => {
    holder.closest("section").scrollIntoView();
    open().show({ place, left, right, camera: [0, 0], light: [0, 0] });
  };
  followLink();
};
const kLiveLayers = ["picture", "visibility", "error"].map((name) => [name, layerOf(name).title]);
const kDrags = { camera: "the camera", light: "the light" };
// A view's drags turn its camera or its light.
const turnView = (view, drags, yaw, pitch) => {
  const [oldYaw, oldPitch] = view[drags];
  view[drags] = [oldYaw + yaw, clamp(oldPitch + pitch, -1, 1)].map((angle) => Number(angle.toFixed(4)));
};
// The places of a slider, 0 to 1, of a range that spans decades; where it begins at 0, the run's own value is halfway.
const kRatiosForLog = [100, 10]; // of the largest value to the least, and to the run's own where the least is 0
const makeLogScale = ({ own, min, max, whole }) => {
  if (whole || !(max > 0)) return null;
  if (min > 0 && max / min >= kRatiosForLog[0])
    return { toPlace: (v) => Math.log(v / min) / Math.log(max / min), toValue: (p) => min * (max / min) ** p };
  if (min !== 0 || !(own > 0) || max / own < kRatiosForLog[1]) return null;
  const floor = own ** 2 / max;
  const span = Math.log1p(max / floor);
  return { toPlace: (v) => Math.log1p(v / floor) / span, toValue: (p) => floor * Math.expm1(p * span) };
};
// `own` is the run's value, which the slider gives back to the last digit.
const addSlider = (parent, { name, value, own = value, min, max, step, unit, text, whole }, onChoose) => {
  const title = element(parent, "label", { title: text }, `${name}${unit ? `, ${unit}` : ""} `);
  const scale = makeLogScale({ own, min, max, whole });
  const range = scale ? { min: 0, max: 1, step: "any" } : { min, max, step };
  const input = element(title, "input", { type: "range", ...range });
  input.value = scale ? scale.toPlace(value) : value;
  const shown = element(title, "output", {}, format(Number(value)));
  const read = () => {
    if (!scale) return Number(Number(input.value).toPrecision(6));
    if (Math.abs(input.value - scale.toPlace(own)) < 0.01) return own;
    return clamp(Number(scale.toValue(Number(input.value)).toPrecision(4)), min, max);
  };
  input.addEventListener("input", () => {
    shown.textContent = format(read());
    onChoose(read());
  });
  return input;
};
const openLive = (holder) => {
  holder.replaceChildren();
  const status = element(holder, "p", { className: "note", role: "status" });
  let engine = null;
  try {
    engine = getEngine();
  } catch ({ message }) {
    status.textContent = message;
    const ignore = () => {};
    return {
      lose: ignore,
      stop: ignore,
      openLink: ignore,
      show: ignore,
      timeHere: () => Promise.reject(new Error(message)),
    };
  }
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
  const constants = element(holder, "p", { className: "note" });
  const code = addCommand(holder, "Measure the right side: ");
  const command = code.parentNode;
  command.hidden = true;
  const unsaid = element(command, "span", { className: "unsaid" });
  const results = element(holder, "div");
  const measuring = makeMeasuring(engine);
  const places = run.places
    .map((_, place) => place)
    .filter((place) => run.cells.some((cell) => cell.place === place && cell.frames));
  const [first] = listFiltersAt(places[0]);
  const state = {
    ...{ id: "live", place: places[0], left: run.truths[places[0]] ? kTruth : first, right: first, split: 0.5 },
    ...{ camera: [0, 0], light: [0, 0], parameters: new Map(), drags: "camera", layer: "picture" },
  };

  // What stands in for the truth is no better than it is where rays were traced.
  const sayStandIn = (maps) => {
    const said = `No rays were traced there: the mean of ${maps} maps replaces the truth`;
    const off = measuring.errorOfReference(state.place);
    const error = findEntry(state.right, state.place)?.rmse?.value;
    if (off === undefined) return [`${said}.`];
    const isVague = off >= error;
    return [
      `${said}. Its RMSE to the traced truth is ${format(off)} under the run's own light.`,
      ...(isVague ? ["This filter's own error is no larger, and cannot be judged here."] : []),
    ];
  };
  let shows = 0;
  const show = async () => {
    if (engine.isBusy) return;
    ++shows;
    holder.ariaBusy = true;
    const sides = [
      [state.left, 0, state.split],
      [state.right, state.split, 1],
    ];
    const messages = [];
    const drawn = [];
    for (const [who, ...part] of sides) {
      const { value, message: why } = await attempt(engine.draw(state, who, canvas, part));
      if (why) {
        messages.push(`${nameOf(who)} cannot be drawn: ${why}`);
        const [from, to] = part.map((share) => Math.round(share * canvas.width));
        canvas.getContext("2d").clearRect(from, 0, to - from, canvas.height);
      }
      if (value) drawn.push(value);
    }
    const isUnfinished = drawn.some((each) => each.isUnfinished);
    if (isUnfinished) requestAnimationFrame(show);
    const maps = drawn.findLast((each) => each.maps)?.maps;
    if (maps) messages.push(...sayStandIn(maps));
    const { value: frame } = await attempt(engine.load(state.right, state.place));
    if (frame?.frames.check.whole && isMoved(state)) messages.push(`Camera and light cannot move: ${kTooLarge}.`);
    else if (frame?.motion.stays && isTurned(state.light))
      messages.push(`This light cannot move: ${frame.motion.stays}.`);
    if (state.layer === "error")
      messages.push(
        `The colours end at errors of \u2212${kMostError} (darker than the truth) and +${kMostError} (lighter).`,
      );
    message.textContent = messages.join(" ");
    canvas.setAttribute(
      "aria-label",
      `Left ${nameOf(state.left)}, right ${nameOf(state.right)}, on ${run.places[state.place].title}`,
    );
    if (maps && !isUnfinished && !measuring.knowsReference(state.place))
      await attempt(measuring.checkReference(state.place)).then(show);
    holder.ariaBusy = --shows > 0 || isUnfinished;
  };
  const showCommand = async () => {
    const { right, place } = state;
    const { value: frame } = right === kTruth ? {} : await attempt(engine.load(right, place));
    code.textContent = frame ? writeRun(state, frame) : "";
    command.hidden = code.textContent === "";
    unsaid.textContent = sayUnsaid(state, frame);
  };
  const fillTable = () => fillResults(results, state.place, measuring);
  const sayRenderer = () =>
    isGpuLost
      ? `Nothing is drawn now: ${kGpuIsGone[0].toLowerCase()}${kGpuIsGone.slice(1)}`
      : `Drawn by ${titleGpu(engine.renderer)}.` +
        (engine.isSoftware ? " It is a CPU, whose times do not predict a GPU's." : "");

  const timeAll = async (onStep) => {
    for (const place of places) {
      if (measuring.isStopped()) break;
      state.place = selects.place.value = place;
      fillSides();
      const say = (what) => {
        status.textContent = `${sayRenderer()} ${run.places[place].title}: ${what}.`;
        onStep(`${run.places[place].title}: ${what}.`);
      };
      say("checking");
      await measuring.checkPlace(place, fillTable);
      await measuring.timePlace(place, (round) => say(`round ${round} of ${kRounds}`));
      fillTable();
    }
    const times = measuring.collectTimes();
    keepTimes(times);
    return addMachine(times, true);
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
      const { value: times, message: why } = await attempt(file.text().then(readTimes));
      if (times) addMachine(times, false);
      message.textContent = `${file.name}: ${why ?? "its times are among the costs."}`;
    }
  };
  // Nothing else is drawn meanwhile. Promises what an action does, or throws what went wrong.
  const work = async (action) => {
    if (engine.isBusy) throw new Error("This GPU is being timed already.");
    if (isGpuLost) throw new Error(kGpuIsGone);
    engine.isBusy = true;
    measuring.begin();
    stopButton.hidden = false;
    const { value, message: why } = await attempt(action());
    engine.isBusy = false;
    stopButton.hidden = true;
    status.textContent = sayRenderer();
    fillTable();
    saveLive(state);
    await show();
    if (why) throw new Error((message.textContent = why));
    return value;
  };
  const timeHere = (onStep) => work(() => timeAll(onStep));

  const changed = () => {
    saveLive(state);
    showCommand();
    show();
  };
  const fillParameters = async () => {
    const { right, place } = state;
    const { value: frame } = await attempt(engine.load(right, place));
    if (right !== state.right || place !== state.place) return;
    parameters.replaceChildren();
    const own = state.parameters.get(right) ?? {};
    const known = frame?.parameters.filter(({ name }) => name in own) ?? [];
    const bounded = known.map(({ name, min, max }) => [name, clamp(own[name], min, max)]);
    state.parameters.set(right, Object.fromEntries(bounded)); // a link may say anything
    showCommand();
    constants.textContent = "";
    if (!frame || right === kTruth) return;
    for (const { value: own, ...each } of frame.parameters) {
      const value = state.parameters.get(right)?.[each.name] ?? own;
      const step = each.whole ? 1 : (each.max - each.min) / 200;
      addSlider(parameters, { ...each, step, own, value }, (chosen) => {
        state.parameters.set(right, { ...state.parameters.get(right), [each.name]: chosen });
        changed();
      });
    }
    if (frame.constants.length === 0) return;
    const built = frame.constants.map(({ name, value }) => `${name} ${value}`).join(", ");
    constants.textContent = `Built into the shaders or their weights: ${built}. The command below measures other values.`;
  };
  // Camera, light and parameters are the run's own again.
  const restore = () => {
    Object.assign(state, { camera: [0, 0], light: [0, 0], parameters: new Map() });
    fillParameters();
    changed();
  };
  const options = () => [kTruth, ...listFiltersAt(state.place)].map((who) => [who, nameOf(who)]);
  const addChoice = (title, name, list) =>
    addSelect(controls, title, list, { dir: "auto" }, (value) => {
      state[name] = Number(value);
      if (name === "place") fillSides();
      fillParameters();
      fillTable();
      changed();
    });
  const selects = {
    place: addChoice(
      "Scene",
      "place",
      places.map((place) => [place, run.places[place].title]),
    ),
    left: addChoice("Left", "left", options()),
    right: addChoice("Right", "right", options()),
    layer: addSelect(controls, "Layer", kLiveLayers, {}, (value) => {
      state.layer = value;
      changed();
    }),
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
  const check = async () => {
    await measuring.checkPlace(state.place, fillTable);
    await measuring.checkReference(state.place);
  };
  addButton(controls, "Check against the run", () => attempt(work(check)));
  addButton(controls, "Time on this GPU", () => attempt(timeHere(() => {})));
  const stop = () => measuring.stop("Timing was stopped before it had all times.");
  const stopButton = addButton(controls, "Stop", stop);
  stopButton.hidden = true;
  addButton(controls, "Save times", saveTimes, "As gpu-times.json");
  const chooser = element(controls, "input", { type: "file", accept: ".json", multiple: true, hidden: true });
  chooser.addEventListener("change", () => loadTimes(chooser.files));
  addButton(controls, "Load times", () => chooser.click(), "Of other machines, as their pages saved them");
  slider.addEventListener("input", () => {
    state.split = slider.value / 100;
    changed();
  });
  status.textContent = sayRenderer();
  status.title = engine.renderer;
  followDrags(canvas, (yaw, pitch) => {
    if (engine.isBusy) return;
    turnView(state, state.drags, yaw, pitch);
    changed();
  });
  const showSides = (changes) => {
    Object.assign(state, { layer: "picture" }, changes);
    selects.layer.value = state.layer;
    selects.place.value = state.place;
    slider.value = 100 * state.split;
    fillSides();
    fillParameters();
    fillTable();
    show();
  };
  const openLink = () => showSides(readLive(places));
  openLink();
  return {
    timeHere,
    openLink,
    show: showSides,
    stop,
    lose: () => {
      measuring.stop(kGpuIsGone);
      status.textContent = sayRenderer();
    },
  };
};
