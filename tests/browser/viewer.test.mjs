// The viewer of a run's page: layers, modes, keys, values and links.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";
import { colours, drag, hashOf, labels, linkOf, openViewer, pageOf, pick, settle, showCrops, testPage } from "./support.mjs";

const kPage = pageOf("several");

testPage("FirstPaint_ShowsTheTruthAndAFilter_Silently", () => openViewer(kPage), async ({ page }) => {
  await page.waitForSelector(".viewer tbody tr:nth-child(9)", { state: "attached" });
  assert.deepEqual((await labels(page)).map((each) => each.replace(/[\u2068\u2069]/g, "")),
    ["Picture of cubes, Side by side. Left: truth", "Picture of cubes, Side by side. Right: none"]);
  assert.equal(new URL(page.url()).hash, "", "the address stays until the reader changes something");
  assert.ok(Object.keys(await colours(page)).length > 20);
});

testPage("EveryLayerInEveryMode_IsShownOrExplained", () => openViewer(kPage, { hash: "#view=cubes,none,vsm%20(radius%201),picture,side,0,0,1" }), async ({ page, shoot }) => {
  await settle(page);
  const layers = await page.locator(".viewer").getByRole("combobox", { name: "Layer", exact: true }).locator("option:not([disabled])").evaluateAll((all) => all.map((each) => each.value));
  for (const name of ["picture", "visibility", "error", "numeric", "estimator", "discretisation", "model", "flip", "stability.half_difference", "uncertainty"])
    assert.ok(layers.includes(name), name + " is among " + layers);
  for (const mode of ["Side by side", "Slider", "Flip", "Difference"]) {
    await page.getByRole("button", { name: mode, exact: true }).click();
    for (const layer of layers) {
      await pick(page, "Layer", layer);
      await settle(page);
      const isExplained = await page.locator(".viewer .message:visible").count() > 0;
      assert.ok(isExplained || Object.keys(await colours(page)).length > 1, `${mode} ${layer}`);
      if (["picture", "error", "flip"].includes(layer)) await shoot(`${mode} ${layer}`.replaceAll(" ", "_"));
    }
  }
});

testPage("Difference_IsRightLessLeft_AsTheErrorIs", () => openViewer(kPage, { hash: "#view=cubes,truth,none,error,flip,0,0,1" }), async ({ page }) => {
  await page.keyboard.press("f");
  await settle(page);
  const error = await colours(page), scale = await page.locator(".viewer .scale").textContent();
  await page.getByRole("button", { name: "Difference" }).click();
  await pick(page, "Layer", "visibility");
  await settle(page);
  assert.ok(error["189,23,33"] > 1.05 * error["23,79,168"], "the sign shows");
  assert.deepEqual(await colours(page), error);
  assert.match(await page.locator(".viewer figcaption").first().textContent(), /^Right \u2212 left/);
  const named = (await page.locator(".viewer .scale").textContent()).replace("Visibility", "Error (visibility \u2212 truth)");
  assert.equal(named.replace("right is lower", "darker than the truth").replace("right is higher", "lighter than the truth"), scale);
});

testPage("LayerThatTheTruthLacks_LeavesItsVisibility", () => openViewer(kPage, { hash: "#view=cubes,truth,vsm%20(radius%201),visibility,side,0,0,1,30-30-60-60" }), async ({ page }) => {
  await settle(page);
  const grey = await colours(page);
  for (const layer of ["error", "model", "flip", "stability.half_difference"]) {
    await pick(page, "Layer", layer);
    await settle(page);
    assert.deepEqual(await colours(page), grey, layer);
    assert.equal(await page.locator(".viewer .message:visible").count(), 0);
    const [left, right] = await page.locator(".viewer figcaption").allTextContents();
    assert.equal(left, "Left: truth (its visibility: only filters have this layer)");
    assert.match(right, /^Right: vsm \(radius 1\), \S+ to \S+$/);
  }
  await showCrops(page);
  assert.equal(await page.locator(".viewer .strip [data-who='-1']").textContent(), "truth");
  await pick(page, "Layer", "uncertainty");
  await settle(page);
  assert.match(await page.locator(".viewer figcaption").first().textContent(), /^Left: truth, 0 to 0\.\d+$/);
});

testPage("Keys_ChooseZoomFlipAndMove", () => openViewer(kPage), async ({ page }) => {
  await page.waitForSelector(".viewer tbody tr:nth-child(9)", { state: "attached" });
  for (const [key, name] of [["3", "tent3x3"], ["8", "esm"], ["t", "truth"], ["2", "pcf2x2"]]) {
    await page.keyboard.press(key);
    await settle(page);
    assert.ok((await labels(page))[1].includes(name), key);
  }
  await page.keyboard.press("+");
  await page.keyboard.press("+");
  assert.match(await hashOf(page), /,2\.25$/);
  const pane = page.locator(".viewer .panes canvas").first();
  await pane.focus();
  const before = (await hashOf(page)).split(",").map(Number);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowUp");
  const moved = (await hashOf(page)).split(",").map(Number);
  assert.ok(moved[5] < before[5] && moved[6] < before[6]);
  await page.keyboard.press("0");
  assert.match(await hashOf(page), /,1$/);
  await page.keyboard.press("f");
  await settle(page);
  assert.match((await labels(page))[0], /Flip. Left/);
  await page.keyboard.press("F");
  assert.match((await labels(page))[0], /Flip. Right/);
  await page.locator("#viewer").getByRole("combobox", { name: "Right", exact: true }).focus();
  await page.keyboard.press("f");
  assert.match((await labels(page))[0], /Flip. Right/, "a key typed into a control stays there");
});

