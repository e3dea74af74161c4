// What drawing with WebGL 2 needs beside frames: programs, a picture on a canvas, and how exactly this GPU samples.
const kTriangle = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }`;
// Throws what the browser complains of.
const linkProgram = (gl, label, vertex, fragment) => {
  const program = gl.createProgram();
  const shaders = [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ].map(([kind, text]) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    return shader;
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const log = [...shaders.map((shader) => gl.getShaderInfoLog(shader)), gl.getProgramInfoLog(program)].join(" ");
    throw new Error(`this browser refuses the shader of ${label}: ${log.trim() || "it gives no reason"}`);
  }
  return program;
};

const makeTexture = (gl, internal, width, height, levels = 1) => {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, levels, internal, width, height);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
};
// A texture that is drawn into; it is bound as the target.
const makeTarget = (gl, internal, width, height) => {
  const texture = makeTexture(gl, internal, width, height);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  return { texture, framebuffer };
};
// The first channel of the target that is bound, or of any rows of it, the topmost first.
const readValues = (gl, width, height) => {
  const texels = new Float32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, texels);
  const values = new Float32Array(width * height);
  for (let y = 0, i = 0; y < height; ++y)
    for (let x = 0; x < width; ++x, ++i) values[i] = texels[4 * ((height - 1 - y) * width + x)];
  return values;
};

// Shows on the canvas linear pictures, or values in a palette from -`most` or 0 to `most`, less those of another texture.
const makeDisplay = (gl) => {
  const list = (palette) =>
    readColours(kPalettes[palette]).map((rgb) => `vec3(${rgb.map((each) => `${each}.0`).join()}) / 255.0`);
  const fragment = `#version 300 es
    precision highp float;
    uniform sampler2D values, less;
    uniform float most;
    out vec4 color;
    vec3 show(vec4 texel, ivec2 place) {
      if (most == 0.0) {
        vec3 linear = clamp(texel.rgb, 0.0, 1.0);
        vec3 curve = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
        return mix(12.92 * linear, curve, greaterThan(linear, vec3(0.0031308)));
      }
      if (textureSize(less, 0) == ivec2(1)) return vec3(clamp(texel.r / most, 0.0, 1.0));
      vec3 stops[3] = vec3[](${list("diverging")});
      float error = clamp((texel.r - texelFetch(less, place, 0).r) / most, -1.0, 1.0);
      return mix(stops[1], error < 0.0 ? stops[0] : stops[2], abs(error));
    }
    void main() {
      ivec2 place = ivec2(gl_FragCoord.xy);
      color = vec4(show(texelFetch(values, place, 0), place), 1.0);
    }`;
  const program = linkProgram(gl, "the display", kTriangle, fragment);
  const place = (name) => gl.getUniformLocation(program, name);
  const array = gl.createVertexArray();
  const nothing = makeTexture(gl, gl.R32F, 1, 1);
  return {
    // `most` is 0 of linear colours.
    show: ({ object, width, height }, most = 0, less = null) => {
      if (gl.canvas.width !== width || gl.canvas.height !== height) Object.assign(gl.canvas, { width, height });
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST].forEach((each) => gl.disable(each));
      gl.useProgram(program);
      gl.bindVertexArray(array);
      gl.viewport(0, 0, width, height);
      [object, less ?? nothing].forEach((texture, unit) => {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindSampler(unit, null);
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.uniform1i(place(unit === 0 ? "values" : "less"), unit);
      });
      gl.uniform1f(place("most"), most);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      gl.activeTexture(gl.TEXTURE0);
    },
  };
};

// How exactly this GPU samples a map of `size` texels, by experiment: across the border of two texels, how far the
// weights of hardware 2x2 PCF are from the ideal ones, and how many texels off the border nearest sampling changes
// sides; and how far its cosines are off.
const measureSampling = (gl, size) => {
  const kSteps = 1024; // pixels across a texel
  const fragment = `#version 300 es
    precision highp float;
    uniform highp sampler2DShadow map;
    uniform float size;
    out float lit;
    void main() {
      float place = gl_FragCoord.x / ${kSteps}.0;
      lit = size > 0.0 ? texture(map, vec3(0.5 + (place - 0.5) / size, 0.5, 0.5)) : cos(6.28318530718 * place);
    }`;
  const program = linkProgram(gl, "the sampling's measurement", kTriangle, fragment);
  const map = makeTexture(gl, gl.DEPTH_COMPONENT32F, size, 1);
  const texels = Float32Array.from({ length: size }, (_, i) => (i < size / 2 ? 0 : 1));
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, size, 1, gl.DEPTH_COMPONENT, gl.FLOAT, texels);
  const { texture: target, framebuffer } = makeTarget(gl, gl.R32F, kSteps, 1);
  gl.viewport(0, 0, kSteps, 1);
  [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST].forEach((each) => gl.disable(each));
  gl.useProgram(program);
  gl.bindVertexArray(null);
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, map);
  const draw = (filter, own = size) => {
    gl.uniform1f(gl.getUniformLocation(program, "size"), own);
    const sampler = gl.createSampler();
    const set = (name, value) => gl.samplerParameteri(sampler, name, value);
    [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER].forEach((name) => set(name, filter));
    [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T].forEach((name) => set(name, gl.CLAMP_TO_EDGE));
    set(gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    set(gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
    gl.bindSampler(0, sampler);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindSampler(0, null);
    gl.deleteSampler(sampler);
    return Array.from(readValues(gl, kSteps, 1));
  };
  const farthest = (values) => Math.max(...values);
  const place = (i) => (i + 0.5) / kSteps;
  const weight = farthest(draw(gl.LINEAR).map((lit, i) => Math.abs(lit - place(i))));
  const isRight = (lit, i) => lit === Number(i >= kSteps / 2);
  const shift = farthest(draw(gl.NEAREST).map((lit, i) => (isRight(lit, i) ? 0 : Math.abs(place(i) - 0.5))));
  const turn = farthest(draw(gl.LINEAR, 0).map((cosine, i) => Math.abs(cosine - Math.cos(2 * Math.PI * place(i)))));
  [map, target].forEach((each) => gl.deleteTexture(each));
  gl.deleteFramebuffer(framebuffer);
  gl.deleteProgram(program);
  return { weight, shift, turn };
};
