// The section that draws with WebGL 2, as its readers use it: timed, turned, taken away and on a phone.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { changeFrames, keepContexts, keepTime, kMsPerLetter, loadTimes, makeFolder, openDrawing, openLive, press, readTable } from "./live_support.mjs";
import { dragOver, folderOf, kNarrow, pageOf, pick, reopen, runProgram, settle, testPage } from "./support.mjs";

const chooseCost = (page, title) => page.locator("select[name=cost]").selectOption({ label: title });

testPage("Times_AreThoseOfTheGpu_AndItsTimesAreCosts", () => openLive(pageOf("odd"), { init: keepTime }), async ({ page, data }, context) => {
  const letters = {};  // more than its empty lookup has: in each scene the same
  changeFrames("odd", "letters", ({ programs }) => {
    const empty = programs.find(({ label }) => label === "empty lookup").fragment.length;
    programs.forEach(({ label, fragment }) => (letters[label] = fragment.length - empty));
  });
  await press(page, "Time on this GPU");
  for (const [filter, , , , time] of await readTable(page)) {
    const wanted = kMsPerLetter * letters[`${filter} lookup`];
    assert.ok(Math.abs(Number(time) / wanted - 1) < 0.01, `${filter}: ${time}, not ${wanted}`);
  }

  // What was timed is a cost of the answer and the table, can be saved, and is there when the page is opened again.
  await chooseCost(page, "static light, this GPU");
  const order = await page.evaluate(() => {
    const { keeping, beaten, noGain } = shadowbench.answer.judge();
    return [...keeping, ...beaten, ...noGain].sort((a, b) => a.rank - b.rank).map(({ index }) => index);
  });
  const labels = data.configurations.map(({ label }) => label);
  assert.deepEqual(order.map((index) => labels[index]), ["none", "nine_compares"]);
  assert.match(await page.locator(".answer code").first().textContent(), / --light-motion static/);
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(".live").getByRole("button", { name: "Save times" }).click()]);
  const saved = JSON.parse(readFileSync(await download.path(), "utf8"));
  assert.equal(Object.keys(saved.cells).length, 6);

  // The terminal says the same of the file that was saved.
  for (const motion of ["moving", "static"]) {
    await chooseCost(page, `${motion} light, this GPU`);
    const said = runProgram(["advise", folderOf("odd"), "--times", await download.path(), "--light-motion", motion, "--json"]);
    assert.ok(said.status === 0, said.stderr);
    const advice = JSON.parse(said.stdout), [first] = await page.locator(".picks tbody tr").first().locator("td").allTextContents();
    assert.equal(await page.evaluate(() => shadowbench.answer.judge().keeping.length), advice.keeping.length);
    assert.ok(first.startsWith(advice.picks[0].label), `${first}, not ${advice.picks[0].label}`);
    assert.ok(Math.abs(Number(/(-?\d[\d.e-]*) ms/.exec(first)[1]) / advice.picks[0].cost - 1) < 0.01, `${first}, not ${advice.picks[0].cost}`);
  }
  await reopen(page);
  await chooseCost(page, "moving light, this GPU");

  // Times of other machines, and files that are none.
  await page.locator("#live").evaluate((section) => section.scrollIntoView());
  await page.waitForSelector(".live canvas");
  const [again] = await Promise.all([page.waitForEvent("download"), page.locator(".live").getByRole("button", { name: "Save times" }).click()]);
  assert.deepEqual(JSON.parse(readFileSync(await again.path(), "utf8")), saved, "what the browser kept is saved");
  const folder = makeFolder(context), key = Object.keys(saved.cells)[0], spoil = (edit) => { const copy = structuredClone(saved); edit(copy); return JSON.stringify(copy); };
  const bad = ["{", spoil((file) => { file.schema = "another"; }), spoil((file) => { file.cells = { other: file.cells[key] }; }), spoil((file) => { file.cells[key].map.median = null; }), spoil((file) => { delete file.renderer; })];
  for (const [i, text] of bad.entries()) assert.match(await loadTimes(page, folder, `${i}.json`, text), /This is no gpu-times\.json that a page of this run saved/);
  assert.match(await loadTimes(page, folder, "f.json", spoil((file) => { file.renderer = "Another GPU"; })), /its times are among the costs/);
  await chooseCost(page, "moving light, Another GPU");
});

