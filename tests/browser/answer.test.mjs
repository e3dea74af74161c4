// The answer on top of a run's page is that of the program.
import assert from "node:assert/strict";
import { test } from "node:test";
import { isDeepStrictEqual } from "node:util";
import { folderOf, makeRandom, openRun, readData, readResults, runProgram } from "./support.mjs";

const kRandomPositions = 12;

// The configuration of a page that has the settings which the program names: with --class its label there may be shorter.
const findConfiguration = (run, data, { filter, params, map_size: map }) => {
  const cell = readResults(run).cells.find((each) => each.filter === filter && each.map_size === map && isDeepStrictEqual(each.params, params));
  return data.cells.find(({ key }) => key === cell.key).configuration;
};

// Runs the command that the page shows, and compares what both say.
const compare = async (page, run) => {
  const command = await page.locator(".answer > .note code").textContent(), [program, ...words] = command.split(" ");
  assert.equal(program, "shadowbench");
  const { status, stdout, stderr } = runProgram([...words.map((word) => (word === "RUN" ? folderOf(run) : word)), "--json"]);
  assert.ok(status === 0 || status === 1, `${command}: ${stderr}`);
  const advice = JSON.parse(stdout), headline = await page.locator(".choice").textContent();
  const reasons = (await page.locator(".answer .choice + ul li").allTextContents()).join("\n");
  assert.equal(advice.fits, status === 0);
  const judged = await page.evaluate(() => {
    const { keeping, failing, unjudged } = shadowbench.answer.judge();
    return { best: keeping[0]?.index, keeping: keeping.length, failing: failing.length, unjudged: unjudged.length };
  });
  const data = await readData(page), labelOf = ({ settings }) => data.configurations[findConfiguration(run, data, settings)].label;
  assert.deepEqual([judged.keeping, judged.failing, judged.unjudged], [advice.keep, advice.fail, advice.not_judged.length], command);
  assert.equal(/Not judged: /.test(reasons), judged.unjudged > 0, `${command}: ${reasons}`);
  if (status === 1) {
    assert.match(headline, /^Nothing keeps these limits/, command);
    if (advice.closest) assert.ok(reasons.includes(`Closest: ${labelOf(advice.closest)} breaks `), `${command}: ${advice.closest.label}: ${reasons}`);
    return status;
  }
  assert.equal(judged.best, findConfiguration(run, data, advice.advised.settings), command);
  assert.ok(headline.startsWith(labelOf(advice.advised)), `${command}: ${headline}`);
  const cost = advice.advised.cost.mean, [, shown] = /([-\d.e]+) (?:(?:ms \(CPU\)|× none) a frame|us estimated)/.exec(headline);
  assert.ok(Math.abs(shown - cost) <= 0.005 * Math.abs(cost), `${command}: ${headline}, not ${cost}`);
  if (advice.runner_up) assert.ok(reasons.includes(`Runner-up: ${labelOf(advice.runner_up)},`), `${command}: ${reasons}`);
  const { tied = false, basis } = advice.runner_up?.lost_by ?? {}, apart = basis === "none";
  assert.equal(reasons.includes("whose cost cannot be told from it"), tied && !apart, `${command}: ${reasons}`);
  assert.equal(reasons.includes("whose ratio is to another 'none'"), apart, `${command}: ${reasons}`);
  if (!advice.runner_up) assert.ok(reasons.includes("no other keeps the limits"), command);
  return status;
};

const listSliders = (page) => page.locator(".sliders input").evaluateAll((all) => all.map(({ name, max }) => ({ name, max: Number(max) })));
const move = (page, { name }, position) => page.locator(`.sliders input[name="${name}"]`).fill(String(position));
const choose = (page, name, value) => page.locator(`.limits select[name="${name}"]`).selectOption(value);
const listOptions = (page, name) => page.locator(`.limits select[name="${name}"] option`).evaluateAll((all) => all.map(({ value }) => value));

for (const run of ["several", "odd", "untrue", "single", "mixed"]) {
  test(`OnLoad_TheAnswerIsThatOfTheProgram: ${run}`, async () => {
    const { page, messages, close } = await openRun(run);
    await compare(page, run);
    assert.deepEqual(messages, []);
    await close();
  });
}

