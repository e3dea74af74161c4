"use strict";
// The answer on top of a run's page: the cheapest configuration within the limits that the reader moves. It judges as
// `shadowbench advise` does, whose command stands below it.
(() => {
  const holder = document.querySelector(".answer"), shadowbench = window.shadowbench, { element } = shadowbench;
  if (!holder || !shadowbench.data) return;
  const { run } = shadowbench.data;
  const kDigits = 3, kSteps = 60, kTime = "time_ms";
  const number = (value) => {
    const text = Number(value.toPrecision(kDigits));
    return Math.abs(text) >= 1e6 ? text.toLocaleString("en") : String(text);
  };
  // The shortest number of three digits that a value keeps as a limit.
  const roundUp = (value) => {
    const short = Number(value.toPrecision(kDigits));
    if (short >= value || value === 0) return short;
    return Number((short + 10 ** (Math.floor(Math.log10(Math.abs(value))) - kDigits + 1)).toPrecision(kDigits));
  };
  const places = run.places.map((place) => place.title);
  const cellsOf = run.configurations.map(() => []);
  for (const cell of run.cells) cellsOf[cell.configuration].push(cell);

  const state = { light: "moving", wide: "", limits: {} };
  for (const [field, most] of Object.entries(run.limits)) state.limits[field] = most;
  const fieldOf = (field) => (field === kTime ? `${kTime}.${state.light}` : field);
  const limits = run.measures.filter((measure) => measure.option && measure.id !== `${kTime}.still`)
    .map((measure) => ({ ...measure, field: measure.option === "--max-ms" ? kTime : measure.id, title: measure.option === "--max-ms" ? "time of a frame" : measure.title }));

  // The worst value of a configuration, where; null where it cannot be judged.
  const findWorst = (index, field) => {
    let worst = null;
    for (const cell of cellsOf[index]) {
      const value = cell.values_of[fieldOf(field)];
      if (value === null && cell.nothing.includes(field)) continue;
      if (value === null) return null;
      if (!worst || value > worst.value) worst = { value, cell };
    }
    return worst;
  };
  const canBeJudged = (index) => {
    const configuration = run.configurations[index], cells = cellsOf[index];
    return !configuration.teaching && cells.length === places.length && cells.every((cell) => cell.status === "ok") && costOf(index) !== null;
  };
  const costOf = (index) => run.configurations[index][fieldOf(kTime)];
  const areTied = (a, b) => {
    const common = costOf(a).ci95 && costOf(b).ci95 && run.configurations[a].surroundings === run.configurations[b].surroundings;
    const name = common ? "ci95" : "quartiles";
    return costOf(a)[name][1] >= costOf(b)[name][0];
  };
  const judge = () => {
    const keeping = [], failing = [];
    run.configurations.forEach((configuration, index) => {
      if (!canBeJudged(index) || (state.wide && configuration.class !== state.wide)) return;
      const broken = [];
      for (const [field, most] of Object.entries(state.limits)) {
        const worst = findWorst(index, field);
        if (!worst) return;
        if (worst.value > most) broken.push({ field, worst, most });
      }
      (broken.length > 0 ? failing : keeping).push({ index, broken });
    });
    const byCost = (a, b) => costOf(a.index).mean - costOf(b.index).mean;
    return { keeping: keeping.sort(byCost), failing: failing.sort(byCost) };
  };

  const labelOf = (index) => run.configurations[index].label;
  const nameOf = (parent, index) => element(parent, "bdi", {}, labelOf(index));
  const titleOf = (field) => limits.find((limit) => limit.field === field).title;
  const costText = (index) => `${number(costOf(index).mean)} ${run.unit}`;

  const command = () => {
    const parts = ["shadowbench advise RUN"];
    for (const limit of limits)
      if (limit.field in state.limits) parts.push(`${limit.option} ${state.limits[limit.field]}`);
    if (state.wide) parts.push(`--class ${state.wide}`);
    if (state.light === "still") parts.push("--light static");
    return parts.join(" ");
  };

  // What the runner-up does better than the choice, of what can be limited.
  const describeGain = (best, second) => {
    const gains = [];
    for (const limit of limits) {
      if (limit.group === "cost") continue;
      const a = findWorst(best, limit.field), b = findWorst(second, limit.field);
      if (!a || !b) continue;
      const least = limit.id === "error.rmse" ? Math.max(a.cell.reach, b.cell.reach) : limit.group === "artefact" ? 0.001 : 0.02 * a.value;
      if (b.value < a.value - least)
        gains.push(`${limit.title} ${number(b.value)} instead of ${number(a.value)} at worst`);
    }
    return gains.length > 0 ? `it would buy ${gains.slice(0, 3).join(", ")}` : "it would buy nothing that was measured";
  };
  const describeFaults = (best) => {
    const faults = limits.filter((limit) => limit.group === "artefact")
      .map((limit) => ({ limit, worst: findWorst(best, limit.field) })).filter(({ worst }) => worst && worst.value >= 0.001);
    return faults.map(({ limit, worst }) => `${limit.title} ${number(100 * worst.value)} % on ${places[worst.cell.place]}`);
  };

  const sentences = (list, parts) => parts.forEach((part) => typeof part === "number" ? nameOf(list, part) : list.append(part));
  const say = (list, lead, ...parts) => {
    const item = element(list, "li");
    element(item, "b", {}, lead + " ");
    sentences(item, parts);
  };
  const headline = element(holder, "p", { className: "choice", "aria-live": "polite" });
  const reasons = element(holder, "ul"), picture = element(holder, "div", { className: "worst" });
  const line = element(holder, "p", { className: "note" });
  const code = element(line, "code");
  const controls = element(holder, "form", { className: "limits", "aria-label": "Limits", onsubmit: () => false });

  const showWorst = async (best) => {
    const worst = findWorst(best, "error.rmse");
    picture.replaceChildren();
    if (!worst) return;
    const asked = (showWorst.last = {});
    try {
      const shown = await shadowbench.worstPlace(worst.cell.place, best);
      if (asked !== showWorst.last) return;
      const open = () => shadowbench.openViewer({ place: worst.cell.place, left: -1, right: best, layer: "picture", rect: shown.rect });
      for (const [canvas, text] of [[shown.left, "truth"], [shown.right, labelOf(best)]]) {
        const figure = element(picture, "figure");
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", `${text} where ${labelOf(best)} is most wrong on ${places[worst.cell.place]}`);
        figure.append(canvas);
        element(element(figure, "figcaption"), "bdi", {}, text);
      }
      element(picture, "button", { type: "button", onclick: open }, "Look closer");
    } catch (error) {
      if (asked === showWorst.last) element(picture, "p", { className: "note" }, `There is no picture of the worst place: ${error.message}`);
    }
  };

  const showChoice = (keeping, failing) => {
    const best = keeping[0].index, tied = keeping.slice(1).filter((other) => areTied(best, other.index)).map((other) => other.index);
    headline.replaceChildren();
    element(headline, "bdi", {}, tied.length > 0 ? labelOf(best) : run.configurations[best].full);
    if (tied.length > 0) {
      headline.append(tied.length > 2 ? ` and ${tied.length} others` : "");
      if (tied.length <= 2) tied.forEach((index) => { headline.append(" or "); nameOf(headline, index); });
      headline.append(": their costs cannot be told apart");
    }
    headline.append(`. ${tied.length > 0 ? "About " : ""}${costText(best)} a frame with a ${state.light} light.`);
    const configuration = run.configurations[best];
    const bounds = Object.entries(state.limits).map(([field, most]) => {
      const worst = findWorst(best, field);
      return `${titleOf(field)} ${number(worst.value)} at worst, on ${places[worst.cell.place]} (limit ${most})`;
    });
    say(reasons, "Why:", `it is the cheapest of ${keeping.length} that keep the limits`, bounds.length > 0 ? `: ${bounds.join("; ")}.` : ".");
    say(reasons, "Kernel:", `${configuration.kernel}${configuration.params ? "; " + configuration.params : ""}.`);
    if (keeping.length > 1) {
      const second = keeping[1].index, more = costOf(second).mean / costOf(best).mean;
      say(reasons, "Runner-up:", second, tied.includes(second) ? `, whose cost cannot be told from it; ` : `, at ${number(more)} times the cost; `, describeGain(best, second) + ".");
    } else say(reasons, "Runner-up:", "no other keeps the limits.");
    const cheaper = failing.find((other) => other.broken.length === 1 && costOf(other.index).mean < costOf(best).mean && !areTied(other.index, best));
    if (cheaper) {
      const [only] = cheaper.broken;
      say(reasons, "Cheaper:", cheaper.index, `, ${costText(cheaper.index)}, were ${titleOf(only.field)} of ${roundUp(only.worst.value)} allowed.`);
    }
    const worst = findWorst(best, "error.rmse"), faults = describeFaults(best);
    if (worst)
      say(reasons, "Fails at:", `${places[worst.cell.place]}, with RMSE ${number(worst.value)}`, worst.cell.cause ? `, most of it ${worst.cell.cause}` : "",
        faults.length > 0 ? `; ${faults.join(", ")}.` : "; no fault is seen.");
    showWorst(best);
  };
  const showNothing = (failing) => {
    headline.textContent = failing.length > 0 ? "Nothing keeps these limits." : "Nothing can be judged: a value, a time or a scene is missing for every filter.";
    const nearest = failing.slice().sort((a, b) => a.broken.length - b.broken.length || a.broken[0].worst.value / a.broken[0].most - b.broken[0].worst.value / b.broken[0].most)[0];
    if (nearest)
      say(reasons, "Closest:", nearest.index, ` breaks ${nearest.broken.map((each) => `${titleOf(each.field)}: ${number(each.worst.value)} on ${places[each.worst.cell.place]}`).join(", ")}.`);
    showWorst.last = null;
    picture.replaceChildren();
  };
  const show = () => {
    reasons.replaceChildren();
    const { keeping, failing } = judge();
    if (keeping.length > 0) showChoice(keeping, failing);
    else showNothing(failing);
    code.textContent = command();
  };

  // A slider's steps are the worst values of the run: each step lets one more configuration through.
  const addSlider = (limit) => {
    const values = run.configurations.map((_, index) => (canBeJudged(index) ? findWorst(index, limit.field) : null)).filter(Boolean).map((worst) => roundUp(worst.value));
    if (limit.field in state.limits) values.push(state.limits[limit.field]);
    let steps = [...new Set(values)].sort((a, b) => a - b);
    if (steps.length < 2 && !(limit.field in state.limits)) return;
    if (steps.length > kSteps) steps = steps.filter((_, i) => i % Math.ceil(steps.length / kSteps) === 0 || steps[i] === state.limits[limit.field]);
    const label = element(sliders, "label", { title: limit.text });
    element(label, "span", {}, `${limit.title}${limit.field === kTime ? ", " + limit.unit : ""}: `);
    const output = element(label.firstChild, "output");
    const slider = element(label, "input", { type: "range", min: 0, max: steps.length, step: 1, name: limit.field });
    slider.value = limit.field in state.limits ? steps.indexOf(state.limits[limit.field]) : steps.length;
    const read = () => {
      const most = steps[Number(slider.value)];
      if (most === undefined) delete state.limits[limit.field];
      else state.limits[limit.field] = most;
      output.textContent = most === undefined ? "no limit" : `at most ${limit.unit === "share" ? number(100 * most) + " %" : number(most)}`;
      slider.setAttribute("aria-valuetext", output.textContent);
    };
    slider.addEventListener("input", () => { read(); show(); });
    read();
  };
  const addChoice = (text, name, options, take) => {
    const label = element(controls, "label");
    element(label, "span", {}, text);
    const select = element(label, "select", { name });
    for (const [value, title] of options) element(select, "option", { value }, title);
    select.addEventListener("change", () => { take(select.value); showSliders(); show(); });
  };
  const showSliders = () => { sliders.replaceChildren(); limits.forEach(addSlider); };
  [...holder.children].forEach((child) => { if (![headline, reasons, picture, line, controls].includes(child)) child.classList.add("without-script"); });
  const notes = holder.querySelectorAll(".without-script");
  notes.forEach((each) => { if (each !== notes[notes.length - 1]) each.remove(); });
  if (notes.length > 0) holder.append(notes[notes.length - 1]);
  line.prepend("In a terminal: ");
  addChoice("Light ", "light", [["moving", "moving: map and prefilter in every frame"], ["still", "still: the lookup alone"]], (value) => { state.light = value; delete state.limits[kTime]; });
  addChoice("Kernel ", "class", [["", "of any width"], ...run.classes.map((name) => [name, name])], (value) => { state.wide = value; });
  const sliders = element(controls, "div", { className: "sliders" });
  showSliders();
  show();
  shadowbench.answer = { judge, state };
})();
