// A short title of a GPU from what a browser says draws for it. That is the driver's own word, or "ANGLE (vendor, word,
// driver)", in which the word may be "Vulkan 1.3 (word (device))" and names the API that it is drawn by.
const titleGpu = (renderer) => {
  const plain = renderer.trim().replace(/\s*\((R|TM|C)\)|, or similar$/gi, "");
  const inner = /^ANGLE \((.*)\)$/.exec(plain)?.[1];
  const nested = /(?:ANGLE|Vulkan [\d.]+) \(([^()]+)/.exec(inner ?? plain)?.[1];
  const own = nested ?? inner?.replace(/^[^,]*, /, "") ?? plain;
  const [title] = own.replace(/^(ANGLE Metal Renderer: |Mesa (DRI )?)/, "").split(/ \(| Direct3D| OpenGL|[,/]/);
  return title.replace(/^(\w+) \1\b/, "$1").trim() || renderer;
};
