// Draws with WebGL 2 what a run drew with OpenGL. A frame is a graph of steps (live/frame_file.h says what they hold):
// a step is drawn again where what it depends on has changed, and at no other time.
const kGl = window.WebGL2RenderingContext ?? {}; // a browser without it still reads the rest of the page
// Formats of the run that WebGL names otherwise, or in an extension alone.
const kFormats = {
  ...{ r16: 0x822a, rg16: 0x822c, rgba16: 0x805b },
  ...{ d16: kGl.DEPTH_COMPONENT16, d24: kGl.DEPTH_COMPONENT24, d32f: kGl.DEPTH_COMPONENT32F },
};
const kClampToBorder = 0x812d;
const kDepth = -1; // the place of a target that holds depth
const isSampler = (type) =>
  [kGl.SAMPLER_2D, kGl.SAMPLER_2D_SHADOW, kGl.UNSIGNED_INT_SAMPLER_2D, kGl.INT_SAMPLER_2D].includes(type);
const kSetters = {
  [kGl.FLOAT]: "uniform1fv",
  [kGl.FLOAT_VEC2]: "uniform2fv",
  [kGl.FLOAT_VEC3]: "uniform3fv",
  [kGl.FLOAT_VEC4]: "uniform4fv",
  [kGl.INT]: "uniform1iv",
  [kGl.INT_VEC2]: "uniform2iv",
  [kGl.BOOL]: "uniform1iv",
  [kGl.UNSIGNED_INT]: "uniform1uiv",
};

