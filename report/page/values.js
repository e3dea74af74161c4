"use strict";
// Loads the files of values and the pictures beside the page, and makes pictures of numbers.
(() => {
  const shadowbench = (window.shadowbench = window.shadowbench || {});
  const kLastCode = 65534, kKeptValues = 64e6;

  shadowbench.element = (parent, name, properties = {}, text = undefined) => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(properties)) key in made ? (made[key] = value) : made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    parent.append(made);
    return made;
  };

  // A number as people read it: three digits, whole numbers in full, shares in percent, bytes in powers of 1024.
  shadowbench.format = (value, unit = "") => {
    if (value === null) return "\u2013";
    if (unit === "share") return `${Number((100 * value).toPrecision(3))} %`;
    const step = unit === "bytes" && value >= 1024 ? Math.min(3, Math.floor(Math.log2(value) / 10)) : 0, scaled = value / 1024 ** step;
    const text = step === 0 && Number.isInteger(value) ? value.toLocaleString("en") : String(Number(scaled.toPrecision(3)));
    return unit === "bytes" ? `${text} ${["B", "KiB", "MiB", "GiB"][step]}` : text;
  };

  // What the reader chose is in the page's address, a part for each script, so that a link opens the same view.
  const kSavedAfterMs = 300, unsaved = new Map();
  const decodeField = (text) => {
    try { return decodeURIComponent(text); } catch { return text; }
  };
  const readParts = () => new Map(location.hash.slice(1).split("&").map((part) => part.split("=")).filter(([, text]) => text !== undefined));
  let saving = 0;
  shadowbench.link = {
    read: (name) => readParts().get(name)?.split(",").map(decodeField) ?? null,
    write: (name, fields) => {
      unsaved.set(name, fields.map(encodeURIComponent).join(","));
      clearTimeout(saving);
      saving = setTimeout(() => {
        const parts = new Map([...readParts(), ...unsaved]);
        unsaved.clear();
        try {
          history.replaceState(null, "", "#" + [...parts].map((part) => part.join("=")).join("&"));
        } catch { /* a page inside another page may not change its address */ }
      }, kSavedAfterMs);
    },
  };

  // Acts once an element is near the screen.
  shadowbench.onceSeen = (node, action) => {
    const watcher = new IntersectionObserver((entries) => {
      if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
      watcher.disconnect();
      action();
    }, { rootMargin: "300px" });
    watcher.observe(node);
  };

  // A map that forgets what was used longest ago once the sizes add up to more than a limit.
  const makeStore = (limit) => {
    const kept = new Map();
    let total = 0;
    return (key, size, make) => {
      const held = kept.get(key) || { size, value: make() };
      if (!kept.delete(key)) total += size;
      kept.set(key, held);
      for (const [oldest, { size: freed }] of kept) {
        if (total <= limit || oldest === key) break;
        kept.delete(oldest);
        total -= freed;
      }
      return held.value;
    };
  };

  const arrivals = new Map(), files = new Map(), keepPlane = makeStore(kKeptValues);
  window.shadowbenchValues = (path, file) => arrivals.get(path)?.(file);
  const refuse = (path, why) => new Error(`${path} cannot be read: ${why}`);

  const addScript = (path) => new Promise((resolve, reject) => {
    const script = document.createElement("script");
    const end = (why) => {
      script.remove();
      arrivals.delete(path);
      reject(refuse(path, why));  // changes nothing once the values have arrived
    };
    arrivals.set(path, resolve);
    script.onload = () => end("it holds no values of that name.");
    script.onerror = () => end("the file is not beside this page.");
    script.src = path;
    document.head.append(script);
  });

  const inflate = async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
  };

  // The words, codes of 16 bits or floats of 32, are differences to the one at the left in their row; all high bytes come first.
  const decode = async (path, width, height, { low, high, data }) => {
    if (!window.DecompressionStream) throw refuse(path, "this browser cannot unpack it; a newer one can.");
    const bytes = await inflate(data).catch(() => []);
    const count = width * height, step = (high - low) / kLastCode, isFloat = low === undefined;
    if (bytes.length !== (isFloat ? 4 : 2) * count) throw refuse(path, "it is damaged or cut short.");
    const values = new Float32Array(count), words = new Uint32Array(values.buffer);
    for (let y = 0, i = 0; y < height; ++y) {
      for (let x = 0, code = 0; x < width; ++x, ++i) {
        const high16 = (bytes[i] << 8) | bytes[count + i];
        if (isFloat) words[i] = code = (code + ((high16 << 16) | (bytes[2 * count + i] << 8) | bytes[3 * count + i])) | 0;
        else values[i] = (code = (code + high16) & 0xffff) > kLastCode ? NaN : low + step * code;
      }
    }
    return values;
  };

  // Promises width, height and planes: a map from a name to a function that promises the numbers.
  shadowbench.loadValues = (path) => {
    if (!files.has(path)) {
      files.set(path, addScript(path).then(({ width, height, planes }) => ({
        width, height, planes: new Map(planes.map((plane) =>
          [plane.name, () => keepPlane(`${path} ${plane.name}`, width * height, () => decode(path, width, height, plane))])),
      })));
    }
    return files.get(path);
  };

  const subtract = (left, right) => {
    if (left.length !== right.length) throw new Error("The two sides have different sizes.");
    return left.map((value, i) => value - right[i]);
  };

  // Finds what all but one of 200 magnitudes over the receivers do not exceed, from a count in small steps.
  const findScale = (planes, mask, least) => {
    const counts = new Uint32Array(4096);
    let largest = 0, total = 0;
    const visit = (look) => planes.forEach((plane) => plane.forEach((value, i) => {
      if ((!mask || mask[i]) && Number.isFinite(value)) look(Math.abs(value));
    }));
    visit((size) => { largest = Math.max(largest, size); });
    visit((size) => { ++total, ++counts[Math.floor((size / (largest || 1)) * 4095)]; });
    let step = 0;
    for (let seen = counts[0]; seen < 0.995 * total; seen += counts[step]) ++step;
    return Number(Math.max(least, ((step + 1) / 4096) * largest).toPrecision(2));
  };

  // The ends and the middle of the first are those of the heat maps that the program draws.
  const kPalettes = {
    diverging: [[23, 79, 168], [242, 242, 240], [189, 23, 33]],
    grey: [[0, 0, 0], [255, 255, 255]],
    heat: [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]],
  };
  const pack = ([red, green, blue]) => ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
  const tables = Object.fromEntries(Object.entries(kPalettes).map(([name, stops]) => [name, Uint32Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (stops.length - 1), from = Math.min(Math.floor(at), stops.length - 2);
    return pack(stops[from].map((channel, j) => Math.round(channel + (at - from) * (stops[from + 1][j] - channel))));
  })]));
  const kHatch = [pack([156, 156, 156]), pack([168, 168, 168])];

  const makeCanvas = (width, height) => Object.assign(document.createElement("canvas"), { width, height });

  // Draws a part of a plane, one pixel for each number; what does not count is hatched.
  const paint = (numbers, mask, width, rect, palette, scale) => {
    const canvas = makeCanvas(rect.width, rect.height), image = new ImageData(rect.width, rect.height);
    const pixels = new Uint32Array(image.data.buffer), table = tables[palette];
    const factor = (palette === "diverging" ? 127.5 : 255) / scale, zero = palette === "diverging" ? 128 : 0.5;
    for (let y = rect.y, to = 0; y < rect.y + rect.height; ++y) {
      for (let x = rect.x, i = y * width + x; x < rect.x + rect.width; ++x, ++i, ++to) {
        const value = numbers[i];
        const counts = value === value && (!mask || mask[i]);
        pixels[to] = counts ? table[Math.min(Math.max(zero + factor * value, 0), 255) | 0] : kHatch[((x + y) >> 2) & 1];
      }
    }
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
  };

  const addSquares = (sums, errors, mask) => {
    const all = sums || new Float32Array(errors.length);
    for (let i = 0; i < all.length; ++i) if ((!mask || mask[i]) && errors[i] === errors[i]) all[i] += errors[i] * errors[i];
    return all;
  };

  // Finds the tiles, an eighth of the width, that hold the most and do not overlap; they lie on a grid of half a tile.
  const findTiles = (sums, width, height, count) => {
    const half = Math.ceil(width / 16), columns = Math.ceil(width / half), rows = Math.ceil(height / half);
    const halves = new Float64Array((columns + 1) * (rows + 1)), tiles = [], found = [];
    const find = (i) => Math.floor(Math.floor(i / width) / half) * (columns + 1) + Math.floor((i % width) / half);
    for (let i = 0; i < sums.length; ++i) halves[find(i)] += sums[i];
    const total = halves.reduce((sum, value) => sum + value, 0);
    for (let row = 0; row < Math.max(1, rows - 1); ++row) {
      for (let column = 0; column < Math.max(1, columns - 1); ++column) {
        const at = row * (columns + 1) + column;
        tiles.push({ row, column, share: (halves[at] + halves[at + 1] + halves[at + columns + 1] + halves[at + columns + 2]) / total });
      }
    }
    for (const tile of tiles.filter(({ share }) => share > 0).sort((a, b) => b.share - a.share)) {
      const overlaps = ({ row, column }) => Math.abs(row - tile.row) < 2 && Math.abs(column - tile.column) < 2;
      if (found.length < count && !found.some(overlaps)) found.push(tile);
    }
    return found.map(({ row, column, share }) => {
      const x = column * half, y = row * half;
      return { share, rect: { x, y, width: Math.min(2 * half, width - x), height: Math.min(2 * half, height - y) } };
    });
  };

  shadowbench.numbers = { makeStore, subtract, findScale, kPalettes, makeCanvas, paint, addSquares, findTiles };

  // What a run holds: a filter is the index of its configuration, and the truth is -1.
  const block = document.getElementById("run");
  if (!block) return;
  const run = JSON.parse(block.textContent), kTruth = -1;
  const kOfTruth = { visibility: "area", uncertainty: "standard_error" }, kOtherNames = { uncertainty: "rounding" };

  const cells = new Map(run.cells.map((cell) => [`${cell.configuration} ${cell.place}`, cell]));
  const findEntry = (who, place) => {
    const entry = who === kTruth ? run.truths[place] : cells.get(`${who} ${place}`);
    return entry && (entry.picture || entry.values) ? entry : null;
  };
  const listFilters = (place) => run.configurations.map((_, who) => who).filter((who) => findEntry(who, place));
  const listAll = (place) => [kTruth, ...listFilters(place)].filter((who) => findEntry(who, place));
  const nameOf = (who) => (who === kTruth ? "truth" : run.configurations[who].label);
  const quote = (text) => `\u2068${text}\u2069`;  // a name of the other direction leaves its sentence in order
  const tell = (who) => (who === kTruth ? "the truth" : quote(nameOf(who)));  // a name inside a sentence

  const loadFile = async (who, place) => {
    const path = findEntry(who, place)?.values;
    if (!path) throw new Error(`No values are stored for ${tell(who)}.`);
    return shadowbench.loadValues(path);
  };
  const namePlane = (file, who, layer) => {
    const names = who === kTruth ? [kOfTruth[layer]] : [layer === "error" ? "visibility" : layer, kOtherNames[layer]];
    return names.find((name) => file.planes.has(name));
  };
  const getPlane = async (who, place, layer) => {
    const file = await loadFile(who, place), name = namePlane(file, who, layer);
    if (!name) throw new Error(`This layer is not stored for ${tell(who)}.`);
    return file.planes.get(name)();
  };
  // The layer that a side shows: its visibility where the truth has no such layer.
  const nameShown = async (who, place, layer) => {
    const { value } = await attempt(loadFile(who, place));
    return who === kTruth && value && !namePlane(value, who, layer) ? "visibility" : layer;
  };
  const getNumbers = async (who, place, layer) =>
    layer !== "error" || who === kTruth ? getPlane(who, place, layer)
      : subtract(await getPlane(who, place, "visibility"), await getPlane(kTruth, place, "visibility"));
  const getMask = async (place) => (await loadFile(kTruth, place)).planes.get("mask")?.();
  const attempt = (promise) => promise.then((value) => ({ value }), ({ message }) => ({ message }));
  const keepPicture = makeStore(24);
  const getPicture = async (who, place) => {
    const path = findEntry(who, place)?.picture;
    if (!path) throw new Error(`No picture is stored for ${tell(who)}.`);
    return keepPicture(path, 1, () => new Promise((resolve, reject) => {
      const image = new Image();
      image.onload = () => {
        const canvas = makeCanvas(image.naturalWidth, image.naturalHeight);
        canvas.getContext("2d").drawImage(image, 0, 0);
        resolve(canvas);
      };
      image.onerror = () => reject(new Error(`${path} cannot be read: the picture is not beside this page.`));
      image.src = path;
    }));
  };
  const cut = (source, rect, factor) => {
    const canvas = makeCanvas(Math.round(rect.width * factor), Math.round(rect.height * factor)), context = canvas.getContext("2d");
    context.imageSmoothingEnabled = factor < 1;
    context.drawImage(source, rect.x, rect.y, rect.width, rect.height, 0, 0, canvas.width, canvas.height);
    return canvas;
  };
  // Promises the tile of a cell that holds most of its squared error, and how the truth and the cell look there.
  shadowbench.worstPlace = async (place, configuration) => {
    const errors = await getNumbers(configuration, place, "error"), { width, height } = await loadFile(kTruth, place);
    const [tile] = findTiles(addSquares(null, errors, (await attempt(getMask(place))).value), width, height, 1);
    if (!tile) throw new Error(`${tell(configuration)} has no error here.`);
    const { rect } = tile, whos = [kTruth, configuration], room = 320 / rect.width;
    const factor = room < 1 ? room : Math.min(3, Math.floor(room));
    const pictures = await Promise.all(whos.map((who) => attempt(getPicture(who, place)))), hasBoth = pictures.every(({ value }) => value);
    const magnify = async (who, i) => (hasBoth ? cut(pictures[i].value, rect, factor)
      : cut(paint(await getNumbers(who, place, "visibility"), null, width, rect, "grey", 1), { ...rect, x: 0, y: 0 }, factor));
    const [left, right] = await Promise.all(whos.map(magnify));
    return { rect, left, right };
  };
  // What the viewer can show of a side; a plane of a family joins them as it is met.
  const describe = (name, title) => ({ name, title, palette: "diverging", least: 0.05, low: "darkens", high: "lightens" });
  const layers = [
    { name: "picture", title: "Picture" },
    { name: "visibility", title: "Visibility", palette: "grey", least: 1, low: "shadow", high: "lit" },
    { ...describe("error", "Error (visibility \u2212 truth)"), low: "darker than the truth", high: "lighter than the truth" },
    ...["numeric", "estimator", "discretisation", "model"].map((name) => describe(name, `Error part: ${name}`)),
    ...[["flip", "FLIP", 0.05], ["stability", "Stability", 0.01], ["uncertainty", "Uncertainty", 1e-4]].map(([name, title, least]) =>
      ({ name, title, palette: "heat", least, low: "", high: "" })),
  ];
  const layerOf = (name) => layers.find((each) => each.name === name);
  // A family of planes ("stability.min") becomes layers as its planes are met. Says whether the plane is new.
  const addLayer = (name) => {
    const family = /^(stability|uncertainty)\../.test(name) && layerOf(name.split(".")[0]);
    if (!family || layerOf(name)) return false;
    layers.splice(layers.indexOf(family) + 1, 0, { ...family, name, title: `${family.title}: ${name.slice(family.name.length + 1)}` });
    return true;
  };
  shadowbench.data = {
    run, kTruth, findEntry, listFilters, listAll, nameOf, quote, tell, loadFile, namePlane, nameShown, getNumbers, getMask, getPicture, cut, attempt, layers, layerOf, addLayer,
  };
})();
