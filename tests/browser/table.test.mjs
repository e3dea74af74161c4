// The table of a run's page holds what results.json holds, sorts, filters and marks.
import assert from "node:assert/strict";
import { changePage, kNarrow, open, openRun, readResults, testPage } from "./support.mjs";

const readHead = (page) => page.locator(".numbers thead th").allTextContents();
const readRows = (page) => page.locator(".numbers tbody tr").evaluateAll((rows) => rows.map((row) => [...row.children].map((cell) => ({
  text: [...cell.childNodes].filter((node) => !node.classList?.contains("mark")).map((node) => node.textContent).join(""),
  mark: [...cell.querySelectorAll(".mark")].map((mark) => mark.textContent.trim()).join(""),
}))));
const kUnits = { "%": 0.01, B: 1, KiB: 1024, MiB: 1024 ** 2, GiB: 1024 ** 3 };
const readNumber = (text) => {
  const [number, unit] = text.replaceAll(",", "").split(" ");
  return number === "\u2013" ? null : Number(number) * (unit ? kUnits[unit] : 1);
};
const show = (page, measure) => page.locator('.numbers select[name="measure"]').selectOption(measure);
const isNear = (shown, value) => (value === null ? shown === null : shown !== null && Math.abs(shown - value) <= 0.0051 * Math.abs(value));

// A value of results.json: the page's times are medians of what a frame takes.
const readValue = (cell, id) => {
  const path = { "time_ms.moving": "time_ms.moving.median", "time_ms.static": "time_ms.static.median" }[id] ?? id;
  return path.split(".").reduce((value, name) => value?.[name] ?? null, cell);
};

for (const run of ["several", "odd", "untrue", "single"]) {
  testPage(`EveryCellOfEveryMeasure_EqualsTheResults: ${run}`, () => openRun(run), async ({ page, data }) => {
    const cells = new Map(readResults(run).cells.map((cell) => [cell.key, cell])), labels = data.configurations.map(({ label }) => label);
    const shown = await page.locator('.numbers select[name="measure"] option').evaluateAll((all) => all.map(({ value }) => value));
    assert.deepEqual(shown, data.measures.map(({ id }) => id).filter((id) => [...cells.values()].some((cell) => readValue(cell, id) !== null)));
    for (const measure of shown) {
      await show(page, measure);
      const rows = await readRows(page), head = await readHead(page), first = head.length - 1 - data.places.length;
      assert.deepEqual(rows.map(([name]) => name.text).sort(), [...labels].sort());
      for (const row of rows) {
        const configuration = labels.indexOf(row[0].text), mine = data.cells.filter((cell) => cell.configuration === configuration);
        assert.equal(mine.length, data.places.length);
        for (const { place, key, status } of mine) {
          const cell = cells.get(key), { text, mark } = row[first + place];
          assert.ok(isNear(readNumber(text), readValue(cell, measure)), `${measure} of ${row[0].text}: ${text}, not ${readValue(cell, measure)}`);
          assert.equal(mark.includes("!"), cell.status !== "ok", status);
        }
        const { field } = data.costs.find(({ id }) => id === data.cost), costs = mine.map(({ key }) => readValue(cells.get(key), field));
        const mean = costs.includes(null) ? null : costs.reduce((sum, cost) => sum + cost, 0) / costs.length;
        assert.ok(isNear(readNumber(row[first - 1].text), mean === null ? null : mean * (head[first - 1].includes("µs") ? 1000 : 1)), `the mean cost: ${row[first - 1].text}, not ${mean}`);
      }
    }
  });
}

