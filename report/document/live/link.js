// What the section Live shows, in the page's address; and as the command that measures its right side.
const saveLive = ({ place, left, right, split, camera, light, parameters, map, layer }) => {
  const changes = { left, ...(right !== left && { right }) };
  const own = Object.entries(changes).flatMap(([side, who]) =>
    Object.entries(parameters.get(who) ?? {}).map(([name, value]) => [side, name, value].join(":")),
  );
  if (layer !== "picture") own.push(`layer:${layer}`);
  own.push(...Object.entries(map).map(([name, value]) => ["map", name, value].join(":")));
  writeLink("live", [run.places[place].title, nameOf(left), nameOf(right), split, ...camera, ...light, ...own]);
};
// What the address says of a view, as far as this run has it; null where it says nothing.
const readLive = (places) => {
  const fields = readLink("live");
  if (!fields) return null;
  const [title, left, right, ...rest] = fields;
  const numbers = rest.splice(0, 5).map((text) => (text === "" ? NaN : Number(text)));
  const found = { place: places.find((each) => run.places[each].title === title), parameters: new Map(), map: {} };
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
  const settings = readSettings(sides.right >= 0 ? sides.right : listFiltersAt(found.place)[0]);
  for (const [side, name, value] of rest.map((text) => text.split(":")))
    if (side === "layer" && kLiveLayers.some(([layer]) => layer === name)) found.layer = name;
    else if (side === "map") Object.assign(found.map, readMapSetting(settings, name, value));
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
  [Math.atan2(-x, -z), Math.asin(clamp(-y, -1, 1))].map((angle) => Number(((180 / Math.PI) * angle).toFixed(2)));
// A map's format in the program's words, "d16 perspective 30.5 reversed hashed", as the options that it stands for.
const writeFormat = (text) =>
  text
    .replace("perspective", "--perspective-depth")
    .replace("reversed", "--reversed-depth")
    .replace(/hashed|dither/, "--blend-casters $&")
    .split(" ");
// Empty where it is not known how the scene, or the file of the filter, was given.
const writeRun = ({ place, right, light, parameters, map: changes }, { motion, settings }) => {
  const { filter, request, map, size } = run.configurations[right];
  const [scene, ...of] = run.places[place].view;
  const file = run.files[filter];
  if (scene === undefined || file === null) return "";
  const sky = motion.isSun && isTurned(light) ? findSkyAngles(motion.directionOf(light)).join() : settings.light;
  const words = [
    ...["--scene", scene, ...of, ...(file ? ["--filter-file", file] : [])],
    ...["--filters", writeChanges(request, parameters.get(right)), "--map-size", changes.size ?? map],
    ...["--size", size.join("x"), "--fit", settings.fit],
    ...["--map-format", ...writeFormat(settings.map_format.replace(/^\S+/, changes.format ?? "$&"))],
    ...writeBias(settings, changes),
    ...(/^-?[\d.]+,/.test(sky) ? ["--light", sky] : []),
  ];
  return `shadowbench run ${words.map((word) => writeWord(`${word}`)).join(" ")}`;
};
// What the command leaves out, or makes otherwise.
const listUnsaid = ({ place, camera, light }, { motion } = {}) => {
  const { view } = run.places[place];
  const isModel = view.includes("--ground") || /\.(obj|gltf|glb)$/i.test(view[0]);
  return [
    ...(isTurned(camera) ? ["The camera that was turned is not in it: the program has the scene's own."] : []),
    ...(isTurned(light) && motion && !motion.isSun && !motion.stays
      ? ["The lamp that was moved is not in it: the program has the scene's own."]
      : []),
    ...(isTurned(light) && isModel ? ["A model's camera and floor, where it has none, follow its light."] : []),
  ];
};
