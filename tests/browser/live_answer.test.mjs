// The answer on top of the page, where this GPU takes part in it: its times, and its picture.
import assert from "node:assert/strict";
import { cpSync, rmSync } from "node:fs";
import { join } from "node:path";
import test from "node:test";
import { changeFrames, compareShots, keepContexts, kMesa, withBrowser } from "./live_support.mjs";
import { changePage, dragOver, folderOf, kNarrow, linkOf, listViolations, measureOverflow, open, pageOf } from "./support.mjs";

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

test("ThisGpuIsACost_ThatIsMeasuredWhenItIsChosen", () => withBrowser(kMesa, async (browser) => {
  const { page, messages, shoot, close } = await open(pageOf("untrue"), { browser, viewport: kNarrow });
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
  await page.reload();
  assert.equal(await chosen(page), "moving light, this GPU", "the link holds it");
  assert.deepEqual(messages, []);
  await close();
}));

test("MeasuringThatEnds_LeavesTheChoiceAsItWas_AndSaysWhy", () => withBrowser(kMesa, async (browser) => {
  const { page, close } = await open(pageOf("untrue"), { browser, init: keepContexts });
  const before = await chosen(page);
  const endsWith = async (words) => {
    await whenItEnds(page);
    assert.equal(await line(page).textContent(), words);
    assert.equal(await chosen(page), before);
    assert.ok((await listTitles(page)).includes(kMeasure));
  };
  await measure(page);
  await whenItSays(page, "round 1 of");
  await page.locator(".answer form").getByRole("button", { name: "Stop" }).click();
  await endsWith("Timing was stopped before it had all times.");
  await measure(page);
  await whenItSays(page, "round 1 of");
  await page.evaluate(() => (window.lost = window.contexts[0].getExtension("WEBGL_lose_context")).loseContext());
  await endsWith("The browser has taken the GPU away from this page, and may give it back.");
  await page.evaluate(() => window.lost.restoreContext());
  await page.waitForFunction(() => document.querySelector(".live select"));
  await measure(page);
  await whenItSays(page, "round 1 of");
  await page.locator("select[name=cost]").selectOption({ label: before });
  await endsWith("Timing was stopped before it had all times.");
  await close();
}));

test("WhereNothingAgreesWithTheRun_MeasuringSaysSo", () => withBrowser(kMesa, async (browser) => {
  const file = changeFrames("single", "disagrees", ({ programs }) => {
    for (const each of programs.filter(({ label }) => label.endsWith("lookup"))) each.fragment = each.fragment.replace("void main()", "void nothing()");
  });
  const { page, close } = await open(file, { browser });
  await measureInVain(page, "Nothing that is drawn here agrees with the run");
  await close();
}));

// A renderer's name that is not that of a CPU.
const nameGpu = () => {
  const { getParameter } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.getParameter = function (name) { return name === 0x9246 ? "A GPU" : getParameter.call(this, name); };
};
const stageOf = (page) => page.locator(".answer .stage");
const isLive = (page) => page.waitForFunction(() => document.querySelector(".stage.turns canvas:not([hidden])"), null, { timeout: 30000 });
const drag = async (page, way) => {
  const { width, height } = await stageOf(page).boundingBox();
  await dragOver(stageOf(page), [0.25 * width, 0.6 * height], [way, 0]);
};
const splitOf = (page) => page.locator(".stage input").inputValue();