// A value far below 0 is the least, and not the best; of two equal ones both are the best; what is for teaching is none.
const makeOddRanks = (data) => {
  for (const cell of data.cells.slice(6, 10)) cell.values_of["error.mean"] = -0.9;
  for (const cell of data.cells) if (cell.place === 0) cell.values_of["error.flip"] = Number(cell.values_of["error.flip"].toFixed(2));
  data.configurations[0].teaching = true;
};
testPage("BestAndTies_AreThoseOfTheColumn_WhateverIsShown", () => open(changePage("several", makeOddRanks)), async ({ page, data }) => {
  const seen = new Set();
  for (const [measure, rank] of [["error.rmse", (value) => value], ["error.mean", Math.abs], ["error.flip", (value) => value], ["time_ms.moving", (value) => value]]) {
    await show(page, measure);
    const wanted = new Map();
    for (const cell of data.cells) {
      const of = (each) => rank(each.values_of[measure]), own = data.configurations[cell.configuration];
      const isRival = (each) => {
        const other = data.configurations[each.configuration];
        return each.place === cell.place && each.status === "ok" && !other.teaching;
      };
      const group = data.cells.filter(isRival), best = Math.min(...group.map(of)), first = group.find((each) => of(each) === best);
      const reach = measure === "error.rmse" ? Math.max(cell.rmse.reach, first?.rmse?.reach) : 0;
      const isTied = measure.startsWith("time") ? () => cell.intervals[measure][0] <= first.intervals[measure][1] : () => of(cell) - best <= reach;
      const mark = !group.includes(cell) || group.length < 2 ? "" : of(cell) === best ? "best" : isTied() ? "\u2248" : "";
      wanted.set(`${own.label} ${cell.place}`, mark);
      seen.add(`${measure.split(".")[0]} ${mark}`);
    }
    const compare = async () => {
      for (const [name, , , ...rest] of await readRows(page))
        data.places.forEach((_, place) => assert.equal(rest[place].mark, wanted.get(`${name.text} ${place}`), `${measure} of ${name.text} on ${place}`));
    };
    await compare();
    for (const text of ["box4x4", "none", "vsm"]) {
      await page.locator('.numbers input[type="search"]').fill(text);
      await compare();
    }
    await page.locator('.numbers input[type="search"]').fill("");
  }
  assert.ok(seen.has("error best") && seen.has("error ") && seen.has("time_ms best"), [...seen].join());
});

testPage("TheWorstOfTheScenes_IsFarthestFromWhatIsBest", () => openRun("several"), async ({ page }) => {
  for (const [measure, rank] of [["error.rmse", (value) => value], ["error.mean", Math.abs]]) {
    await show(page, measure);
    for (const row of await readRows(page)) {
      const values = row.slice(3).map(({ text }) => readNumber(text)), worst = values.pop();
      assert.equal(rank(worst), Math.max(...values.map(rank)), `${measure} of ${row[0].text}`);
    }
  }
});

const makeGap = (data) => { data.cells[2].values_of["error.rmse"] = null; };
testPage("EveryHead_SortsUpAndDown_WithWhatIsMissingLast", () => open(changePage("several", makeGap)), async ({ page, data }) => {
  const count = (await readHead(page)).length;
  const kept = (await readRows(page)).map(([name]) => name.text), key = page.locator(".numbers > .note"), usual = await key.textContent();
  for (let column = 0; column < count; ++column) {
    const head = page.locator(".numbers thead th").nth(column), isSorted = (await head.getAttribute("aria-sort")) !== "none";
    for (const direction of isSorted ? ["descending", "ascending"] : ["ascending", "descending"]) {
      await head.getByRole("button").click();
      assert.equal(await head.getAttribute("aria-sort"), direction);
      assert.equal(await page.locator('.numbers th:not([aria-sort="none"])[scope="col"]').count(), 1);
      const texts = (await readRows(page)).map((row) => row[column].text);
      const sigma = (row) => data.configurations.find(({ label }) => label === row[0].text).sigma;
      const sorted = column === 0 ? texts : column === 1 ? (await readRows(page)).map(sigma) : texts.map(readNumber), missing = sorted.filter((value) => value === null).length;
      assert.ok(sorted.slice(sorted.length - missing).every((value) => value === null), "what is missing comes last");
      const present = sorted.slice(0, sorted.length - missing);
      const order = column === 0 ? (a, b) => a.localeCompare(b) : (a, b) => a - b;
      assert.deepEqual(present, [...present].sort((a, b) => (direction === "ascending" ? 1 : -1) * order(a, b)));
      assert.equal(await page.evaluate(() => document.activeElement.closest("th")?.cellIndex), column, "the focus stays on the head");
      assert.match(await key.textContent(), /^(?!≈).*: /, "the focus says what the column is");
      await page.evaluate(() => document.activeElement.blur());
      assert.equal(await key.textContent(), usual, "then the key is back");
    }
  }
  assert.deepEqual((await readRows(page)).map(([name]) => name.text).sort(), kept.sort());
});

testPage("NameParameterAndClass_Filter", () => openRun("several"), async ({ page, data }) => {
  const search = page.locator('.numbers input[type="search"]'), width = page.locator('.numbers select[name="width"]');
  const names = async () => (await readRows(page)).map(([name]) => name.text).sort();
  const expect = (test) => data.configurations.filter(test).map(({ label }) => label).sort();
  await search.fill("VSM");
  assert.deepEqual(await names(), expect(({ filter }) => filter === "vsm"));
  await search.fill("radius=1");
  assert.deepEqual(await names(), expect(({ label, params }) => `${label} ${params}`.includes("radius=1")));
  await search.fill("[(*<b>");
  assert.deepEqual(await names(), []);
  await search.fill("");
  for (const name of data.classes) {
    await width.selectOption(name);
    assert.deepEqual(await names(), expect((each) => each.class === name));
  }
  await width.selectOption("");
  assert.equal((await names()).length, data.configurations.length);
});

