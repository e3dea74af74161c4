// What the tests of the pages that draw with WebGL 2 share.
import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { deflateSync, inflateSync } from "node:zlib";
import { folderOf, open, readPng, runProgram } from "./support.mjs";

// Mesa's llvmpipe draws the runs too; Chromium's own rasteriser is another implementation.
export const kMesa = ["--use-gl=angle", "--use-angle=gl", "--ignore-gpu-blocklist"], kOwn = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
// Opens a page in a browser with WebGL; openLive() scrolls to its section Live, too.
export const openDrawing = (file, options) => open(file, { args: kMesa, ...options });
export const openLive = async (file, options) => {
  const opened = await openDrawing(file, options);
  await opened.page.locator("#live").evaluate((section) => section.scrollIntoView());
  await opened.page.waitForSelector(".live canvas");
  return opened;
};
export const press = async (page, name) => {
  await page.locator(".live").getByRole("button", { name }).click();
  await page.waitForFunction(() => [...document.querySelectorAll(".live button")].find((each) => each.textContent === "Stop").hidden, null, { timeout: 240000 });
};
export const readTable = (page) => page.locator(".live table tbody tr").evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
// Makes a folder that is removed after the test.
export const makeFolder = (context) => {
  const folder = mkdtempSync(join(tmpdir(), "shadowbench-"));
  context.after(() => rmSync(folder, { recursive: true }));
  return folder;
};
// Hands the page a file of times, and gives what it says of that file.
export const loadTimes = async (page, folder, name, text) => {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator(".live").getByRole("button", { name: "Load times" }).click()]);
  await page.locator(".live p.note").evaluateAll((notes) => notes.forEach((note) => note.getAttribute("role") || note.querySelector("code") || (note.textContent = "")));
  const file = join(folder, name);
  writeFileSync(file, text);
  await chooser.setFiles(file);
  await page.waitForFunction((said) => document.querySelector(".live").textContent.includes(said + ":"), name);
  return page.locator(".live p.note", { hasText: `${name}:` }).textContent();
};
// Has the program measure what some words name, as quickly as it can; gives the cells.
export const measure = (words, out, cwd) => {
  const said = runProgram([...words, "--rounds", "1", "--phases", "1", "--no-attribution", "--gpu", "none", "--no-grids", "--out", out], { cwd });
  assert.equal(said.status, 0, said.stderr);
  return JSON.parse(readFileSync(join(out, "results.json"), "utf8")).cells;
};
// A copy of a run, of whose scripts of frames a function changes the JSON.
export const changeFrames = (run, name, edit) => {
  const folder = folderOf(run) + "." + name;
  cpSync(folderOf(run), folder, { recursive: true });
  for (const file of readdirSync(join(folder, "live"))) {
    const path = join(folder, "live", file), [, head, text] = /^(shadowbenchValues\("[^"]*",)"([^"]*)"/.exec(readFileSync(path, "utf8"));
    const json = inflateSync(Buffer.from(text, "base64")).toString();
    if (!json.startsWith("{")) continue;
    const frames = JSON.parse(json);
    edit(frames);
    writeFileSync(path, `${head}"${deflateSync(JSON.stringify(frames)).toString("base64")}");`);
  }
  return join(folder, "index.html");
};
// Runs in a page before its scripts: keeps each WebGL context that they get in window.contexts.
export const keepContexts = () => {
  const { getContext } = HTMLCanvasElement.prototype;
  window.contexts = [];
  HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
    const context = getContext.call(this, kind, ...rest);
    if (kind === "webgl2" && context) window.contexts.push(context);
    return context;
  };
};
// Runs in a page before its scripts: a GPU whose work is done when something is read back, and takes kMsPerLetter for each
// letter of the fragment shader that it draws with, by a clock that nothing else moves.
export const kMsPerLetter = 0.01;
export const keepTime = `(${(msPerLetter) => {
  const { prototype } = WebGL2RenderingContext, letters = new Map();
  let now = 0, waiting = 0, drawsWith = null;
  const before = (name, act) => {
    const own = prototype[name];
    prototype[name] = function (...words) {
      act(...words);
      return own.apply(this, words);
    };
  };
  before("attachShader", (program, shader) => letters.set(program, letters.get(shader) ?? letters.get(program)));
  before("shaderSource", (shader, text) => text.includes("gl_Position") || letters.set(shader, text.length));
  before("useProgram", (program) => (drawsWith = program));
  for (const name of ["drawArrays", "drawElements"]) before(name, () => (waiting += msPerLetter * letters.get(drawsWith)));
  before("readPixels", () => [now, waiting] = [now + waiting, 0]);
  performance.now = () => (now += 1e-6);
}})(${kMsPerLetter})`;
// How far two PNGs of one size are apart, in steps of 255: the mean, and the share of colours beyond `far`.
export const compareShots = (shots, far = 8) => {
  const [a, b] = shots.map(readPng), gaps = [];
  if (a.width !== b.width || a.height !== b.height) throw new Error("the shots have different sizes");
  for (let i = 0; i < a.data.length; ++i) if (i % 4 < 3) gaps.push(Math.abs(a.data[i] - b.data[i]));
  return { mean: gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length, share: gaps.filter((gap) => gap > far).length / gaps.length };
};
