// The answer on top of a run's page is that of the program.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { isDeepStrictEqual } from "node:util";
import { changePage, folderOf, linkOf, open, openRun, readResults, runProgram, splitWords, testPage } from "./support.mjs";

// Parameters as a reader names them: what the light's width sets is "light".
const nameParams = ({ params, kernel }) => (kernel.by_light ? { ...params, [kernel.by_light]: "light" } : params);
// The configuration of a page that has the settings which the program names: with --class its label there may be shorter.
const findConfiguration = (run, data, { filter, params, map_size: map }) => {
  const cell = readResults(run).cells.find((each) => each.filter === filter && each.map_size === map && isDeepStrictEqual(nameParams(each), params));
  return data.cells.find(({ key }) => key === cell.key).configuration;
};

// Runs the command that the page shows, and compares what both say.
const runAdvice = (command, ...more) => {
  const [program, ...words] = command.split(" ");
  assert.equal(program, "shadowbench");
  const { status, stdout, stderr } = runProgram([...words, ...more, "--json"]);
  assert.ok(status === 0 || status === 1, `${command}: ${stderr}`);
  return { status, advice: JSON.parse(stdout) };
};
const readCommand = (page, i = 0) => page.locator(".reasons code").nth(i).textContent();
const compare = async ({ page, data }, run) => {
  const command = await readCommand(page), { status, advice } = runAdvice(command), headline = await page.locator(".choice").textContent();
  assert.equal(advice.fits, status === 0);
  const judged = await page.evaluate(() => {
    const { keeping, beaten, failing, unjudged, noGain } = shadowbench.answer.judge();
    return { keeping: keeping.length, beaten: beaten.length, failing: failing.length, unjudged: unjudged.length, noGain: noGain.length };
  });
  const indexOf = ({ settings }) => findConfiguration(run, data, settings), labelOf = (each) => data.configurations[indexOf(each)].label;
  const counts = { keeping: advice.keeping.length, beaten: advice.beaten.length, failing: advice.failing.length, unjudged: advice.not_judged.length, noGain: advice.no_better_than_none.length };
  assert.deepEqual(judged, counts, command);
  if (status === 1) {
    assert.match(headline, advice.failing.length > 0 ? /^Nothing keeps these limits/ : /^Nothing can be judged/, command);
    return status;
  }
  const rows = await page.locator(".picks tbody tr").all(), cells = await rows[0].locator("td").allTextContents();
  const named = { fast: [0], balanced: [1], best: [2], "fast and best": [0, 2] };
  const filled = cells.map((text) => text !== "–"), wanted = [false, false, false];
  for (const each of advice.picks) {
    for (const column of named[each.name]) {
      wanted[column] = true;
      assert.ok(cells[column].startsWith(labelOf(each)), `${command}: ${each.name}: ${cells[column]}`);
      const [, cost, unit] = /([-\d.e,]+) (ms|µs)/.exec(cells[column].slice(labelOf(each).length));
      assert.ok(Math.abs(Number(cost.replaceAll(",", "")) / (unit === "ms" ? 1 : 1000) - each.cost) <= 0.005 * Math.abs(each.cost), `${command}: ${cells[column]}, not ${each.cost}`);
    }
  }
  assert.deepEqual(filled, wanted, `${command}: ${cells}`);
  // The same sentence, but for what --class leaves out of names.
  if (!/--class/.test(command)) assert.ok(headline.replaceAll(/[\u2068\u2069]/g, "").startsWith(advice.choice), `${command}: ${headline}, not ${advice.choice}`);
  return status;
};
// Each scene's row is what the command says with --scene.
const compareScenes = async ({ page, data }, run) => {
  const command = await readCommand(page);
  for (const { scene, left_out: leftOut } of data.scopes.slice(1)) {
    const rows = page.locator(".picks tbody tr"), own = rows.filter({ has: page.locator("th", { hasText: scene }) });
    if (leftOut) continue;
    const row = (await own.count()) > 0 ? own : rows.first();  // what is answered as all scenes are has no row
    const { status, advice } = runAdvice(command, "--scene", scene), text = (await row.locator("td").allTextContents()).join(" ");
    if (status === 1) assert.match(text, /Nothing keeps these limits/);
    for (const each of advice.picks ?? []) assert.ok(text.includes(data.configurations[findConfiguration(run, data, each.settings)].label), `${command}, ${scene}: ${each.name} ${each.label}: ${text}`);
    if (status === 0) assert.equal(await row.locator("button").count(), advice.picks.reduce((sum, { name }) => sum + (name === "fast and best" ? 2 : 1), 0), text);
  }
};