testPage("ACell_OpensTheViewer", () => openRun("several"), async ({ page, data }) => {
  const row = page.locator(".numbers tbody tr").filter({ hasText: "box4x4" });
  await row.locator("td button").nth(1).click();
  const pattern = `#view=${data.places[1].title},truth,box4x4,`;
  await page.waitForFunction((start) => decodeURIComponent(location.hash).startsWith(start), pattern);
});

testPage("ACostChosenOnTop_IsThatOfAnswerTableAndChart_AndSaysWhatItIsOf", () => openRun("several"), async ({ page, data }) => {
  const front = await page.evaluate(() => JSON.parse(document.getElementById("charts").textContent).charts.find(({ id }) => id === "front"));
  const chart = page.locator("#front select").nth(2), { costs } = front.selectors[2];
  const readChosen = async () => costs[Number(await chart.inputValue())];
  assert.equal(data.cost, "gpu.navi21.moving", "without a GPU here, an estimate comes first");
  assert.equal(await readChosen(), data.cost, "the chart begins with the answer's cost");
  assert.deepEqual(data.costs.slice(0, 2).map(({ id }) => id), ["gpu.navi21.moving", "gpu.navi21.static"]);
  for (const light of ["moving", "static"]) assert.ok(data.costs.find(({ id }) => id === light).title.startsWith(`${light} light, this CPU`));
  for (const { id, title, unit, text, field } of data.costs) {
    await page.locator('.limits select[name="cost"]').selectOption(id);
    assert.equal(await readChosen(), id);
    assert.match(text, /^ms of a (1920x1080|240x135) frame with one map, .*left out: /);
    assert.ok((await page.locator(".reasons .note").allTextContents()).includes(`Cost: ${text}.`));
    const shownUnit = unit === "ms" && data.configurations.every((each) => !(each[field] >= 1)) ? "µs" : unit;
    assert.equal((await readHead(page))[2].replace(/ [▲▼]$/, ""), `${title}, ${shownUnit}`);
    const [label, cost] = await page.locator(".picks tbody td").first().evaluate((cell) => [cell.querySelector("bdi").textContent, cell.querySelector("b.cost").textContent]);
    const rows = await readRows(page), row = rows.find(([name]) => name.text === label);
    assert.equal(`${row[2].text} ${shownUnit}`, cost, "the number of the answer is that of the table");
    for (const [name, , shown] of rows) {
      const mean = data.configurations.find((each) => each.label === name.text)[field];
      assert.ok(isNear(readNumber(shown.text), mean === null ? null : mean * (shownUnit === unit ? 1 : 1000)), `${id} of ${name.text}`);
    }
  }
});

const giveLongName = (data) => { data.configurations[0].label = "a_filter_of_a_long_name (parameter 12, another 0.5), map 512 x 512"; };
testPage("OnAPhone_NamesStay_ANumberIsSeenBesideThem_AndTheCaptionIsWhole", () => open(changePage("several", giveLongName), { viewport: kNarrow }), async ({ page }) => {
  const find = () => page.locator(".numbers .scroll").evaluate((scroll) => {
    const edges = (node) => { const { left, right } = node.getBoundingClientRect(); return { left, right }; };
    const rows = [...scroll.querySelectorAll("tbody tr")].map((row) => [...row.children].map(edges));
    return { box: edges(scroll), caption: edges(scroll.querySelector("caption")), rows, moves: scroll.scrollWidth - scroll.clientWidth };
  });
  const { moves, ...before } = await find();
  assert.ok(moves > 0, "the table is wider than the phone");
  for (const [name, , cost, first] of before.rows) {
    assert.ok(name.right - name.left > 90, "a name keeps room for a word");
    assert.ok(name.right <= cost.left && cost.right <= first.left && first.right <= before.box.right, "two numbers are seen at once");
  }
  await page.locator(".numbers .scroll").evaluate((scroll) => { scroll.scrollLeft = 1e4; });
  const after = await find();
  for (const { box, caption, rows } of [before, after]) {
    assert.ok(Math.abs(caption.left - box.left) < 1 && caption.right <= box.right + 1, "the caption is whole");
    for (const [name] of rows) assert.ok(Math.abs(name.left - box.left) < 1, "the name stays");
  }
  assert.ok(after.rows.every((row) => row[0].right <= row.at(-1).left && row.at(-1).right <= after.box.right + 1), "the last column can be seen");
});
