// What the package filament 1.53.4 lacks, and is had all the same: options of shadows, 32 bits, and pictures read back.

export const fail = (sentence) => {
  throw new Error(sentence);
};

// Its ShadowOptions have a field of a type that is never bound, so that all calls with them throw. Without the field
// they do not; `instantiateWasm` is Emscripten's own hook.
const instantiateWasm = (imports, receive) => {
  let memory;
  const isTransform = (at) => new TextDecoder().decode(new Uint8Array(memory.buffer, at, 10)) === "transform\0";
  for (const [key, bind] of Object.entries(imports.a))
    if (bind.name === "__embind_register_value_object_field")
      imports.a[key] = (type, name, ...rest) => isTransform(name) || bind(type, name, ...rest);
  WebAssembly.instantiateStreaming(fetch("/node_modules/filament/filament.wasm"), imports).then((made) => {
    memory = Object.values(made.instance.exports).find((is) => is instanceof WebAssembly.Memory);
    receive(made.instance, made.module);
  });
  return {};
};

// It is no module: it puts a function into the window, and init puts what that makes in its place.
export const loadPackage = async () => {
  const script = Object.assign(document.createElement("script"), { src: "/node_modules/filament/filament.js" });
  document.head.append(script);
  await new Promise((done, fail) => Object.assign(script, { onload: done, onerror: fail }));
  const make = window.Filament;
  window.Filament = Object.assign(() => make({ instantiateWasm }), make);
  await new Promise((done) => window.Filament.init([], done));
  return window.Filament;
};

// Before the engine is made: sees in its calls of GL which texture has floats, and lets its shaders have them if they
// ask for 16 bits. Gives read(), the values of that texture.
export const watch = (gl, precision) => {
  const { texStorage2D, shaderSource } = gl;
  const framebuffer = gl.createFramebuffer();
  let texture, width, height;
  gl.getExtension("EXT_color_buffer_float");
  gl.texStorage2D = (target, levels, format, ...size) => {
    if (format === gl.RGBA32F) [texture, width, height] = [gl.getParameter(gl.TEXTURE_BINDING_2D), ...size];
    texStorage2D.call(gl, target, levels, format, ...size);
  };
  const raise = (text) => (precision === "high" ? text.replace(/\b(mediump|lowp)\b/g, "highp") : text);
  gl.shaderSource = (shader, text) => shaderSource.call(gl, shader, raise(text));
  return () => {
    const before = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, framebuffer);
    gl.framebufferTexture2D(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    const values = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, before); // which the engine takes to be as it left it
    return values;
  };
};
