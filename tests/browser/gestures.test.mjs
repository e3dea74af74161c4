// Gestures over the viewer, what it says where files are gone, and how it fits a page.
import assert from "node:assert/strict";
import { cpSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { changePage, colours, drag, folderOf, hashOf, kNarrow, kWide, labels, measureOverflow, multiply, open, openViewer, pageOf, pick, settle, showCrops, testPage } from "./support.mjs";

const kPage = pageOf("several");

// The browser hands the page a turn of the wheel some time after it was told of it.
const wheel = async (page, by) => {
  await page.evaluate(() => { window.wheeled = new Promise((resolve) => addEventListener("wheel", () => resolve(), { once: true, capture: true })); });
  await page.mouse.wheel(0, by);
  await page.evaluate(() => window.wheeled);
};
testPage("Gestures_PanSplitCropAndPinch", () => openViewer(kPage, { hash: "#view=cubes,truth,none,visibility,slider,120,67.5,4", hasTouch: true }), async ({ page }) => {
  await page.waitForSelector(".viewer tbody tr", { state: "attached" });
  const box = await page.locator(".viewer .panes canvas").first().boundingBox(), step = 240 / box.width / 4;
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  await drag(page, [box.x + 100, box.y + 100], [box.x + 150, box.y + 80]);
  const [,,,,, x, y] = (await hashOf(page)).split(",").map(Number);
  assert.ok(Math.abs(x - (120 - 50 * step)) < 1 && Math.abs(y - (67.5 + 20 * step)) < 1, `${x} ${y}`);
  const caption = page.locator(".viewer caption"), spot = await caption.textContent();
  await wheel(page, -200);
  await page.mouse.move(box.x + 150.4, box.y + 80);
  assert.equal(await caption.textContent(), spot, "the wheel keeps the pixel under the pointer");
  await wheel(page, 200);
  await drag(page, middle, [box.x + box.width / 4, middle[1]]);
  assert.ok(Math.abs(await page.getByRole("slider", { name: "Split" }).inputValue() - 25) <= 1);
  await page.getByRole("slider", { name: "Split" }).focus();
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs(await page.getByRole("slider", { name: "Split" }).inputValue() - 26) <= 1);
  await page.keyboard.down("Shift");
  await drag(page, [box.x + 500, box.y + 200], [box.x + 600, box.y + 280]);
  await page.keyboard.up("Shift");
  assert.equal((await hashOf(page)).split(",").length, 9);
  const client = await page.context().newCDPSession(page);
  const touch = (type, apart) => client.send("Input.dispatchTouchEvent", { type, touchPoints: apart === null ? []
    : [{ x: middle[0] - apart, y: middle[1], id: 0 }, { x: middle[0] + apart, y: middle[1], id: 1 }] });
  await touch("touchStart", 100);
  for (const apart of [110, 125, 150]) await touch("touchMove", apart);
  await touch("touchEnd", null);
  const zoom = Number((await hashOf(page)).split(",")[7]);
  assert.ok(zoom > 4.5 && zoom < 6.5, String(zoom));
});

const kMissing = /ERR_FILE_NOT_FOUND/; // the browser's own word
testPage("MissingAndDamagedFiles_AreNamed_AndTheRestWorks", () => {
  const folder = folderOf("missing");
  rmSync(folder, { recursive: true, force: true });
  cpSync(folderOf("several"), folder, { recursive: true });
  rmSync(join(folder, "images/cubes.none.values.js"));
  writeFileSync(join(folder, "images/cubes.pcf2x2.values.js"), readFileSync(join(folder, "images/cubes.pcf2x2.values.js"), "utf8").replace(/"data": ?"[^"]{40}/, '"data": "'));
  rmSync(join(folder, "images/cubes.tent3x3.picture.png"));
  return openViewer(join(folder, "index.html"), { hash: "#view=cubes,none,pcf2x2,visibility,side,0,0,1" });
}, async ({ page }) => {
  await page.waitForSelector(".viewer tbody tr", { state: "attached" });
  assert.deepEqual(await page.locator(".viewer .message").allTextContents(), ["images/cubes.none.values.js cannot be read: the file is not beside this page.",
    "images/cubes.pcf2x2.values.js cannot be read: it is damaged or cut short."]);
  await pick(page, "Layer", "picture");
  await pick(page, "Right", { label: "tent3x3" });
  await settle(page);
  assert.deepEqual(await page.locator(".viewer .message:visible").allTextContents(), ["images/cubes.tent3x3.picture.png cannot be read: the picture is not beside this page."]);
  await page.locator(".reasons").evaluate((each) => { each.open = true; });
  const slider = page.locator('.sliders input[name="error.rmse"]'), before = await page.locator(".reasons code").first().textContent();
  await slider.fill("1");
  assert.notEqual(await page.locator(".reasons code").first().textContent(), before);
  await page.locator('.numbers input[type="search"]').fill("vsm");
  assert.equal(await page.locator(".numbers tbody tr").count(), 2);
}, kMissing);

const clear = (data) => {
  data.truths = data.truths.map(() => null);
  for (const cell of data.cells) cell.values = null;
};
testPage("WithoutTruthOrValues_ThePicturesStay", () => openViewer(changePage("several", clear)), async ({ page }) => {
  await settle(page);
  assert.match((await labels(page))[0], /Left: .none/);
  assert.ok(Object.keys(await colours(page)).length > 5, "a picture is drawn");
  await page.getByRole("button", { name: "Difference" }).click();
  await settle(page);
  assert.match(await page.locator(".viewer .message:visible").textContent(), /No values are stored/);
});

const clearPictures = (data) => {
  clear(data);
  for (const cell of data.cells) cell.picture = null;
};
testPage("WithNothing_TheViewerIsHidden", () => open(changePage("several", clearPictures), { waits: false }), async ({ page }) => {
  assert.equal(await page.locator("#viewer").isVisible(), false);
});

const kNames = ['a "quoted" <b>name</b>', "مرشح الظل", "a,comma", "name-" + "long".repeat(40)];
const nameMany = (data) => {
  multiply(data, 300);
  kNames.forEach((name, i) => { data.configurations[i].label = name; });
};
for (const viewport of [kWide, kNarrow]) {
  const hash = "#view=" + ["cubes", kNames[0], kNames[3], "visibility", "side", "9", "9", "1", "10-10-50-50"].map(encodeURIComponent);
  testPage(`ManyFiltersWithOddNames_StayUsable: ${viewport.width}`, () => openViewer(changePage("several", nameMany), { viewport, hash }), async ({ page }) => {
    await showCrops(page);
    await settle(page);
    assert.equal(await page.locator(".viewer .said").textContent(), "");
    assert.ok(await page.locator(".viewer tbody tr").count() <= 15, "the values of few filters are loaded at first");
    assert.equal(await page.locator(".viewer b").count(), 0);
    assert.ok(await measureOverflow(page) <= 0);
    await pick(page, "Right", { label: kNames[1] });
    await settle(page);
    assert.match(await hashOf(page), /مرشح الظل/);
  });
}
