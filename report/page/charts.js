"use strict";
// Draws the charts of a page as SVG, from the JSON block "charts" that write_html() makes.
(() => {
  const page = JSON.parse(document.getElementById("charts").textContent);
  const kFont = '"DejaVu Sans", Verdana, sans-serif', kSize = 13, kLine = 18;
  const kInk = "#1c1f24", kSecond = "#545a63", kGrid = "#e2e4e8", kPaper = "#ffffff";
  const kFaint = 0.55, kReach = 24, kSavedWidth = 1120;

  let clips = 0;

  const ruler = document.createElement("canvas").getContext("2d");
  ruler.font = `${kSize}px ${kFont}`;
  const widthOf = (text) => ruler.measureText(text).width;

  const element = (parent, name, properties, text) => {
    const made = document.createElement(name);
    Object.assign(made, properties);
    if (text !== undefined) made.textContent = text;
    parent.append(made);
    return made;
  };
  const svgElement = (parent, name, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, typeof value === "number" ? Math.round(value * 100) / 100 : value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  };
  const number = (value) => String(Number(value.toPrecision(4)));

  // Breaks a text into lines of at most a width.
  const wrap = (text, width) => {
    const lines = [];
    for (const word of text.split(" ")) {
      const longer = lines.length > 0 ? lines[lines.length - 1] + " " + word : word;
      if (lines.length > 0 && widthOf(longer) <= width) lines[lines.length - 1] = longer;
      else lines.push(word);
    }
    return lines;
  };

  const kMarks = {
    circle: (r) => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0z`,
    square: (r) => `M${-r},${-r}h${2 * r}v${2 * r}h${-2 * r}z`,
    triangle: (r) => `M0,${-r}L${r},${r}L${-r},${r}z`,
    diamond: (r) => `M0,${-r - 1}L${r + 1},0L0,${r + 1}L${-r - 1},0z`,
    down: (r) => `M0,${r}L${r},${-r}L${-r},${-r}z`,
    cross: (r) => `M${-r},${-r}L${r},${r}M${-r},${r}L${r},${-r}`,
  };
  const drawMark = (parent, series, x, y) => svgElement(parent, "path", {
    d: kMarks[series.mark](5), transform: `translate(${x.toFixed(2)},${y.toFixed(2)})`, stroke: series.color, "stroke-width": 1.5,
    fill: series.filled && series.mark !== "cross" ? series.color : "none",
  });
  const dashOf = (line) => (line === "dashed" ? { "stroke-dasharray": "6 4" } : line === "ties" ? { "stroke-dasharray": "2 3" } : {});

  // From values to pixels.
  const makeScale = (axis, from, to) => {
    const place = axis.log ? Math.log : (value) => value;
    const low = place(axis.low), high = place(axis.high);
    const scale = (value) => from + ((to - from) * (place(value) - low)) / (high - low);
    scale.clamped = (value) => scale(Math.min(Math.max(value, axis.low), axis.high));
    const slack = 1e-6 * Math.abs(axis.high - axis.low);
    scale.holds = (value) => value !== null && value >= axis.low - (axis.log ? 0 : slack) && value <= axis.high + slack;
    return scale;
  };

  const drawAxes = (svg, chart, x, y, area, width) => {
    const taken = [];
    for (const [value, label] of chart.x.ticks) {
      const half = widthOf(label) / 2, at = x(value), middle = Math.min(Math.max(at, half + 2), width - half - 2);
      svgElement(svg, "path", { d: `M${at.toFixed(2)},${area.top}V${area.bottom + 5}`, stroke: kGrid });
      if (taken.some((end) => middle - half < end + 8)) continue;
      taken.push(middle + half);
      svgElement(svg, "text", { x: middle, y: area.bottom + kLine, "text-anchor": "middle" }, label);
    }
    let last = Infinity;
    for (const [value, label] of chart.y.ticks) {
      const at = y(value);
      svgElement(svg, "path", { d: `M${area.left - 5},${at.toFixed(2)}H${area.right}`, stroke: kGrid });
      if (last - at < kSize + 2) continue;
      last = at;
      svgElement(svg, "text", { x: area.left - 8, y: at + kSize * 0.35, "text-anchor": "end" }, label);
    }
    svgElement(svg, "path", { d: `M${area.left},${area.top}V${area.bottom}H${area.right}`, stroke: kInk, fill: "none" });
  };

  // How a line runs through points; ties join each point with the one after it, in pairs.
  const pathOf = (line, points) => points.map(([px, py], i) => {
    const to = `${px.toFixed(2)},${py.toFixed(2)}`;
    if (i === 0 || (line === "ties" && i % 2 === 0)) return "M" + to;
    return line === "steps" ? `H${px.toFixed(2)}V${py.toFixed(2)}` : "L" + to;
  }).join("");

  const drawWhiskers = (parent, point, x, y, color) => {
    const px = x(point.x[0]), py = y(point.y[0]);
    let d = "";
    if (point.x[1] !== point.x[2]) {
      const [a, b] = [point.x[1], point.x[2]].map(x.clamped);
      d += `M${a},${py}H${b}M${a},${py - 3}v6M${b},${py - 3}v6`;
    }
    if (point.y[1] !== point.y[2]) {
      const [a, b] = [point.y[1], point.y[2]].map(y.clamped);
      d += `M${px},${a}V${b}M${px - 3},${a}h6M${px - 3},${b}h6`;
    }
    if (d) svgElement(parent, "path", { d, stroke: color, fill: "none" });
  };

  // Puts labels beside their points, where they cover neither marks nor each other; what says most comes first.
  const drawLabels = (svg, labels, marks, area) => {
    const boxes = marks.map(([px, py]) => [px - 6, py - 6, px + 6, py + 6]);
    const isFree = (box) => box[0] >= area.left && box[2] <= area.right && box[1] >= area.top && box[3] <= area.bottom &&
      boxes.every((other) => box[2] <= other[0] || box[0] >= other[2] || box[3] <= other[1] || box[1] >= other[3]);
    for (const [px, py, label] of labels.sort((a, b) => a[3] - b[3])) {
      const width = widthOf(label), places = [];
      for (const away of [8, 20]) {
        for (const [dx, dy] of [[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [0, 1], [1, 0], [-1, 0]]) {
          const cx = px + dx * (away + width / 2), cy = py + dy * (away + 2);
          places.push([cx - width / 2, cy - kSize / 2, cx + width / 2, cy + kSize / 2]);
        }
      }
      const box = places.find(isFree);
      if (!box) continue;  // the pointer still finds it
      boxes.push(box);
      const [cx, cy] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
      svgElement(svg, "text", { x: cx, y: cy + kSize * 0.35, "text-anchor": "middle", stroke: kPaper, "stroke-width": 3, "paint-order": "stroke" }, label);
    }
  };

  // The key, then the notes, in rows below the plot; returns where they end.
  const drawKey = (svg, chart, top, width, hidden, onToggle) => {
    let left = 12, y = top;
    const place = (room) => {
      if (left > 12 && left + room > width - 8) [left, y] = [12, y + kLine];
      const at = left;
      left += room + 20;
      return at;
    };
    const entries = chart.series.filter((series) => series.title && series.points.length > 0);
    for (const series of entries) {
      const lines = wrap(series.title, width - 60), at = place(Math.max(...lines.map(widthOf)) + 34);
      const group = svgElement(svg, "g", { opacity: hidden.has(series.title) ? 0.3 : 1, class: "key" });
      if (series.line !== "none") svgElement(group, "path", { d: `M${at},${y}h26`, stroke: series.color, "stroke-width": 1.6, ...dashOf(series.line) });
      if (series.mark !== "none") drawMark(group, series, at + 13, y);
      lines.forEach((line, i) => svgElement(group, "text", { x: at + 34, y: y + kSize * 0.35 + i * kLine }, line));
      y += (lines.length - 1) * kLine;
      group.addEventListener("click", () => onToggle(series.title));
    }
    if (entries.length > 0) [left, y] = [12, y + kLine + 4];
    for (const note of chart.notes) {
      const lines = wrap(note, width - 24), at = place(Math.max(...lines.map(widthOf)));
      lines.forEach((line, i) => svgElement(svg, "text", { x: at, y: y + kSize * 0.35 + i * kLine, fill: kSecond }, line));
      y += (lines.length - 1) * kLine;
    }
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

  // Draws one chart. Returns the SVG and where its points are.
  const drawChart = (chart, width, hidden, onToggle) => {
    const svg = svgElement(null, "svg", {
      xmlns: "http://www.w3.org/2000/svg", role: "img", "aria-label": chart.title, "font-family": kFont, "font-size": kSize, fill: kInk,
    });
    const paper = svgElement(svg, "rect", { width: "100%", height: "100%", fill: kPaper });
    let top = kLine + 2;
    const say = (text, attributes) => wrap(text, width - 24).forEach((line) => {
      svgElement(svg, "text", { y: top, ...attributes }, line);
      top += kLine;
    });
    say(chart.title, { x: 12, "font-weight": "bold" });
    say(chart.y.name, { x: 12, fill: kSecond });
    const left = 20 + Math.max(0, ...chart.y.ticks.map(([, label]) => widthOf(label)));
    const area = { left, right: width - 16, top: top - 4, bottom: top + Math.min(Math.max(width * 0.45, 260), 460) };
    const x = makeScale(chart.x, area.left, area.right), y = makeScale(chart.y, area.bottom, area.top);
    drawAxes(svg, chart, x, y, area, width);
    top = area.bottom + 2 * kLine + 2;
    say(chart.x.name, { x: (area.left + area.right) / 2, "text-anchor": "middle", fill: kSecond });

    const clipId = `clip-${++clips}`;
    const clip = svgElement(svgElement(svg, "defs", {}), "clipPath", { id: clipId });
    svgElement(clip, "rect", { x: area.left, y: area.top, width: area.right - area.left, height: area.bottom - area.top });
    const shown = listShown(chart, hidden), hits = [], labels = [], marks = [];
    const layers = shown.map((series) => svgElement(svg, "g", series.faint ? { opacity: kFaint } : {}));
    shown.forEach((series, i) => {
      const points = series.points.filter((point) => point.x[0] !== null && point.y[0] !== null && (!chart.x.log || point.x[0] > 0) && (!chart.y.log || point.y[0] > 0));
      if (series.line !== "none") {
        svgElement(layers[i], "path", {
          d: pathOf(series.line, points.map((point) => [x(point.x[0]), y(point.y[0])])), stroke: series.color, "stroke-width": 1.6, fill: "none",
          "stroke-linejoin": "round", "clip-path": `url(#${clipId})`, ...dashOf(series.line),
        });
      }
      for (const point of points.filter((each) => x.holds(each.x[0]) && y.holds(each.y[0]))) {
        const at = [x(point.x[0]), y(point.y[0])];
        if (series.whiskers) drawWhiskers(layers[i], point, x, y, series.color);
        if (series.mark !== "none") drawMark(layers[i], series, ...at);
        if (series.mark !== "none") marks.push(at);
        if (point.label) labels.push([...at, point.label, series.faint ? 2 : series.filled ? 0 : 1]);
        if (series.mark !== "none" || point.details.length > 0) hits.push({ at, point, series });
      }
    });
    drawLabels(svg, labels, marks, area);
    const bottom = drawKey(svg, chart, top + 4, width, hidden, onToggle);
    for (const each of [svg, paper]) each.setAttribute("width", width), each.setAttribute("height", bottom);
    svg.setAttribute("viewBox", `0 0 ${width} ${bottom}`);
    return { svg, hits };
  };

  // The saved file does not depend on the window.
  const serialize = (chart, hidden) => new XMLSerializer().serializeToString(drawChart(chart, kSavedWidth, hidden, () => {}).svg);
  const save = (blob, name) => {
    const link = element(document.body, "a", { href: URL.createObjectURL(blob), download: name });
    link.click();
    link.remove();
  };
  const saveSvg = (chart, hidden) => save(new Blob([serialize(chart, hidden)], { type: "image/svg+xml" }), chart.id + ".svg");
  const savePng = (chart, hidden) => {
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [2 * image.width, 2 * image.height];
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => save(blob, chart.id + ".png"), "image/png");
    };
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(serialize(chart, hidden));
  };

  const listLines = (chart, { point, series }) => point.details.length > 0 ? point.details :
    [series.title, `${chart.x.name}: ${number(point.x[0])}`, `${chart.y.name}: ${number(point.y[0])}`].filter(Boolean);

  const canOpen = ({ point }) => Boolean(point.opens && window.shadowbench && window.shadowbench.openCell);

  // Shows what is said of the point nearest to the pointer.
  const followPointer = (holder, tip, chart, { svg, hits }) => {
    const find = (event) => {
      const box = svg.getBoundingClientRect(), scale = box.width / Number(svg.getAttribute("width"));
      const away = ({ at }) => Math.hypot(at[0] * scale - (event.clientX - box.left), at[1] * scale - (event.clientY - box.top));
      return hits.reduce((best, hit) => (away(hit) < (best ? away(best) : kReach) ? hit : best), null);
    };
    const show = (event) => {
      const hit = find(event);
      tip.hidden = !hit;
      svg.style.cursor = hit && canOpen(hit) ? "pointer" : "default";
      if (!hit) return;
      tip.replaceChildren();
      for (const line of listLines(chart, hit)) element(tip, "div", {}, line);
      const room = holder.clientWidth - tip.offsetWidth;
      tip.style.left = Math.max(0, Math.min(hit.at[0] + 14, room)) + "px";
      tip.style.top = hit.at[1] + 14 + "px";
    };
    svg.addEventListener("pointermove", show);
    svg.addEventListener("pointerdown", show);
    svg.addEventListener("pointerleave", () => { tip.hidden = true; });
    svg.addEventListener("click", (event) => {
      const hit = find(event);
      if (hit && canOpen(hit)) window.shadowbench.openCell(hit.point.opens);
    });
  };

  // Texts and points are packed: see the writer.
  const unpack = (packed) => ({
    ...packed, series: packed.series.map((series) => ({
      ...series, points: series.points.map(([x, y, label, details, opens, group]) => ({
        x: typeof x === "number" ? [x, x, x] : x || [null], y: typeof y === "number" ? [y, y, y] : y || [null], label: label || "",
        details: (details || []).map((i) => page.texts[i]), opens: opens || "", group: group || "",
      })),
    })),
  });

  // The chart with the points of one group, and those that belong to none.
  const keepGroup = (chart, group) => !group ? chart : {
    ...chart, series: chart.series.map((series) => ({ ...series, points: series.points.filter((point) => !point.group || point.group === group) })),
  };

  const start = (choice) => {
    const figure = document.getElementById(choice.id);
    const [controls, holder] = ["controls", "holder"].map((name) => figure.querySelector("." + name));
    const hidden = new Set(choice.charts.flatMap(({ series }) => series.filter((each) => each.hidden).map((each) => each.title)));
    let chart = null, drawn = 0;
    const draw = () => {
      drawn = holder.clientWidth;
      if (drawn === 0) return;  // folded away
      const toggle = (title) => {
        if (!hidden.delete(title)) hidden.add(title);
        draw();
      };
      const result = drawChart(chart, drawn, hidden, toggle);
      holder.replaceChildren(result.svg);
      const tip = element(holder, "div", { className: "tip", hidden: true });
      followPointer(holder, tip, chart, result);
    };
    const selects = choice.selectors.map(({ label, options }) => {
      const select = element(element(controls, "label", {}, label + " "), "select", {});
      options.forEach((option, i) => select.add(new Option(option, String(i))));
      return select;
    });
    const groups = [...new Set(choice.charts.flatMap(({ series }) => series.flatMap(({ points }) => points.map((point) => point[5]))))].filter(Boolean);
    const width = groups.length > 1 ? element(element(controls, "label", {}, "width "), "select", {}) : null;
    if (width) for (const group of ["", ...groups]) width.add(new Option(group || "any", group));
    const choose = () => {
      const packed = choice.charts[selects.reduce((index, select, i) => index * choice.selectors[i].options.length + Number(select.value), 0)];
      chart = keepGroup(unpack(packed), width?.value);
      draw();
    };
    for (const select of [...selects, width]) select?.addEventListener("change", choose);
    element(controls, "button", { type: "button", onclick: () => saveSvg(chart, hidden) }, "Save as SVG");
    element(controls, "button", { type: "button", onclick: () => savePng(chart, hidden) }, "Save as PNG");
    choose();
    new ResizeObserver(() => { if (holder.clientWidth !== drawn) draw(); }).observe(holder);
  };
  for (const choice of page.charts) start(choice);
})();
