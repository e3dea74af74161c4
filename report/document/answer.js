// The costs that the answer's select has: those of the page, and where this GPU could be timed and was not yet, that.
const kMeasure = "measure";
const fillCosts = (select) => {
  const costs = run.costs.map(({ id, title }) => new Option(title, id));
  const canMeasure = run.cells.some(({ frames }) => frames) && !timesHere();
  if (canMeasure) costs.push(new Option("this GPU (measure)", kMeasure));
  select.replaceChildren(...costs);
  select.value = shadowbench.cost;
};
// Fills a select of costs; `begin` times this GPU, says in a line below the select how far that is, and gives the cost that was found to `choose`.
const makeMeasurer = (select, choose) => {
  fillCosts(select);
  const line = element(select.form, "p", { className: "note", hidden: true });
  const said = element(line, "span", { role: "status" });
  line.append(" ");
  const stop = addButton(line, "Stop", () => shadowbench.stopTiming());
  let isAtWork = false;
  const say = (text) => {
    said.textContent = text;
    stop.hidden = !isAtWork;
    line.hidden = text === "";
  };
  const begin = async () => {
    isAtWork = true;
    const sayStep = (step) => say(`This GPU is being timed. ${step}`);
    sayStep("");
    const { value: id, message } = await attempt(shadowbench.timeHere(sayStep));
    isAtWork = false;
    say(message ?? "");
    if (id) choose(id);
    else select.value = shadowbench.cost;
  };
  return { begin, end: () => isAtWork && shadowbench.stopTiming() };
};
// The answer on top of a run's page: which filters are fast, balanced and best within the limits that the reader moves.
// `shadowbench advise` gives the same, as the command below the answer.
const startAnswer = (holder) => {
  const kSteps = 60;
  const kPicks = ["Fast", "Balanced", "Best"];
  const kClaim = "contact-hardening";
  const places = run.places.map(({ title }) => title);
  const state = { wide: "", soft: false, limits: {} };
  const nameLimit = (measure) =>
    measure.option === "--max-ms"
      ? { ...measure, field: kTime, title: "time of a frame" }
      : { ...measure, field: measure.id };
  const limits = run.measures.filter(({ option }) => option).map(nameLimit);
  const limitOf = (field) => limits.find((limit) => limit.field === field);
  const unitOf = (field) => (field === kTime ? costChoice().unit : limitOf(field).unit);
  const [all] = run.scopes;
  const worstOf = (index, field) => all.rows[index].worst[field === kTime ? costChoice().field : field];
  const judge = (scope = all) => judgeScope(scope, costChoice(), state);
  const labelOf = (index) => run.configurations[index].label;

  // Of what is there without the script the notes stay, which are of the choice that the page opens with.
  const notes = holder.querySelector(":scope > ul");
  [...holder.children].filter((child) => !child.matches("figure")).forEach((child) => child.remove());
  const headline = element(holder, "p", { className: "choice", "aria-live": "polite" });
  const setting = element(holder, "p", { className: "note" }, `${run.setting} · `);
  const controls = element(holder, "form", { className: "limits", "aria-label": "Limits", onsubmit: () => false });
  const table = element(element(holder, "div", { className: "scroll picks" }), "table");
  holder.append(...holder.querySelectorAll(":scope > figure")); // the grid
  const picture = startPicture(holder);
  const folded = element(holder, "details", { className: "reasons" });
  element(folded, "summary", {}, "Why, limits and commands");
  const sliders = element(folded, "div", { className: "limits sliders" });
  const stated = element(folded, "p", { className: "note" }); // what the chosen cost is of, and leaves out
  if (notes) folded.append(notes);
  const codes = ["In a terminal: ", "In a window: "].map((lead) => addCommand(folded, lead));

  const writeAdvise = () => {
    const asked = limits.filter(({ field }) => field in state.limits);
    return [
      `shadowbench advise ${folderOfPage()}`,
      ...asked.map(({ option, field }) => `${option} ${state.limits[field]}`),
      ...(state.soft ? [`--requires ${kClaim}`] : []),
      ...(state.wide ? [`--class ${state.wide}`] : []),
      ...(costChoice().option ? [costChoice().option] : []),
    ].join(" ");
  };
  // The program's words, with names and numbers in their places.
  const fill = (name, values) => run.words[name].replaceAll(/\{(\w+)\}/g, (_, key) => values[key]);
  const percent = (share) => `${Math.round(100 * share)}\u00a0%`;
  const sayChoice = ({ picks, failing }) => {
    const [fast, best] = [0, 2].map((column) => picks.find(({ columns }) => columns.includes(column)));
    if (!fast) return failing.length > 0 ? fill("fails") : fill("unjudged");
    const [name, other] = [fast, best ?? fast].map(({ index }) => quote(labelOf(index)));
    const kind = !fast.rmse ? "unmeasured" : !best ? "fast" : best === fast ? "both" : best.times ? "dearer" : "best";
    return fill(kind, { fast: name, best: other, times: format(best?.times ?? 1) });
  };

  // The table: all scenes, and those whose answer is another; a click shows the picture.
  const findWorstPlace = (index, scope) => {
    const own = run.cells.filter(
      ({ configuration, place }) =>
        configuration === index && (!scope.scene || run.places[place].scene === scope.scene),
    );
    const flip = ({ values_of: values, picture }) => (picture ? (values["error.flip"] ?? -1) : -2);
    return own.reduce((a, b) => (flip(b) > flip(a) ? b : a)).place;
  };
  const showPick = (index, place) => {
    picture.show(index, place);
    for (const button of table.querySelectorAll("button"))
      button.setAttribute(
        "aria-pressed",
        Number(button.dataset.index) === index && Number(button.dataset.place) === place,
      );
    codes[1].textContent = writeView(index, place);
    codes[1].parentNode.hidden = !codes[1].textContent;
  };
  // A number with its bar, which is as long as its share of `most`.
  const addNumber = (cell, className, text, words, share) => {
    const line = element(cell, "span");
    element(line, "b", { className }, text);
    line.append(` ${words}`);
    if (share !== null) element(cell, "i", { className: `bar ${className}`, style: `--share: ${share}` });
  };
  const addPick = (row, pick, scope, { picks, none }) => {
    const { index, cost, rmse, gain, extra } = pick;
    const place = findWorstPlace(index, scope);
    const cell = element(row, "td");
    const choose = () => {
      showPick(index, place);
      picture.figure.scrollIntoView({ block: "nearest" });
      writeLink("shown", [labelOf(index), places[place]]);
    };
    const button = addButton(cell, "", choose, run.configurations[index].full);
    Object.assign(button.dataset, { index, place });
    element(button, "bdi", {}, labelOf(index));
    const costText = `${format(cost * costScale().factor)} ${costScale().unit}`;
    if (scope !== all) {
      element(button, "span", {}, rmse ? format(rmse.value) : costText);
      return cell;
    }
    const share = (value, most) => (most > 0 ? Math.min(1, Math.max(0, value / most)) : null);
    const less = rmse && none?.value > rmse.value ? fill("less", { share: percent(1 - rmse.value / none.value) }) : "";
    if (rmse) addNumber(cell, "error", format(rmse.value), `RMSE${less}`, share(rmse.value, none?.value ?? 0));
    const dearest = Math.max(...picks.map((each) => each.cost));
    addNumber(cell, "cost", costText, "a frame", share(cost, dearest));
    if (gain) element(cell, "span", {}, fill("balanced", { gain: percent(gain), extra: percent(extra) }));
    if (scope.rows[index].wrong) element(cell, "span", {}, scope.rows[index].wrong);
    return cell;
  };
  const addRow = (scope, judged) => {
    const row = element(table.tBodies[0] ?? element(table, "tbody"), "tr");
    const title = scope.scene ?? (places.length > 1 ? "all scenes" : places[0]);
    const head = element(row, "th", { scope: "row", dir: "auto" });
    for (const part of title.split(/(?<=[._-])/)) head.append(part, document.createElement("wbr"));
    if (scope.left_out) return element(row, "td", { colSpan: 3 }, scope.left_out);
    if (judged.keeping.length === 0) return element(row, "td", { colSpan: 3 }, fill("fails"));
    for (const [column, title] of kPicks.entries()) {
      const own = judged.picks.find(({ columns }) => columns.includes(column));
      const cell = own ? addPick(row, own, scope, judged) : element(row, "td", { className: "empty" }, "–");
      cell.dataset.head = title;
    }
  };
  // What a sweep of the bias recommends for picks, where one was made.
  const addBiasRow = (picks) => {
    const biasOf = (column) => run.configurations[picks.find(({ columns }) => columns.includes(column))?.index]?.bias;
    const biases = [0, 1, 2].map(biasOf);
    if (!biases.some(Boolean)) return;
    const row = element(table.tBodies[0], "tr");
    element(row, "th", { scope: "row" }, "bias to ship");
    for (const bias of biases) element(row, "td", {}, bias || "–");
  };
  const listNames = ({ picks }) => picks.map(({ index, columns }) => [index, ...columns].join()).join(" ");
  const showTable = (judged) => {
    table.replaceChildren();
    if (judged.keeping.length === 0) return;
    const head = element(element(table, "thead"), "tr");
    element(head, "td");
    for (const title of kPicks) element(head, "th", { scope: "col" }, title);
    addRow(all, judged);
    for (const scope of run.scopes.slice(1)) {
      const own = judge(scope);
      if (scope.left_out || listNames(own) !== listNames(judged)) addRow(scope, own);
    }
    addBiasRow(judged.picks);
  };
  // What charts mark: "fast", "balanced", "best", or two of them, by the key of any of its cells.
  const roles = { names: "", picks: [] };
  shadowbench.roleOf = (key) => {
    const { configuration } = run.cells.find((cell) => cell.key === key) ?? {};
    const pick = roles.picks.find(({ index }) => index === configuration);
    return pick?.columns.map((column) => kPicks[column].toLowerCase()).join(" and ");
  };
  const isAsked = () => state.wide || state.soft || Object.keys(state.limits).length > 0;
  const show = () => {
    stated.textContent = `Cost: ${costChoice().text}.`;
    const judged = judge();
    headline.textContent = [sayChoice(judged), all.judged].filter(Boolean).join(" ");
    showTable(judged);
    const first = table.querySelector("button");
    picture.figure.hidden = !first;
    if (first) showPick(Number(first.dataset.index), Number(first.dataset.place));
    codes[0].textContent = writeAdvise();
    if (notes) notes.hidden = isAsked() || shadowbench.cost !== run.cost;
    const names = listNames(judged);
    const isNew = names !== roles.names;
    Object.assign(roles, { names, picks: judged.picks });
    if (isNew) shadowbench.drawCharts?.();
  };

  // A slider's steps are the worst values of the run: each step lets one more configuration through.
  const listSteps = (field) => {
    const { order } = all.advice[shadowbench.cost][""];
    const known = order.map(({ index }) => worstOf(index, field).limit).filter((limit) => limit !== undefined);
    const values = known.map((limit) => Math.max(0, limit)); // a time that is a difference may be below zero
    if (field in state.limits) values.push(state.limits[field]);
    const steps = [...new Set(values)].sort((a, b) => a - b);
    const every = Math.ceil(steps.length / kSteps);
    return steps.filter((step, i) => i % every === 0 || step === state.limits[field]);
  };
  const addSlider = ({ field, title, text }) => {
    const unit = unitOf(field);
    const steps = listSteps(field);
    if (steps.length < 2 && !(field in state.limits)) return;
    const label = element(sliders, "label", { title: text });
    const output = element(element(label, "span", {}, `${title}${field === kTime ? `, ${unit}` : ""}: `), "output");
    const slider = element(label, "input", { type: "range", min: 0, max: steps.length, step: 1, name: field });
    slider.value = field in state.limits ? steps.indexOf(state.limits[field]) : steps.length;
    const read = () => {
      const most = steps[Number(slider.value)];
      if (most === undefined) delete state.limits[field];
      else state.limits[field] = most;
      output.textContent = most === undefined ? "no limit" : `at most ${format(most, unit)}`;
      slider.setAttribute("aria-valuetext", output.textContent);
    };
    slider.addEventListener("input", () => {
      read();
      change();
    });
    read();
  };
  const showSliders = () => {
    sliders.replaceChildren();
    limits.forEach(addSlider);
  };
  const change = () => {
    const asked = Object.entries(state.limits).map((limit) => limit.join(":"));
    writeLink("limits", [shadowbench.cost, state.wide, state.soft ? kClaim : "", ...asked]);
    show();
  };
  const choose = (changes) => {
    Object.assign(state, changes);
    showSliders();
    change();
  };
  const chooseCost = (value) => {
    if (value === kMeasure) return measurer.begin();
    measurer.end();
    shadowbench.cost = cost.value = value;
    delete state.limits[kTime];
    choose({});
    showCost();
  };
  const cost = addSelect(controls, "Cost", [], { name: "cost" }, chooseCost);
  // Costs that came after the page was opened.
  shadowbench.listCosts = () => {
    fillCosts(cost);
    showSliders();
    show();
    showCost();
  };
  const classes = [["", "of any width"], ...run.classes.map((name) => [name, name])];
  const wide = addSelect(controls, "Kernel", classes, { name: "class" }, (value) => choose({ wide: value }));
  const softLabel = element(controls, "label", { title: "Only filters whose shadows are sharper where they touch" });
  const soft = element(softLabel, "input", { type: "checkbox", name: "soft" });
  softLabel.append(" Contact hardening");
  softLabel.hidden = !run.configurations.some(({ hardens, teaching }) => hardens && !teaching);
  soft.addEventListener("change", () => choose({ soft: soft.checked }));
  addButton(setting, "My limits", () => {
    folded.open = true;
    folded.scrollIntoView();
  });
  const measurer = makeMeasurer(cost, chooseCost);
  const openShown = () => {
    const [label, title] = readLink("shown") ?? [];
    const [index, place] = [run.configurations.findIndex((each) => each.label === label), places.indexOf(title)];
    if (cellAt(index, place)) showPick(index, place);
  };
  const openLink = () => {
    const [id, width, claim, ...asked] = readLink("limits") ?? [];
    if (id !== undefined) {
      if (run.costs.some((each) => each.id === id)) shadowbench.cost = cost.value = id;
      if (width === "" || run.classes.includes(width)) state.wide = wide.value = width;
      state.soft = soft.checked = claim === kClaim && !softLabel.hidden;
      const isKnown = ([field, most]) => limitOf(field) && most && Number.isFinite(Number(most));
      const known = asked.map((text) => text.split(":")).filter(isKnown);
      state.limits = Object.fromEntries(known.map(([field, most]) => [field, Number(most)]));
      showSliders();
      show();
      showCost();
    }
    openShown();
  };

  window.addEventListener("hashchange", openLink);
  showSliders();
  show();
  openLink();
  shadowbench.answer = { judge, state, picks: (scope = all) => judge(scope).picks, writeView };
};