for (const run of ["several", "mixed"]) {
  test(`EverySliderAndChoice_MovesTheAnswerAsTheProgramDoes: ${run}`, async () => {
    const { page, messages, close } = await openRun(run);
    const exits = new Set(), sliders = await listSliders(page);
    assert.ok(sliders.length >= 5, String(sliders.length));
    for (const slider of sliders) {
      for (const position of [0, Math.floor(slider.max / 2)]) {
        await move(page, slider, position);
        exits.add(await compare(page, run));
      }
      await move(page, slider, slider.max);
    }
    for (const name of ["cost", "class"]) {
      for (const option of (await listOptions(page, name)).reverse()) {
        await choose(page, name, option);
        exits.add(await compare(page, run));
      }
    }
    for (const slider of await listSliders(page)) await move(page, slider, 0);
    exits.add(await compare(page, run));
    for (const slider of await listSliders(page)) await move(page, slider, slider.max);
    const rmse = page.locator('.sliders input[name="error.rmse"]'), before = Number(await rmse.inputValue());
    await rmse.focus();
    await page.keyboard.press("ArrowLeft");
    assert.equal(Number(await rmse.inputValue()), before - 1, "a key moves the slider");
    await compare(page, run);
    assert.deepEqual([...exits].sort(), [0, 1], "some limits are kept and some are not");
    assert.deepEqual(messages, []);
    await close();
  });
}

test("AtRandomPositions_TheAnswerIsThatOfTheProgram", async () => {
  const { page, messages, close } = await openRun("several"), random = makeRandom(7);
  const exits = [0, 0], pick = (list) => list[Math.floor(random() * list.length)];
  for (let i = 0; i < kRandomPositions; ++i) {
    await choose(page, "cost", pick(await listOptions(page, "cost")));
    await choose(page, "class", pick(await listOptions(page, "class")));
    // Every other slider sets no limit: else nothing would ever be left.
    for (const slider of await listSliders(page)) await move(page, slider, random() < 0.5 ? slider.max : Math.round(slider.max * random()));
    ++exits[await compare(page, "several")];
  }
  assert.ok(exits[0] > 2 && exits[1] > 2, `kept and not kept: ${exits}`);
  assert.deepEqual(messages, []);
  await close();
});

test("LookCloser_OpensTheViewerAtTheWorstPlace", async () => {
  const { page, messages, close } = await openRun("several");
  await page.waitForSelector(".worst canvas");
  assert.equal(await page.locator(".worst canvas").count(), 2);
  const label = await page.locator(".worst figcaption").nth(1).textContent();
  await page.getByRole("button", { name: "Look closer" }).click();
  await page.waitForFunction((name) => document.querySelectorAll(".viewer figcaption")[1].textContent.includes(name), label);
  await page.waitForFunction(() => location.hash.startsWith("#view="));
  assert.ok(Number(new URL(page.url()).hash.split(",")[7]) > 2, "the view is at the place");
  assert.deepEqual(messages, []);
  await close();
});

test("ALink_OpensTheSameAnswerAndTable", async () => {
  const { page, close } = await openRun("several");
  await choose(page, "cost", "static");
  await choose(page, "class", "medium");
  await move(page, { name: "error.flip" }, 2);
  await page.locator('.numbers select[name="measure"]').selectOption("error.mean");
  await page.locator('.numbers input[type="search"]').fill("3x");
  await page.locator(".numbers thead button").first().click();
  const read = (from) => from.evaluate(() => [".choice", ".answer code", ".numbers table", ".sliders"].map((name) => document.querySelector(name).textContent));
  await page.waitForFunction(() => /limits=.*table=.*3x/.test(location.hash));
  const hash = new URL(page.url()).hash, wanted = await read(page), again = await openRun("several", { hash });
  assert.match(wanted[1], /--max-flip .*--class medium --light-motion static/);
  assert.deepEqual(await read(again.page), wanted);
  assert.deepEqual(again.messages, []);
  // What the page does not have is left as it was.
  const bad = await openRun("several", { hash: "#limits=noon,vast,error.rmse:x,nothing:1&table=none,none,none,none,&view" }), plain = await openRun("several");
  assert.deepEqual((await read(bad.page))[2], (await read(plain.page))[2]);
  assert.deepEqual(bad.messages, []);
  for (const each of [{ close }, again, bad, plain]) await each.close();
});
