"use strict";
// The table of a run: configurations by scenes, of the measure that the reader chooses.
(() => {
  const holder = document.querySelector(".numbers"), shadowbench = window.shadowbench, { element, format, link } = shadowbench;
  if (!holder || !shadowbench.data) return;
  const { run } = shadowbench.data;
  const kHeat = 5, kMany = 25;
  const kWorst = { more: "the least value", zero: "the value farthest from 0" };
  const cells = run.configurations.map(() => []);
  for (const cell of run.cells) cells[cell.configuration][cell.place] = cell;
  shadowbench.light = "moving";  // of which the answer and the table say the cost
  const state = { measure: "error.rmse", sort: "cost", down: false, text: "", wide: "" };
  const measures = run.measures.filter((measure) => run.cells.some((cell) => cell.values_of[measure.id] !== null));
  if (measures.length > 0 && !measures.some((measure) => measure.id === state.measure)) state.measure = measures[0].id;
  const measureOf = () => measures.find((measure) => measure.id === state.measure);
  const valueOf = (index, place) => (cells[index][place] ? cells[index][place].values_of[state.measure] ?? null : null);
  // The smaller, the better; of a measure that is neither good nor bad, the value itself.
  const rankOf = (value) => ({ more: -value, zero: Math.abs(value) })[measureOf()?.better] ?? value;
  const worstOf = (index) => run.places.reduce((worst, _, place) => {
    const value = valueOf(index, place);
    return worst === null || (value !== null && rankOf(value) > rankOf(worst)) ? value : worst;
  }, null);
  const timeOf = () => `time_ms.${shadowbench.light}`;
  const costOf = (index) => run.configurations[index][timeOf()]?.mean ?? null;

  const columns = () => {
    const unit = measureOf()?.unit;
    return [
      { id: "filter", title: "filter", text: "a filter, with the parameters and settings that tell it from the others", of: (i) => run.configurations[i].label, name: true },
      { id: "class", title: "width", text: "class of the kernel's standard deviation: errors are compared within one class", of: (i) => run.configurations[i].class || "–", key: (i) => run.configurations[i].sigma },
      { id: "cost", title: `${shadowbench.light} light, ${run.unit}`, text: run.measures.find(({ id }) => id === timeOf()).text, of: costOf, unit: "" },
      ...run.places.map((place, at) => ({ id: `place${at}`, title: place.title, text: `${measureOf()?.title} on ${place.title}: ${measureOf()?.text}`, of: (i) => valueOf(i, at), unit, place: at })),
      { id: "worst", title: "worst", text: `${kWorst[measureOf()?.better] ?? "the largest value"} over the scenes`, of: worstOf, unit },
    ];
  };
  // In a column: the best of each class of width under the same settings, if there are two to compare, and what cannot
  // be told from it, whether or not their rows are shown.
  const findMarks = (column) => {
    const marks = new Map(), groups = new Map();
    if (column.place === undefined || measureOf()?.better === "neither") return marks;
    for (const [i, { class: width, surroundings, teaching }] of run.configurations.entries()) {
      if (teaching || !width || cells[i][column.place]?.status !== "ok" || column.of(i) === null) continue;
      const group = `${width} ${surroundings}`;
      groups.set(group, [...(groups.get(group) ?? []), i]);
    }
    for (const group of groups.values()) {
      if (group.length < 2) continue;
      const rank = (i) => rankOf(column.of(i)), best = group.reduce((least, i) => (rank(i) < rank(least) ? i : least));
      for (const i of group) {
        if (rank(i) === rank(best)) marks.set(i, "best");
        else if (areTied(cells[i][column.place], cells[best][column.place], rank(i) - rank(best))) marks.set(i, "tied");
      }
    }
    return marks;
  };
  const areTied = (cell, best, gap) => {
    const [own, least] = [cell, best].map(({ intervals }) => intervals[state.measure]);
    return own && least ? own[0] <= least[1] : state.measure === "error.rmse" && gap <= Math.max(cell.reach, best.reach);
  };
  const listRows = () => {
    const wanted = state.text.toLowerCase();
    const rows = run.configurations.map((_, i) => i).filter((i) => (!state.wide || run.configurations[i].class === state.wide) &&
      `${run.configurations[i].label} ${run.configurations[i].params}`.toLowerCase().includes(wanted));
    const column = columns().find((each) => each.id === state.sort) || columns()[0];
    const order = (a, b) => {
      const [x, y] = [a, b].map(column.key ?? column.of);
      if (x === null || y === null) return (x === null) - (y === null);
      return (state.down ? -1 : 1) * (typeof x === "string" ? x.localeCompare(y) : x - y);
    };
    return rows.sort(order);
  };

  const controls = element(holder, "div", { className: "controls" });
  const scroll = element(holder, "div", { className: "scroll", tabIndex: 0, role: "region", "aria-label": "All numbers" });
  const note = element(holder, "p", { className: "note" });
  let key = "";
  const addField = (text, name, properties) => {
    const label = element(controls, "label", {}, text);
    return element(label, name, properties);
  };
  const chooser = addField("Show ", "select", { name: "measure" });
  for (const measure of measures) element(chooser, "option", { value: measure.id }, measure.title);
  chooser.value = state.measure;
  const search = addField("Filter ", "input", { type: "search", name: "filter", placeholder: "name or parameter" });
  const wide = addField("Width ", "select", { name: "width" });
  for (const [value, title] of [["", "any"], ...run.classes.map((name) => [name, name])]) element(wide, "option", { value }, title);

  const addHead = (row, column) => {
    const sorted = state.sort === column.id;
    const head = element(row, "th", { scope: "col", className: column.unit === undefined ? "s" : "n", "aria-sort": sorted ? (state.down ? "descending" : "ascending") : "none" });
    const button = element(head, "button", { type: "button", title: column.text }, column.title + (sorted ? (state.down ? " ▼" : " ▲") : ""));
    button.addEventListener("focus", () => { note.textContent = `${column.title}: ${column.text}.`; });
    button.addEventListener("blur", () => { note.textContent = key; });
    button.addEventListener("click", () => {
      change({ down: sorted && !state.down, sort: column.id });
      scroll.querySelectorAll("th button")[columns().findIndex((each) => each.id === column.id)].focus();
    });
  };
  const addCell = (row, column, index, heat, mark) => {
    const value = column.of(index), cell = column.place === undefined ? null : cells[index][column.place];
    const made = element(row, column.name ? "th" : "td", { className: column.unit === undefined ? "s" : "n" });
    if (column.name) made.scope = "row";
    if (heat !== null) made.classList.add(`heat${heat}`);
    if (column.name) return element(made, "bdi", {}, value);
    const text = typeof value === "string" ? value : format(value, column.unit);
    const shown = cell && shadowbench.openViewer && cell.picture
      ? element(made, "button", { type: "button", title: `${run.configurations[index].label} on ${run.places[column.place].title}: look closer` }, text)
      : element(made, "span", {}, text);
    if (shown.type === "button") shown.addEventListener("click", () => shadowbench.openViewer({ place: column.place, left: -1, right: index }));
    if (mark) element(made, "span", { className: "mark", title: mark === "best" ? "the best of its class of width and settings" : "cannot be told from the best of its class and settings" }, mark === "best" ? " ★" : " ≈");
    if (cell && cell.status !== "ok") element(made, "span", { className: "mark", title: cell.status }, " !");
  };
  const draw = () => {
    scroll.replaceChildren();
    const table = element(scroll, "table"), rows = listRows(), all = columns();
    element(table, "caption", {}, `${measureOf()?.title ?? "nothing was measured"}: ${measureOf()?.text ?? ""}`);
    addHeadRow(table, all);
    const body = element(table, "tbody"), marks = all.map(findMarks);
    const scales = all.map((column) => (column.unit === undefined || column.id === "cost" ? null : makeScale(rows, column)));
    rows.forEach((index, at) => {
      const row = element(body, "tr", { className: at >= kMany ? "beyond" : "" });
      all.forEach((column, i) => addCell(row, column, index, scales[i] ? scales[i](column.of(index)) : null, marks[i].get(index)));
    });
    const many = rows.length > kMany ? ` Print has the first ${kMany} of ${rows.length} rows.` : "";
    key = `${rows.length} of ${run.configurations.length} configurations. ★ best of its class of width and settings, ≈ cannot be told from it, ! suspect or not finished.${many}`;
    note.textContent = key;
  };
  const addHeadRow = (table, all) => {
    const row = element(element(table, "thead"), "tr");
    all.forEach((column) => addHead(row, column));
  };
  // Shades of a column, from its best to its worst value.
  const makeScale = (rows, column) => {
    const values = rows.map(column.of).filter((value) => value !== null && Number.isFinite(value)).map(rankOf);
    const least = Math.min(...values), most = Math.max(...values);
    return (value) => (value === null || !(most > least) ? null : Math.round(((rankOf(value) - least) / (most - least)) * (kHeat - 1)));
  };
  const change = (changes) => {
    Object.assign(state, changes);
    link.write("table", [state.measure, state.sort, state.down ? "down" : "up", state.wide, state.text]);
    draw();
  };
  const openLink = () => {
    const [measure, sort, direction, width = "", text = ""] = link.read("table") ?? [];
    if (measure === undefined) return;
    Object.assign(state, { down: direction === "down", text });
    if (measures.some(({ id }) => id === measure)) state.measure = measure;
    if (columns().some(({ id }) => id === sort)) state.sort = sort;
    if (run.classes.includes(width) || width === "") state.wide = width;
    [chooser.value, search.value, wide.value] = [state.measure, state.text, state.wide];
    draw();
  };
  chooser.addEventListener("change", () => change({ measure: chooser.value }));
  search.addEventListener("input", () => change({ text: search.value }));
  wide.addEventListener("change", () => change({ wide: wide.value }));
  window.addEventListener("hashchange", openLink);
  [...holder.children].forEach((child) => { if (![controls, scroll, note].includes(child)) child.remove(); });
  shadowbench.drawTable = draw;
  draw();
  openLink();
})();
