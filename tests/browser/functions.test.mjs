// Functions of the pages' scripts that need no page: titles of GPUs from what browsers say of them, axes of charts, and the
// timing of a GPU.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";

const take = (file, name) => {
  const text = readFileSync(new URL(`../../report/document/${file}`, import.meta.url), "utf8");
  const page = { createElement: () => ({ getContext: () => ({}) }) };
  return new Function("document", "location", `${text}; return ${name};`)(page, { pathname: "" });
};
const titleGpu = take("live/machine_times.js", "titleGpu"), fitAxis = take("chart_drawing.js", "fitAxis");

const kTitles = {
  // Chromium and Edge under Windows.
  "ANGLE (NVIDIA, NVIDIA GeForce RTX 4070 Direct3D11 vs_5_0 ps_5_0, D3D11)": "NVIDIA GeForce RTX 4070",
  "ANGLE (AMD, AMD Radeon(TM) Graphics (0x00001638) Direct3D11 vs_5_0 ps_5_0, D3D11)": "AMD Radeon Graphics",
  "ANGLE (Intel, Intel(R) Iris(R) Xe Graphics (0x00009A49) Direct3D11 vs_5_0 ps_5_0, D3D11)": "Intel Iris Xe Graphics",
  "ANGLE (Qualcomm, Qualcomm(R) Adreno(TM) X1-85 GPU (0x36334330) Direct3D11 vs_5_0 ps_5_0, D3D11)": "Qualcomm Adreno X1-85 GPU",
  // Firefox, which rounds names.
  "ANGLE (Intel, Intel(R) HD Graphics 400 Direct3D11 vs_5_0 ps_5_0), or similar": "Intel HD Graphics 400",
  // macOS and iOS.
  "ANGLE (Apple, ANGLE Metal Renderer: Apple M1 Pro, Unspecified Version)": "Apple M1 Pro",
  "ANGLE (Intel Inc., Intel(R) Iris(TM) Plus Graphics OpenGL Engine, OpenGL 4.1)": "Intel Iris Plus Graphics",
  "Apple GPU": "Apple GPU",
  // Phones.
  "ANGLE (Qualcomm, Adreno (TM) 740, OpenGL ES 3.2)": "Adreno 740",
  "ANGLE (ARM, Mali-G715, OpenGL ES 3.2)": "Mali-G715",
  "ANGLE (Samsung Electronics Co., Ltd., Vulkan 1.3.279 (Samsung Xclipse 940 (0x00000000)), Samsung driver)": "Samsung Xclipse 940",
  "ANGLE (Samsung Xclipse 920) on Vulkan 1.1.179": "Samsung Xclipse 920",
  // Linux.
  "Mesa DRI Intel(R) HD Graphics 520 (Skylake GT2)": "Intel HD Graphics 520",
  "NVIDIA GeForce RTX 3080/PCIe/SSE2": "NVIDIA GeForce RTX 3080",
  "ANGLE (NVIDIA, Vulkan 1.3.242 (NVIDIA NVIDIA GeForce RTX 3070 (0x00002484)), NVIDIA-535.54.3)": "NVIDIA GeForce RTX 3070",
  "ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)": "Intel UHD Graphics 620",
  "ANGLE (AMD, AMD Radeon RX 6900 XT (radeonsi, navi21, LLVM 15.0.6, DRM 3.54, 6.5.0), OpenGL 4.6)": "AMD Radeon RX 6900 XT",
  // Software.
  "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)": "SwiftShader Device",
  "ANGLE (Mesa, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5)": "llvmpipe",
  // What is not known stays as it is.
  "WebKit WebGL": "WebKit WebGL",
  "ANGLE ()": "ANGLE ()",
  "<img src=x onerror=alert(1)>": "<img src=x onerror=alert(1)>",
  "": "",
};
test("AGpuHasAShortTitle", () => {
  for (const [renderer, title] of Object.entries(kTitles)) assert.equal(titleGpu(renderer), title, renderer);
});

test("HiddenCurves_TakeNoRoom", () => {
  const axis = { low: 0.01, high: 2, log: true, ticks: [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1].map((value) => [value, `${value}`]) };
  const curve = (...values) => ({ points: values.map((value) => ({ y: value === null ? [null] : [value, 0.9 * value, 1.1 * value] })) });
  const fitted = fitAxis(axis, [curve(0.06, null), curve(0.15)]);
  assert.deepEqual([fitted.low, fitted.high], [0.05, 0.2]);
  assert.deepEqual(fitted.ticks.map(([value]) => value), [0.05, 0.1, 0.2]);
  assert.deepEqual(fitAxis(axis, [curve(0.06, 1.5)]).high, 2, "beyond the last tick");
  assert.deepEqual(fitAxis(axis, []), axis, "nothing is shown");
});

const kTiming = new URL("../../report/document/live/timing.js", import.meta.url);
const makeTimer = new Function("makeTarget", "document", `${readFileSync(kTiming, "utf8")}; return makeTimer;`)(() => ({ framebuffer: 0 }), { hidden: false });
const draw = (count) => {
  const end = performance.now() + 0.02 * count;
  while (performance.now() < end);
};

test("ThePageIsAliveBetweenAllTimes", async () => {
  const gl = new Proxy({}, { get: (own, name) => own[name] ?? (() => 0) });
  const seen = [];
  let ticks = 0, isOver = false;
  const tick = () => {
    ++ticks;
    if (!isOver) setTimeout(tick);
  };
  tick();
  const times = await makeTimer(gl)([draw, draw, draw], 3, () => seen.push(ticks), () => false);
  isOver = true;
  assert.equal(times.length, 3);
  for (const [i, count] of seen.entries()) assert.ok(count >= (i > 0 ? seen[i - 1] : 0) + 3, `the page did something else so often by the end of the rounds: ${seen}`);
});