// What is folded is unfolded: only what is seen can be moved.
const openAnswer = async (...words) => {
  const opened = await openRun(...words);
  await opened.page.locator(".reasons").evaluate((each) => { each.open = true; });
  return opened;
};
const listSliders = (page) => page.locator(".sliders input").evaluateAll((all) => all.map(({ name, max }) => ({ name, max: Number(max) })));
const move = (page, { name }, position) => page.locator(`.sliders input[name="${name}"]`).fill(String(position));
const choose = (page, name, value) => page.locator(`.limits select[name="${name}"]`).selectOption(value);

for (const run of ["several", "odd", "untrue", "single", "mixed"]) {
  testPage(`OnLoad_TheAnswerIsThatOfTheProgram: ${run}`, () => openRun(run), async (opened) => {
    await compare(opened, run);
    await compareScenes(opened, run);
  });
}

// tests/report/pages/picks_script.cpp asks the script what the program is asked, under limits; here they are moved.
testPage("SlidersAndChoices_MoveTheAnswerAsTheProgramDoes", () => openAnswer("several"), async (opened) => {
  const { page } = opened, exits = new Set(), sliders = await listSliders(page);
  assert.ok(sliders.length >= 5, String(sliders.length));
  for (const slider of sliders) {
    await move(page, slider, Math.floor(slider.max / 2));
    exits.add(await compare(opened, "several"));
    await move(page, slider, slider.max);
  }
  for (const [name, option] of [["cost", "static"], ["class", "medium"]]) {
    await choose(page, name, option);
    await compare(opened, "several");
    await compareScenes(opened, "several");
  }
  const soft = page.locator('.limits input[name="soft"]');
  if (await soft.isVisible()) {
    await soft.check();
    assert.match(await readCommand(page), /--requires contact-hardening/);
    await soft.uncheck();
  }
  for (const slider of await listSliders(page)) await move(page, slider, 0);
  exits.add(await compare(opened, "several"));
  for (const slider of await listSliders(page)) await move(page, slider, slider.max);
  const rmse = page.locator('.sliders input[name="error.rmse"]'), before = Number(await rmse.inputValue());
  await rmse.focus();
  await page.keyboard.press("ArrowLeft");
  assert.equal(Number(await rmse.inputValue()), before - 1, "a key moves the slider");
  assert.deepEqual([...exits].sort(), [0, 1], "some limits are kept and some are not");
});

const lowerLimit = ({ scopes }) => scopes.forEach(({ rows }) => { rows[0].worst["time_ms.static"].limit = -0.01; });
testPage("ALimitIsNeverBelowNought_ThoughATimeMayBe", () => open(changePage("several", lowerLimit)), async ({ page }) => {
  await page.locator(".reasons").evaluate((each) => { each.open = true; });
  await choose(page, "cost", "static");
  await move(page, { name: "time_ms" }, 0);
  assert.match(await readCommand(page), / --max-ms 0 /);
});

testPage("ThePicture_ShowsThePickAgainstTheTruth_AndOpensTheViewerThere", () => openRun("several"), async ({ page, data }) => {
  const stage = page.locator(".split .stage"), names = () => page.locator(".split figcaption bdi").allTextContents();
  const [first] = await page.evaluate(() => shadowbench.answer.picks());
  assert.deepEqual((await names())[0], "truth");
  assert.ok((await names())[1].startsWith(data.configurations[first.index].label));
  const { width } = await stage.boundingBox(), room = (await page.locator(".answer").boundingBox()).width;
  assert.ok(width > 0.95 * room, `${width} of ${room} px`);
  const shown = await stage.evaluate((box) => [...box.querySelectorAll("img")].map((image) => [image.naturalWidth, image.offsetWidth, image.offsetLeft, image.offsetTop, box.clientWidth, box.clientHeight]));
  assert.deepEqual(shown[0], shown[1], "both lie in one place");
  const title = (await names())[1].split(" on ")[1], place = data.places.findIndex((each) => each.title === title);
  const [natural, drawn, left, top, wide, high] = shown[1], scale = drawn / natural;
  const { left: x, top: y, width: across, height: down } = readResults("several").cells.find(({ key }) => key === data.cells.find((each) => each.configuration === first.index && each.place === place).key).images.hardest;
  const middle = [left + scale * (x + across / 2), top + scale * (y + down / 2)];
  assert.ok(middle[0] > 0 && middle[0] < wide && middle[1] > 0 && middle[1] < high, `the hardest tile is at ${middle} of ${wide} x ${high}`);
  const sources = () => stage.locator("img").evaluateAll((all) => all.map((image) => image.getAttribute("src")));
  const { images } = readResults("several").cells.find(({ key }) => key === data.cells.find((each) => each.configuration === first.index && each.place === place).key);
  assert.deepEqual(await sources(), [images.truth_supersampled, images.supersampled]);
  assert.equal(await page.locator(".split .note").textContent(), "16 samples a pixel; errors are of one.");
  const button = page.locator(".picks tbody tr").last().locator("button").last();
  await button.click();
  const chosen = await button.evaluate(({ dataset }) => [Number(dataset.index), Number(dataset.place)]);
  assert.deepEqual(await names(), ["truth", `${data.configurations[chosen[0]].label} on ${data.places[chosen[1]].title}`]);
  assert.equal(await page.locator('.picks [aria-pressed="true"]').count() > 0, true);
  await stage.locator("input").fill("20");
  assert.equal(await stage.evaluate((box) => getComputedStyle(box).getPropertyValue("--split")), "20%");
  assert.match(await readCommand(page, 1), new RegExp(`^shadowbench view ${data.places[chosen[1]].scene} --left truth --right ${data.configurations[chosen[0]].filter}`));
  await page.getByRole("button", { name: "Look closer" }).click();
  await page.waitForFunction((name) => document.querySelectorAll(".viewer figcaption")[1].textContent.includes(name), data.configurations[chosen[0]].label);
  assert.match(await linkOf(page), /view=/);
});

