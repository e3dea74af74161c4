// What the pages of all engines share: the canvas, the order of drawing, and how pictures leave the page.

const readDriver = (canvas) => {
  const gl = canvas.getContext("webgl2");
  if (!gl) throw new Error("Chromium has no WebGL 2 with this driver; try driver=swiftshader");
  if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("this driver cannot draw into floats");
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  return gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
};

// WebGL reads rows from the bottom; pictures begin at the top.
const flipRows = (values, width, height) => {
  const flipped = new Float32Array(4 * width * height);
  for (let y = 0; y < height; ++y)
    flipped.set(values.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
  return flipped;
};

const toBase64 = (values) =>
  new Promise((done) => {
    const reader = new FileReader();
    reader.onload = () => done(reader.result.slice(reader.result.indexOf(",") + 1));
    reader.readAsDataURL(new Blob([values]));
  });

// The time of a frame with shadows less that of one without: the median of so many, each read back, since only what is
// read has surely been drawn.
const measure = async (draw, frames) => {
  const times = { lit: [], unlit: [] };
  for (let i = 0; i < frames; ++i) {
    for (const what of ["lit", "unlit"]) {
      const start = performance.now();
      await draw(what);
      times[what].push(performance.now() - start);
    }
  }
  const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];
  return Math.max(0, median(times.lit) - median(times.unlit));
};

// Every engine's module has open({view, canvas, settings}), which gives draw(what), of "lit", "unlit" and "depth", as
// RGBA floats from the bottom, and what is to be said of map, bias and fit.
export const drawView = async (engine, settings) => {
  const view = await (await fetch("/scene.json")).json();
  const canvas = Object.assign(document.createElement("canvas"), { width: view.width, height: view.height });
  const driver = readDriver(Object.assign(document.createElement("canvas"), { width: 1, height: 1 }));
  const { draw, says } = await (await import(`./${engine}.js`)).open({ view, canvas, settings });
  const layers = {};
  for (const what of ["unlit", "lit", "depth"])
    layers[what] = await toBase64(flipRows(await draw(what), view.width, view.height));
  if (settings.frames > 0) {
    says.ms = Number((await measure(draw, settings.frames)).toFixed(3));
    says.timed = `frame with shadows less one without, median of ${settings.frames}, wall clock, read back`;
  }
  return { layers, says: { driver, ...says } };
};
