// Draws a scene that 'shadowbench export' wrote with an engine of the web, in headless Chromium:
//   node draw.mjs ENGINE SETTINGS scene.json picture.exr
// SETTINGS is key=value,key=value, or "" for what the engine ships. Writes layers lit, unlit and depth, and a meta.json
// beside them. engines.mjs has the settings.
import { accessSync, constants, existsSync, readFileSync, writeFileSync } from "node:fs";
import { delimiter, dirname, extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { kEngines, readSettings } from "./engines.mjs";
import { writeExr } from "./exr.mjs";

const kFolder = dirname(fileURLToPath(import.meta.url));
const kOrigin = "http://shadowbench.invalid"; // no machine has this name: all that the page gets, it gets from here
const kDrivers = {
  gl: ["--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"],
  swiftshader: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
};
const kTypes = {
  ".html": "text/html",
  ".json": "application/json",
  ".glb": "model/gltf-binary",
  ".wasm": "application/wasm",
};

const fail = (sentence) => {
  throw new Error(sentence);
};

const findChromium = () => {
  const named = process.env.SHADOWBENCH_CHROMIUM;
  const isProgram = (file) => {
    try {
      accessSync(file, constants.X_OK);
      return true;
    } catch {
      return false;
    }
  };
  if (named) return isProgram(named) ? named : fail(`SHADOWBENCH_CHROMIUM names '${named}', which cannot be run`);
  const places = (process.env.PATH ?? "").split(delimiter).map((folder) => join(folder, "chromium"));
  return (
    places.find(isProgram) ?? fail("there is no 'chromium' on PATH: install it, or name it in SHADOWBENCH_CHROMIUM")
  );
};

const readPackage = (name) => {
  const file = join(kFolder, "node_modules", name, "package.json");
  if (!existsSync(file)) fail(`the package ${name} is not installed: run 'npm ci --ignore-scripts' in ${kFolder}`);
  return JSON.parse(readFileSync(file, "utf8"));
};

const readView = (file) => {
  let view;
  try {
    view = JSON.parse(readFileSync(file, "utf8"));
  } catch (error) {
    fail(`${file} cannot be read as a scene.json: ${error.message}`);
  }
  const layer = view.maps?.[0]?.layers?.[0];
  if (view.light?.type !== "directional" || layer?.kind !== "orthographic")
    fail(
      `${file}: these pages draw a directional light through one map with a window, and this is another light or fit`,
    );
  const model = join(dirname(resolve(file)), view.model);
  if (!existsSync(model)) fail(`there is no model ${model}, which ${file} names`);
  return view;
};

// What the page asks for: its own page and scripts, the packages, the scene.
const answer = (route, { engine, scene, view }) => {
  const path = decodeURIComponent(new URL(route.request().url()).pathname);
  if (
    !route
      .request()
      .url()
      .startsWith(kOrigin + "/")
  )
    return route.abort();
  const imports = JSON.stringify({ imports: kEngines[engine].imports });
  if (path === "/") {
    const body = `<!doctype html><title>${engine}</title><script type="importmap">${imports}</script>`;
    return route.fulfill({ contentType: "text/html", body });
  }
  const inFolder = (name) => join(kFolder, normalize(name));
  const files = { "/scene.json": resolve(scene), "/scene.glb": join(dirname(resolve(scene)), view.model) };
  const file = files[path] ?? (/^\/(node_modules|pages)\//.test(path) && inFolder(path));
  if (!file || !existsSync(file)) return route.fulfill({ status: 404, body: "" });
  return route.fulfill({ contentType: kTypes[extname(file)] ?? "text/javascript", body: readFileSync(file) });
};

// What playwright and the engines say, without where: the first two lines, since a shader's compiler has dozens.
const shorten = (message) => {
  const lines = message.split("\n").map((line) => line.trim());
  const said = lines.filter((line) => line && !line.startsWith("at ")).slice(0, 2);
  return said.join(" ").replace(/^(page\.evaluate|browserType\.launch): (Error: )?/, "");
};

// Gives what pages/page.js gives. Throws an Error with one sentence for whatever the page says is wrong.
const drawInBrowser = async (task) => {
  readPackage("playwright-core");
  const { chromium } = await import("playwright-core");
  const executablePath = findChromium();
  const browser = await chromium
    .launch({ executablePath, args: kDrivers[task.settings.driver] })
    .catch((error) => fail(`${executablePath} does not start: ${shorten(error.message.split("\n")[0])}`));
  try {
    const page = await browser.newPage();
    const errors = [];
    page.on("pageerror", (error) => errors.push(error.message));
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    await page.route("**/*", (route) => answer(route, task));
    await page.goto(kOrigin + "/");
    const draw = async ([engine, settings]) => (await import("/pages/page.js")).drawView(engine, settings);
    const drawn = await page.evaluate(draw, [task.engine, task.settings]).catch((error) => ({ error: error.message }));
    if (drawn.error) errors.unshift(drawn.error);
    if (errors.length) fail(`the page of ${task.engine} failed: ${shorten(errors[0])}`);
    return drawn;
  } finally {
    await browser.close();
  }
};

const writePicture = (file, { width, height }, layers) => {
  const channels = {};
  for (const [name, base64] of Object.entries(layers)) {
    const bytes = Buffer.from(base64, "base64");
    const values = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
    const pick = (at) => Float32Array.from({ length: width * height }, (_, i) => values[4 * i + at]);
    if (name === "depth") channels["depth.Z"] = pick(0);
    else for (const [at, letter] of [..."RGB"].entries()) channels[`${name}.${letter}`] = pick(at);
  }
  writeExr(file, width, height, channels);
};

const main = async ([engine, text, scene, picture, ...rest]) => {
  if (picture === undefined || rest.length) fail("usage: node draw.mjs ENGINE SETTINGS scene.json picture.exr");
  if (!Object.hasOwn(kEngines, engine))
    fail(`there is no engine '${engine}'; there are: ${Object.keys(kEngines).join(", ")}`);
  const settings = readSettings(engine, text);
  const { version } = readPackage(kEngines[engine].package);
  const view = readView(scene);
  const { layers, says } = await drawInBrowser({ engine, settings, scene, view });
  writePicture(picture, view, layers);
  const meta = { engine: kEngines[engine].title, version, ...says, truth: view.truth };
  writeFileSync(join(dirname(resolve(picture)), "meta.json"), JSON.stringify(meta, null, 2) + "\n");
};

main(process.argv.slice(2)).catch((error) => {
  console.error(`draw.mjs: ${error.message.split("\n")[0]}`);
  process.exitCode = 1;
});
