// Lights of every kind are moved by the page, and the program draws the same.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { compareShots, makeFolder, measure, openLive, press } from "./live_support.mjs";
import { pageOf, pick, settle, splitWords } from "./support.mjs";

const kScene = new URL("../../data/scenes/teaching/three_lights.toml", import.meta.url);
// The right side's picture with camera and light turned so, and the page.
const drawTurned = async (run, place, filter, camera, light) => {
  const fields = [place, filter, filter, 0.5, ...camera, ...light].map(encodeURIComponent).join();
  const { page, messages, data, close } = await openLive(pageOf(run), { hash: `#live=${fields}` });
  await settle(page);
  const picture = await page.locator(".live-stage canvas").evaluate((canvas) => canvas.toDataURL().split(",")[1]);
  const said = await page.locator(".live").textContent(), command = await page.locator(".live code").textContent();
  assert.deepEqual(messages, []);
  await close();
  return { picture: Buffer.from(picture, "base64"), said, words: splitWords(command), data };
};
const drawByProgram = (words, out, cwd) => readFileSync(join(out, measure(words, out, cwd)[0].images.picture));
const ownPicture = (run, data, place, label) => {
  const [at, who] = [data.places.findIndex(({ title }) => title === place), data.configurations.findIndex((each) => each.label === label)];
  return readFileSync(pageOf(run, decodeURI(data.cells.find((cell) => cell.place === at && cell.configuration === who).picture)));
};
const holdAgainst = (context, name, [shown, drawn, own], most = 0.03) => {
  const [gap, moved] = [compareShots([shown, drawn], 24), compareShots([own, drawn], 24)];
  context.diagnostic(`${name}: ${gap.share} of the values differ from the program's, and ${moved.share} from those of the run's own light`);
  assert.ok(gap.share < most && gap.share < moved.share / 3, `${name}: ${JSON.stringify([gap, moved])}`);
};

test("LampsGoRoundTheScene_AsTheProgramDrawsThemThere", async (context) => {
  const folder = makeFolder(context), yaw = 0.5, [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  // Floor and posts of the scene have their middle over the origin.
  const turn = (text, key) => text.replace(new RegExp(`^${key} = \\[(.*)\\]$`, "gm"), (_, list) => {
    const [x, y, z] = list.split(",").map(Number);
    return `${key} = [${c * x + s * z}, ${y}, ${c * z - s * x}]`;
  });
  const [head, ...lights] = readFileSync(kScene, "utf8").split("[[light]]"), moved = lights.map((light, i) => (i === 0 ? light : turn(turn(light, "position"), "target")));
  writeFileSync(join(folder, "moved.toml"), [head, ...moved].join("[[light]]"));
  for (const light of ["spot", "bulb"]) {
    const place = `three_lights.${light}`, { picture, said, data } = await drawTurned("lamps", place, "tent3x3", [0, 0], [yaw, 0]);
    assert.match(said, /the scene's own lamp, not the moved one/);
    const drawn = drawByProgram(["run", "--scene", "moved.toml", "--light-name", light, "--filters", "tent3x3", "--size", "160x90", "--map-size", "128"], join(folder, light), folder);
    holdAgainst(context, light, [picture, drawn, ownPicture("lamps", data, place, "tent3x3")]);
  }
});

// Maps from the lamps' middles alone are 0.11 and 0.23 off.
test("AReferenceForALamp_IsNearItsTracedTruth", async (context) => {
  const folder = makeFolder(context), out = join(folder, "out");
  writeFileSync(join(folder, "wide.toml"), readFileSync(kScene, "utf8").replace("radius = 0.04", "radius = 0.4").replace("radius = 0.03", "radius = 0.15"));
  measure(["run", "--scene", "wide.toml", "--filters", "none", "--size", "240x135", "--map-size", "1024"], out, folder);
  const { page, messages, close } = await openLive(join(out, "index.html")), found = {};
  for (const light of ["spot", "bulb"]) {
    await pick(page, "Scene", { label: `wide.${light}` }, ".live");
    await press(page, "Check against the run");
    const said = await page.locator(".live .results").textContent();
    found[light] = Number(/The mean of 256 maps from points of the light has an RMSE of ([\d.]+) to the traced truth/.exec(said)?.[1]);
  }
  context.diagnostic(JSON.stringify(found));
  for (const [light, rmse] of Object.entries(found)) assert.ok(rmse > 0 && rmse < 0.02, `${light}: ${rmse}`);
  assert.deepEqual(messages, []);
  await close();
});

test("CascadesFollowSunAndCamera_AndAWarpedMapSaysThatItStays", async (context) => {
  const folder = makeFolder(context), { data } = await drawTurned("fits", "avenue", "none", [0, 0], [0, 0]);
  const labelOf = (fit) => data.configurations.find(({ surroundings, filter }) => filter === "none" && JSON.parse(surroundings).fit.startsWith(fit)).label;
  // One map of 128 texels over all that is seen has coarse edges, which another window puts elsewhere.
  for (const [fit, most] of [["cascades", 0.03], ["view", 0.08]]) {
    const label = labelOf(fit), { picture, words } = await drawTurned("fits", "avenue", label, [0, 0], [0.4, 0.1]);
    assert.ok(words.includes("--light"));
    const own = ownPicture("fits", data, "avenue", label);
    holdAgainst(context, fit, [picture, drawByProgram(words, join(folder, fit), folder), own], most);
    // A whole turn of the camera fits its windows anew, and shows what was seen before.
    const whole = await drawTurned("fits", "avenue", label, [2 * Math.PI, 0], [0, 0]), gap = compareShots([whole.picture, own], 24);
    context.diagnostic(`${fit}: ${gap.share} of the values move with a whole turn`);
    assert.ok(gap.share < most, JSON.stringify(gap));
  }
  const label = labelOf("lispsm"), warped = await drawTurned("fits", "avenue", label, [0, 0], [0.4, 0.1]);
  assert.match(warped.said, /This light cannot move: its map is warped/);
  assert.ok((compareShots([warped.picture, ownPicture("fits", data, "avenue", label)])).mean < 0.5);
});
