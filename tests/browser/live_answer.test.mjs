// The answer on top of the page, where this GPU takes part in it: its times, and its picture.
import assert from "node:assert/strict";
import { cpSync, rmSync } from "node:fs";
import { join } from "node:path";
import { changeFrames, keepContexts, kMesa, openDrawing } from "./live_support.mjs";
import { folderOf, kNarrow, linkOf, listViolations, measureOverflow, open, pageOf, pick, reopen, testPage } from "./support.mjs";

const kMeasure = "this GPU (measure)";
const listTitles = (page) => page.locator("select[name=cost] option").allTextContents();
const chosen = (page) => page.locator("select[name=cost]").evaluate((select) => select.selectedOptions[0].textContent);
const measure = (page) => page.locator("select[name=cost]").selectOption({ label: kMeasure });
const line = (page) => page.locator(".answer form [role=status]");
const whenItSays = (page, text) => page.waitForFunction((words) => document.querySelector(".answer form [role=status]").textContent.includes(words), text, { timeout: 120000 });
const whenItEnds = (page) => page.waitForFunction(() => document.querySelector(".answer form button").hidden, null, { timeout: 120000 });

const measureInVain = async (page, words) => {
  const before = await chosen(page);
  await measure(page);
  await whenItSays(page, words);
  await whenItEnds(page);
  assert.equal(await chosen(page), before);
};

testPage("ThisGpuIsACost_ThatIsMeasuredWhenItIsChosen", () => openDrawing(pageOf("untrue"), { viewport: kNarrow }), async ({ page, shoot }) => {
  const before = await chosen(page), top = await page.evaluate(() => scrollY);
  assert.equal((await listTitles(page)).at(-1), kMeasure);
  await measure(page);
  await whenItSays(page, "This GPU is being timed. cubes: round");
  assert.deepEqual(await listViolations(page), []);
  assert.ok((await measureOverflow(page)) <= 0);
  await shoot("answer.measuring");
  await whenItEnds(page);
  assert.equal(await line(page).textContent(), "");
  assert.equal(await chosen(page), "moving light, this GPU");
  assert.ok(!(await listTitles(page)).includes(kMeasure) && before !== (await chosen(page)));
  assert.equal(await page.evaluate(() => scrollY), top);
  assert.match(await page.locator(".answer code").first().textContent(), / --times gpu-times.json/);
  assert.match(await linkOf(page), /machine0\.moving/);
  await reopen(page);
  const kept = await page.evaluate(() => [location.hash, ...Object.keys(localStorage)]);
  assert.equal(await chosen(page), "moving light, this GPU", `the link holds it: ${kept}`);
});

testPage("MeasuringThatEnds_LeavesTheChoiceAsItWas_AndSaysWhy", () => openDrawing(pageOf("untrue"), { init: keepContexts }), async ({ page }) => {
  const before = await chosen(page);
  const stopped = "Timing was stopped before it had all times.";
  for (const [end, words] of [[() => page.locator(".answer form").getByRole("button", { name: "Stop" }).click(), stopped],
    [() => page.locator("select[name=cost]").selectOption({ label: before }), stopped],
    [() => page.evaluate(() => window.contexts[0].getExtension("WEBGL_lose_context").loseContext()), "The browser has taken the GPU away from this page: load it again."]]) {
    await measure(page);
    await whenItSays(page, "round 1 of");
    await end();
    await whenItEnds(page);
    assert.equal(await line(page).textContent(), words);
    assert.equal(await chosen(page), before);
    assert.ok((await listTitles(page)).includes(kMeasure));
  }
  await measureInVain(page, "load it again");
});

const breakLookups = ({ programs }) => {
  for (const each of programs.filter(({ label }) => label.endsWith("lookup"))) each.fragment = each.fragment.replace("void main()", "void nothing()");
};
testPage("WhereNothingAgreesWithTheRun_MeasuringSaysSo", () => openDrawing(changeFrames("single", "disagrees", breakLookups)), ({ page }) =>
  measureInVain(page, "Nothing that is drawn here agrees with the run"));

// Runs in a page before its scripts: the browser cannot draw into floats.
const lackFloats = () => {
  const { getExtension } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.getExtension = function (name) { return name === "EXT_color_buffer_float" ? null : getExtension.call(this, name); };
};
for (const [name, options, words] of [["TargetsOfFloats", { args: kMesa, init: lackFloats }, "lacks EXT_color_buffer_float"],
  ["WebGl", { args: ["--disable-gpu", "--disable-3d-apis"] }, "no WebGL 2"]])
  testPage(`Without${name}_ThePageSaysSo_AndGoesOn`, () => open(pageOf("several"), options), async ({ page }) => {
    await page.locator("#live").evaluate((section) => section.scrollIntoView());
    await page.waitForFunction((text) => document.querySelector(".live").textContent.includes(text), words);
    assert.equal(await page.locator(".live canvas").count(), 0);
    await measureInVain(page, words);
    // The rest of the page works.
    await page.locator(".picks button").last().click();
    assert.ok(await page.locator(".stage img").first().isVisible());
    await pick(page, "Right", { index: 3 });
  });

testPage("TheAnswersPicture_OpensLiveAtItsSceneAndFilter", () => openDrawing(pageOf("several")), async ({ page }) => {
  const button = page.locator(".picks button").last(), wanted = await button.evaluate(({ dataset }) => [Number(dataset.place), -1, Number(dataset.index)]);
  await button.click();
  await page.locator(".answer").getByRole("button", { name: "Live" }).click();
  await page.waitForSelector(".live canvas");
  assert.deepEqual(await page.locator(".live select").evaluateAll((all) => all.slice(0, 3).map(({ value }) => Number(value))), wanted);
  assert.ok(await page.locator(".live canvas").evaluate((canvas) => canvas.getBoundingClientRect().top < innerHeight));
});

testPage("WhereFramesAreMissing_TheRestOfThePageStays_AndLiveSaysSo", () => {
  const folder = folderOf("ball") + ".bare";
  cpSync(folderOf("ball"), folder, { recursive: true });
  rmSync(join(folder, "live"), { recursive: true });
  return openDrawing(join(folder, "index.html"));
}, async ({ page }) => {
  await page.locator(".answer").getByRole("button", { name: "Live" }).click();
  await page.waitForFunction(() => document.querySelector(".live").textContent.includes("not beside this page"));
  assert.ok(await page.locator(".stage img").first().isVisible());
}, /ERR_FILE_NOT_FOUND/);
