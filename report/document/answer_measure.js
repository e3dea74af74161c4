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
