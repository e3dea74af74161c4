// The map as a reader has it: of another size, of another format, and with another depth bias. Nothing is drawn but the
// run's own steps, into other textures and with other numbers in their uniforms. `settings` is empty as the run was.
const kMapSizes = [1 / 4, 1 / 2, 1, 2, 4]; // of the run's
const kMapFormats = ["d16", "d24", "d32f"];
const kBiases = [
  { id: "constant", name: "constant bias", max: 0.01, step: 1e-5, unit: "depth", text: "The same for every receiver" },
  { id: "kernels", name: "plane bias", max: 4, step: 0.05, unit: "reaches", text: "Of a plane over a filter's reach" },
  { id: "normal", name: "normal offset", max: 5, step: 0.05, unit: "texels", text: "Along the receiver's normal" },
];
const kTooLarge = "the scene has more triangles than go with a page, and its map is the run's";
const readSettings = (who) => JSON.parse(run.configurations[who].surroundings);
const isMapChanged = (settings = {}) => Object.keys(settings).length > 0;

// One of a link's, as far as this run can have it.
const readMapSetting = ({ map_size: own }, name, value) => {
  const bias = kBiases.find(({ id }) => id === name);
  if (bias && Number.isFinite(Number(value || NaN))) return { [name]: clamp(Number(value), 0, bias.max) };
  if (name === "size" && kMapSizes.includes(Number(value) / own)) return { size: Number(value) };
  return name === "format" && kMapFormats.includes(value) ? { format: value } : {};
};

// What cannot be changed, by the name of the setting, and why.
const listFixed = ({ frames, player, picture }, { bias }) => {
  const fixed = {};
  if (frames.check.whole) fixed.size = fixed.format = kTooLarge;
  const hasLevels = ({ texture }) => frames.textures[texture].levels > 1;
  const isMade = ({ targets, uniforms }) => targets.some(hasLevels) || uniforms?.pass_stride?.[0] > 1;
  if ([...player.listSteps(picture)].some((index) => isMade(frames.steps[index])))
    fixed.size = "its passes are as many as this size of map needs";
  if (bias.constant_texels || bias.slope_texels || bias.normal_offset_world || bias.slope_world)
    fixed.size = "the run's bias has parts in other units, which another size of map changes";
  if (!bias.plane_kernels) fixed.kernels = "the run had none, so that it is not known how far each filter reaches";
  if (bias.slope_depth || bias.slope_texels || bias.slope_world)
    fixed.constant = "the larger of this and the bias by slope counts";
  return fixed;
};

// A view's settings without those that stay. The size does for the frames of some filters alone, which share a player.
const dropFixed = ({ fixed, frames }, map = {}) =>
  Object.fromEntries(Object.entries(map).filter(([name]) => !fixed[name] || (name === "size" && !frames.check.whole)));

// What player.vary() takes.
const varyMap = ({ frames, player, settings }, { size, format, constant, kernels, normal }) => {
  const { bias } = settings;
  const ofMap = new Set();
  for (const { inputs = [] } of frames.steps)
    for (const { sampler, levels } of inputs)
      if (/^map_/.test(sampler))
        levels.filter((level) => level !== null).forEach((level) => player.listSteps(level, ofMap));
  const factor = (size ?? settings.map_size) / settings.map_size;
  const isOther = factor !== 1 || format !== undefined;
  const isDrawn = (index) => isOther && ofMap.has(index) && frames.steps[index].op !== "upload";
  const scale = (value) => [value[0] * factor];
  const shrink = (value) => [value[0] / factor];
  const changes = {
    ...(factor !== 1 && {
      map_texel_uv: shrink,
      texel_size_ws: shrink,
      map_texels: scale,
      pass_size: (value) => value.map((each) => each * factor),
    }),
    ...(constant !== undefined && { bias_constant: () => [constant] }),
    ...(normal !== undefined && { bias_normal_texels: () => [normal] }),
    ...(kernels !== undefined && {
      bias_plane_kernels: () => [kernels],
      bias_plane_texels: ([texels]) => [
        bias.plane_texels + ((texels - bias.plane_texels) / bias.plane_kernels) * kernels,
      ],
    }),
  };
  const textures = new Map();
  const steps = new Map();
  frames.steps.forEach((step, index) => {
    const uniforms = Object.entries(step.uniforms ?? {}).filter(([name]) => name in changes);
    if (!isDrawn(index) && uniforms.length === 0) return;
    const changed = Object.fromEntries(uniforms.map(([name, value]) => [name, changes[name](value)]));
    const viewport = isDrawn(index) && step.viewport?.map((each) => each * factor);
    steps.set(index, { ...step, uniforms: { ...step.uniforms, ...changed }, ...(viewport && { viewport }) });
    if (!isDrawn(index)) return;
    for (const { texture } of step.targets) {
      const { width, height, ...rest } = frames.textures[texture];
      const stored = /^d/.test(rest.format) && format ? format : rest.format;
      textures.set(texture, { ...rest, format: stored, width: width * factor, height: height * factor });
    }
  });
  return { textures, steps };
};