test("ThePictureOfTheAnswer_IsTheStillOne_UntilItIsTurned", (context) => withBrowser(kMesa, async (browser) => {
  for (const viewport of [undefined, kNarrow]) {
    const { page, messages, shoot, close } = await open(pageOf("ball"), { browser, ...(viewport && { viewport }) });
    // What is drawn here has one sample a pixel.
    await page.locator(".answer").getByRole("button", { name: "16 samples a pixel" }).click();
    const requests = [], bottom = () => page.locator(".answer").evaluate((each) => each.getBoundingClientRect().bottom + scrollY);
    page.on("request", (request) => requests.push(request.url()));
    const [still, before] = [await stageOf(page).screenshot(), await bottom()];
    await stageOf(page).hover({ position: { x: 20, y: 100 } });
    await page.waitForTimeout(700);
    assert.ok(!requests.some((url) => url.includes("/live/")), "a CPU draws when it is asked to");
    await page.locator(".answer").getByRole("button", { name: "Live" }).click();
    await isLive(page);
    assert.equal(await bottom(), before, "nothing moves");
    const live = await stageOf(page).screenshot(), gap = compareShots([still, live]);
    context.diagnostic(`mean gap ${gap.mean} of 255, ${gap.share} of the values farther than 8`);
    assert.ok(gap.mean < 0.5 && gap.share < 0.003, JSON.stringify(gap));
    await drag(page, 60);
    await page.waitForFunction(() => document.querySelector(".split figcaption").textContent.includes("mean of 256 maps"), null, { timeout: 60000 });
    assert.equal(await splitOf(page), "50");
    const turned = compareShots([still, await stageOf(page).screenshot()]);
    assert.ok(turned.share > 0.03, JSON.stringify(turned));
    await shoot(`answer.live.${viewport ? "phone" : "wide"}`);
    assert.ok((await measureOverflow(page)) <= 0);
    assert.deepEqual(await listViolations(page), []);
    // The line is still the slider's, and the keys too.
    const { width, height } = await stageOf(page).boundingBox();
    await dragOver(stageOf(page), [width / 2, height / 2], [0.2 * width, 0]);
    assert.equal(await splitOf(page), "70");
    await page.locator(".stage input").press("ArrowLeft");
    assert.equal(await splitOf(page), "69");
    await page.locator(".stage input").fill("50");
    await page.locator(".answer").getByRole("button", { name: "Live" }).click();
    await stageOf(page).locator("input").blur();
    const ended = compareShots([still, await stageOf(page).screenshot()]);
    assert.ok(ended.mean < 0.002, JSON.stringify(ended)); // the browser scales a picture not always alike
    assert.deepEqual(messages, []);
    await close();
  }
}));

test("AGpu_DrawsThePictureOfTheAnswer_WhenAPointerComes", () => withBrowser(kMesa, async (browser) => {
  const { page, close } = await open(pageOf("several"), { browser, init: nameGpu });
  await stageOf(page).hover({ position: { x: 20, y: 100 } });
  await isLive(page);
  const look = () => stageOf(page).screenshot(), before = await look();
  await page.locator(".answer").getByLabel("A drag turns").selectOption("light");
  await drag(page, 80);
  await page.waitForFunction(() => document.querySelector(".split figcaption").textContent.includes("maps"));
  assert.ok((compareShots([before, await look()])).share > 0.01);
  // Another filter is drawn with the same light.
  const shown = () => page.locator(".answer figure.split").innerText(), first = await shown();
  await page.locator(".answer form").getByLabel("Kernel").selectOption("medium");
  await page.locator(".picks button").first().click();
  await isLive(page);
  assert.notEqual(await shown(), first);
  await close();
}));

test("WhereFramesAreMissing_TheStillPicturesStay", () => withBrowser(kMesa, async (browser) => {
  const folder = folderOf("ball") + ".bare";
  cpSync(folderOf("ball"), folder, { recursive: true });
  rmSync(join(folder, "live"), { recursive: true });
  for (const init of [undefined, nameGpu]) {
    const { page, close } = await open(join(folder, "index.html"), { browser, init });
    const still = await stageOf(page).screenshot();
    await stageOf(page).hover({ position: { x: 20, y: 100 } });
    await page.waitForTimeout(500);
    assert.equal(await page.locator(".answer .split p.note").textContent(), "");
    await page.locator(".answer").getByRole("button", { name: "Live" }).click();
    await page.waitForFunction(() => document.querySelector(".answer .split p.note").textContent.includes("not beside this page"));
    assert.ok((compareShots([still, await stageOf(page).screenshot()])).mean < 0.001);
    await close();
  }
}));

test("TheRightPicture_BeginsAtTheLine_WhereAPartIsShown", () => withBrowser(kMesa, async (browser) => {
  const file = changePage("ball", "part.html", ({ cells }) => { for (const cell of cells) cell.part = [100, 40, 120, 67.5]; });
  const { page, close } = await open(file, { browser });
  await page.locator(".answer").getByRole("button", { name: "Live" }).click();
  await isLive(page);
  for (const split of [20, 50, 90]) {
    await page.locator(".stage input").fill(`${split}`);
    const seen = await stageOf(page).evaluate((stage, at) => {
      const { left, top, width, height } = stage.getBoundingClientRect();
      const layersAt = (share) => document.elementsFromPoint(left + share * width, top + height / 2);
      return [at - 2, at + 2].map((percent) => layersAt(percent / 100).filter(({ tagName }) => /IMG|CANVAS/.test(tagName)).length);
    }, split);
    assert.deepEqual(seen, [2, 4], `at ${split} %`);
  }
  await close();
}));
