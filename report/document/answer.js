// The answer on top of a run's page: which filters are fast, balanced and best within the limits that the reader moves.
// What advise() found is in the page's data; here worst values are compared with limits, and no more. `shadowbench
// advise` says the same, as the command below the answer.
const startAnswer = (holder) => {
  const kSteps = 60;
  const kTime = "time_ms";
  const kSeen = 0.001;
  const kVisibleSeam = 0.02;
  const kClaim = "contact-hardening";
  const places = run.places.map(({ title }) => title);
  const state = { wide: "", soft: false, limits: {} };
  const nameLimit = (measure) =>
    measure.option === "--max-ms"
      ? { ...measure, field: kTime, title: "time of a frame" }
      : { ...measure, field: measure.id };
  const limits = run.measures.filter(({ option }) => option).map(nameLimit);
  const limitOf = (field) => limits.find((limit) => limit.field === field);
  const titleOf = (field) => limitOf(field)?.title ?? field;
  const fieldOf = (field) => (field === kTime ? costChoice().field : field);
  const [all] = run.scopes;

  // The worst value of a configuration in a scope, or a text that says why there is none.
  const worstOf = (index, field, scope = all) => scope.rows[index].worst[fieldOf(field)];
  const seamOf = (index, scope) => worstOf(index, "artefact.seam", scope)?.value ?? 0;
  const costOf = (index, scope = all) => scope.rows[index][costChoice().field];
  // Whether the cost of one cannot be told from that of another, which ranks behind it.
  const areTied = ({ tied }, { rank }) => tied.some(([from, end]) => from <= rank && rank < end);
  const limitsWhatIsSeen = () => Object.keys(state.limits).some((field) => limitOf(field).group !== "cost");
  // Of what keeps the limits, cheapest first, what nothing beats; and where nothing that is seen is limited, what is
  // clearly better than the cheapest without a filter.
  const takeFront = (kept, scope) => {
    const rmseOf = ({ index }) => scope.rows[index].rmse;
    const seam = ({ index }) => seamOf(index, scope);
    const isBeaten = (each, i) =>
      kept.slice(0, i).some((other) => rmseOf(other)?.value <= rmseOf(each)?.value && seam(other) <= seam(each));
    const [front, beaten] = [kept.filter((...each) => !isBeaten(...each)), kept.filter(isBeaten)];
    const any = scope.advice[shadowbench.cost][""]?.order ?? [];
    const unfiltered = any.find(({ index }) => run.configurations[index].filter === "none");
    const isGain = (each) => unfiltered && rmseOf(each) && isErrorLess(rmseOf(each), rmseOf(unfiltered));
    const gains = limitsWhatIsSeen() ? [] : front.filter(isGain);
    const noGain = gains.length > 0 ? front.filter((each) => !gains.includes(each)) : [];
    return { keeping: gains.length > 0 ? gains : front, beaten, noGain, unfiltered, gained: gains.length > 0 };
  };
  const judge = (scope = all) => {
    const { order, unjudged } = scope.advice[shadowbench.cost][state.wide] ?? { order: [], unjudged: [] };
    const judged = { keeping: [], failing: [], unjudged: [...unjudged] };
    const fields = Object.keys(state.limits);
    for (const [rank, { index, tied }] of order.entries()) {
      const gap = fields.map((field) => worstOf(index, field, scope)).find((worst) => typeof worst === "string");
      const broken = fields.filter((field) => worstOf(index, field, scope).value > state.limits[field]);
      if (state.soft && !run.configurations[index].hardens) broken.push(kClaim);
      if (gap) judged.unjudged.push({ index, gap });
      else (broken.length > 0 ? judged.failing : judged.keeping).push({ index, rank, tied, broken });
    }
    return Object.assign(judged, takeFront(judged.keeping, scope));
  };

  const labelOf = (index) => run.configurations[index].label;
  const unitOf = (field) => (field === kTime ? costChoice().unit : limitOf(field).unit);
  const say = (value, field) => format(value, unitOf(field));
  const sayWorst = (index, field) =>
    `${say(worstOf(index, field).value, field)} on ${places[worstOf(index, field).place]}`;
  const costText = (index, scope) => `${format(costOf(index, scope))} ${costChoice().unit}`;
  const list = (texts) => (texts.length > 1 ? `${texts.slice(0, -1).join(", ")} and ${texts.at(-1)}` : texts.join());

  // Which filters on smaller maps a choice beats.
  const describeLargerMap = ({ index, rank }, beaten, scope) => {
    const [own, rmseOf] = [run.configurations[index], (each) => scope.rows[each.index].rmse?.value];
    const isBeaten = (each) => {
      const other = run.configurations[each.index];
      return (
        each.rank > rank && other.map < own.map && other.filter !== own.filter && rmseOf(each) >= rmseOf({ index })
      );
    };
    const found = beaten.filter(isBeaten);
    if (found.length === 0) return "";
    const least = found.reduce((a, b) => (rmseOf(b) < rmseOf(a) ? b : a));
    return `; its larger map beats ${labelOf(least.index)}`;
  };
  const pick = ({ keeping, beaten, noGain, unfiltered, gained }, scope) => {
    const limited = Object.keys(state.limits).length > 0 || state.soft;
    const picks = pickThree(keeping, {
      hasOthers: keeping.length + beaten.length + noGain.length > 1,
      rmseOf: ({ index }) => scope.rows[index].rmse,
      costOf: ({ index }) => costOf(index, scope),
      areTied,
      seamOf: ({ index }) => seamOf(index, scope),
      why: gained
        ? `cheapest clearly better than ${labelOf(unfiltered.index)}`
        : limited
          ? "cheapest within the limits"
          : "cheapest",
    });
    const describeSeam = ({ index }) =>
      seamOf(index, scope) >= kVisibleSeam ? `; its cascades show a seam of ${format(seamOf(index, scope))}` : "";
    const describe = (each) => each.why + describeLargerMap(each, beaten, scope) + describeSeam(each);
    return picks.map((each) => ({ ...each, why: describe(each) }));
  };

  // How the worst of what can be limited differs between the choice and the runner-up.
  const compareWorst = (best, second) => {
    const found = { lower: [], higher: [] };
    for (const { field, group, title } of limits) {
      const [a, b] = [best, second].map((index) => worstOf(index, field));
      if (group === "cost" || a.value === undefined || b.value === undefined) continue;
      const seen = group === "artefact" ? kSeen : 0.02 * Math.max(a.value, b.value);
      const isTied =
        field === "error.rmse"
          ? areErrorsTied(cellAt(best, a.place).rmse, cellAt(second, b.place).rmse)
          : Math.abs(b.value - a.value) <= seen;
      if (isTied) continue;
      const text = `${title} ${say(b.value, field)} instead of ${say(a.value, field)}`;
      found[b.value < a.value ? "lower" : "higher"].push(text);
    }
    const parts = Object.entries(found).filter(([, texts]) => texts.length > 0);
    if (parts.length === 0) return "at worst nothing that can be limited differs clearly";
    return `at worst it has ${parts.map(([word, texts]) => `${word} ${list(texts)}`).join("; and ")}`;
  };
  // Where the choice is most wrong, and its faults: those that are seen, that are not, and that nobody could see.
  const describeFaults = (best) => {
    const { value, place } = worstOf(best, "error.rmse");
    if (value === undefined) return [];
    const { cause } = cellAt(best, place);
    const said = [`${places[place]}, with RMSE ${format(value)}${cause && `, most of it ${cause}`}`];
    const free = [];
    const unknown = [];
    for (const { field, title } of limits.filter(({ group }) => group === "artefact")) {
      const worst = worstOf(best, field);
      if (worst.value >= kSeen) said.push(`${title} ${sayWorst(best, field)}`);
      else (worst.value === undefined ? unknown : free).push(title);
    }
    if (free.length > 0) said.push(`no ${free.join(" or ")} is seen`);
    if (unknown.length > 0) said.push(`${unknown.join(" and ")} could not be measured`);
    return said;
  };
  // How the choice stands to the limits, and where a limit had nothing to be judged on.
  const describeBounds = (best) => {
    const fields = Object.keys(state.limits);
    const bounds = fields.map((field) => {
      const { value, place } = worstOf(best, field);
      const limit = say(state.limits[field], field);
      return `${titleOf(field)} ${say(value, field)} at worst, on ${places[place]} (limit ${limit})`;
    });
    const blind = fields.filter((field) => worstOf(best, field).unseen.length > 0);
    const unseen = (field) => list(worstOf(best, field).unseen.map((place) => places[place]));
    return [...bounds, ...blind.map((field) => `${titleOf(field)} had nothing to show on ${unseen(field)}`)];
  };

  const headline = element(holder, "p", { className: "choice", "aria-live": "polite" });
  const controls = element(holder, "form", { className: "limits", "aria-label": "Limits", onsubmit: () => false });
  const stated = element(holder, "p", { className: "note" }); // what the chosen cost is of, and leaves out
  const table = element(element(holder, "div", { className: "scroll picks" }), "table");
  const picture = startPicture(holder);
  const folded = element(holder, "details", { className: "reasons" });
  element(folded, "summary", {}, "Why, limits and commands");
  const sliders = element(folded, "div", { className: "limits sliders" });
  const reasons = element(folded, "ul");
  const codes = ["In a terminal: ", "In a window: "].map((lead) => addCommand(folded, lead));
  // An item of the reasons, in which a number stands for a configuration's name.
  const explain = (lead, ...parts) => {
    const item = element(reasons, "li");
    element(item, "b", {}, lead + " ");
    for (const part of parts)
      if (typeof part === "number") element(item, "bdi", {}, labelOf(part));
      else item.append(part);
  };

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
  const explainSecond = (best, second) => {
    if (!second) return explain("Runner-up:", "no other on the front keeps the limits.");
    const times = `at ${format(costOf(second.index) / costOf(best.index))} times the cost`;
    const stands = areTied(best, second) ? "whose cost cannot be told from it" : times;
    explain("Runner-up:", second.index, `, ${stands}; ${compareWorst(best.index, second.index)}.`);
  };
  const explainChoice = ({ keeping, failing, noGain, beaten, unfiltered, gained }) => {
    const [best, second] = keeping;
    const tied = keeping.filter((other) => areTied(best, other));
    const configuration = run.configurations[best.index];
    const lead = tied.length > 0 ? "it has the lowest mean cost" : "it is the cheapest";
    const bounds = describeBounds(best.index);
    const limited = Object.keys(state.limits).length > 0 || state.soft;
    const judged = limited ? "that keep the limits" : gained ? "on the Pareto front" : "that can be judged";
    explain(
      "Fast:",
      best.index,
      `; ${lead} of ${keeping.length} ${judged}${bounds.length > 0 ? ": " : ""}${bounds.join("; ")}.`,
    );
    if (tied.length > 0) {
      const others = tied.length > 3 ? `${tied.length} others` : list(tied.map(({ index }) => labelOf(index)));
      explain("Tied:", `the costs of ${others} cannot be told from it.`);
    }
    const kernel = configuration.sigma === null ? "of no one width that is known" : configuration.kernel;
    explain("Kernel:", `${kernel}${configuration.params && `; ${configuration.params}`}.`);
    explainSecond(best, second);
    const isCheaper = (other) => costOf(other.index) < costOf(best.index);
    const cheaper = failing.find(
      (other) => other.broken.length === 1 && limitOf(other.broken[0]) && isCheaper(other) && !areTied(other, best),
    );
    if (cheaper) {
      const [field] = cheaper.broken;
      const limit = say(worstOf(cheaper.index, field).limit, field);
      explain("Cheaper:", cheaper.index, `, ${costText(cheaper.index)}, were ${titleOf(field)} of ${limit} allowed.`);
    }
    const names = (each) => list(each.map(({ index }) => labelOf(index)));
    if (noGain.length > 0) explain("No better than", unfiltered.index, `: ${names(noGain)}.`);
    if (beaten.length > 0) explain("Beaten in cost and error:", `${names(beaten)}.`);
    const faults = describeFaults(best.index);
    if (faults.length > 0) explain("Fails at:", `${faults.join("; ")}.`);
  };
  // How many times a limit the worst value is, at most; beyond a limit of 0, and without a claim, infinitely.
  const measureExcess = ({ index, broken }) =>
    Math.max(
      ...broken.map((field) =>
        state.limits[field] > 0 ? worstOf(index, field).value / state.limits[field] : Infinity,
      ),
    );
  const explainNothing = (failing) => {
    const none = "Nothing can be judged: a value, a time or a scene is missing for every filter.";
    headline.textContent = failing.length > 0 ? "Nothing keeps these limits." : all.judged || none;
    const [nearest] = failing
      .map((each) => ({ ...each, excess: measureExcess(each) }))
      .sort((a, b) => a.broken.length - b.broken.length || (a.excess === b.excess ? 0 : a.excess - b.excess));
    if (!nearest) return;
    const { index, broken } = nearest;
    const breaks = broken.map(
      (field) => titleOf(field) + (field in state.limits ? `, with ${sayWorst(index, field)}` : ""),
    );
    explain("Closest:", index, ` breaks ${list(breaks)}.`);
  };

  // The table: all scenes, and each; a click shows the picture.
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
  const addPick = (row, { index, why }, scope) => {
    const place = findWorstPlace(index, scope);
    const cell = element(row, "td");
    const choose = () => {
      showPick(index, place);
      writeLink("shown", [labelOf(index), places[place]]);
    };
    const button = addButton(cell, "", choose, `${run.configurations[index].full}\n${why}`);
    Object.assign(button.dataset, { index, place });
    element(button, "bdi", {}, labelOf(index));
    const rmse = scope.rows[index].rmse;
    const error = rmse ? `RMSE ${format(rmse.value)}` : "";
    if (scope !== all) return element(button, "span", {}, rmse ? format(rmse.value) : costText(index, scope));
    const line = element(cell, "span");
    for (const text of [costText(index, scope), error].filter(Boolean)) {
      line.append(line.firstChild ? " · " : "");
      element(line, "span", { className: "whole" }, text);
    }
    element(cell, "span", {}, why.replaceAll(" %", "\u00a0%"));
  };
  const addRow = (scope, judged) => {
    const row = element(table.tBodies[0] ?? element(table, "tbody"), "tr");
    const title = scope.scene ?? (places.length > 1 ? "all scenes" : places[0]);
    const head = element(row, "th", { scope: "row", dir: "auto" });
    for (const part of title.split(/(?<=[._-])/)) head.append(part, document.createElement("wbr"));
    if (scope.left_out) return element(row, "td", { colSpan: 3 }, scope.left_out);
    if (judged.keeping.length === 0) return element(row, "td", { colSpan: 3 }, "nothing keeps the limits");
    const picks = pick(judged, scope);
    for (const column of [0, 1, 2]) {
      const own = picks.find(({ columns }) => columns.includes(column));
      if (own) addPick(row, own, scope);
      else element(row, "td", {}, "–");
    }
  };
  const showTable = (judged) => {
    table.replaceChildren();
    if (judged.keeping.length === 0) return;
    const head = element(element(table, "thead"), "tr");
    element(head, "td");
    for (const title of ["Fast", "Balanced", "Best"]) element(head, "th", { scope: "col" }, title);
    run.scopes.forEach((scope) => addRow(scope, scope === all ? judged : judge(scope)));
    addBiasRow(table.tBodies[0], pick(judged, all));
  };
  const show = () => {
    headline.textContent = all.judged;
    stated.textContent = `Cost: ${costChoice().text}.`;
    reasons.replaceChildren();
    const judged = judge();
    showTable(judged);
    if (judged.keeping.length > 0) explainChoice(judged);
    else explainNothing(judged.failing);
    const first = table.querySelector("button");
    picture.figure.hidden = !first;
    if (first) showPick(Number(first.dataset.index), Number(first.dataset.place));
    const gaps = new Map(judged.unjudged.map(({ gap }) => [gap, []]));
    for (const { index, gap } of judged.unjudged) gaps.get(gap).push(index);
    for (const [gap, [index, ...others]] of gaps)
      explain("Not judged:", index, others.length > 0 ? ` and ${others.length} more` : "", `: ${gap}.`);
    codes[0].textContent = writeAdvise();
  };

  // A slider's steps are the worst values of the run: each step lets one more configuration through.
  const listSteps = (field) => {
    const { order } = all.advice[shadowbench.cost][""];
    const known = order.map(({ index }) => worstOf(index, field).limit).filter((limit) => limit !== undefined);
    const values = known.map((limit) => Math.max(0, limit)); // a time that is a difference may be below nought
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
  softLabel.append(" Soft shadows that harden at contacts");
  softLabel.hidden = !run.configurations.some(({ hardens, teaching }) => hardens && !teaching);
  soft.addEventListener("change", () => choose({ soft: soft.checked }));
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

  // Of what stood there without the script, the notes stay, folded.
  const own = [headline, controls, stated, table.parentNode, picture.figure, folded];
  const before = [...holder.children].filter((child) => !own.includes(child));
  const notes = before.find(({ localName }) => localName === "ul");
  before.forEach((child) => child.remove());
  if (notes) folded.append(notes);
  window.addEventListener("hashchange", openLink);
  showSliders();
  show();
  openLink();
  shadowbench.answer = { judge, state, picks: (scope = all) => pick(judge(scope), scope), writeView };
};
