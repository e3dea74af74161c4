// Draws the run's filters with WebGL 2 on a canvas that nobody sees, from which the section Live copies. A view has an id, a
// place, the angles that camera and light are turned by, parameters by filter, and a layer.
const kAsRun = { id: "run", camera: [0, 0], light: [0, 0], parameters: new Map() };
const kMapsAtOnce = 4; // of a reference, in each frame
const kMostError = 0.5; // of visibility, has the palette's last colour
const kGpuIsGone = "The browser has taken the GPU away from this page: load it again.";
const listFiltersAt = (place) => [...run.configurations.keys()].filter((who) => cellAt(who, place)?.frames);
const isTurned = (angles) => angles.some((angle) => angle !== 0);
const isMoved = ({ camera, light }) => isTurned(camera) || isTurned(light);
const posesOf = ({ camera, light }) => JSON.stringify([camera, light]);

const makeEngine = (gl) => {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const renderer = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  const open = makeLoader(gl);
  const frames = new Map(); // by filter and place
  const truths = new Map(); // by place
  const motions = new Map(); // by what they move
  const references = new Map(); // by view and place
  let turn = 0; // counts the changes of camera and light
  let posed = "";
  let display = null;

  // How a side is drawn: the truth by the shading of another one's frame.
  const readFrame = async (who, place) => {
    const shown = who === kTruth ? listFiltersAt(place)[0] : who;
    const cell = cellAt(shown, place);
    if (!cell?.frames) throw new Error(`${nameOf(shown)} was not measured there.`);
    const { frames: graph, blobs, player } = await open(cell.frames);
    if (!graph.cells[cell.key]) throw new Error(`${cell.frames} does not hold it.`);
    const frame = { ...graph.cells[cell.key], frames: graph, player, cell, who };
    const key = `${cell.frames} ${frame.picture}`;
    const settings = readSettings(cell.configuration);
    if (!motions.has(key))
      motions.set(key, { ...makeMotion(player, graph, blobs, frame.picture, settings.fit), turn: 0 });
    const steps = [...player.listSteps(frame.picture)];
    const stepsWith = (name) => steps.filter((index) => graph.steps[index].uniforms?.[name]);
    const parameters = frame.parameters.map((each) => ({ ...each, steps: stepsWith(each.name) }));
    const constants = parameters.filter((each) => each.steps.length === 0);
    return {
      ...frame,
      settings,
      motion: motions.get(key),
      constants,
      parameters: parameters.filter((each) => each.steps.length > 0),
    };
  };
  const load = (who, place) => {
    const key = `${who} ${place}`;
    if (!frames.has(key)) frames.set(key, readFrame(who, place));
    return frames.get(key);
  };
  // Turns a frame as a view is turned, and gives it the view's parameters.
  const pose = (frame, view) => {
    const { player, motion, parameters, who } = frame;
    const { camera, light, parameters: own } = view;
    const key = posesOf(view);
    if (key !== posed) ++turn;
    posed = key;
    if (motion.turn !== turn) {
      motion.turn = turn;
      motion.moveCamera(camera);
      motion.moveLight(light);
    }
    if (who === kTruth) return;
    for (const { name, steps, min, max } of parameters) {
      const value = own.get(who)?.[name];
      const values = value === undefined ? null : [clamp(value, min, max)];
      for (const index of steps) player.setUniforms(index, { [name]: values });
    }
  };
  // The mean over many maps, of the frame without a filter; null where there is none, or no light that could be moved.
  const findReference = async ({ id }, place) => {
    const who = run.configurations.findIndex(({ request }) => /^none\b/.test(request));
    if (who < 0 || !cellAt(who, place)?.frames) return null;
    const frame = await load(who, place);
    if (frame.motion.stays) return null;
    const key = `${id} ${place}`;
    const visibility = frame.player.inputOf(frame.picture, kVisibility);
    if (!references.has(key))
      references.set(key, { ...makeReference(gl, frame, frame.motion, visibility), frame, of: null });
    return references.get(key);
  };
  const refine = (reference, view) => {
    pose(reference.frame, view);
    const of = posesOf(view);
    if (reference.of !== of) reference.restart();
    reference.of = of;
    return reference.refine(view.light, kMapsAtOnce);
  };
  const readTruth = async (place) => {
    const { width, height } = await loadFile(kTruth, place);
    const values = await getPlane(kTruth, place, "visibility");
    const rows = new Float32Array(values.length);
    for (let y = 0; y < height; ++y) rows.set(values.subarray(y * width, (y + 1) * width), (height - 1 - y) * width);
    const texture = makeTexture(gl, gl.R32F, width, height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RED, gl.FLOAT, rows);
    return texture;
  };
  const truthAt = (place) => {
    if (!truths.has(place)) truths.set(place, readTruth(place));
    return truths.get(place);
  };
  // `visibility` stands in for the frame's own, where it is given.
  const drawPicture = ({ player, picture }, visibility) => {
    if (visibility) player.standIn(kVisibility, visibility);
    try {
      player.draw(picture);
    } finally {
      if (visibility) player.standIn(kVisibility, null);
    }
    display.show(player.textureOf(picture));
  };
  const drawLayer = ({ player, picture }, layer, isTruth, sharp) => {
    const visibility = player.inputOf(picture, kVisibility);
    if (!isTruth) player.draw(visibility);
    const shown = player.textureOf(visibility);
    if (isTruth) display.show({ ...shown, object: sharp }, 1);
    else display.show(shown, layer === "error" ? kMostError : 1, layer === "error" ? sharp : null);
  };
  const copy = ({ width, height }, canvas, [from, to]) => {
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const [x, end] = [Math.round(from * width), Math.round(to * width)];
    if (end > x) canvas.getContext("2d").drawImage(gl.canvas, x, 0, end - x, height, x, 0, end - x, height);
  };

  return {
    gl,
    renderer,
    isSoftware: /swiftshader|llvmpipe|software|basic render/i.test(renderer),
    isBusy: false, // it checks or times, and draws nothing else
    load,
    pose,
    findReference,
    refine,
    // Draws a side of a view, and copies it, from one part of the width to another. Promises of a reference that stood in
    // for the truth how many maps it is of, and whether more would better it.
    draw: async (asked, who, canvas, part = [0, 1]) => {
      const { place, layer = "picture" } = asked;
      const frame = await load(who, place);
      const { stays } = frame.motion;
      const view = {
        ...asked,
        ...(frame.frames.check.whole && { camera: [0, 0] }),
        ...(stays && { light: [0, 0] }),
      };
      const needsTruth = who === kTruth || layer === "error";
      const reference = needsTruth ? await findReference(view, place) : null;
      const truth = needsTruth ? await attempt(truthAt(place)) : null;
      // Nothing waits from here on: views take turns whole.
      const { player, picture } = frame;
      const isTraced = !needsTruth || !isMoved(view);
      if (!isTraced && !reference) throw new Error("no rays were traced there; let the scene be as it was.");
      if (isTraced && truth?.message) throw new Error(truth.message);
      const isUnfinished = !isTraced && refine(reference, view);
      pose(frame, view);
      const sharp = needsTruth ? (isTraced ? truth.value : reference.texture()) : null;
      display ??= makeDisplay(gl);
      if (layer === "picture") drawPicture(frame, who === kTruth ? sharp : null);
      else drawLayer(frame, who === kTruth ? "visibility" : layer, who === kTruth, sharp);
      copy(player.textureOf(picture), canvas, part);
      return isTraced ? {} : { maps: reference.count(), isUnfinished };
    },
  };
};

// The page has one engine, made when it is asked for.
let engine = null;
let isGpuLost = false;
let whenGpuIsLost = () => {};
const makeContext = () => {
  const canvas = makeCanvas(1, 1);
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
  if (!gl) throw new Error("This browser gives no WebGL 2, with which filters would be drawn here.");
  if (!gl.getExtension("EXT_color_buffer_float"))
    throw new Error("This browser's WebGL 2 lacks EXT_color_buffer_float, without which filters cannot be drawn here.");
  canvas.addEventListener("webglcontextlost", () => {
    isGpuLost = true;
    whenGpuIsLost();
  });
  return gl;
};
// Throws why nothing can be drawn.
const getEngine = () => {
  if (isGpuLost) throw new Error(kGpuIsGone);
  return (engine ??= makeEngine(makeContext()));
};
