// The section "Live": the run's filters drawn by the reader's own GPU, held against what the run drew, and timed.
const startLive = (holder) => onceSeen(holder, () => openLive(holder));
const openLive = (holder) => {
  const kVisibility = "visibility_image"; // the sampler of the shading, which reads what the lookup wrote
  const kRounds = 11;
  const kFarthestTap = 16; // texels
  const kGoals = { comparison: 1e-5, stored: 1e-3 }; // RMSE to the run's visibility
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
  const state = { place: places[0], left: kTruth, right: 0, split: 0.5 };
  const players = new Map();
  const found = new Map(); // by a cell's key: how far it is from the run, and its times
  const truths = new Map();
  const samplings = new Map(); // by a map's size
  let display = null;
  let isBusy = false;
  let isStopped = false;

  const unpacked = new Map(); // by path: frames share them
  const unpack = (blob) => {
    if (!unpacked.has(blob.path)) unpacked.set(blob.path, readBlob(blob));
    return unpacked.get(blob.path);
  };
  const readBlob = async ({ path, rows, columns }) => {
    const text = await addScript(path);
    if (columns === 0) return inflate(text);
    const planes = await decode(path, rows, columns, { data: text });
    const vertices = new Float32Array(rows * columns);
    for (let column = 0; column < columns; ++column)
      for (let row = 0; row < rows; ++row) vertices[row * columns + column] = planes[column * rows + row];
    return vertices;
  };
  const openFrames = async (path) => {
    const frames = JSON.parse(new TextDecoder().decode(await inflate(await addScript(path))));
    const blobs = await Promise.all(frames.blobs.map(unpack));
    return { frames, player: makePlayer(gl, frames, blobs) };
  };
  const open = (path) => {
    if (!players.has(path)) players.set(path, openFrames(path));
    return players.get(path);
  };
  const listFiltersAt = (place) => [...run.configurations.keys()].filter((who) => cellAt(who, place)?.frames);

  // How a side is drawn: the truth by the shading of another one's frame.
  const findFrame = async (who) => {
    const shown = who === kTruth ? listFiltersAt(state.place)[0] : who;
    const cell = cellAt(shown, state.place);
    if (!cell?.frames) throw new Error(`${nameOf(shown)} was not measured there.`);
    const { frames, player } = await open(cell.frames);
    return { ...frames.cells[cell.key], frames, player, cell };
  };
  const truthAt = async (place) => {
    if (truths.has(place)) return truths.get(place);
    const { width, height } = await loadFile(kTruth, place);
    const values = await getPlane(kTruth, place, "visibility");
    const rows = new Float32Array(values.length);
    for (let y = 0; y < height; ++y) rows.set(values.subarray(y * width, (y + 1) * width), (height - 1 - y) * width);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.R32F, width, height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RED, gl.FLOAT, rows);
    truths.set(place, texture);
    return texture;
  };

  const showSide = async (who, from, to) => {
    const { player, picture } = await findFrame(who);
    if (who === kTruth) player.standIn(kVisibility, await truthAt(state.place));
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
    message.textContent = messages.join(" ");
    canvas.setAttribute(
      "aria-label",
      `Left ${nameOf(state.left)}, right ${nameOf(state.right)}, on ${run.places[state.place].title}`,
    );
  };

  // What this GPU's own arithmetic may make of a filter: its weights in each of two directions, its cosines where taps
  // are turned, and receivers so near to the border of two texels that it takes the other one. These are left out, as
  // many as there may be.
  const samplingAt = (size) => {
    if (!samplings.has(size)) samplings.set(size, measureSampling(gl, size));
    return samplings.get(size);
  };
  const compare = (values, plane, mask, width, { x, y, width: columns, height: rows }, leftOut) => {
    const gaps = [];
    for (let row = y; row < y + rows; ++row)
      for (let column = x, i = row * width + x; column < x + columns; ++column, ++i)
        if ((!mask || mask[i]) && Number.isFinite(plane[i])) gaps.push(Math.abs(values[i] - plane[i]));
    gaps.sort((a, b) => a - b);
    const kept = gaps.slice(0, gaps.length - Math.floor(leftOut * gaps.length));
    return {
      rmse: Math.sqrt(kept.reduce((sum, gap) => sum + gap * gap, 0) / Math.max(kept.length, 1)),
      worst: gaps.at(-1) ?? 0,
    };
  };
  // How far a filter's visibility is from what the run drew of it: where receivers and map are those of the run, less
  // the outermost pixels, whose neighbours are not; and everywhere, where they are this GPU's own.
  const check = async (who) => {
    const { player, picture, frames, cell } = await findFrame(who);
    const visibility = player.inputOf(picture, kVisibility);
    const read = () => {
      player.draw(visibility);
      return player.read(visibility);
    };
    const same = player.withKnown(read);
    const own = read();
    const [plane, mask] = [await getPlane(who, state.place, "visibility"), await getMask(state.place)];
    const { width, height } = player.textureOf(visibility);
    const [x, y, columns, rows] = frames.check.rect;
    const inner = { x: x + 1, y: y + 1, width: columns - 2, height: rows - 2 };
    const { weight, shift, turn } = samplingAt(run.configurations[who].map);
    const gap = compare(same, plane, mask, width, inner, 4 * shift);
    const all = compare(own, plane, mask, width, { x: 0, y: 0, width, height }, 0);
    const isStored = frames.steps[visibility].inputs.some(({ sampler }) => /^map_(?!depth$|compare)/.test(sampler));
    const goal = (isStored ? kGoals.stored : kGoals.comparison) + 2 * (weight + kFarthestTap * turn);
    const isSame = gap.rmse <= goal;
    found.set(cell.key, { ...found.get(cell.key), ...gap, all: all.rmse, isSame, refused: undefined });
  };
  const stepsOf = ({ player, picture, frames }) => {
    const visibility = player.inputOf(picture, kVisibility);
    const all = [...player.listSteps(visibility)];
    const labelled = (label) => {
      const isOf = ({ op, program }) => op === "draw" && frames.programs[program].label.startsWith(label);
      return all.filter((index) => isOf(frames.steps[index]));
    };
    const textureOf = (index) => frames.steps[index].targets[0].texture;
    const into = (indices) => all.filter((index) => indices.map(textureOf).includes(textureOf(index)));
    const [map, lookups] = [into([...labelled("depth"), ...labelled("midpoint")]), into([visibility])];
    const shared = [...map, ...lookups, ...labelled("gbuffer"), ...labelled("prepare_receivers")];
    const isOwn = (index) => frames.steps[index].op === "draw" && !shared.includes(index);
    return { map, lookup: lookups, prefilter: all.filter(isOwn), empty: [] };
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
      const parts = { ...stepsOf(frame), empty: empty === null ? [] : [empty] };
      const names = Object.keys(parts).filter((name) => parts[name].length > 0);
      const idOf = (name) => `${frame.cell.frames} ${parts[name].join()}`;
      for (const name of names) drawn.set(idOf(name), () => parts[name].forEach((index) => player.redraw(index)));
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
  // The lookup less its empty one, whose intervals add up.
  const subtractTimes = (lookup, empty) => {
    if (!empty) return lookup;
    const interval =
      lookup.interval && empty.interval
        ? [lookup.interval[0] - empty.interval[1], lookup.interval[1] - empty.interval[0]]
        : null;
    return { median: lookup.median - empty.median, interval, rounds: lookup.rounds };
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
    const link = element(holder, "a", { download: "gpu-times.json" });
    link.href = URL.createObjectURL(new Blob([JSON.stringify(collectTimes(), null, 1)], { type: "application/json" }));
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
      `What this GPU draws on ${run.places[state.place].title}. ${saySampling()}${sayMap(rows)}`,
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
      if (!steps.some((index) => frame.frames.steps[index].uniforms?.[name])) continue;
      const title = element(parameters, "label", { title: text }, `${name}${unit ? `, ${unit}` : ""} `);
      const input = element(title, "input", { type: "range", min, max, step: whole ? 1 : (max - min) / 200, value });
      const shown = element(title, "output", {}, format(value));
      input.addEventListener("input", () => {
        shown.textContent = format(Number(input.value));
        frame.player.setUniform(steps, name, [Number(input.value)]);
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
  const work = async (action) => {
    isBusy = true;
    isStopped = false;
    stopButton.hidden = false;
    await action();
    isBusy = false;
    stopButton.hidden = true;
    status.textContent = sayRenderer();
    fillTable();
    show();
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
  addButton(controls, "Check against the run", () => work(checkAll));
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
  fillParameters();
  show();
};
