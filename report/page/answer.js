"use strict";
// The answer on top of a run's page: the cheapest configuration within the limits that the reader moves. It judges as
// `shadowbench advise` does, whose command stands below it.
(() => {
  const holder = document.querySelector(".answer"), shadowbench = window.shadowbench, { element, format, link } = shadowbench;
  if (!holder || !shadowbench.data) return;
  const { run } = shadowbench.data;
  const kSteps = 60, kTime = "time_ms", kSeen = 0.001;
  // The shortest number of three digits that a value keeps as a limit; a whole number itself.
  const roundUp = (value) => {
    const short = Number(value.toPrecision(3));
    if (Number.isInteger(value)) return value;
    return short >= value ? short : Number((short + 10 ** (Math.floor(Math.log10(Math.abs(value))) - 2)).toPrecision(3));
  };
  const places = run.places.map((place) => place.title);
  const cellsOf = run.configurations.map(() => []);
  for (const cell of run.cells) cellsOf[cell.configuration].push(cell);

  const state = { wide: "", limits: {} };
  for (const [field, most] of Object.entries(run.limits)) state.limits[field] = most;
  const fieldOf = (field) => (field === kTime ? `${kTime}.${shadowbench.light}` : field);
  const limits = run.measures.filter((measure) => measure.option && measure.id !== `${kTime}.still`)
    .map((measure) => ({ ...measure, field: measure.option === "--max-ms" ? kTime : measure.id, title: measure.option === "--max-ms" ? "time of a frame" : measure.title }));

  const isAsked = ({ teaching, class: width }) => !teaching && (!state.wide || width === state.wide);
  const valueOf = (cell, field) => cell.values_of[fieldOf(field)];
  // The worst value of a configuration, and where; null where there is nothing to see anywhere.
  const findWorst = (index, field) => {
    const told = cellsOf[index].filter((cell) => valueOf(cell, field) !== null);
    const worst = told.reduce((most, cell) => (most === null || valueOf(cell, field) > valueOf(most, field) ? cell : most), null);
    return worst && { value: valueOf(worst, field), cell: worst };
  };
  // Why a configuration cannot be said to keep limits; empty where it can. `asked` are the places that count.
  const findGap = (index, asked, fields) => {
    const cells = cellsOf[index];
    for (const place of asked) {
      const cell = cells.find((each) => each.place === place);
      if (!cell) return `not measured on ${places[place]}`;
      if (cell.status !== "ok") return `${cell.status}, on ${places[place]}`;
    }
    for (const field of [...fields, kTime]) {
      const title = titleOf(field), missing = cells.find((cell) => valueOf(cell, field) === null && !cell.nothing.includes(field));
      if (missing) return `no ${title} on ${places[missing.place]}`;
      if (!findWorst(index, field)) return `nothing on which ${title} could show`;
    }
    return "";
  };
  const listAsked = () => [...new Set(run.cells.filter((cell) => isAsked(run.configurations[cell.configuration])).map((cell) => cell.place))];
  const costOf = (index) => run.configurations[index][fieldOf(kTime)];
  const areAlike = (a, b) => run.configurations[a].surroundings === run.configurations[b].surroundings;
  // Of mixed machines, costs are ratios to `none`, which under other settings is another one.
  const areComparable = (a, b) => !run.ratios || areAlike(a, b);
  const areTied = (a, b) => {
    const common = costOf(a).ci95 && costOf(b).ci95 && areAlike(a, b);
    const name = common ? "ci95" : "quartiles";
    return costOf(a)[name][1] >= costOf(b)[name][0];
  };
  const judge = () => {
    const keeping = [], failing = [], unjudged = [], asked = listAsked(), fields = Object.keys(state.limits);
    run.configurations.forEach((configuration, index) => {
      if (!isAsked(configuration)) return;
      const gap = findGap(index, asked, fields);
      if (gap) return unjudged.push({ index, gap });
      const broken = fields.map((field) => ({ field, worst: findWorst(index, field), most: state.limits[field] })).filter(({ worst, most }) => worst.value > most);
      (broken.length > 0 ? failing : keeping).push({ index, broken });
    });
    const sizeOf = ({ index }, by) => (run.ratios ? run.configurations[index][by] : 0);
    const byCost = (a, b) => sizeOf(a, "pixels") - sizeOf(b, "pixels") || sizeOf(a, "map") - sizeOf(b, "map") || costOf(a.index).mean - costOf(b.index).mean;
    return { keeping: keeping.sort(byCost), failing: failing.sort(byCost), unjudged };
  };

  const labelOf = (index) => run.configurations[index].label;
  const nameOf = (parent, index) => element(parent, "bdi", {}, labelOf(index));
  const limitOf = (field) => limits.find((limit) => limit.field === field);
  const titleOf = (field) => limitOf(field)?.title ?? "time of a frame";
  const say = (value, field) => format(value, limitOf(field)?.unit);
  const costText = (index) => `${format(costOf(index).mean)} ${run.unit}`;

  const command = () => {
    const parts = ["shadowbench advise RUN"];
    for (const limit of limits)
      if (limit.field in state.limits) parts.push(`${limit.option} ${state.limits[limit.field]}`);
    if (state.wide) parts.push(`--class ${state.wide}`);
    if (shadowbench.light === "still") parts.push("--light static");
    return parts.join(" ");
  };

  const list = (texts) => (texts.length > 1 ? `${texts.slice(0, -1).join(", ")} and ${texts.at(-1)}` : texts.join());
  // How the worst of what can be limited differs between the choice and the runner-up.
  const compareWorst = (best, second) => {
    const lower = [], higher = [];
    for (const { field, group, title } of limits) {
      const a = findWorst(best, field), b = findWorst(second, field);
      if (group === "cost" || !a || !b) continue;
      const least = field === "error.rmse" ? Math.max(a.cell.reach, b.cell.reach) : group === "artefact" ? kSeen : 0.02 * Math.max(a.value, b.value);
      if (Math.abs(b.value - a.value) > least) (b.value < a.value ? lower : higher).push(`${title} ${say(b.value, field)} instead of ${say(a.value, field)}`);
    }
    const parts = [["lower", lower], ["higher", higher]].filter(([, found]) => found.length > 0).map(([word, found]) => `${word} ${list(found)}`);
    return parts.length > 0 ? `at worst it has ${parts.join("; and ")}` : "at worst nothing that can be limited differs clearly";
  };
  // The faults of the choice: those that are seen, those that are not, and those that nobody could see.
  const describeFaults = (best) => {
    const faults = limits.filter(({ group }) => group === "artefact").map(({ field, title }) => ({ field, title, worst: findWorst(best, field) }));
    const seen = faults.filter(({ worst }) => worst && worst.value >= kSeen), free = faults.filter(({ worst }) => worst && worst.value < kSeen);
    const unknown = faults.filter(({ worst }) => !worst), titles = (some, word) => some.map(({ title }) => title).join(` ${word} `);
    return [...seen.map(({ field, title, worst }) => `${title} ${say(worst.value, field)} on ${places[worst.cell.place]}`),
      free.length > 0 && `no ${titles(free, "or")} is seen`, unknown.length > 0 && `${titles(unknown, "and")} could not be measured`].filter(Boolean);
  };
  // Where a limit of the choice had nothing to be judged on.
  const listUnseen = (best) => Object.keys(state.limits).map((field) => {
    const blind = cellsOf[best].filter((cell) => valueOf(cell, field) === null);
    return blind.length > 0 && `${titleOf(field)} had nothing to show on ${list(blind.map((cell) => places[cell.place]))}`;
  }).filter(Boolean);

  // An item of the reasons, in which a number stands for a configuration's name.
  const explain = (lead, ...parts) => {
    const item = element(reasons, "li");
    element(item, "b", {}, lead + " ");
    parts.forEach((part) => (typeof part === "number" ? nameOf(item, part) : item.append(part)));
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
    const best = keeping[0].index, tied = keeping.slice(1).filter((other) => areComparable(best, other.index) && areTied(best, other.index)).map((other) => other.index);
    headline.replaceChildren();
    element(headline, "bdi", {}, tied.length > 0 ? labelOf(best) : run.configurations[best].full);
    if (tied.length > 0) {
      headline.append(tied.length > 2 ? ` and ${tied.length} others` : "");
      if (tied.length <= 2) tied.forEach((index) => { headline.append(" or "); nameOf(headline, index); });
      headline.append(": their costs cannot be told apart");
    }
    headline.append(`. ${tied.length > 0 ? "About " : ""}${costText(best)} a frame with a ${shadowbench.light} light.`);
    const configuration = run.configurations[best];
    const bounds = Object.entries(state.limits).map(([field, most]) => {
      const { value, cell } = findWorst(best, field);
      return `${titleOf(field)} ${say(value, field)} at worst, on ${places[cell.place]} (limit ${say(most, field)})`;
    });
    const smallest = keeping.every((other) => areComparable(best, other.index)) ? "" : ", on the smallest picture and map,";
    const lead = run.ratios ? `it has the lowest ratio to 'none'${smallest}` : tied.length > 0 ? "it has the lowest mean cost" : "it is the cheapest";
    explain("Why:", `${lead} of ${keeping.length} ${bounds.length > 0 ? "that keep the limits" : "that can be judged"}`, ...[...bounds, ...listUnseen(best)].map((text, i) => (i === 0 ? ": " : "; ") + text), ".");
    explain("Kernel:", `${configuration.sigma === null ? "of no one width that is known" : configuration.kernel}${configuration.params ? "; " + configuration.params : ""}.`);
    if (keeping.length > 1) {
      const second = keeping[1].index, more = costOf(second).mean / costOf(best).mean;
      explain("Runner-up:", second, !areComparable(best, second) ? ", whose ratio is to another 'none', and is not compared; " : tied.includes(second) ? ", whose cost cannot be told from it; " : `, at ${format(more)} times the cost; `, compareWorst(best, second) + ".");
    } else explain("Runner-up:", "no other keeps the limits.");
    const cheaper = failing.find((other) => other.broken.length === 1 && areComparable(best, other.index) && costOf(other.index).mean < costOf(best).mean && !areTied(other.index, best));
    if (cheaper) {
      const [only] = cheaper.broken;
      explain("Cheaper:", cheaper.index, `, ${costText(cheaper.index)}, were ${titleOf(only.field)} of ${say(roundUp(only.worst.value), only.field)} allowed.`);
    }
    const worst = findWorst(best, "error.rmse"), faults = describeFaults(best);
    if (worst) explain("Fails at:", [`${places[worst.cell.place]}, with RMSE ${format(worst.value)}${worst.cell.cause ? `, most of it ${worst.cell.cause}` : ""}`, ...faults].join("; "), ".");
    showWorst(best);
  };
  // How many times a limit the worst value is, at most; beyond a limit of 0, infinitely.
  const measureExcess = ({ broken }) => Math.max(...broken.map(({ worst, most }) => (most > 0 ? worst.value / most : Infinity)));
  const showNothing = (failing) => {
    headline.textContent = failing.length > 0 ? "Nothing keeps these limits." : "Nothing can be judged: a value, a time or a scene is missing for every filter.";
    const isNearer = (a, b) => a.broken.length < b.broken.length || (a.broken.length === b.broken.length && measureExcess(a) < measureExcess(b));
    const nearest = failing.reduce((least, each) => (least && !isNearer(each, least) ? least : each), null);
    if (nearest)
      explain("Closest:", nearest.index, ` breaks ${list(nearest.broken.map(({ field, worst }) => `${titleOf(field)}, with ${say(worst.value, field)} on ${places[worst.cell.place]}`))}.`);
    showWorst.last = null;
    picture.replaceChildren();
  };
  const show = () => {
    reasons.replaceChildren();
    const { keeping, failing, unjudged } = judge(), gaps = new Map();
    if (keeping.length > 0) showChoice(keeping, failing);
    else showNothing(failing);
    for (const { index, gap } of unjudged) gaps.set(gap, [...(gaps.get(gap) ?? []), index]);
    for (const [gap, [first, ...others]] of gaps) explain("Not judged:", first, others.length > 0 ? ` and ${others.length} more` : "", `: ${gap}.`);
    code.textContent = command();
  };

  // A slider's steps are the worst values of the run: each step lets one more configuration through.
  const addSlider = (limit, asked) => {
    const values = run.configurations.map((each, index) => (each.teaching || findGap(index, asked, [limit.field]) ? null : findWorst(index, limit.field))).filter(Boolean).map((worst) => roundUp(worst.value));
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
      output.textContent = most === undefined ? "no limit" : `at most ${format(most, limit.unit)}`;
      slider.setAttribute("aria-valuetext", output.textContent);
    };
    slider.addEventListener("input", () => { read(); change(); });
    read();
  };
  const addChoice = (text, name, options, take) => {
    const label = element(controls, "label");
    element(label, "span", {}, text);
    const select = element(label, "select", { name });
    for (const [value, title] of options) element(select, "option", { value }, title);
    select.addEventListener("change", () => { take(select.value); showSliders(); change(); });
    return select;
  };
  const showSliders = () => { sliders.replaceChildren(); limits.forEach((limit) => addSlider(limit, listAsked())); };
  [...holder.children].forEach((child) => { if (![headline, reasons, picture, line, controls].includes(child)) child.classList.add("without-script"); });
  const notes = holder.querySelectorAll(".without-script");
  notes.forEach((each) => { if (each !== notes[notes.length - 1]) each.remove(); });
  if (notes.length > 0) holder.append(notes[notes.length - 1]);
  line.prepend("In a terminal: ");
  const kLights = [["moving", "moving: map and prefilter in every frame"], ["still", "still: the lookup alone"]];
  const light = addChoice("Light ", "light", kLights, (value) => { shadowbench.light = value; delete state.limits[kTime]; shadowbench.drawTable?.(); });
  const wide = addChoice("Kernel ", "class", [["", "of any width"], ...run.classes.map((name) => [name, name])], (value) => { state.wide = value; });
  const sliders = element(controls, "div", { className: "sliders" });
  const change = () => {
    link.write("limits", [shadowbench.light, state.wide, ...Object.entries(state.limits).map((limit) => limit.join(":"))]);
    show();
  };
  const openLink = () => {
    const [motion, width, ...asked] = link.read("limits") ?? [];
    if (motion === undefined) return;
    if (kLights.some(([name]) => name === motion)) shadowbench.light = light.value = motion;
    if (width === "" || run.classes.includes(width)) state.wide = wide.value = width;
    const known = asked.map((text) => text.split(":")).filter(([field, most]) => limits.some((limit) => limit.field === field) && most && Number.isFinite(Number(most)));
    state.limits = Object.fromEntries(known.map(([field, most]) => [field, Number(most)]));
    showSliders();
    show();
    shadowbench.drawTable?.();
  };
  window.addEventListener("hashchange", openLink);
  showSliders();
  show();
  openLink();
  shadowbench.answer = { judge, state };
})();
