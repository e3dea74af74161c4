// The charts of a page, from the JSON block "charts" that write_html() makes: choosing, pointing, saving.
const page = JSON.parse(document.getElementById("charts").textContent);
const kReach = 24;
const kLeastWidth = 380; // of one of several charts, pixels
const kSavedWidth = 1120;

// The saved file does not depend on the window.
const serialize = (chart, hidden) => {
  const { svg } = drawChart(chart, kSavedWidth, hidden, () => {});
  return new XMLSerializer().serializeToString(svg);
};
const save = (blob, name) => {
  const link = element(document.body, "a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  link.remove();
};
const saveSvg = (chart, hidden) =>
  save(new Blob([serialize(chart, hidden)], { type: "image/svg+xml" }), `${chart.id}.svg`);
const savePng = (chart, hidden) => {
  const image = new Image();
  image.onload = () => {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [2 * image.width, 2 * image.height];
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => save(blob, `${chart.id}.png`), "image/png");
  };
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(serialize(chart, hidden))}`;
};

const listLines = (chart, { point, series }) => {
  const say = (axis, [value]) => `${axis.name}: ${format(value)}`;
  if (point.details.length > 0) return point.details;
  return [series.title, say(chart.x, point.x), say(chart.y, point.y)].filter(Boolean);
};

// Shows what is said of the point nearest to the pointer; a click opens the cell behind the point that is shown.
const followPointer = (holder, tip, chart, { svg, hits }) => {
  const openerOf = (hit) => (hit?.point.opens ? window.shadowbench.openCell : undefined);
  const find = ({ clientX, clientY }) => {
    const box = svg.getBoundingClientRect();
    const scale = box.width / Number(svg.getAttribute("width"));
    const away = ({ at: [x, y] }) => Math.hypot(x * scale - (clientX - box.left), y * scale - (clientY - box.top));
    return hits.reduce((best, hit) => (away(hit) < (best ? away(best) : kReach) ? hit : best), null);
  };
  let hit = null;
  const show = (event) => {
    hit = find(event);
    tip.hidden = !hit;
    svg.style.cursor = openerOf(hit) ? "pointer" : "default";
    if (!hit) return;
    tip.replaceChildren();
    for (const line of listLines(chart, hit)) element(tip, "div", {}, line);
    const room = holder.clientWidth - tip.offsetWidth;
    tip.style.left = `${Math.max(0, Math.min(hit.at[0] + 14, room))}px`;
    tip.style.top = `${hit.at[1] + 14}px`;
  };
  svg.addEventListener("pointermove", show);
  svg.addEventListener("pointerdown", show);
  svg.addEventListener("pointerleave", () => (tip.hidden = true));
  svg.addEventListener("click", () => openerOf(hit)?.(hit.point.opens));
};

// Texts and points are packed: see the writer. Left are the points of one group, and those that belong to none.
const unpack = (packed, chosen) => {
  const ends = (value) => (typeof value === "number" ? [value, value, value] : (value ?? [null]));
  const read = ([x, y, label = "", details = [], opens = "", group = ""]) => {
    const texts = (details || []).map((i) => page.texts[i]);
    return { x: ends(x), y: ends(y), label, details: texts, opens, group };
  };
  const isChosen = ({ group }) => !chosen || !group || group === chosen;
  const series = packed.series.map((each) => ({ ...each, points: each.points.map(read).filter(isChosen) }));
  return { ...packed, series };
};

const start = ({ id, charts, selectors }) => {
  const figure = document.getElementById(id);
  const controls = figure.querySelector(".controls");
  const holder = figure.querySelector(".holder");
  const all = charts.flatMap(({ series }) => series);
  const hidden = new Set(all.filter((series) => series.hidden).map(({ title }) => title));
  let shown = []; // without anything to choose all, small, with one key
  let drawn = 0;
  const toggle = (title) => {
    if (!hidden.delete(title)) hidden.add(title);
    draw();
  };
  const draw = () => {
    drawn = holder.clientWidth;
    if (drawn === 0) return; // folded away
    holder.replaceChildren();
    const isOne = shown.length === 1;
    const columns = isOne ? 1 : Math.max(1, Math.floor(drawn / kLeastWidth));
    for (const chart of shown) {
      const box = element(holder, "div", { className: "multiple" });
      const result = drawChart(chart, Math.floor(drawn / columns), hidden, isOne && toggle);
      box.append(result.svg);
      followPointer(box, element(box, "div", { className: "tip", hidden: true }), chart, result);
    }
    if (!isOne) holder.append(drawKey(shown, drawn, hidden, toggle));
  };
  const choose = () => {
    const find = (index, select, i) => index * selectors[i].options.length + Number(select.value);
    const chosen = selects.length > 0 ? [charts[selects.reduce(find, 0)]] : charts;
    shown = chosen.map((each) => unpack(each, width?.value));
    draw();
  };
  const addChoice = (text, options) => addSelect(controls, text, options, {}, choose);
  const selects = selectors.map(({ label, options }) =>
    addChoice(
      label,
      options.map((option, i) => [i, option]),
    ),
  );
  const groups = new Set(all.flatMap(({ points }) => points.map((point) => point[5])).filter(Boolean));
  const classes = [["", "any"], ...[...groups].map((group) => [group, group])];
  const width = groups.size > 1 ? addChoice("width", classes) : null;
  addButton(controls, "Save as SVG", () => shown.forEach((chart) => saveSvg(chart, hidden)));
  addButton(controls, "Save as PNG", () => shown.forEach((chart) => savePng(chart, hidden)));
  // The cost that the page's reader chose anew, where there is a chart of it.
  const follow = (isNew) => {
    selectors.forEach(({ costs }, i) => {
      if (!isNew) return;
      const at = costs.indexOf(shadowbench.cost);
      if (at >= 0) selects[i].value = at;
    });
    choose();
  };
  follow(true);
  new ResizeObserver(() => holder.clientWidth !== drawn && draw()).observe(holder);
  return follow;
};
const followers = page.charts.map(start);
let followed = shadowbench.cost;
shadowbench.drawCharts = () => {
  const isNew = shadowbench.cost !== followed;
  followed = shadowbench.cost;
  followers.forEach((follow) => follow(isNew));
};
