// The recipe for three.js still leads to a row: its BasicShadowMap in the window of our map is our unfiltered lookup.
// CTest puts into the environment where the program is; harness/engines has its packages (npm ci).
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test, { after, before } from "node:test";

const { SHADOWBENCH_PROGRAM: kProgram, SHADOWBENCH_ENGINES: kEngines } = process.env;
if (!kProgram || !kEngines)
  throw new Error("Run these tests with 'ctest -L slow': it names the program and the pages.");
const kDraw = join(kEngines, "draw.mjs");
const start = (program, words) => spawnSync(program, words, { encoding: "utf8", timeout: 120000 });
const runProgram = (words) => {
  const { status, stdout, stderr } = start(kProgram, words);
  assert.equal(status, 0, stderr);
  return stdout;
};

let folder, report;
before(() => {
  folder = mkdtempSync(join(tmpdir(), "engines"));
  report = join(folder, "report");
  const size = ["--size", "240x136", "--map-size", "1024", "--rounds", "1", "--no-attribution"];
  runProgram(["run", "--scene", "cubes", "--filters", "none,pcf2x2,tent3x3", ...size, "--out", report]);
});
after(() => rmSync(folder, { recursive: true }));

const score = (name, settings) => {
  const command = `'${process.execPath}' '${kDraw}' ${settings}`;
  return JSON.parse(runProgram(["score", report, "--name", name, "--command", command, "--json"]))[0];
};

test("ThreeBasicInOurWindow_IsNone", () => {
  const { error, external } = score("three.js Basic", "three type=basic,side=front,bias=-0.002");
  assert.equal(external.nearest, "none");
  assert.ok(external.nearest_rmse < 0.01, `${external.nearest_rmse} from none`);
  assert.ok(Math.hypot(external.shift_x, external.shift_y) < 0.001, `${external.shift_x} ${external.shift_y}`);
  assert.match(external.engine, /three/);
  const none = JSON.parse(readFileSync(join(report, "results.json"), "utf8")).cells.find(
    (cell) => cell.filter === "none",
  );
  assert.ok(Math.abs(error.rmse - none.error.rmse) < 0.003, `${error.rmse} and ${none.error.rmse}`);
});

test("TheSamePictureTwice_IsTheSameRow", () => {
  const rows = ["first", "second"].map((name) => score(name, "three type=pcf"));
  const [first, second] = rows.map(({ error, artefact, external }) => ({
    error,
    artefact,
    nearest: external.nearest_rmse,
  }));
  assert.deepEqual(first, second);
});

test("WhatCannotBeDrawn_IsSaidInOneSentence", () => {
  const cases = [
    [
      ["foo", "", "scene.json", "picture.exr"],
      /^draw\.mjs: there is no engine 'foo'; there are: three, babylon, /,
    ],
    [
      ["three", "typ=pcf", "scene.json", "picture.exr"],
      /^draw\.mjs: there is no setting 'typ' of three; there are: type /,
    ],
    [
      ["three", "type=foo", "scene.json", "picture.exr"],
      /^draw\.mjs: type cannot be 'foo'; it can be: pcf, basic, vsm$/,
    ],
    [
      ["three", "", join(folder, "none.json"), "picture.exr"],
      /^draw\.mjs: .*none\.json cannot be read as a scene\.json/,
    ],
  ];
  for (const [words, sentence] of cases) {
    const { status, stderr } = start(process.execPath, [kDraw, ...words]);
    assert.equal(status, 1);
    assert.match(stderr.trimEnd(), sentence);
  }
});