testPage("TheCommandForTheWindow_NamesSceneAndFilterAsTheyWereGiven", () => openAnswer("odd"), async ({ page, data }) => {
  const { scenes } = readResults("odd"), { configurations, places } = data;
  const write = async (index, place) => splitWords(await page.evaluate((pick) => shadowbench.answer.writeView(...pick), [index, place])).join("|");
  const [button] = await page.locator(".picks button").all();
  await button.click();
  const lines = [splitWords(await readCommand(page, 1)).join("|")];
  for (const place of places.keys()) lines.push(await write(0, place));
  assert.ok(existsSync(join(folderOf("odd"), "..", scenes[0].view_words[0])), "the scene was given as a file");
  const [odd, cubes] = scenes.map(({ view_words: words }) => `view|${words.join("|")}|`);
  assert.ok(odd.endsWith("|--ground|") && lines.some((line) => line.startsWith(odd)) && lines.some((line) => line.startsWith(cubes)), lines.join());
  const own = await write(configurations.findIndex(({ filter }) => filter === "nine_compares"), 0);
  assert.ok(own.includes("|--filter-file|nine_compares.glsl|--left|truth|--right|nine_compares"), own);
});

const forgetScenes = ({ places }) => places.forEach((place) => { place.view = []; });
const forgetFiles = ({ configurations, files }) => configurations.forEach(({ filter }) => { files[filter] = null; });
for (const forget of [forgetScenes, forgetFiles])
  testPage(`TheCommandForTheWindow_IsHiddenWhereItIsNotKnown: ${forget.name}`, () => open(changePage("odd", forget)), async ({ page }) => {
    await page.getByText("Why, limits and commands").click();
    assert.deepEqual(await page.locator(".reasons code").evaluateAll((all) => all.map((each) => each.checkVisibility())), [true, false]);
  });

testPage("Printed_TheAnswerHasItsThreeNames_AndNoForm", () => openRun("several"), async ({ page }) => {
  const names = await page.locator(".picks tbody tr").first().locator("bdi").allTextContents();
  assert.ok(names.length > 1, names.join());
  await page.emulateMedia({ media: "print" });
  const printed = await page.locator(".picks").innerText();
  for (const name of names) assert.ok(printed.includes(name), name);
  for (const form of await page.locator("form, .sliders").all()) assert.equal(await form.isVisible(), false);
});

testPage("ALink_OpensTheSameAnswerAndTable", () => openAnswer("several"), async ({ page }) => {
  await choose(page, "cost", "static");
  await choose(page, "class", "medium");
  await move(page, { name: "error.flip" }, 2);
  await page.locator(".picks button").last().click();
  await page.locator('.numbers select[name="measure"]').selectOption("error.mean");
  await page.locator('.numbers input[type="search"]').fill("3x");
  await page.locator(".numbers thead button").first().click();
  const read = (from) => from.evaluate(() => [".picks", ".reasons", ".numbers table", ".split figcaption"].map((name) => document.querySelector(name).textContent));
  const hash = await linkOf(page), wanted = await read(page), again = await openRun("several", { hash });
  assert.match(hash, /limits=.*shown=.*table=.*3x/);
  assert.match(wanted[1], /--max-flip .*--class medium --cheapest time --light-motion static/);
  assert.deepEqual(await read(again.page), wanted);
  assert.deepEqual(again.messages, []);
  // What the page does not have is left as it was.
  const bad = await openRun("several", { hash: "#limits=noon,vast,,error.rmse:x,nothing:1&shown=nobody,nowhere&table=none,none,none,none,&view" }), plain = await openRun("several");
  assert.deepEqual((await read(bad.page))[2], (await read(plain.page))[2]);
  assert.deepEqual(bad.messages, []);
  for (const each of [again, bad, plain]) await each.close();
});
