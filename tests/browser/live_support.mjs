// What the tests of the pages that draw with WebGL 2 share.
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { deflateSync, inflateSync } from "node:zlib";
import { folderOf, launch, open } from "./support.mjs";

// Mesa's llvmpipe draws the runs too; Chromium's own rasteriser is another implementation.
export const kMesa = ["--use-gl=angle", "--use-angle=gl", "--ignore-gpu-blocklist"], kOwn = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
export const openLive = async (file, browser, options = {}) => {
  const opened = await open(file, { browser, ...options });
  await opened.page.locator("#live").evaluate((section) => section.scrollIntoView());
  await opened.page.waitForSelector(".live canvas");
  return opened;
};
export const press = async (page, name) => {
  await page.locator(".live").getByRole("button", { name }).click();
  await page.waitForFunction(() => [...document.querySelectorAll(".live button")].find((each) => each.textContent === "Stop").hidden, null, { timeout: 240000 });
};
export const readTable = (page) => page.locator(".live table tbody tr").evaluateAll((rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
// Hands the page a file of times, and gives what it says of that file.
export const loadTimes = async (page, name, text) => {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.locator(".live").getByRole("button", { name: "Load times" }).click()]);
  await page.locator(".live p.note").evaluateAll((notes) => notes.forEach((note) => note.getAttribute("role") || note.querySelector("code") || (note.textContent = "")));
  const folder = mkdtempSync(join(tmpdir(), "times")), file = join(folder, name);
  writeFileSync(file, text);
  await chooser.setFiles(file);
  await page.waitForFunction((said) => document.querySelector(".live").textContent.includes(said + ":"), name);
  rmSync(folder, { recursive: true });
  return page.locator(".live p.note", { hasText: `${name}:` }).textContent();
};
export const withBrowser = async (args, action) => {
  const browser = await launch(args);
  try {
    await action(browser);
  } finally {
    await browser.close();
  }
};
// A command's words as a shell has them.
export const splitWords = (command) => [...command.matchAll(/'((?:[^']|'\\'')*)'|(\S+)/g)].map(([, quoted, plain]) => plain ?? quoted.replaceAll("'\\''", "'"));
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
// How far two screenshots of one size are apart, in steps of 255: the mean, and the share of pixels beyond `far`.
export const compareShots = async (browser, shots, far = 8) => {
  const page = await browser.newPage();
  const found = await page.evaluate(async ([texts, most]) => {
    const [a, b] = await Promise.all(texts.map(async (text) => {
      const image = new Image();
      image.src = "data:image/png;base64," + text;
      await image.decode();
      const context = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height }).getContext("2d");
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    }));
    if (a.length !== b.length) throw new Error("the shots have different sizes");
    const gaps = a.map((value, i) => Math.abs(value - b[i]));
    return { mean: gaps.reduce((sum, gap) => sum + gap, 0) / gaps.length, share: gaps.filter((gap) => gap > most).length / gaps.length };
  }, [shots.map((shot) => shot.toString("base64")), far]);
  await page.close();
  return found;
};
