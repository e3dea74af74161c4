// Loads the files of values beside the page, and makes pictures of numbers.
const kLastCode = 65534;
const kKeptValues = 64e6;

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

const arrivals = new Map();
const files = new Map();
const keepPlane = makeStore(kKeptValues);
window.shadowbenchValues = (path, file) => arrivals.get(path)?.(file);
const refuse = (path, why) => new Error(`${path} cannot be read: ${why}`);

const addScript = (path) =>
  new Promise((resolve, reject) => {
    const script = document.createElement("script");
    const end = (why) => {
      script.remove();
      arrivals.delete(path);
      reject(refuse(path, why)); // changes nothing once the values have arrived
    };
    arrivals.set(path, resolve);
    script.onload = () => end("it holds no values of that name.");
    script.onerror = () => end("the file is not beside this page.");
    script.src = path;
    document.head.append(script);
  });

const inflate = async (text) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
};

// The words, codes of 16 bits or floats of 32, are differences to the one at the left in their row; all high bytes come
// first.
const decode = async (path, width, height, { low, high, data }) => {
  if (!window.DecompressionStream) throw refuse(path, "this browser cannot unpack it; a newer one can.");
  const bytes = await inflate(data).catch(() => []);
  const count = width * height;
  const step = (high - low) / kLastCode;
  const isFloat = low === undefined;
  if (bytes.length !== (isFloat ? 4 : 2) * count) throw refuse(path, "it is damaged or cut short.");
  const values = new Float32Array(count);
  const words = new Uint32Array(values.buffer);
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
const readFile = async (path) => {
  const { width, height, planes } = await addScript(path);
  const read = (plane) => () =>
    keepPlane(`${path} ${plane.name}`, width * height, () => decode(path, width, height, plane));
  return { width, height, planes: new Map(planes.map((plane) => [plane.name, read(plane)])) };
};
const loadValues = (path) => {
  if (!files.has(path)) files.set(path, readFile(path));
  return files.get(path);
};

const subtract = (left, right) => {
  if (left.length !== right.length) throw new Error("The two sides have different sizes.");
  return left.map((value, i) => value - right[i]);
};

// The scale of error images, as the program's figures have it: what 95 % of the magnitudes over the receivers do not
// exceed, of those that anybody sees, rounded up to 1, 2 or 5 times a power of 10. It counts in small steps.
const findScale = (planes, mask, least) => {
  const counts = new Uint32Array(4096);
  const visit = (look) => {
    for (const plane of planes)
      plane.forEach((value, i) => (!mask || mask[i]) && Math.abs(value) >= 0.1 * least && look(Math.abs(value)));
  };
  let largest = 0;
  visit((size) => Number.isFinite(size) && (largest = Math.max(largest, size)));
  visit((size) => Number.isFinite(size) && ++counts[Math.floor((size / largest) * 4095)]);
  const total = counts.reduce((sum, count) => sum + count, 0);
  let step = 0;
  for (let seen = counts[0]; seen < 0.95 * total; seen += counts[step]) ++step;
  const most = Math.max(least, ((step + 1) / 4096) * largest);
  const power = 10 ** Math.floor(Math.log10(most));
  return [1, 2, 5, 10].map((factor) => factor * power).find((end) => most <= end * (1 + 1e-6));
};

// The ends and the middle of the first are those of the heat maps that the program draws.
const kPalettes = {
  diverging: ["#174fa8", "#f2f2f0", "#bd1721"],
  grey: ["#000000", "#ffffff"],
  heat: ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"],
};
const pack = ([red, green, blue]) => ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
const readColours = (colours) => colours.map((text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)));
const makeTable = (colours) => {
  const stops = readColours(colours);
  return Uint32Array.from({ length: 256 }, (_, i) => {
    const at = (i / 255) * (stops.length - 1);
    const from = Math.min(Math.floor(at), stops.length - 2);
    const mix = (channel, j) => Math.round(channel + (at - from) * (stops[from + 1][j] - channel));
    return pack(stops[from].map(mix));
  });
};
const tables = Object.fromEntries(Object.entries(kPalettes).map(([name, colours]) => [name, makeTable(colours)]));
const kHatch = [pack([156, 156, 156]), pack([168, 168, 168])];

const makeCanvas = (width, height) => Object.assign(document.createElement("canvas"), { width, height });

// Draws a part of a plane, one pixel for each number; what does not count is hatched.
const paint = (numbers, mask, width, rect, palette, scale) => {
  const canvas = makeCanvas(rect.width, rect.height);
  const image = new ImageData(rect.width, rect.height);
  const pixels = new Uint32Array(image.data.buffer);
  const table = tables[palette];
  const factor = (palette === "diverging" ? 127.5 : 255) / scale;
  const zero = palette === "diverging" ? 128 : 0.5;
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
