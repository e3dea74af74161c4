// The answer on top of a run's page: the cheapest configuration within the limits that the reader moves. What advise()
// found is in the page's data; here worst values are compared with limits, and no more. `shadowbench advise` says the
// same, as the command below the answer.
const startAnswer = (holder) => {
  const kSteps = 60;
  const kTime = "time_ms";
  const kSeen = 0.001;
  const places = run.places.map(({ title }) => title);
  const state = { wide: "", limits: { ...run.limits } };
  const nameLimit = (measure) =>
    measure.option === "--max-ms"
      ? { ...measure, field: kTime, title: "time of a frame" }
      : { ...measure, field: measure.id };
  const limits = run.measures.filter(({ id, option }) => option && id !== `${kTime}.static`).map(nameLimit);
  const limitOf = (field) => limits.find((limit) => limit.field === field);
  const canLimit = (field) => limitOf(field) && !(field === kTime && costChoice().isEstimate);
  const titleOf = (field) => limitOf(field).title;
  const fieldOf = (field) => (field === kTime ? costChoice().field : field);

  // The worst value of a configuration, or a text that says why there is none.
  const worstOf = (index, field) => run.configurations[index].worst[fieldOf(field)];
  const costOf = (index) => run.configurations[index][costChoice().field];
  // Of mixed machines, costs are ratios to `none`, which under other settings is another one.
  const areComparable = (a, b) =>
    !run.ratios ||
    costChoice().isEstimate ||
    run.configurations[a.index].surroundings === run.configurations[b.index].surroundings;
  // Whether the cost of one cannot be told from that of another, which ranks behind it.
  const areTied = ({ tied }, { rank }) => tied.some(([from, end]) => from <= rank && rank < end);
  const judge = () => {
    const { order, unjudged } = run.advice[shadowbench.cost][state.wide];
    const judged = { keeping: [], failing: [], unjudged: [...unjudged] };
    const fields = Object.keys(state.limits);
    for (const [rank, { index, tied }] of order.entries()) {
      const gap = fields.map((field) => worstOf(index, field)).find((worst) => typeof worst === "string");
      const broken = fields.filter((field) => worstOf(index, field).value > state.limits[field]);
      if (gap) judged.unjudged.push({ index, gap });
      else (broken.length > 0 ? judged.failing : judged.keeping).push({ index, rank, tied, broken });
    }
    return judged;
  };

  const labelOf = (index) => run.configurations[index].label;
  const say = (value, field) => format(value, limitOf(field).unit);
  const sayWorst = (index, field) =>
    `${say(worstOf(index, field).value, field)} on ${places[worstOf(index, field).place]}`;
  const costText = (index) => `${format(costOf(index))} ${costChoice().unit}`;
  const list = (texts) => (texts.length > 1 ? `${texts.slice(0, -1).join(", ")} and ${texts.at(-1)}` : texts.join());
  const writeCommand = () => {
    const asked = limits.filter(({ field }) => field in state.limits);
    return [
      "shadowbench advise RUN",
      ...asked.map(({ option, field }) => `${option} ${state.limits[field]}`),
      ...(state.wide ? [`--class ${state.wide}`] : []),
      ...(costChoice().option ? [costChoice().option] : []),
    ].join(" ");
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
          ? areErrorsTied(cellAt(best, a.place), cellAt(second, b.place))
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
  const reasons = element(holder, "ul");
  const picture = element(holder, "div", { className: "worst" });
  const line = element(holder, "p", { className: "note" }, "In a terminal: ");
  const code = element(line, "code");
  const controls = element(holder, "form", { className: "limits", "aria-label": "Limits", onsubmit: () => false });
  // An item of the reasons, in which a number stands for a configuration's name.
  const explain = (lead, ...parts) => {
    const item = element(reasons, "li");
    element(item, "b", {}, lead + " ");
    for (const part of parts)
      if (typeof part === "number") element(item, "bdi", {}, labelOf(part));
      else item.append(part);
  };

  let turn = 0;
  const showWorst = async (best) => {
    const mine = ++turn;
    const worst = best === null ? {} : worstOf(best, "error.rmse");
    picture.replaceChildren();
    if (worst.value === undefined) return;
    const { value: shown, message } = await attempt(shadowbench.worstPlace(worst.place, best));
    if (mine !== turn) return;
    if (message) element(picture, "p", { className: "note" }, `There is no picture of the worst place: ${message}`);
    if (!shown) return;
    const addPicture = (canvas, text) => {
      const figure = element(picture, "figure");
      canvas.setAttribute("role", "img");
      const where = `where ${labelOf(best)} is most wrong on ${places[worst.place]}`;
      canvas.setAttribute("aria-label", `${text} ${where}`);
      figure.append(canvas);
      element(element(figure, "figcaption"), "bdi", {}, text);
    };
    addPicture(shown.left, "truth");
    addPicture(shown.right, labelOf(best));
    const view = { place: worst.place, left: kTruth, right: best, layer: "picture", rect: shown.rect };
    addButton(picture, "Look closer", () => shadowbench.openViewer(view));
  };
  const showHeadline = ({ index: best }, tied) => {
    headline.replaceChildren();
    element(headline, "bdi", {}, tied.length > 0 ? labelOf(best) : run.configurations[best].full);
    if (tied.length > 2) headline.append(` and ${tied.length} others`);
    for (const { index } of tied.length > 2 ? [] : tied) {
      headline.append(" or ");
      element(headline, "bdi", {}, labelOf(index));
    }
    if (tied.length > 0) headline.append(": their costs cannot be told apart");
    headline.append(`. ${tied.length > 0 ? "About " : ""}${costText(best)} ${costChoice().said}.`);
  };
  const explainSecond = (best, second) => {
    if (!second) return explain("Runner-up:", "no other keeps the limits.");
    const times = `at ${format(costOf(second.index) / costOf(best.index))} times the cost`;
    const apart = "whose ratio is to another 'none', and is not compared";
    const stands = !areComparable(best, second)
      ? apart
      : areTied(best, second)
        ? "whose cost cannot be told from it"
        : times;
    explain("Runner-up:", second.index, `, ${stands}; ${compareWorst(best.index, second.index)}.`);
  };
  const showChoice = (keeping, failing) => {
    const [best, second] = keeping;
    const tied = keeping.filter((other) => areTied(best, other));
    const configuration = run.configurations[best.index];
    showHeadline(best, tied);
    const smallest = keeping.every((other) => areComparable(best, other)) ? "" : ", on the smallest picture and map,";
    const cheapest = tied.length > 0 ? "it has the lowest mean cost" : "it is the cheapest";
    const lead = run.ratios && !costChoice().isEstimate ? `it has the lowest ratio to 'none'${smallest}` : cheapest;
    const bounds = describeBounds(best.index);
    const judged = Object.keys(state.limits).length > 0 ? "that keep the limits" : "that can be judged";
    explain("Why:", `${lead} of ${keeping.length} ${judged}${bounds.length > 0 ? ": " : ""}${bounds.join("; ")}.`);
    const kernel = configuration.sigma === null ? "of no one width that is known" : configuration.kernel;
    explain("Kernel:", `${kernel}${configuration.params && `; ${configuration.params}`}.`);
    explainSecond(best, second);
    const isCheaper = (other) => areComparable(best, other) && costOf(other.index) < costOf(best.index);
    const cheaper = failing.find((other) => other.broken.length === 1 && isCheaper(other) && !areTied(other, best));
    if (cheaper) {
      const [field] = cheaper.broken;
      const limit = say(worstOf(cheaper.index, field).limit, field);
      const were = `were ${titleOf(field)} of ${limit} allowed`;
      explain("Cheaper:", cheaper.index, `, ${costText(cheaper.index)}, ${were}.`);
    }
    const faults = describeFaults(best.index);
    if (faults.length > 0) explain("Fails at:", `${faults.join("; ")}.`);
    showWorst(best.index);
  };
  // How many times a limit the worst value is, at most; beyond a limit of 0, infinitely.
  const measureExcess = ({ index, broken }) =>
    Math.max(
      ...broken.map((field) =>
        state.limits[field] > 0 ? worstOf(index, field).value / state.limits[field] : Infinity,
      ),
    );
  const showNothing = (failing) => {
    const none = "Nothing can be judged: a value, a time or a scene is missing for every filter.";
    headline.textContent = failing.length > 0 ? "Nothing keeps these limits." : none;
    const [nearest] = failing
      .map((each) => ({ ...each, excess: measureExcess(each) }))
      .sort((a, b) => a.broken.length - b.broken.length || (a.excess === b.excess ? 0 : a.excess - b.excess));
    if (nearest) {
      const { index, broken } = nearest;
      explain(
        "Closest:",
        index,
        ` breaks ${list(broken.map((field) => `${titleOf(field)}, with ${sayWorst(index, field)}`))}.`,
      );
    }
    showWorst(null);
  };
  const show = () => {
    reasons.replaceChildren();
    const { keeping, failing, unjudged } = judge();
    if (keeping.length > 0) showChoice(keeping, failing);
    else showNothing(failing);
    const gaps = new Map(unjudged.map(({ gap }) => [gap, []]));
    for (const { index, gap } of unjudged) gaps.get(gap).push(index);
    for (const [gap, [first, ...others]] of gaps)
      explain("Not judged:", first, others.length > 0 ? ` and ${others.length} more` : "", `: ${gap}.`);
    code.textContent = writeCommand();
  };

  // A slider's steps are the worst values of the run: each step lets one more configuration through.
  const listSteps = (field) => {
    const { order } = run.advice[shadowbench.cost][""];
    const values = order.map(({ index }) => worstOf(index, field).limit).filter((limit) => limit !== undefined);
    if (field in state.limits) values.push(state.limits[field]);
    const steps = [...new Set(values)].sort((a, b) => a - b);
    const every = Math.ceil(steps.length / kSteps);
    return steps.filter((step, i) => i % every === 0 || step === state.limits[field]);
  };
  const addSlider = ({ field, title, text, unit }) => {
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
    limits.filter(({ field }) => canLimit(field)).forEach(addSlider);
  };
  const change = () => {
    const asked = Object.entries(state.limits).map((limit) => limit.join(":"));
    writeLink("limits", [shadowbench.cost, state.wide, ...asked]);
    show();
  };
  const choose = (changes) => {
    Object.assign(state, changes);
    showSliders();
    change();
  };
  const costs = run.costs.map(({ id, title }) => [id, title]);
  const cost = addSelect(controls, "Cost", costs, { name: "cost" }, (value) => {
    shadowbench.cost = value;
    delete state.limits[kTime];
    choose({});
    shadowbench.drawTable?.();
  });
  cost.value = shadowbench.cost;
  const classes = [["", "of any width"], ...run.classes.map((name) => [name, name])];
  const wide = addSelect(controls, "Kernel", classes, { name: "class" }, (value) => choose({ wide: value }));
  const sliders = element(controls, "div", { className: "sliders" });
  const openLink = () => {
    const [id, width, ...asked] = readLink("limits") ?? [];
    if (id === undefined) return;
    if (run.costs.some((each) => each.id === id)) shadowbench.cost = cost.value = id;
    if (width === "" || run.classes.includes(width)) state.wide = wide.value = width;
    const isKnown = ([field, most]) => canLimit(field) && most && Number.isFinite(Number(most));
    const known = asked.map((text) => text.split(":")).filter(isKnown);
    state.limits = Object.fromEntries(known.map(([field, most]) => [field, Number(most)]));
    showSliders();
    show();
    shadowbench.drawTable?.();
  };

  // Of what stood there without the script, the notes stay, at the end.
  const own = [headline, reasons, picture, line, controls];
  const before = [...holder.children].filter((child) => !own.includes(child));
  const notes = before.pop();
  before.forEach((child) => child.remove());
  if (notes) holder.append(notes);
  window.addEventListener("hashchange", openLink);
  showSliders();
  show();
  openLink();
  shadowbench.answer = { judge, state };
};
