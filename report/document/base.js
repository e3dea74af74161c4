// What all scripts share: elements, numbers as people read them, and the page's address.
const shadowbench = (window.shadowbench ??= {});

const element = (parent, name, properties = {}, text = undefined) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties))
    key in made ? (made[key] = value) : made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
};
const addSelect = (parent, text, options, properties, onPick) => {
  const select = element(element(parent, "label", {}, text + " "), "select", properties);
  for (const [value, title] of options) select.add(new Option(title, value));
  select.addEventListener("change", () => onPick(select.value));
  return select;
};
const addButton = (parent, text, onclick, title = "") =>
  element(parent, "button", { type: "button", onclick, title }, text);

// Three digits, and those before the point in full.
const shorten = (value) => (Math.abs(value) >= 99.95 ? Math.round(value) : Number(value.toPrecision(3)));
// A number as people read it: whole numbers with their thousands apart, shares in percent, bytes in powers of 1024.
const format = (value, unit = "") => {
  if (value === null) return "\u2013";
  if (unit === "share") return `${shorten(100 * value)} %`;
  const step = unit === "bytes" && value >= 1024 ? Math.min(3, Math.floor(Math.log2(value) / 10)) : 0;
  const text = step === 0 && Number.isInteger(value) ? value.toLocaleString("en") : `${shorten(value / 1024 ** step)}`;
  return unit === "bytes" ? `${text} ${["B", "KiB", "MiB", "GiB"][step]}` : text;
};

// What the reader chose is in the page's address, a part for each script, so that a link opens the same view.
const kSavedAfterMs = 300;
const unsaved = new Map();
let saving = 0;
const decodeField = (text) => {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
};
const readParts = () => {
  const parts = location.hash.slice(1).split("&");
  return new Map(parts.map((part) => part.split("=")).filter(([, text]) => text !== undefined));
};
const readLink = (name) => readParts().get(name)?.split(",").map(decodeField) ?? null;
const writeLink = (name, fields) => {
  unsaved.set(name, fields.map(encodeURIComponent).join(","));
  clearTimeout(saving);
  saving = setTimeout(() => {
    const parts = readParts();
    for (const [part, text] of unsaved) {
      parts.delete(part); // the one that was changed last stands last
      parts.set(part, text);
    }
    unsaved.clear();
    try {
      history.replaceState(null, "", "#" + [...parts].map((part) => part.join("=")).join("&"));
    } catch {
      // A page inside another page may not change its address.
    }
  }, kSavedAfterMs);
};

// Acts once an element is near the screen.
const onceSeen = (node, action) => {
  const act = (entries, watcher) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    watcher.disconnect();
    action();
  };
  new IntersectionObserver(act, { rootMargin: "300px" }).observe(node);
};
