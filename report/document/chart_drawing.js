// Draws one chart as SVG.
const kFont = '"DejaVu Sans", Verdana, sans-serif';
const kSize = 13;
const kLine = 18;
const kInk = "#1c1f24";
const kSecond = "#545a63";
const kGrid = "#e2e4e8";
const kPaper = "#ffffff";
const kAccent = "#0b57d0";
const kFaint = 0.55;
const kManyLabels = 60;
const kAcross = [-1, 1, 1, -1, 0, 0, 1, -1];
const kDown = [-1, -1, 1, 1, -1, 1, 0, 0];
const kLines = {
  steps: { "stroke-width": 1 },
  dashed: { "stroke-dasharray": "6 4" },
  ties: { "stroke-dasharray": "2 3" },
};
const kMarks = {
  circle: (r) => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0z`,
  square: (r) => `M${-r},${-r}h${2 * r}v${2 * r}h${-2 * r}z`,
  triangle: (r) => `M0,${-r}L${r},${r}L${-r},${r}z`,
  diamond: (r) => `M0,${-r - 1}L${r + 1},0L0,${r + 1}L${-r - 1},0z`,
  down: (r) => `M0,${r}L${r},${-r}L${-r},${-r}z`,
};

let clips = 0;
const ruler = document.createElement("canvas").getContext("2d");
ruler.font = `${kSize}px ${kFont}`;
const widthOf = (text) => ruler.measureText(text).width;

const svgElement = (parent, name, attributes, text) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  const short = (value) => (typeof value === "number" ? Math.round(value * 100) / 100 : value);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, short(value));
  if (text !== undefined) made.textContent = text;
  parent?.append(made);
  return made;
};
const addPath = (parent, d, stroke, attributes = {}) =>
  svgElement(parent, "path", { d, stroke, fill: "none", ...attributes });
// Text whose middle is at a height.
const addText = (parent, x, y, text, attributes = {}) =>
  svgElement(parent, "text", { x, y: y + kSize * 0.35, ...attributes }, text);
const addMark = (parent, { mark, color, filled }, x, y) =>
  addPath(parent, kMarks[mark](5), color, {
    transform: `translate(${x.toFixed(2)},${y.toFixed(2)})`,
    "stroke-width": 1.5,
    fill: filled ? color : "none",
  });

// Breaks a text into lines of at most a width.
const wrap = (text, width) => {
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = lines.length > 0 ? `${lines.at(-1)} ${word}` : word;
    if (lines.length > 0 && widthOf(longer) <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
};

// From values to pixels.
const makeScale = (axis, from, to) => {
  const place = axis.log ? Math.log : (value) => value;
  const [low, high] = [axis.low, axis.high].map(place);
  const slack = 1e-6 * Math.abs(axis.high - axis.low);
  const scale = (value) => from + ((to - from) * (place(value) - low)) / (high - low);
  scale.clamped = (value) => scale(Math.min(Math.max(value, axis.low), axis.high));
  scale.can = (value) => value !== null && (!axis.log || value > 0);
  scale.holds = (value) => value >= axis.low - (axis.log ? 0 : slack) && value <= axis.high + slack;
  return scale;
};

// The axis between the ticks around what is shown, so that hidden curves take no room.
const fitAxis = (axis, shown) => {
  const values = shown.flatMap(({ points }) => points.flatMap(({ y }) => y)).filter((value) => value !== null);
  const low = axis.ticks.findLast(([tick]) => tick <= Math.min(...values))?.[0] ?? axis.low;
  const high = axis.ticks.find(([tick]) => tick >= Math.max(...values))?.[0] ?? axis.high;
  return low < high ? { ...axis, low, high, ticks: axis.ticks.filter(([tick]) => tick >= low && tick <= high) } : axis;
};

const addAxes = (svg, chart, x, y, area, width) => {
  const taken = [];
  for (const [value, label] of chart.x.ticks) {
    const half = widthOf(label) / 2;
    const middle = Math.min(Math.max(x(value), half + 2), width - half - 2);
    addPath(svg, `M${x(value).toFixed(2)},${area.top}V${area.bottom + 5}`, kGrid);
    if (taken.some((end) => middle - half < end + 8)) continue;
    taken.push(middle + half);
    svgElement(svg, "text", { x: middle, y: area.bottom + kLine, "text-anchor": "middle" }, label);
  }
  let last = Infinity;
  for (const [value, label] of chart.y.ticks) {
    addPath(svg, `M${area.left - 5},${y(value).toFixed(2)}H${area.right}`, kGrid);
    if (last - y(value) < kSize + 2) continue;
    last = y(value);
    addText(svg, area.left - 8, last, label, { "text-anchor": "end" });
  }
  addPath(svg, `M${area.left},${area.top}V${area.bottom}H${area.right}`, kInk);
};

// How a line runs through points; ties join each point with the one after it, in pairs.
const pathOf = (line, points) => {
  const step = ([px, py], i) => {
    const [x, y] = [px.toFixed(2), py.toFixed(2)];
    if (i === 0 || (line === "ties" && i % 2 === 0)) return `M${x},${y}`;
    return line === "steps" ? `H${x}V${y}` : `L${x},${y}`;
  };
  return points.map(step).join("");
};

const addWhiskers = (parent, point, x, y, color) => {
  const [px, py] = [x(point.x[0]), y(point.y[0])];
  const [left, right] = point.x.slice(1).map(x.clamped);
  const [low, high] = point.y.slice(1).map(y.clamped);
  const across = `M${left},${py}H${right}M${left},${py - 3}v6M${right},${py - 3}v6`;
  const along = `M${px},${low}V${high}M${px - 3},${low}h6M${px - 3},${high}h6`;
  if (point.x[1] !== point.x[2]) addPath(parent, across, color);
  if (point.y[1] !== point.y[2]) addPath(parent, along, color);
};

// Puts labels beside their points, where they cover neither marks nor each other, a far one with a line to its point;
// what says most comes first.
const addLabels = (svg, labels, marks, area) => {
  const boxes = marks.map(([px, py]) => [px - 6, py - 6, px + 6, py + 6]);
  const isInside = ([left, top, right, bottom]) =>
    left >= area.left && right <= area.right && top >= area.top && bottom <= area.bottom;
  const areApart = (a, b) => a[2] <= b[0] || a[0] >= b[2] || a[3] <= b[1] || a[1] >= b[3];
  for (const [px, py, label] of labels.sort((a, b) => a[3] - b[3])) {
    const half = widthOf(label) / 2;
    const boxAt = (i, away) => {
      const [cx, cy] = [px + kAcross[i] * (away + half), py + kDown[i] * (away + 2)];
      return [cx - half, cy - kSize / 2, cx + half, cy + kSize / 2];
    };
    const places = (labels.length > kManyLabels ? [10] : [10, 20, 36, 52]).flatMap((away) =>
      kAcross.map((_, i) => boxAt(i, away)),
    );
    const at = places.findIndex((each) => isInside(each) && boxes.every((other) => areApart(each, other)));
    if (at < 0) continue; // the pointer still finds it
    const box = places[at];
    boxes.push(box);
    const [left, top, right, bottom] = box;
    const end = [Math.min(Math.max(px, left), right), Math.min(Math.max(py, top), bottom)];
    if (at >= 2 * kAcross.length) addPath(svg, `M${px},${py}L${end}`, kSecond, { "stroke-width": 0.7 });
    const halo = { "text-anchor": "middle", stroke: kPaper, "stroke-width": 3, "paint-order": "stroke" };
    addText(svg, (box[0] + box[2]) / 2, (box[1] + box[3]) / 2, label, halo);
  }
};

// The key, then the notes, in rows below the plot; returns where they end.
const addKey = (svg, chart, top, width, hidden, onToggle) => {
  let left = 12;
  let y = top;
  const addLines = (parent, text, indent, attributes) => {
    const lines = wrap(text, width - 24 - indent);
    const room = Math.max(...lines.map(widthOf)) + indent;
    if (left > 12 && left + room > width - 8) [left, y] = [12, y + kLine];
    const at = { x: left, y };
    lines.forEach((line, i) => addText(parent, left + indent, y + i * kLine, line, attributes));
    left += room + 20;
    y += (lines.length - 1) * kLine;
    return at;
  };
  const entries = chart.series.filter(({ title, points }) => title && points.length > 0);
  for (const series of entries) {
    const group = svgElement(svg, "g", { opacity: hidden.has(series.title) ? 0.3 : 1, class: "key" });
    const at = addLines(group, series.title, 34, {});
    const line = { "stroke-width": 1.6, ...kLines[series.line] };
    if (series.line !== "none") addPath(group, `M${at.x},${at.y}h26`, series.color, line);
    if (series.mark !== "none") addMark(group, series, at.x + 13, at.y);
    group.addEventListener("click", () => onToggle(series.title));
  }
  if (entries.length > 0) [left, y] = [12, y + kLine + 4];
  for (const note of chart.notes) addLines(svg, note, 0, { fill: kSecond });
  return chart.notes.length > 0 ? y + kLine : y;
};

// A series without a title is shown and hidden with the titled one before it.
const listShown = (chart, hidden) => {
  let title = "";
  return chart.series.filter((series) => {
    title = series.title || title;
    return !hidden.has(title);
  });
};

// Begins an SVG on paper; `end` gives it its height.
const beginSvg = (title, width) => {
  const font = { "font-family": kFont, "font-size": kSize, fill: kInk };
  const name = { xmlns: "http://www.w3.org/2000/svg", role: "img", "aria-label": title };
  const svg = svgElement(null, "svg", { ...name, ...font, width });
  const paper = svgElement(svg, "rect", { width, height: "100%", fill: kPaper });
  const end = (height) => {
    for (const each of [svg, paper]) each.setAttribute("height", height);
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  };
  return { svg, end };
};

// Draws the key of several charts: all that one of them has.
const drawKey = (charts, width, hidden, onToggle) => {
  const { svg, end } = beginSvg("Key", width);
  const all = charts.flatMap(({ series }) => series).filter(({ points }) => points.length > 0);
  const series = all.filter(({ title }, i) => all.findIndex((each) => each.title === title) === i);
  const notes = [...new Set(charts.flatMap((chart) => chart.notes))];
  end(addKey(svg, { series, notes }, kLine, width, hidden, onToggle));
  return svg;
};

// Draws one chart, its key included where a click on it does something. Returns the SVG and where its points are.
const drawChart = (chart, width, hidden, onToggle) => {
  const { svg, end } = beginSvg(chart.title, width);
  let top = kLine + 2;
  const say = (text, attributes) => {
    for (const line of wrap(text, width - 24)) {
      svgElement(svg, "text", { y: top, ...attributes }, line);
      top += kLine;
    }
  };
  const shown = listShown(chart, hidden);
  const yAxis = shown.length < chart.series.length ? fitAxis(chart.y, shown) : chart.y;
  say(chart.title, { x: 12, "font-weight": "bold" });
  say(chart.y.name, { x: 12, fill: kSecond });
  const left = 20 + Math.max(0, ...yAxis.ticks.map(([, label]) => widthOf(label)));
  const area = { left, right: width - 16, top: top - 4, bottom: top + Math.min(Math.max(width * 0.45, 260), 460) };
  const x = makeScale(chart.x, area.left, area.right);
  const y = makeScale(yAxis, area.bottom, area.top);
  addAxes(svg, { x: chart.x, y: yAxis }, x, y, area, width);
  top = area.bottom + 2 * kLine + 2;
  say(chart.x.name, { x: (area.left + area.right) / 2, "text-anchor": "middle", fill: kSecond });

  const id = `clip-${++clips}`;
  const inside = { x: left, y: area.top, width: area.right - left, height: area.bottom - area.top };
  svgElement(svgElement(svgElement(svg, "defs", {}), "clipPath", { id }), "rect", inside);
  const line = { "stroke-width": 1.6, "stroke-linejoin": "round", "clip-path": `url(#${id})` };
  const hits = [];
  const labels = [];
  const marks = [];
  const layers = shown.map((series) => svgElement(svg, "g", series.faint ? { opacity: kFaint } : {}));
  for (const [i, series] of shown.entries()) {
    const isMarked = series.mark !== "none";
    const points = series.points.filter((point) => x.can(point.x[0]) && y.can(point.y[0]));
    const path = points.map((point) => [x(point.x[0]), y(point.y[0])]);
    if (series.line !== "none")
      addPath(layers[i], pathOf(series.line, path), series.color, { ...line, ...kLines[series.line] });
    for (const [j, point] of points.entries()) {
      if (!x.holds(point.x[0]) || !y.holds(point.y[0])) continue;
      if (series.whiskers) addWhiskers(layers[i], point, x, y, series.color);
      const role = point.opens && window.shadowbench.roleOf?.(point.opens); // an answer of the page
      if (isMarked) addMark(layers[i], role ? { ...series, filled: true, color: kAccent } : series, ...path[j]);
      if (role) addPath(svg, kMarks.circle(9), kAccent, { transform: `translate(${path[j]})`, "stroke-width": 2 });
      if (isMarked) marks.push(path[j]);
      const rank = role ? 0 : series.faint ? 3 : series.filled ? 1 : 2;
      if (point.label) labels.push([...path[j], role ? `${point.label} · ${role}` : point.label, rank]);
      if (isMarked || point.details.length > 0) hits.push({ at: path[j], point, series });
    }
  }
  addLabels(svg, labels, marks, area);
  end(onToggle ? addKey(svg, chart, top + 4, width, hidden, onToggle) : top);
  return { svg, hits };
};