const makePlayer = (gl, frames, blobs) => {
  const textures = frames.textures.map(() => null);
  const programs = frames.programs.map(() => null);
  const buffers = frames.blobs.map(() => null);
  const arrays = new Map();
  const samplers = new Map();
  const framebuffers = new Map();
  const overrides = new Map(); // uniforms that are not the run's, by step and name, with the turn of their change
  const standIns = new Map(); // textures that stand in for a sampler's, by its name, with the turn of their change
  const known = new Map(); // steps whose textures hold what the run drew, with the turn of that
  let turn = 0;

  const remember = (map, key, make) => {
    if (!map.has(key)) map.set(key, make());
    return map.get(key);
  };
  const need = (extension) => {
    if (!gl.getExtension(extension)) throw new Error(`this browser's WebGL lacks ${extension}.`);
  };

  const textureOf = (index) => {
    if (textures[index]) return textures[index];
    const { format, width, height, levels, samples } = frames.textures[index];
    if (samples > 0) throw new Error("WebGL 2 has no textures of several samples.");
    if (/^rg?b?a?16$/.test(format)) need("EXT_texture_norm16");
    if (/^r.*32f$/.test(format)) need("OES_texture_float_linear");
    const object = makeTexture(gl, kFormats[format] ?? gl[format.toUpperCase()], width, height, levels);
    const isInteger = /ui$/.test(format);
    const isDepth = /^d/.test(format);
    textures[index] = { object, width, height, isDepth, isInteger, contents: Array(levels).fill(null), ringed: null };
    return textures[index];
  };

  const programOf = (index) => {
    if (programs[index]) return programs[index];
    const { label, vertex, fragment, refused } = frames.programs[index];
    if (refused) throw new Error(`${refused}.`);
    const object = linkProgram(gl, label, vertex, fragment);
    const count = gl.getProgramParameter(object, gl.ACTIVE_UNIFORMS);
    const uniforms = Array.from({ length: count }, (_, i) => gl.getActiveUniform(object, i)).map(({ name, type }) => ({
      name,
      type,
      location: gl.getUniformLocation(object, name),
    }));
    return (programs[index] = { object, uniforms, label });
  };

  const samplerOf = ({ minify, magnify, wrap, compare }) => {
    const edge = wrap === kClampToBorder ? gl.CLAMP_TO_EDGE : wrap;
    return remember(samplers, [minify, magnify, edge, compare].join(), () => {
      const sampler = gl.createSampler();
      const set = (name, value) => gl.samplerParameteri(sampler, name, value);
      set(gl.TEXTURE_MIN_FILTER, minify);
      set(gl.TEXTURE_MAG_FILTER, magnify);
      set(gl.TEXTURE_WRAP_S, edge);
      set(gl.TEXTURE_WRAP_T, edge);
      set(gl.TEXTURE_COMPARE_MODE, compare ? gl.COMPARE_REF_TO_TEXTURE : gl.NONE);
      if (compare) set(gl.TEXTURE_COMPARE_FUNC, compare);
      return sampler;
    });
  };

  const framebufferOf = (targets) =>
    remember(framebuffers, JSON.stringify(targets), () => {
      const object = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, object);
      const colors = [];
      for (const { place, texture, level } of targets) {
        const attachment = place === kDepth ? gl.DEPTH_ATTACHMENT : gl.COLOR_ATTACHMENT0 + place;
        gl.framebufferTexture2D(gl.FRAMEBUFFER, attachment, gl.TEXTURE_2D, textureOf(texture).object, level);
        if (place !== kDepth) colors[place] = attachment;
      }
      gl.drawBuffers(Array.from(colors, (each) => each ?? gl.NONE));
      if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE)
        throw new Error("this browser's WebGL cannot draw into the formats of this frame.");
      return object;
    });
  const bindTargets = (targets) => {
    const plain = targets.map(({ place, texture, level }) => ({ place, texture, level }));
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebufferOf(plain));
  };

  const bufferOf = (blob) => {
    if (buffers[blob]) return buffers[blob];
    buffers[blob] = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[blob]);
    gl.bufferData(gl.ARRAY_BUFFER, blobs[blob], gl.STATIC_DRAW);
    return buffers[blob];
  };
  const arrayOf = (vertices) =>
    remember(arrays, JSON.stringify(vertices ?? null), () => {
      const array = gl.createVertexArray();
      if (!vertices) return array;
      if (vertices.blob === null) throw new Error("the scene has too many triangles for this page.");
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ARRAY_BUFFER, bufferOf(vertices.blob));
      for (const [location, components, offset] of vertices.attributes) {
        gl.enableVertexAttribArray(location);
        gl.vertexAttribPointer(location, components, gl.FLOAT, false, vertices.stride, offset);
      }
      return array;
    });

  // WebGL 2 has no colour beyond a texture's border: the outermost texels have it instead, and go on for ever.
  const drawRing = (input) => {
    const texture = textureOf(input.texture);
    if (input.wrap !== kClampToBorder || texture.isInteger || texture.ringed === texture.contents[0]) return;
    bindTargets([{ place: texture.isDepth ? kDepth : 0, texture: input.texture, level: 0 }]);
    gl.enable(gl.SCISSOR_TEST);
    gl.depthMask(true);
    const { width, height } = texture;
    const sides = [
      [0, 0, width, 1],
      [0, height - 1, width, 1],
      [0, 0, 1, height],
      [width - 1, 0, 1, height],
    ];
    for (const side of sides) {
      gl.scissor(...side);
      if (texture.isDepth) gl.clearBufferfv(gl.DEPTH, 0, [input.border[0]]);
      else gl.clearBufferfv(gl.COLOR, 0, input.border);
    }
    gl.disable(gl.SCISSOR_TEST);
    texture.ringed = texture.contents[0];
  };

  const setState = ({ viewport, depth, writesDepth, adds, culled, offset }) => {
    const switchTo = (capability, isOn) => (isOn ? gl.enable(capability) : gl.disable(capability));
    gl.viewport(...viewport);
    switchTo(gl.DEPTH_TEST, depth !== gl.NONE);
    if (depth !== gl.NONE) gl.depthFunc(depth);
    gl.depthMask(writesDepth);
    switchTo(gl.BLEND, adds);
    gl.blendFunc(gl.ONE, gl.ONE);
    switchTo(gl.CULL_FACE, culled !== gl.NONE);
    if (culled !== gl.NONE) gl.cullFace(culled);
    switchTo(gl.POLYGON_OFFSET_FILL, offset[0] !== 0 || offset[1] !== 0);
    gl.polygonOffset(...offset);
  };
  const setUniform = ({ name, type, location }, values) => {
    if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(location, false, values);
    else gl[kSetters[type]](location, values);
  };
  const valuesOf = (index, name) => overrides.get(`${index} ${name}`)?.values ?? frames.steps[index].uniforms[name];
  // The program keeps samplers that the run's compiler had dropped: they get a unit of their own, without a texture.
  const bindUniforms = (program, index) => {
    const step = frames.steps[index];
    let unit = 0;
    for (const uniform of program.uniforms) {
      if (!isSampler(uniform.type)) {
        const values = valuesOf(index, uniform.name);
        if (values) setUniform(uniform, values);
        continue;
      }
      const input = step.inputs.find(({ sampler }) => sampler === uniform.name);
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(
        gl.TEXTURE_2D,
        standIns.get(uniform.name)?.texture ?? (input ? textureOf(input.texture).object : null),
      );
      if (input) {
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, Math.max(0, input.levels.length - 1));
        gl.bindSampler(unit, samplerOf(input));
      }
      gl.uniform1i(uniform.location, unit++);
    }
    gl.activeTexture(gl.TEXTURE0);
  };
  const issue = (index) => {
    const step = frames.steps[index];
    const program = programOf(step.program);
    step.inputs.forEach(drawRing);
    bindTargets(step.targets);
    setState(step);
    gl.useProgram(program.object);
    bindUniforms(program, index);
    gl.bindVertexArray(arrayOf(step.vertices));
    gl.drawArrays(gl.TRIANGLES, step.first, step.count);
  };
  const kActions = {
    draw: issue,
    clear: (index) => {
      const { targets, value } = frames.steps[index];
      const [target] = targets;
      bindTargets([target.place === kDepth ? target : { ...target, place: 0 }]);
      gl.depthMask(true);
      if (target.place === kDepth) gl.clearBufferfv(gl.DEPTH, 0, [value[0]]);
      else gl.clearBufferfv(gl.COLOR, 0, value);
    },
    upload: (index) => {
      const { targets, format, type, blob } = frames.steps[index];
      const { object, width, height } = textureOf(targets[0].texture);
      const bytes = blobs[blob];
      const texels = type === gl.FLOAT ? new Float32Array(bytes.buffer, 0, bytes.byteLength / 4) : bytes;
      gl.bindTexture(gl.TEXTURE_2D, object);
      gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format, type, texels);
    },
    mipmaps: (index) => {
      gl.bindTexture(gl.TEXTURE_2D, textureOf(frames.steps[index].targets[0].texture).object);
      gl.generateMipmap(gl.TEXTURE_2D);
    },
  };

  const sourcesOf = (step) =>
    (step.inputs ?? [])
      .flatMap(({ sampler, levels }) => (standIns.has(sampler) ? [] : levels))
      .concat(step.targets.map(({ before }) => before))
      .filter((source) => source !== null);
  // The turn of the newest change that a step depends on.
  const stampOf = (index, seen) => {
    if (known.has(index)) return known.get(index);
    if (seen.has(index)) return seen.get(index);
    const step = frames.steps[index];
    const own = Object.keys(step.uniforms ?? {})
      .map((name) => overrides.get(`${index} ${name}`)?.turn ?? 0)
      .concat((step.inputs ?? []).map(({ sampler }) => standIns.get(sampler)?.turn ?? 0));
    const stamp = Math.max(0, ...own, ...sourcesOf(step).map((source) => stampOf(source, seen)));
    seen.set(index, stamp);
    return stamp;
  };
  const isWritten = ({ op, writesDepth }, { place }) => place !== kDepth || op !== "draw" || writesDepth;
  const listWritten = (step) => step.targets.filter((target) => isWritten(step, target));
  const isCurrent = (index, seen) =>
    known.has(index) ||
    listWritten(frames.steps[index]).every(({ texture, level }) => {
      const held = textures[texture]?.contents[level];
      return held && held.index === index && held.stamp === stampOf(index, seen);
    });
  const ensure = (index, seen) => {
    if (isCurrent(index, seen)) return;
    const step = frames.steps[index];
    const sources = sourcesOf(step);
    // A source may overwrite what another one has drawn: that is drawn once more then.
    for (let tries = 0; tries < 3 && !sources.every((source) => isCurrent(source, seen)); ++tries)
      for (const source of sources) ensure(source, seen);
    kActions[step.op](index);
    for (const { texture, level } of listWritten(step))
      textureOf(texture).contents[level] = { index, stamp: stampOf(index, seen) };
  };

  // Texels of depth as their format takes them.
  const encodeTexels = (format, values) => {
    if (format === "d16") return [gl.UNSIGNED_SHORT, Uint16Array.from(values, (value) => Math.round(65535 * value))];
    if (format === "d24") return [gl.UNSIGNED_INT, Uint32Array.from(values, (value) => Math.round(4294967295 * value))];
    return [gl.FLOAT, values];
  };
  // Puts what the run drew in the place of what this GPU draws, until `forget` is called.
  const know = ({ texture, step, rect: [x, y, columns, rows], channels, fill, blob }) => {
    const { object, width, height, contents, isDepth } = textureOf(texture);
    const values = new Float32Array(width * height * channels).fill(fill);
    for (let row = 0; row < rows; ++row)
      values.set(
        blobs[blob].subarray(row * columns * channels, (row + 1) * columns * channels),
        ((y + row) * width + x) * channels,
      );
    const [type, texels] = encodeTexels(frames.textures[texture].format, values);
    gl.bindTexture(gl.TEXTURE_2D, object);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, isDepth ? gl.DEPTH_COMPONENT : gl.RGBA, type, texels);
    known.set(step, ++turn);
    contents[0] = { index: step, stamp: turn };
  };
  const forget = ({ texture, step }) => {
    textureOf(texture).contents.fill(null);
    known.delete(step);
  };

  // A step with all that it needs, in an order in which they can be drawn.
  const listSteps = (index, found = new Set()) => {
    if (found.has(index)) return found;
    for (const source of sourcesOf(frames.steps[index])) listSteps(source, found);
    return found.add(index);
  };
  const inputOf = (index, name) =>
    frames.steps[index].inputs.find(({ sampler }) => sampler === name)?.levels[0] ?? null;
  // Of a scene that is too large to be drawn, receivers and map are the run's for good.
  if (frames.check.whole) frames.check.known.forEach(know);
  return {
    // Draws a step, and what it needs of others.
    draw: (index) => ensure(index, new Map()),
    // Draws some steps alone, again and again: all that they read is there. What one step needs is set once, so that a
    // fast GPU does not wait for the page.
    repeat: (indices, count) => {
      const [only] = indices.length === 1 ? indices.map((index) => frames.steps[index]) : [];
      for (let i = 0; i < count; ++i)
        if (i > 0 && only?.op === "draw") gl.drawArrays(gl.TRIANGLES, only.first, only.count);
        else indices.forEach((index) => kActions[frames.steps[index].op](index));
    },
    inputOf,
    textureOf: (index) => textureOf(frames.steps[index].targets[0].texture),
    listSteps,
    // Acts on what the run drew of receivers and map, as far as it is known.
    withKnown: (action) => {
      if (frames.check.whole) return action();
      frames.check.known.forEach(know);
      try {
        return action();
      } finally {
        frames.check.known.forEach(forget);
      }
    },
    // Gives uniforms of a step other values; null gives them the run's own again.
    setUniforms: (index, changes) => {
      ++turn;
      for (const [name, values] of Object.entries(changes)) {
        const key = `${index} ${name}`;
        const isNew = String(overrides.get(key)?.values ?? null) !== String(values);
        if (isNew) overrides.set(key, { values, turn });
      }
    },
    // Puts a texture in the place of one that a sampler reads; null takes it away.
    standIn: (sampler, texture) => {
      ++turn;
      if (texture) standIns.set(sampler, { texture, turn });
      else standIns.delete(sampler);
    },
    read: (index) => {
      const { width, height } = textureOf(frames.steps[index].targets[0].texture);
      bindTargets(frames.steps[index].targets);
      return readValues(gl, width, height);
    },
  };
};

// Loads what a run wrote of its frames, when it is asked for: promises the frames, their buffers and textures, and the
// player that draws them.
const makeLoader = (gl) => {
  const players = new Map();
  const unpacked = new Map(); // by path: frames share them
  const unpack = (blob) => {
    if (!unpacked.has(blob.path)) unpacked.set(blob.path, readBlob(blob));
    return unpacked.get(blob.path);
  };
  const readBlob = async ({ path, rows, columns }) => {
    const text = await addScript(path);
    if (columns === 0) return inflate(text);
    const planes = await decode(path, rows, columns, { data: text });
    const vertices = new Float32Array(rows * columns);
    for (let column = 0; column < columns; ++column)
      for (let row = 0; row < rows; ++row) vertices[row * columns + column] = planes[column * rows + row];
    return vertices;
  };
  const openFrames = async (path) => {
    const frames = JSON.parse(new TextDecoder().decode(await inflate(await addScript(path))));
    const blobs = await Promise.all(frames.blobs.map(unpack));
    return { frames, blobs, player: makePlayer(gl, frames, blobs) };
  };
  return (path) => {
    if (!players.has(path)) players.set(path, openFrames(path));
    return players.get(path);
  };
};