// Reads a plane of a file of values without the page's own script: a function of the pixel.
const readPlane = (file, name) => {
  const text = readFileSync(pageOf("several", `images/${file}.values.js`), "utf8");
  const { width, height, planes } = JSON.parse(text.slice(text.indexOf("{"), text.lastIndexOf("}") + 1));
  const { low, high, data } = planes.find((plane) => plane.name === name), bytes = inflateSync(Buffer.from(data, "base64"));
  return (x, y) => {
    let code = 0;
    for (let i = y * width; i <= y * width + x; ++i) code = (code + 256 * bytes[i] + bytes[width * height + i]) % 65536;
    return code === 65535 ? NaN : low + ((high - low) * code) / 65534;
  };
};

testPage("Values_UnderThePointer_AreThoseOfTheFile", () => openViewer(kPage, { hash: "#view=cubes,truth,none,visibility,side,120,67,1" }), async ({ page }) => {
  await page.waitForSelector(".viewer tbody tr:nth-child(9)", { state: "attached" });
  assert.equal(await page.locator(".viewer tbody tr").count(), 9);
  const box = await page.locator(".viewer .panes canvas").first().boundingBox();
  const [truth, none] = [readPlane("cubes.truth.area", "area"), readPlane("cubes.none", "visibility")];
  const edge = [...Array(240).keys()].find((at) => Math.abs(truth(at, 100) - none(at, 100)) > 0.1);
  for (const [x, y] of [[50, 75], [150, 50], [120, 100], [90, 79], [40, 60], [edge, 100]]) {
    await page.mouse.move(box.x + ((x + 0.5) / 240) * box.width, box.y + ((y + 0.5) / 135) * box.height);
    assert.equal(await page.locator(".viewer caption").textContent(), `Pixel x ${x}, y ${y}`);
    const shown = await page.locator(".viewer tbody tr").nth(1).locator("td").allTextContents();
    const read = (file, name) => readPlane(file, name)(x, y), parts = ["numeric", "estimator", "discretisation", "model"];
    const direct = { value: read("cubes.none", "visibility"), truth: read("cubes.truth.area", "area"), sum: 0 };
    for (const part of parts) direct.sum += read("cubes.none", part);
    assert.equal(shown[0], direct.value.toFixed(3));
    assert.equal(Number(shown[1].replace("\u2212", "-")).toFixed(3), (direct.value - direct.truth).toFixed(3).replace("-0.000", "0.000"));
    assert.ok(Math.abs(direct.sum - (direct.value - direct.truth)) < 2e-3, "the parts add up");
  }
});

testPage("Link_RestoresTheView", () => openViewer(kPage), async ({ page, shoot }) => {
  await pick(page, "Scene", { label: "ball" });
  await pick(page, "Left", { label: "vsm (radius 1)" });
  await pick(page, "Layer", "error");
  await settle(page);
  const box = await page.locator(".viewer .panes canvas").first().boundingBox();
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.wheel(0, -600);
  await page.getByRole("button", { name: "Crop", exact: true }).click();
  await drag(page, [box.x + 50, box.y + 50], [box.x + 200, box.y + 150]);
  await showCrops(page);
  await settle(page);
  await shoot("crop");
  const hash = await linkOf(page), before = await labels(page);
  assert.match(decodeURIComponent(hash), /^#view=ball,vsm \(radius 1\),none,error,side,[\d.]+,[\d.]+,[\d.]+,\d+-\d+-\d+-\d+$/);
  const again = await openViewer(kPage, { hash });
  await showCrops(again.page);
  assert.deepEqual(await labels(again.page), before);
  assert.equal(await again.page.locator(".viewer .strip [data-who]").count(), 9);
  await again.page.locator(".viewer .strip [data-who]").last().click();
  await settle(again.page);
  assert.match((await labels(again.page))[1], /esm/);
  assert.deepEqual(again.messages, []);
  await again.close();
});

for (const [hash, expected] of [["#view=nowhere,%E0%A4%A,<b>,glow,spin,NaN,1e999,-4,9-9", /nowhere.*<b>.*glow.*spin/], ["#view=", /^$/], ["#view=cubes", /^$/],
  ["#view=cubes,truth,none,error,side,1e9,-1e9,1e9,99999-99999-99999-99999", /^$/]])
  testPage(`UnknownNamesOfALink_AreSaid: ${hash}`, () => openViewer(kPage, { hash }), async ({ page }) => {
    assert.match(await page.locator(".viewer .said").textContent(), expected);
  });

testPage("OpenViewer_ServesThePage", () => openViewer(kPage), async ({ page }) => {
  await page.evaluate(() => shadowbench.openViewer({ place: 1, right: 0, layer: "error", mode: "slider", rect: { x: 60, y: 40, width: 30, height: 30 } }));
  const [,,, layer, mode, x, y, zoom] = (await hashOf(page)).split(",");
  assert.deepEqual([layer, mode], ["error", "slider"]);
  assert.ok(Number(zoom) > 3);
  assert.ok(Math.abs(x - 75) < 1 && Math.abs(y - 55) < 1, `${x}, ${y}`);
});

