"use strict";
// Draws the trade of index.html from the JSON block "trade-data" with Chart.js 3.
(() => {
  const data = JSON.parse(document.getElementById("trade-data").textContent);
  const byId = (id) => document.getElementById(id);
  const filterOf = new Map(data.filters.map((filter) => [filter.id, filter]));
  const kInk = "#1c1f24", kGrid = "#e2e4e8", kFaint = 0.4;

  if (typeof Chart === "undefined") {
    for (const canvas of document.querySelectorAll(".trade-canvas")) canvas.textContent = "chart.min.js is missing beside this page.";
    return;
  }

  Chart.defaults.font.family = '"DejaVu Sans", system-ui, sans-serif';
  Chart.defaults.font.size = 13;

  const number = (value) => {
    const size = Math.abs(value);
    return size >= 99.95 ? value.toFixed(0) : String(Number(value.toPrecision(3)));
  };
  const bytes = (value) => {
    const units = ["B", "KiB", "MiB", "GiB"];
    let unit = 0;
    for (; value >= 1024 && unit + 1 < units.length; ++unit) value /= 1024;
    return number(value) + " " + units[unit];
  };
  const estimate = (values, measure) => {
    const write = measure && measure.bytes ? bytes : number;
    const interval = values[1] === values[2] ? "" : ` [${write(values[1])}, ${write(values[2])}]`;
    return write(values[0]) + interval + (measure && measure.unit ? " " + measure.unit : "");
  };
  const fade = (color, alpha) => color + Math.round(255 * alpha).toString(16).padStart(2, "0");

  const fill = (select, texts) => {
    texts.forEach((text, i) => select.add(new Option(text, String(i))));
    return select;
  };
  const makeElement = (name, text) => {
    const element = document.createElement(name);
    if (text !== undefined) element.textContent = text;
    return element;
  };

  // The library's shapes, and a triangle on its tip.
  const shapeOf = (filter) => ({
    pointStyle: filter.shape === "down" ? "triangle" : filter.shape,
    rotation: filter.shape === "down" ? 180 : 0,
  });

  const makeScale = (axis, title) => ({
    type: axis.log ? "logarithmic" : "linear",
    min: axis.low,
    max: axis.high,
    title: { display: true, text: title, color: kInk },
    grid: { color: kGrid },
    ticks: { color: kInk, autoSkip: false, maxRotation: 0, callback: (value) => (axis.ticks.find((tick) => tick[0] === value) || [0, ""])[1] },
    afterBuildTicks: (scale) => { scale.ticks = axis.ticks.map((tick) => ({ value: tick[0] })); },
  });

  // A white paper: what is saved is what is seen, in dark pages too.
  const paper = {
    id: "paper",
    beforeDraw: ({ ctx, width, height }) => {
      ctx.save();
      ctx.fillStyle = "#ffffff";
      ctx.fillRect(0, 0, width, height);
      ctx.restore();
    },
  };

  const line = (ctx, x0, y0, x1, y1) => {
    ctx.beginPath();
    ctx.moveTo(x0, y0);
    ctx.lineTo(x1, y1);
    ctx.stroke();
  };

  // Intervals: a point's `xRange` and `yRange` are [low, high].
  const drawWhiskers = (chart, point, color) => {
    const { ctx, scales: { x, y }, chartArea } = chart;
    const px = x.getPixelForValue(point.x), py = y.getPixelForValue(point.y);
    const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
    ctx.strokeStyle = color;
    ctx.lineWidth = 1;
    if (point.xRange[0] !== point.xRange[1]) {
      const [a, b] = point.xRange.map((v) => clamp(x.getPixelForValue(Math.max(v, x.min)), chartArea.left, chartArea.right));
      line(ctx, a, py, b, py);
      for (const end of [a, b]) line(ctx, end, py - 3, end, py + 3);
    }
    if (point.yRange[0] !== point.yRange[1]) {
      const [a, b] = point.yRange.map((v) => clamp(y.getPixelForValue(Math.max(v, y.min)), chartArea.top, chartArea.bottom));
      line(ctx, px, a, px, b);
      for (const end of [a, b]) line(ctx, px - 3, end, px + 3, end);
    }
  };

  const drawTie = (chart, point, color) => {
    const { ctx, scales: { x, y } } = chart;
    ctx.save();
    ctx.setLineDash([2, 3]);
    ctx.lineWidth = 1.5;
    ctx.strokeStyle = color;
    line(ctx, x.getPixelForValue(point.x), y.getPixelForValue(point.y), x.getPixelForValue(point.tiedTo[0]), y.getPixelForValue(point.tiedTo[1]));
    ctx.restore();
  };

  const intervals = {
    id: "intervals",
    beforeDatasetsDraw: (chart) => {
      chart.ctx.save();
      chart.data.datasets.forEach((dataset, i) => {
        if (!dataset.whiskers || !chart.isDatasetVisible(i)) return;
        for (const point of dataset.data) {
          drawWhiskers(chart, point, point.faint ? fade(dataset.color, kFaint) : dataset.color);
          if (point.tiedTo) drawTie(chart, point, dataset.color);
        }
      });
      chart.ctx.restore();
    },
  };

  // A filter's entry is filled, whatever stands first among its cells.
  const makeLegend = (chart) => {
    const labels = Chart.defaults.plugins.legend.labels.generateLabels(chart);
    for (const label of labels) {
      const dataset = chart.data.datasets[label.datasetIndex];
      label.fillStyle = dataset.backgroundColor;
      label.strokeStyle = dataset.borderColor;
      label.lineWidth = 1.5;
    }
    return labels;
  };

  const makeOptions = (x, y, title, describe, onClick) => ({
    animation: false,
    maintainAspectRatio: false,
    devicePixelRatio: Math.max(2, window.devicePixelRatio || 1),
    layout: { padding: { right: 12 } },
    scales: { x, y },
    interaction: { mode: "nearest", intersect: true },
    onClick,
    onHover: (event, elements, chart) => { chart.canvas.style.cursor = elements.length > 0 && onClick ? "pointer" : "default"; },
    plugins: {
      title: { display: true, text: title, color: kInk },
      legend: { position: "bottom", labels: { usePointStyle: true, color: kInk, generateLabels: makeLegend } },
      tooltip: { callbacks: { title: (items) => items[0].raw.title || "", label: (item) => describe(item.raw) }, usePointStyle: true },
    },
  });

  // One chart in a canvas, drawn anew when a selection changes.
  const makeHolder = (name) => {
    let chart = null;
    byId(name + "-save").addEventListener("click", () => {
      const link = makeElement("a");
      link.href = chart.toBase64Image();
      link.download = name + ".png";
      link.click();
    });
    return (datasets, options) => {
      if (chart) chart.destroy();
      chart = new Chart(byId(name + "-canvas"), { type: "scatter", data: { datasets }, options, plugins: [paper, intervals] });
      return chart;
    };
  };

  // The fronts.
  const selection = {
    scope: fill(byId("front-scope"), data.scopes.map((scope) => scope.title)),
    error: fill(byId("front-error"), data.errors.map((error) => error.name)),
    cost: fill(byId("front-cost"), data.costs.map((cost) => cost.name)),
  };
  const drawFrontChart = makeHolder("front");

  const makePoint = (scope, place, error, cost) => {
    const [index, standing, by] = place;
    const cell = scope.configurations[index], leader = scope.configurations[by];
    const e = cell.errors[error], c = cell.costs[cost];
    return {
      x: c[0], y: e[0], xRange: [c[1], c[2]], yRange: [e[1], e[2]], index, standing, title: cell.label,
      faint: standing === "dominated", by: leader.label,
      tiedTo: standing === "tied" ? [leader.costs[cost][0], leader.errors[error][0]] : null,
    };
  };

  const makeFilterSet = (filter, points) => {
    const alpha = (point) => (point.faint ? kFaint : 1);
    const edges = points.map((point) => fade(filter.color, alpha(point)));
    const faces = points.map((point) => (point.standing === "front" ? filter.color : "#ffffff00"));
    return {
      label: filter.id, data: points, whiskers: true, color: filter.color, pointRadius: points.map((p) => (p.faint ? 5 : 6)), pointHoverRadius: 8,
      borderColor: filter.color, backgroundColor: filter.color, pointBorderColor: edges, pointBackgroundColor: faces,
      pointBorderWidth: points.map((point) => (point.standing === "tied" ? 2.5 : 1.5)), ...shapeOf(filter), clip: false,
    };
  };

  const makeFrontDatasets = (scope, front, error, cost) => {
    const points = front.places.map((place) => makePoint(scope, place, error, cost));
    const sets = [];
    for (const filter of data.filters) {
      const own = points.filter((point) => scope.configurations[point.index].filter === filter.id);
      if (own.length > 0) sets.push(makeFilterSet(filter, own));
    }
    const members = front.members.map((i) => points.find((point) => point.index === i));
    sets.push({
      label: "front", data: members.map((p) => ({ x: p.x, y: p.y })), type: "line", showLine: true, stepped: "before", pointRadius: 0, pointHitRadius: 0,
      borderColor: kInk, backgroundColor: "#ffffff00", borderWidth: 1.5, pointStyle: "line",
    });
    return sets;
  };

  const describeCell = (scope, error, cost) => (point) => {
    const cell = scope.configurations[point.index];
    const standing = { front: "on the front", tied: "tied with " + point.by, dominated: "beaten by " + point.by };
    return [
      cell.params || "no parameters", `map ${cell.map} × ${cell.map}`,
      `${data.errors[error].name}: ${estimate(cell.errors[error], data.errors[error])}`,
      `${data.costs[cost].name}: ${estimate(cell.costs[cost], data.costs[cost])}`, standing[point.standing],
    ];
  };

  const makePicture = (path, caption) => {
    const figure = makeElement("figure"), link = makeElement("a"), image = makeElement("img");
    link.href = image.src = path;
    image.alt = caption;
    link.append(image);
    figure.append(link, makeElement("figcaption", caption));
    return figure;
  };

  const showPictures = (cell) => {
    const panel = byId("front-pictures"), gallery = makeElement("div");
    gallery.className = "gallery";
    for (const place of cell.pictures) {
      if (place.picture) gallery.append(makePicture(place.picture, `${place.scene}: picture`));
      if (place.visibility) gallery.append(makePicture(place.visibility, `${place.scene}: visibility`));
    }
    panel.replaceChildren(makeElement("h3", cell.label), gallery.childNodes.length > 0 ? gallery : makeElement("p", "This cell has no pictures."));
  };

  const showWords = (words) => {
    const list = makeElement("ul");
    for (const sentence of words) list.append(makeElement("li", sentence));
    byId("front-words").replaceChildren(list);
  };

  const drawFront = () => {
    const scope = data.scopes[selection.scope.value], error = Number(selection.error.value), cost = Number(selection.cost.value);
    const front = scope.fronts[error][cost];
    const onClick = (event, elements, chart) => {
      const hit = elements.map((each) => chart.data.datasets[each.datasetIndex].data[each.index]).find((point) => point.index !== undefined);
      if (hit) showPictures(scope.configurations[hit.index]);
    };
    const options = makeOptions(makeScale(scope.costAxes[cost], data.costs[cost].axis), makeScale(scope.errorAxes[error], data.errors[error].axis),
      scope.title, describeCell(scope, error, cost), onClick);
    options.plugins.tooltip.filter = (item) => item.raw.index !== undefined;
    drawFrontChart(makeFrontDatasets(scope, front, error, cost), options);
    showWords(front.words);
    byId("front-pictures").replaceChildren();
  };
  for (const select of Object.values(selection)) select.addEventListener("change", drawFront);
  drawFront();

  // Time over kernel radius.
  if (data.charts.length === 0) return;
  const place = fill(byId("radius-place"), data.charts.map((chart) => chart.title));
  const light = fill(byId("radius-light"), ["still: lookup", "moving: map, prefilter, lookup"]);
  const drawRadiusChart = makeHolder("radius");

  const makeCurve = (curve) => {
    const filter = filterOf.get(curve.filter);
    const points = curve.points.map((point) => ({
      x: point.radius, y: point.time[0], xRange: [point.radius, point.radius], yRange: [point.time[1], point.time[2]], title: curve.label, values: point.time,
    }));
    return {
      label: curve.label, data: points, whiskers: true, color: filter.color, showLine: true, borderColor: filter.color, backgroundColor: filter.color,
      borderWidth: 1.5, borderDash: curve.prefiltered ? [] : [6, 4], pointRadius: 5, pointHoverRadius: 8, ...shapeOf(filter), clip: false,
    };
  };

  const drawRadius = () => {
    const moving = light.value === "1", chart = data.charts[place.value][moving ? "moving" : "still"], measure = data.costs[moving ? 1 : 0];
    const sets = chart.curves.map(makeCurve);
    if (chart.crossings.length > 0) {
      sets.push({
        label: "crossing", data: chart.crossings.map((c) => ({ x: c.radius, y: c.time, title: c.label, values: [c.time, c.time, c.time] })),
        pointStyle: "crossRot", pointRadius: 8, borderColor: kInk, borderWidth: 2, backgroundColor: kInk,
      });
    }
    const describe = (point) => [`kernel half-width ${number(point.x)} texels`, `${measure.name}: ${estimate(point.values, measure)}`];
    drawRadiusChart(sets, makeOptions(makeScale(chart.x, "kernel half-width, texels"), makeScale(chart.y, measure.axis), data.charts[place.value].title, describe, null));
  };
  place.addEventListener("change", drawRadius);
  light.addEventListener("change", drawRadius);
  drawRadius();
})();