testPage("CameraAndSunAreTurned_AndAReferenceStandsInForTheTruth_WhichIsNearIt", () => openLive(pageOf("ball")), async ({ page, shoot }) => {
  const canvas = page.locator(".live canvas"), look = async () => (await canvas.screenshot()).toString("base64"), note = page.locator(".live p.note").nth(1);
  const turn = async () => {
    await dragOver(canvas, [300, 200], [80, 10]);
    await page.waitForFunction(() => document.querySelector(".live").textContent.includes("the mean of 256 maps"), null, { timeout: 60000 });
  };
  await pick(page, "Right", { label: "pcss" }, ".live");
  await settle(page);
  const before = await look();
  await turn();
  const turned = await look();
  await page.waitForFunction(() => /RMSE to the traced truth is 0\.\d+ under/.test(document.querySelector(".live").textContent), null, { timeout: 60000 });
  await shoot("live.turned");
  await pick(page, "A drag turns", "light", ".live");
  await turn();
  assert.ok(before !== turned && turned !== (await look()));
  await shoot("live.sun");
  await page.locator(".live").getByRole("button", { name: "As it was" }).click();
  await page.waitForFunction(() => !document.querySelector(".live").textContent.includes("No rays were traced"));
  await settle(page);
  assert.equal(await note.textContent(), "");
  assert.equal(await look(), before);

  // What is checked is what the run measured, whatever the sliders say.
  await pick(page, "Right", { label: "vsm" }, ".live");
  const parameter = page.locator(".live .controls input[type=range]").first();
  await parameter.fill(await parameter.getAttribute("max"));
  await press(page, "Check against the run");
  const said = await page.locator(".live .results").textContent(), rmse = Number(/The mean of 256 maps .* RMSE of ([\d.]+) to the traced truth/.exec(said)[1]);
  assert.ok(rmse > 0 && rmse < 0.01, said);
  for (const [filter, own] of await readTable(page)) assert.match(own, /^[\d.e-]+$/, filter);
});

testPage("Layers_AreVisibility_AndItsErrorAgainstTheTruth", () => openLive(pageOf("several")), async ({ page }, context) => {
  const slider = page.locator(".live-stage input");
  const look = async (layer, split) => {
    await pick(page, "Layer", layer, ".live");
    await slider.fill(`${split}`);
    await settle(page);
    return page.locator(".live-stage canvas").evaluate((canvas) => {
      const { width, height } = canvas, context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");
      context.drawImage(canvas, 0, 0);
      return [...context.getImageData(0, 0, width, height).data];
    });
  };
  await pick(page, "Right", { label: "box4x4" }, ".live");
  const [truth, filter, errors] = [await look("visibility", 100), await look("visibility", 0), await look("error", 0)];
  let marked = 0, wrong = 0;
  for (let i = 0; i < truth.length; i += 4) {
    assert.ok(truth[i] === truth[i + 1] && filter[i] === filter[i + 2], "visibility is grey");
    const gap = filter[i] - truth[i], warmth = errors[i] - errors[i + 2];
    if (Math.abs(gap) < 8) continue;
    ++marked;
    if (Math.sign(gap) !== Math.sign(warmth)) ++wrong;
  }
  context.diagnostic(`${marked} pixels have an error, ${wrong} of them another sign than their colour`);
  assert.ok(marked > 200 && wrong === 0);
  await look("error", 50);
  await reopen(page);
  await page.waitForSelector(".live-stage canvas");
  assert.equal(await page.locator(".live").getByRole("combobox", { name: "Layer" }).inputValue(), "error");
  await page.waitForFunction(() => document.querySelector(".live").textContent.includes("The colours end at errors of"));
  // Where the camera was turned both sides are held against one mean of maps, which is said once.
  await dragOver(page.locator(".live-stage canvas"), [60, 60], [30, 0]);
  await page.waitForFunction(() => document.querySelector(".live").textContent.includes("mean of 256 maps"), null, { timeout: 120000 });
  assert.equal((await page.locator(".live > p.note", { hasText: "mean of" }).textContent()).match(/No rays were traced there/g).length, 1);
});

testPage("AContextThatIsLost_IsSaid", () => openLive(pageOf("ball"), { init: keepContexts }), async ({ page }) => {
  await page.evaluate(() => window.contexts[0].getExtension("WEBGL_lose_context").loseContext());
  await page.waitForFunction(() => document.querySelector(".live").textContent.includes("the browser has taken the GPU away"));
  await page.locator(".live").getByRole("button", { name: "Check against the run" }).click();
  await settle(page);
  assert.match(await page.locator(".live [role=status]").textContent(), /Nothing is drawn now/, "also once a check has ended");
});

testPage("BeforeItIsReached_AStillAndASentenceAreThere_AndNotesAreWholeAfterwards", () => openDrawing(pageOf("several"), { viewport: { ...kNarrow, width: 700 } }), async ({ page }) => {
  const still = page.locator(".live img");
  assert.match(await page.locator(".live").textContent(), /once you scroll to this section/);
  assert.ok(await still.evaluate(async (image) => (await image.decode(), image.naturalWidth > 0)));
  await page.locator("#live").evaluate((section) => section.scrollIntoView());
  await page.waitForSelector(".live canvas");
  assert.equal(await still.count(), 0);
  await press(page, "Check against the run");
  for (const note of await page.locator(".live p.note, .live .unsaid").all())
    assert.ok(await note.evaluate((each) => each.scrollWidth <= each.clientWidth + 1 && each.getBoundingClientRect().right <= innerWidth), await note.textContent());
});
