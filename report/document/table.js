// The table of a run: configurations by scenes, of the measure that the reader chooses.
const startTable = (holder) => {
  const kShades = 5;
  const kMany = 25;
  const kWorst = { more: "the least value", zero: "the value farthest from 0" };
  const kMarks = {
    best: ["best ", "the best of its column"],
    tied: ["≈ ", "statistically tied with the best of its column"],
  };
  const state = { measure: "error.rmse", sort: "cost", down: false, text: "", wide: "" };
  const measures = run.measures.filter(({ id }) => run.cells.some((cell) => cell.values_of[id] !== null));
  if (measures.length > 0 && !measures.some(({ id }) => id === state.measure)) state.measure = measures[0].id;
  const kNone = { title: "nothing was measured", text: "", unit: "" };
  const measureOf = () => measures.find(({ id }) => id === state.measure) ?? kNone;
  const valueOf = (index, place) => cellAt(index, place)?.values_of[state.measure] ?? null;
  // The smaller, the better; of a measure that is neither good nor bad, the value itself.
  const rankOf = (value) => ({ more: -value, zero: Math.abs(value) })[measureOf().better] ?? value;
  const worstOf = (index) => {
    const values = run.places.map((_, place) => valueOf(index, place)).filter((value) => value !== null);
    return values.length > 0 ? values.reduce((worst, value) => (rankOf(value) > rankOf(worst) ? value : worst)) : null;
  };
  const timeOf = () => costChoice().field;

  // Texts stand at the left, and numbers, which have a unit, at the right.
  const listColumns = () => {
    const { title, text, unit, better } = measureOf();
    const of = (name) => (index) => run.configurations[index][name];
    const filter = "a filter, with the parameters and settings that tell it from the others";
    const width = "class of the kernel's standard deviation: fronts are found within one class";
    const cost = run.measures.find(({ id }) => id === timeOf()).text;
    const scale = costScale();
    const costOf = (index) => (of(timeOf())(index) === null ? null : of(timeOf())(index) * scale.factor);
    const places = run.places.map((place, at) => ({
      id: `place${at}`,
      title: place.title,
      text: `${title} on ${place.title}: ${text}`,
      of: (index) => valueOf(index, at),
      unit,
      place: at,
    }));
    return [
      { id: "filter", title: "filter", text: filter, of: of("label") },
      { id: "class", title: "width", text: width, of: (index) => of("class")(index) || "–", key: of("sigma") },
      { id: "cost", title: `${costChoice().title}, ${scale.unit}`, text: cost, of: costOf, unit: "" },
      ...places,
      {
        id: "worst",
        title: "worst",
        text: `${kWorst[better] ?? "the largest value"} over the scenes`,
        of: worstOf,
        unit,
      },
    ];
  };
  const areTied = (cell, best) => {
    const [own, least] = [cell, best].map(({ intervals }) => intervals[state.measure]);
    if (own && least) return own[0] <= least[1];
    return state.measure === "error.rmse" && areErrorsTied(cell.rmse, best.rmse);
  };
  // In a column of two values or more: the best, and what is tied with it, whether or not their rows are shown.
  const findMarks = ({ place, of }) => {
    const marks = new Map();
    if (place === undefined || measureOf().better === "neither") return marks;
    const isJudged = (i) => !run.configurations[i].teaching && cellAt(i, place)?.status === "ok" && of(i) !== null;
    const judged = [...run.configurations.keys()].filter(isJudged);
    if (judged.length < 2) return marks;
    const rank = (i) => rankOf(of(i));
    const best = judged.reduce((least, i) => (rank(i) < rank(least) ? i : least));
    for (const i of judged) {
      if (rank(i) === rank(best)) marks.set(i, kMarks.best);
      else if (areTied(cellAt(i, place), cellAt(best, place))) marks.set(i, kMarks.tied);
    }
    return marks;
  };
  const listRows = (columns) => {
    const isWanted = (i) => {
      const { label, params, class: width } = run.configurations[i];
      const isFound = `${label} ${params}`.toLowerCase().includes(state.text.toLowerCase());
      return isFound && (!state.wide || width === state.wide);
    };
    const { key, of } = columns.find(({ id }) => id === state.sort) ?? columns[0];
    const order = (a, b) => {
      const [x, y] = [a, b].map(key ?? of);
      if (x === null || y === null) return (x === null) - (y === null);
      return (state.down ? -1 : 1) * (typeof x === "string" ? x.localeCompare(y) : x - y);
    };
    return [...run.configurations.keys()].filter(isWanted).sort(order);
  };

  holder.replaceChildren();
  const controls = element(holder, "div", { className: "controls" });
  const region = { className: "scroll", tabIndex: 0, role: "region", "aria-label": "All numbers" };
  const scroll = element(holder, "div", region);
  const note = element(holder, "p", { className: "note" });
  let key = "";
  const shown = measures.map(({ id, title }) => [id, title]);
  const chooser = addSelect(controls, "Show", shown, { name: "measure" }, (measure) => change({ measure }));
  const field = { type: "search", name: "filter", placeholder: "name or parameter" };
  const search = element(element(controls, "label", {}, "Filter "), "input", field);
  const classes = [["", "any"], ...run.classes.map((name) => [name, name])];
  const wide = addSelect(controls, "Width", classes, { name: "width" }, (value) => change({ wide: value }));

  const isMixed = run.classes.length > 1;
  wide.parentNode.hidden = !isMixed;

  const addHead = (row, { id, title, text, unit }, at) => {
    const sorted = state.sort === id;
    const [direction, arrow] = state.down ? ["descending", " ▼"] : ["ascending", " ▲"];
    const className = unit === undefined ? "s" : "n";
    const head = element(row, "th", { scope: "col", className, "aria-sort": sorted ? direction : "none" });
    const sort = () => {
      change({ down: sorted && !state.down, sort: id });
      scroll.querySelectorAll("th button")[at].focus();
    };
    const button = addButton(head, title + (sorted ? arrow : ""), sort, text);
    button.addEventListener("focus", () => (note.textContent = `${title}: ${text}.`));
    button.addEventListener("blur", () => (note.textContent = key));
  };
  const addCell = (row, column, index, heat, mark, digits) => {
    const { id, of, unit, place } = column;
    const made = element(row, id === "filter" ? "th" : "td", { className: unit === undefined ? "s" : "n" });
    if (heat !== null) made.classList.add(`heat${heat}`);
    if (id === "filter") {
      made.scope = "row";
      return element(made, "bdi", {}, of(index));
    }
    const cell = place === undefined ? null : cellAt(index, place);
    const number = of(index);
    const text =
      unit === undefined ? number : digits && number !== null ? number.toFixed(digits) : format(number, unit);
    const addMark = ([words, title]) => element(made, "span", { className: "mark", title }, words);
    if (mark) addMark(mark);
    made.classList.toggle("best", mark === kMarks.best);
    const title = `${run.configurations[index].label} on ${run.places[place]?.title}: look closer`;
    const open = () => shadowbench.openViewer({ place, left: kTruth, right: index });
    if (cell?.picture) addButton(made, text, open, title);
    else element(made, "span", {}, text);
    if (cell && cell.status !== "ok") addMark([" !", cell.status]);
  };
  // Shades of a column, from its best to its worst value.
  const makeShades = (rows, { id, of, unit }) => {
    if (unit === undefined || id === "cost") return () => null;
    const ranks = rows.map(of).filter(Number.isFinite).map(rankOf);
    const least = Math.min(...ranks);
    const most = Math.max(...ranks);
    const shade = (value) => Math.round(((rankOf(value) - least) / (most - least)) * (kShades - 1));
    return (value) => (value === null || !(most > least) ? null : shade(value));
  };
  // The decimals of a column of fractions below 1, so that its points are aligned; 0: each number has its own.
  const countDecimals = (rows, { id, of, unit }) => {
    const numbers = rows.map(of).filter(Number.isFinite);
    const isOfFractions = unit !== undefined && !["share", "bytes"].includes(unit) && id !== "cost";
    if (!isOfFractions || numbers.some((number) => Math.abs(number) >= 1)) return 0;
    const decimals = Math.max(0, ...numbers.map((number) => `${shorten(number)}`.split(".")[1]?.length ?? 0));
    return decimals > 5 ? 0 : decimals;
  };
  const draw = () => {
    scroll.replaceChildren();
    const table = element(scroll, "table");
    const columns = listColumns().filter(({ id }) => id !== "class" || isMixed);
    const rows = listRows(columns);
    element(table, "caption", {}, measureOf().text);
    const head = element(element(table, "thead"), "tr");
    columns.forEach((column, at) => addHead(head, column, at));
    const body = element(table, "tbody");
    const marks = columns.map(findMarks);
    const shades = columns.map((column) => makeShades(rows, column));
    const decimals = columns.map((column) => countDecimals(rows, column));
    for (const [at, index] of rows.entries()) {
      const row = element(body, "tr", { className: at >= kMany ? "beyond" : "" });
      columns.forEach((column, i) =>
        addCell(row, column, index, shades[i](column.of(index)), marks[i].get(index), decimals[i]),
      );
    }
    const many = rows.length > kMany ? ` Print has the first ${kMany} of ${rows.length} rows.` : "";
    const all = run.configurations.length;
    const isMarked = (mark) => marks.some((each) => [...each.values()].includes(mark));
    const said = [
      rows.length < all && `${rows.length} of ${all} configurations.`,
      isMarked(kMarks.tied) && "≈: tied with the best of its column.",
      run.cells.some(({ status }) => status !== "ok") && "!: suspect or not finished.",
    ];
    key = said.filter(Boolean).join(" ") + many;
    note.textContent = key;
  };
  const change = (changes) => {
    Object.assign(state, changes);
    writeLink("table", [state.measure, state.sort, state.down ? "down" : "up", state.wide, state.text]);
    draw();
  };
  const openLink = () => {
    const [measure, sort, direction, width = "", text = ""] = readLink("table") ?? [];
    if (measure === undefined) return;
    Object.assign(state, { down: direction === "down", text });
    if (measures.some(({ id }) => id === measure)) state.measure = measure;
    if (listColumns().some(({ id }) => id === sort)) state.sort = sort;
    if (width === "" || run.classes.includes(width)) state.wide = width;
    [chooser.value, search.value, wide.value] = [state.measure, state.text, state.wide];
    draw();
  };
  chooser.value = state.measure;
  search.addEventListener("input", () => change({ text: search.value }));
  window.addEventListener("hashchange", openLink);
  shadowbench.drawTable = draw;
  draw();
  openLink();
};
