// What the section Live shows is in the page's address, and a command measures it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { compareShots, makeFolder, measure, openLive } from "./live_support.mjs";
import { dragOver, kNarrow, linkOf, measureOverflow, pageOf, pick, reopen, settle, splitWords, testPage } from "./support.mjs";

const canvasOf = (page) => page.locator(".live-stage canvas");
const settled = async (page) => {
  await settle(page);
  await page.evaluate(() => document.querySelector(".live-stage").scrollIntoView({ block: "center" }));
  return (await canvasOf(page).screenshot()).toString("base64");
};
const drag = async (page, ...way) => {
  await canvasOf(page).scrollIntoViewIfNeeded();
  await dragOver(canvasOf(page), [150, 100], way);
};
const commandOf = async (page) => {
  await page.waitForFunction(() => document.querySelector(".live code")?.textContent.startsWith("shadowbench run "));
  return page.locator(".live code").textContent();
};
const setParameter = async (page, name, value) => {
  const slider = page.locator(".live").getByLabel(name);
  return slider.evaluate((input, wanted) => {
    input.value = wanted;
    input.dispatchEvent(new Event("input"));
    return Number(Number(input.value).toPrecision(6));
  }, value);
};

testPage("ALink_HoldsAllThatIsSeen", () => openLive(pageOf("several")), async ({ page, data }) => {
  const titles = data.places.map(({ title }) => title);
  await pick(page, "Scene", { label: titles[1] }, ".live");
  await pick(page, "Left", { label: "none" }, ".live");
  await pick(page, "Right", { label: "tent3x3" }, ".live");
  const plain = await settled(page);
  await pick(page, "Right", { label: (await page.locator(".live select").nth(2).locator("option").allTextContents()).find((text) => text.startsWith("vsm")) }, ".live");
  const value = await setParameter(page, "bleed_reduction", 0.9);
  await drag(page, 60, 10);
  await pick(page, "A drag turns", "light", ".live");
  await drag(page, -70, 20);
  await page.locator(".live-stage input").fill("30");
  const seen = await settled(page);
  assert.notEqual(seen, plain);
  const hash = await linkOf(page);
  assert.match(hash, /live=/);
  await reopen(page);
  await page.waitForSelector(".live-stage canvas");
  assert.equal(await settled(page), seen, "reloaded");

  const again = await openLive(pageOf("several"), { hash });
  assert.equal(await settled(again.page), seen, "opened");
  assert.equal(Number(await again.page.locator(".live").getByLabel("bleed_reduction").inputValue()), value);
  assert.equal(await again.page.locator(".live-stage input").inputValue(), "30");
  await again.page.locator(".live").getByRole("button", { name: "As it was" }).click();
  assert.notEqual(await settled(again.page), seen);
  await again.close();

  // A link of another run, and links that nobody could have made.
  for (const bad of [hash, "#live=cubes,nobody,nobody,x,1e9,,2,3,right:radius:2", "#live=cubes,none,none,0.5,0,0,0,0,left:constructor:1,left:radius:1e99,left", "#live="]) {
    const other = await openLive(pageOf("untrue"), { hash: bad });
    await settled(other.page);
    assert.deepEqual(other.messages, [], bad);
    await other.close();
  }
});

for (const [run, filter, name, wanted] of [["ball", "vsm", "bleed_reduction", 0.7], ["odd", "nine_compares", "weight", 0.5]])
  testPage(`TheCommand_MeasuresWhatIsSeen: ${run}`, () => openLive(pageOf(run), { viewport: kNarrow }), async ({ page, data }, context) => {
    const folder = makeFolder(context);
    const labels = await page.locator(".live select").nth(2).locator("option").allTextContents();
    await pick(page, "Right", { label: labels.find((label) => label === filter || data.configurations.find((each) => each.label === label)?.filter === filter) }, ".live");
    const value = await setParameter(page, name, wanted);
    assert.notEqual(value, undefined);
    const before = splitWords(await commandOf(page)), [beforeKey] = await page.evaluate(() => [...document.querySelectorAll(".live select")].map(({ value }) => Number(value))).then(([place, , right]) => data.cells.filter((each) => each.place === place && each.configuration === right).map(({ key }) => key));
    assert.ok(!before.includes("--light"));
    await pick(page, "A drag turns", "light", ".live");
    await drag(page, 50, 15);
    await page.waitForFunction(() => document.querySelector(".live code").textContent.includes("--light"));
    assert.doesNotMatch(await page.locator(".live").textContent(), /not the turned one/);
    const words = splitWords(await commandOf(page));
    const out = join(folder, run), cells = measure(words, out, pageOf(run, "..")), [cell] = cells;
    assert.equal(cells.length, 1);
    const sky = words[words.indexOf("--light") + 1], configuration = data.configurations.find((each) => each.filter === filter);
    assert.deepEqual([cell.filter, cell.params[name], cell.light, cell.map_size, cell.size.width, cell.size.height], [filter, value, sky, configuration.map, ...configuration.size]);
    // The program's picture is the one that is seen: its sun stands there, and its map has the same window.
    await page.locator(".live-stage input").fill("0");
    await settled(page);
    const shown = await canvasOf(page).evaluate((canvas) => canvas.toDataURL().split(",")[1]), drawn = readFileSync(join(out, cell.images.picture));
    const gap = compareShots([Buffer.from(shown, "base64"), drawn], 24), moved = compareShots([readFileSync(pageOf(run, decodeURI(data.cells.find(({ key }) => key === beforeKey).picture))), drawn], 24);
    context.diagnostic(`${run}: ${gap.share} of the values differ from the program's, and ${moved.share} from those of the run's own sun`);
    const isModel = run === "odd"; // its camera and floor follow the light
    assert.equal((await page.locator(".live .unsaid").textContent()).includes("follow its light"), isModel);
    assert.ok(isModel || (gap.share < 0.002 && gap.share < moved.share / 4), JSON.stringify([gap, moved]));
    // The scene as it was, with the run's own parameters, is the run's own cell.
    await page.locator(".live").getByRole("button", { name: "As it was" }).click();
    await page.waitForFunction(() => !document.querySelector(".live code").textContent.includes("--light"));
    const plain = splitWords(await commandOf(page)), same = join(folder, run + " same");
    const [{ key }] = measure(plain, same, pageOf(run, "..")), place = await page.locator(".live select").first().inputValue();
    assert.equal(data.cells.find((each) => each.key === key)?.place, Number(place));
    // A camera cannot be given.
    await pick(page, "A drag turns", "camera", ".live");
    await drag(page, 50, 0);
    await page.waitForFunction(() => document.querySelector(".live").textContent.includes("not the turned one"));
    assert.ok((await measureOverflow(page)) <= 0);
  });

testPage("ASliderOfManyDecades_GoesBackToTheRunsOwnValue_AndAWeightIsListed", () => openLive(pageOf("ball"), { viewport: kNarrow }), async ({ page, data }) => {
  await pick(page, "Right", { label: data.configurations.find(({ filter }) => filter === "vsm").label }, ".live");
  const slider = page.locator(".live").getByLabel("min_variance"), own = await slider.inputValue(), before = (await commandOf(page)).replace("1e-05", "0.00001");
  await slider.fill("1");
  assert.match(await commandOf(page), /min_variance=0\.1\b/);
  await slider.fill(own);
  assert.equal(await commandOf(page), before);
  await slider.fill("0");
  assert.match(await commandOf(page), /min_variance=0\b(?!\.)/);
  // What the run made weights of cannot be moved here, and is listed.
  assert.match(await page.locator(".live").textContent(), /weights: radius \d+/);
});
