// Makes the runs whose pages are tested: node runs.mjs PROGRAM FOLDER
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const [program, folder] = process.argv.slice(2).map((path) => resolve(path)), filters = join(dirname(fileURLToPath(import.meta.url)), "../user_filters");
mkdirSync(folder, { recursive: true });

// A scene whose name has quotes, angle brackets and letters that run from right to left.
const kOddScene = "\u0645\u0634\u0647\u062f \"<b>bold<b>\" & 'it'.obj";
const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 2) & 1} ${(i >> 1) & 1}`);
writeFileSync(join(folder, kOddScene), [...corners, "f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4", ""].join("\n"));
// Waves of so many triangles that their vertices do not go with a page.
const kSide = 515, grid = Array.from({ length: kSide * kSide }, (_, i) => [i % kSide, Math.floor(i / kSide)]);
const waves = grid.map(([x, z]) => `v ${x / 20} ${(Math.sin(x / 17) + Math.cos(z / 23)).toFixed(4)} ${z / 20}`);
const quads = grid.filter(([x, z]) => x + 1 < kSide && z + 1 < kSide).map(([x, z]) => [1, 1 + kSide, 2 + kSide, 2].map((corner) => z * kSide + x + corner));
writeFileSync(join(folder, "waves.obj"), [...waves, ...quads.map((quad) => `f ${quad.join(" ")}`), ""].join("\n"));
copyFileSync(join(filters, "wrong/constant.glsl"), join(folder, "constant.glsl"));
const titled = readFileSync(join(filters, "nine_compares.glsl"), "utf8").replace(/title = .*/, 'title = "The \\"<b>ninth</b>\\" & \u0645\u0631\u0634\u062d"');
writeFileSync(join(folder, "nine_compares.glsl"), titled);

// What no test of a run reads is left out of it: a run costs the more, the more it measures.
const kLean = ["--phases", "1", "--no-attribution", "--no-grids", "--gpu", "none"];
const kSmall = ["--size", "160x90", "--map-size", "128", "--rounds", "2", ...kLean];
const kMany = ["none", ...Array.from({ length: 399 }, (_, i) => `vsm:bleed_reduction=${(i + 1) / 1000}`)].join();
const kPanes = ["run", "--scene", "panes", ...kSmall, "--filters", "none,tent3x3,vsm", "--blend-casters"];
const kFits = ["tight", "view", "focused", "lispsm", "psm", "tsm", "logpsm", "cascades:count=4,split=practical", "cascades:count=4,split=logarithmic"];
const kRuns = {
  several: ["run", "--scene", "cubes", "--scene", "ball", "--size", "240x135", "--map-size", "128", "--rounds", "2", "--stability",
    "--uncertainty", "--filters", "none,pcf2x2,tent3x3,box4x4,box3x3,vsm,vsm:radius=1,esm:radius=1"],
  odd: ["run", "--scene", kOddScene, "--ground", "--scene", "cubes", ...kSmall, "--filters", "none,constant,nine_compares", "--filter-file",
    "constant.glsl", "--filter-file", "nine_compares.glsl"],
  untrue: ["run", "--scene", "cubes", ...kSmall, "--filters", "none,pcf2x2,vsm", "--no-truth"],
  single: ["run", "--scene", "cubes", ...kSmall, "--filters", "tent3x3"],
  mixed: ["run", "--scene", "cubes", "--size", "160x90", "--map-size", "64,128", "--rounds", "4", "--no-attribution", "--no-grids", "--filters",
    "none,pcf2x2,tent3x3,vsm,vsm:radius=1,esm:radius=1"],
  live: ["run", "--scene", "cubes", "--scene", "lantern", "--filters", "all,pcss:screen=bilateral", ...kSmall],
  ball: ["run", "--scene", "ball", "--filters", "none,pcss,vsm", "--size", "240x135", "--map-size", "512", "--rounds", "2", ...kLean],
  lamps: ["run", "--scene", "three_lights", "--filters", "none,tent3x3,vsm,pcss", ...kSmall],
  fits: ["run", "--scene", "avenue", ...kFits.flatMap((fit) => ["--fit", fit]), "--filters", "none,vsm", "--width", "own", ...kSmall],
  hashed: [...kPanes, "hashed"],
  dither: [...kPanes, "dither"],
  waves: ["run", "--scene", "waves.obj", ...kSmall, "--filters", "none,tent3x3,vsm"],
  hundreds: ["run", "--scene", "cubes", "--size", "96x54", "--map-size", "64", "--rounds", "1", ...kLean, "--filters", kMany],
  stress: ["stress", "--filters", "vsm", "--axes", "vsm-cancellation"],
  bias: ["bias", "--filters", "none,tent3x3", "--map-size", "128", "--size", "160x90"],
  tune: ["tune", "--filter", "vsm", "--scene", "cubes", "--budget", "2", "--map-size", "128", "--size", "96x54"],
};
const make = (name) => {
  const words = kRuns[name];
  rmSync(join(folder, name, "results.json"), { force: true });  // else a run that is finished writes no page
  const { status, stderr } = spawnSync(program, [...words, "--out", name], { cwd: folder, encoding: "utf8", env: { ...process.env, XDG_CACHE_HOME: folder } });
  if (status !== 0) {
    console.error(`shadowbench ${words.join(" ")} ended with ${status}:\n${stderr}`);
    process.exit(1);
  }
};
Object.keys(kRuns).forEach(make);

// Every other cell of a run was measured elsewhere, as in a run that was gone on with on another machine.
const cells = join(folder, "mixed", "cells");
readdirSync(cells).sort().forEach((name, i) => {
  const file = JSON.parse(readFileSync(join(cells, name), "utf8"));
  if (i % 2 === 0) return;
  file.cell.machine.cpu = "Another processor";
  writeFileSync(join(cells, name), JSON.stringify(file));
});
make("mixed");