// The bias as the command has it; empty where it is the program's default.
const writeBias = ({ bias: rule }, { constant, kernels, normal }) => {
  const amounts = (name, list) => {
    const given = list.filter(([, value]) => value).map(([key, value]) => `${key}=${value}`);
    return given.length > 0 ? [`${name}:${given.join()}`] : [];
  };
  const units = (name, depth = rule[`${name}_depth`]) =>
    Object.entries({ depth, texels: rule[`${name}_texels`], world: rule[`${name}_world`] });
  const flags = { receiver_plane: "receiver-plane", front_cull: "front-cull", midpoint: "midpoint" };
  const words = [
    ...amounts("constant", constant === undefined ? units("constant") : [["depth", constant]]),
    ...amounts("slope", units("slope")),
    ...amounts("plane", Object.entries({ kernels: kernels ?? rule.plane_kernels, texels: rule.plane_texels })),
    ...amounts("normal-offset", normal === undefined ? units("normal_offset", 0) : [["texels", normal]]),
    ...amounts("polygon-offset", Object.entries({ factor: rule.polygon_factor, units: rule.polygon_units })),
    ...Object.keys(flags).flatMap((flag) => (rule[flag] ? [`${flags[flag]}:depth=0`] : [])),
  ];
  const isDefault = words.join() === "constant:depth=0.00002,plane:kernels=1";
  return isDefault ? [] : (words.length > 0 ? words : ["none"]).flatMap((word) => ["--bias", word]);
};

// Fills a box with the controls of a view's map, as its right side's frame has it; `most` texels a side can be drawn.
const fillMapControls = (box, frame, view, most, changed) => {
  const { settings: own, fixed } = frame;
  const wasOpen = box.querySelector("details")?.open ?? isMapChanged(view.map);
  box.replaceChildren();
  const details = element(box, "details", { open: wasOpen });
  element(details, "summary", {}, "Map and bias");
  const row = element(details, "div", { className: "controls" });
  const choose = (name, value, isOwn) => {
    const { [name]: old, ...rest } = view.map;
    view.map = isOwn ? rest : { ...rest, [name]: value };
    changed();
  };
  const whole = kMapSizes.map((share) => share * own.map_size).filter((size) => Number.isInteger(size) && size <= most);
  const sizes = whole.map((size) => [size, `${size} texels`]);
  const size = addSelect(row, "Map", sizes, {}, (text) => choose("size", Number(text), Number(text) === own.map_size));
  size.value = view.map.size ?? own.map_size;
  size.disabled = Boolean(fixed.size);
  const [stored] = own.map_format.split(" ");
  const formats = kMapFormats.map((name) => [name, name]);
  const format = addSelect(row, "Format", formats, {}, (name) => choose("format", name, name === stored));
  format.value = view.map.format ?? stored;
  format.disabled = Boolean(fixed.format);
  const largest = (name) => Math.max(0, ...steps.map((index) => frame.frames.steps[index].uniforms?.[name]?.[0] ?? 0));
  const steps = [...frame.player.listSteps(frame.picture)];
  const values = {
    constant: largest("bias_constant"),
    kernels: own.bias.plane_kernels,
    normal: largest("bias_normal_texels"),
  };
  for (const { id, ...each } of kBiases) {
    const bounds = { ...each, min: 0, own: values[id], value: view.map[id] ?? values[id] };
    addSlider(row, bounds, (chosen) => choose(id, chosen, false)).disabled = Boolean(fixed[id]);
  }
  const title = (id) => kBiases.find((each) => each.id === id)?.name ?? `map's ${id}`;
  const said = [...new Set(Object.values(fixed))].map((why) => {
    const titles = Object.keys(fixed).filter((id) => fixed[id] === why);
    return `The ${titles.map(title).join(" and the ")} ${titles.length > 1 ? "stay" : "stays"}: ${why}.`;
  });
  if (said.length > 0) element(details, "p", { className: "note" }, said.join(" "));
};
