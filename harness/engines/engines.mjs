// The engines that draw.mjs knows, where the browser finds their modules, and what can be set. Of a list of words the
// first is used where nothing is said; numbers are given as they are used then. Both are what the engine ships, but for
// the fit: a row says more where the engine's map covers the same window as ours.
const kCommon = { driver: ["gl", "swiftshader"], frames: 0 };

export const kEngines = {
  three: {
    title: "three.js",
    package: "three",
    imports: {
      three: "/node_modules/three/build/three.module.js",
      "three/addons/": "/node_modules/three/examples/jsm/",
    },
    settings: {
      type: ["pcf", "basic", "vsm"],
      side: ["auto", "back", "front", "both"], // the faces that cast; "auto" is what materials of one side do
      bias: 0,
      normal: 0, // bias along the normal, metres
      radius: 1,
      ...kCommon,
    },
  },
  babylon: {
    title: "Babylon.js",
    package: "@babylonjs/core",
    imports: { "@babylonjs/": "/node_modules/@babylonjs/" },
    settings: {
      type: ["none", "pcf", "pcss", "poisson", "esm", "blur_esm", "close_esm", "blur_close_esm"],
      quality: ["high", "medium", "low"],
      side: ["front", "both", "back"],
      bias: 0.00005,
      normal: 0,
      light: 0.1, // width of the light for pcss, as a part of the window
      store: ["half", "float"], // of the map, where it is no depth texture
      fit: ["window", "own"],
      hand: ["right", "left"],
      ...kCommon,
    },
  },
  playcanvas: {
    title: "PlayCanvas",
    package: "playcanvas",
    imports: { playcanvas: "/node_modules/playcanvas/build/playcanvas.mjs" },
    settings: {
      type: ["pcf3", "pcf1", "pcf5", "vsm16", "vsm32", "pcss"],
      side: ["front", "both"], // the engine casts the faces that the material shows
      bias: 0.05,
      normal: 0,
      distance: 40, // as far as shadows reach from the camera, metres
      penumbra: 1, // size for pcss
      ...kCommon,
    },
  },
  filament: {
    title: "Filament",
    package: "filament",
    imports: {},
    settings: {
      type: ["pcf"], // the package has no way to set another
      side: ["front", "both"],
      bias: 0.001, // metres
      normal: 1, // texels
      offset: 0.5, // polygon offset while the map is drawn
      slope: 2, // and its part that grows with the slope
      lispsm: ["on", "off"], // the map is finer near the camera
      precision: ["high", "medium"], // of the shaders; medium is what the engine asks for
      ...kCommon,
    },
  },
};

const list = (names) => names.join(", ");
const describe = ([key, value]) => (Array.isArray(value) ? `${key} (${list(value)})` : `${key} (${value})`);

// Reads "key=value,key=value" onto what the engine ships. Throws an Error whose message names what there is.
export const readSettings = (engine, text) => {
  const known = kEngines[engine].settings;
  const settings = Object.fromEntries(Object.entries(known).map(([key, is]) => [key, Array.isArray(is) ? is[0] : is]));
  for (const word of text.split(",").filter(Boolean)) {
    const [key, value = ""] = word.split("=");
    if (!Object.hasOwn(known, key))
      throw new Error(
        `there is no setting '${key}' of ${engine}; there are: ${list(Object.entries(known).map(describe))}`,
      );
    if (Array.isArray(known[key]) && !known[key].includes(value))
      throw new Error(`${key} cannot be '${value}'; it can be: ${list(known[key])}`);
    if (!Array.isArray(known[key]) && !(value !== "" && Number.isFinite(Number(value))))
      throw new Error(`${key} must be a number, and is '${value}'`);
    settings[key] = Array.isArray(known[key]) ? value : Number(value);
  }
  return settings;
};
