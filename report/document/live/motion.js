// Moves a light: its map is drawn by the run's own steps, with other matrices for each of its layers. A sun turns about
// the scene's middle, and its windows become as large as they must be: fitted to the scene as the program fits them, or
// around what the camera sees of it where the run's windows follow that. A spot light goes round the middle and keeps
// looking at what it looked at; a point light goes round it too, and the faces of its cube stay parallel to the axes.
const kOfLight = [
  ...["clip_from_world", "uv_depth_from_world", "light_direction_ws", "light_right_ws", "light_up_ws"],
  ...["texel_size_ws", "depth_range_ws", "bias_constant", "bias_slope", "light_position_ws", "far_over_near"],
];
const kWindowMargin = 1.05; // for kernels beyond the border
const kNearestShare = 1 / 500; // of a lamp's far plane, as the program has it

const rowOf = (m, row, length = 4) => Array.from({ length }, (_, i) => m[4 * i + row]);
const lengthOfRow = (m, row) => Math.hypot(...rowOf(m, row, 3));
const setRow = (m, row, values) => m.map((value, i) => ((i & 3) === row ? values[i >> 2] : value));
const add = (a, b, factor = 1) => a.map((value, i) => value + factor * b[i]);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);

// The sphere around what a camera sees between two depths: through the corners, or around the far ones alone.
const findSlice = ({ clip, position, forward }, from, to) => {
  const half = Math.hypot(1 / lengthOfRow(clip, 0), 1 / lengthOfRow(clip, 1));
  const isPerspective = lengthOfRow(clip, 3) > 0;
  const at = isPerspective ? Math.min(to, ((from + to) / 2) * (1 + half * half)) : (from + to) / 2;
  const reachTo = (depth) => Math.hypot(depth - at, half * (isPerspective ? depth : 1));
  return { middle: add(position, forward, at), radius: Math.max(reachTo(from), reachTo(to)) };
};

const axisLeastParallel = (direction) => {
  const [x, y, z] = direction.map(Math.abs);
  if (z <= x && z <= y) return [0, 0, 1];
  return x <= y ? [1, 0, 0] : [0, 1, 0];
};
// A sun's axes, which depend on its direction alone, and its scene's extent along them, from the scene's middle.
const fitScene = ({ middle, farthest, forEach }, direction, fit) => {
  const back = direction.map((value) => -value);
  const right = normalise(cross(axisLeastParallel(direction), back));
  const axes = [right, cross(back, right), back];
  let [low, high] = [axes.map(() => Infinity), axes.map(() => -Infinity)];
  let reach = 0;
  forEach((x, y, z) => {
    const from = [x - middle[0], y - middle[1], z - middle[2]];
    reach = Math.max(reach, dot(from, from));
    for (let i = 0; i < 3; ++i) {
      const along = axes[i][0] * from[0] + axes[i][1] * from[1] + axes[i][2] * from[2];
      if (along < low[i]) low[i] = along;
      if (along > high[i]) high[i] = along;
    }
  });
  if (fit === "sphere") [low, high] = [-1, 1].map((side) => axes.map(() => side * Math.sqrt(reach)));
  const [wide, tall, deep] = low.map((value, i) => high[i] - value);
  const side = Math.max(wide, tall, 1e-3 * deep);
  // Depth is computed in single precision.
  const padding = Math.max(1e-4 * deep, deep < 1e-3 * side ? 5e-4 * side : 0, 8 * 2 ** -23 * farthest);
  return { axes, side, low, high: [high[0], high[1], high[2] + padding], deep: deep + 2 * padding };
};
// What a sun's layer becomes over a whole scene; `own` is what the scene's extent is in the run's own window.
const frameScene = (uv, { middle }, { axes, side, low, high, deep }, own) => {
  const width = side / own.side / lengthOfRow(uv, 0);
  const row = (axis, share, at) => [...axis.map((value) => value * share), at - share * dot(axis, middle)];
  const centre = (i) => 0.5 - (low[i] + high[i]) / (2 * width);
  const rows = [
    row(axes[0], 1 / width, centre(0)),
    row(axes[1], 1 / width, centre(1)),
    row(axes[2], -1 / deep, high[2] / deep),
    [0, 0, 0, 1],
  ];
  const fitted = Array.from({ length: 16 }, (_, i) => rows[i & 3][i >> 2]);
  // Rows of clip space are multiples of those of the map's, with something added.
  const clipOf = (clip) =>
    [0, 1, 2].reduce((matrix, r) => {
      const factor = dot(rowOf(clip, r, 3), rowOf(uv, r, 3)) / lengthOfRow(uv, r) ** 2;
      const added = add(rowOf(clip, r), rowOf(uv, r), -factor);
      return setRow(matrix, r, add(added, rows[r], factor));
    }, fitted);
  return { wide: side / own.side, deep: deep * lengthOfRow(uv, 2), uv: fitted, clipOf, axes };
};

// What a sun's layer becomes that covers a sphere of a scene; `back` takes the world to where the sun was.
const frameSun = (uv, back, cover, { middle, radius }) => {
  const wide = 2 * cover.radius * Math.max(lengthOfRow(uv, 0), lengthOfRow(uv, 1));
  const deep = 2 * radius * lengthOfRow(uv, 2);
  const narrow = (own, center) => {
    const matrix = multiply(own, back);
    const [u, v] = transform(matrix, cover.middle, 1);
    const toOrigin = multiply(shiftBy([-u, -v, -transform(matrix, middle, 1)[2]]), matrix);
    return multiply(shiftBy(center), multiply(scaleBy([1 / wide, 1 / wide, 1 / deep]), toOrigin));
  };
  return { wide, deep, uv: narrow(uv, [0.5, 0.5, 0.5]), clipOf: (clip) => narrow(clip, [0, 0, 0.5]) };
};
// What a lamp's layer becomes, so far from a scene's middle; `range` is the run's own from the near to the far plane.
const frameLamp = (uv, back, range, distance, { radius }) => {
  const far = 1.001 * (distance + radius);
  const near = Math.max((distance - radius) / Math.sqrt(3), kNearestShare * far);
  const turned = multiply(uv, back);
  const along = rowOf(turned, 3);
  const past = add(along, [0, 0, 0, near], -1).map((value) => value / (far - near));
  const clipOf = (clip) => {
    const isReversed = dot(rowOf(clip, 2, 3), rowOf(clip, 3, 3)) < 0;
    const depth = past.map((value) => far * value);
    return setRow(multiply(clip, back), 2, isReversed ? add(along, depth, -1) : depth);
  };
  return { wide: 1, deep: (far - near) / range, uv: setRow(turned, 2, past), clipOf, farOverNear: far / near };
};

// `bounds` are the scene's; `cameraNow` gives where the camera is; `fit` is the run's.
const makeLightMotion = (player, { steps, casters, bounds, fit, cameraNow, uniformsOf }) => {
  const { middle, radius } = bounds;
  const find = (name) => steps.map((index) => uniformsOf(index)[name]).find(Boolean);
  const followsView = /^(view|cascades)/.test(fit);
  const byMatrix = new Map();
  for (const { uv_depth_from_world: uv, layer_slice: slice } of steps.map(uniformsOf))
    if (uv && !byMatrix.has(String(uv))) byMatrix.set(String(uv), { uv, slice });
  const layers = [...byMatrix.values()];
  // A layer's casters have its window, but not its matrix.
  const gapTo =
    (clip) =>
    ({ uv }) =>
      clip.reduce((sum, value, i) => sum + ((i & 3) < 2 ? Math.abs(value - (2 * uv[i] - uv[i | 3])) : 0), 0);
  const nearest = (clip) => layers.reduce((a, b) => (gapTo(clip)(b) < gapTo(clip)(a) ? b : a));
  const layerOf = new Map();
  for (const index of layers.length > 0 ? steps : []) {
    const { uv_depth_from_world: uv, clip_from_world: clip } = uniformsOf(index);
    const read = () => [...player.listSteps(index)].map((each) => layerOf.get(each)).find(Boolean);
    layerOf.set(index, uv ? byMatrix.get(String(uv)) : casters.includes(index) ? nearest(clip) : read());
  }
  const direction = find("light_direction_ws");
  const lamp = find("light_position_ws");
  const isCube = find("layer_face") !== undefined;
  const isBall = lamp && !(find("light_cone")?.[1] > -1); // a point light, which has no cone
  const stays = layers.length === 0 || find("map_texels") ? "its map is warped for the run's own camera and light" : "";

  const coverOf = ({ slice = [0, 0, Infinity, Infinity] }) => {
    const camera = cameraNow();
    const depth = dot(add(middle, camera.position, -1), camera.forward);
    const [from, to] = [Math.max(0, slice[0], depth - radius), Math.min(slice[3], depth + radius)];
    const seen = followsView && from < to ? findSlice(camera, from, to) : bounds;
    return seen.radius < radius ? { ...seen, radius: kWindowMargin * seen.radius } : bounds;
  };
  const isOfScene = !lamp && /^(tight|sphere)$/.test(fit);
  const ofScene = isOfScene && direction && fitScene(bounds, direction, fit);
  const fits = new Map(); // the last one, by direction: a reference draws many maps of one
  const fitAt = (towards) => {
    const key = String(towards);
    if (!fits.has(key)) {
      fits.clear();
      fits.set(key, fitScene(bounds, towards, fit));
    }
    return fits.get(key);
  };
  const restore = () => {
    for (const index of steps)
      if (!uniformsOf(index).camera_forward_ws || !uniformsOf(index).clip_from_world)
        player.setUniforms(index, Object.fromEntries(kOfLight.map((name) => [name, null])));
  };
  // `point` is one of the light's own, from its middle: tangents of a sun, metres of a lamp; only a point light is deep.
  const move = ([yaw, pitch], point = [0, 0, 0]) => {
    const isMoved = yaw !== 0 || pitch !== 0 || (followsView && cameraNow().isTurned);
    const off = Math.hypot(...point);
    if (!isMoved && off === 0) return restore();
    const turn = turnAround(middle, direction, yaw, pitch);
    const across = normalise(cross(direction, Math.abs(direction[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
    const beside = add(add([0, 0, 0], across, point[0]), cross(direction, across), point[1]);
    const about = (angle) => turnAt(middle, rotateAbout(normalise(beside), lamp ? 0 : angle));
    const tilt = Math.atan(Math.hypot(...beside));
    const shift = isBall ? add(beside, direction, point[2]) : beside;
    // A spot light's cone stays about its middle.
    const place = lamp && transform(turn.forth, isBall ? add(lamp, shift) : lamp, 1);
    const unshift = lamp ? shiftBy(shift.map((value) => -value)) : about(-tilt);
    const back = isCube ? shiftBy(add(lamp, place, -1)) : multiply(unshift, turn.back);
    const turned = (vector) => (isCube ? vector : transform(turn.forth, transform(about(tilt), vector, 0), 0));
    const distance = lamp && Math.hypot(...add(middle, lamp, -1));
    const own = ({ uv }) => ({ wide: 1, deep: 1, uv: multiply(uv, back), clipOf: (clip) => multiply(clip, back) });
    const tilted = (sign) => multiply(turn.forth, multiply(about(sign * tilt), turn.back));
    const refit = ({ uv }) => {
      const fitted = frameScene(uv, bounds, fitAt(transform(turn.forth, direction, 0)), ofScene);
      if (off === 0) return fitted;
      const clipOf = (clip) => multiply(fitted.clipOf(clip), tilted(-1));
      const axes = fitted.axes.map((axis) => transform(tilted(1), axis, 0));
      return { ...fitted, uv: multiply(fitted.uv, tilted(-1)), clipOf, axes };
    };
    const frame = (layer) =>
      lamp
        ? frameLamp(layer.uv, back, find("depth_range_ws")[0], distance, { radius: bounds.radius + off })
        : isOfScene
          ? refit(layer)
          : frameSun(layer.uv, back, coverOf(layer), bounds);
    const framed = new Map(layers.map((layer) => [layer, isMoved ? frame(layer) : own(layer)]));
    for (const index of steps) {
      const base = uniformsOf(index);
      const { wide, deep, uv, clipOf, farOverNear, axes } = framed.get(layerOf.get(index) ?? layers[0]);
      const changes = {};
      if (base.uv_depth_from_world) changes.uv_depth_from_world = uv;
      if (casters.includes(index)) changes.clip_from_world = clipOf(base.clip_from_world);
      if (base.light_position_ws) changes.light_position_ws = place;
      if (base.far_over_near && farOverNear) changes.far_over_near = [farOverNear];
      for (const name of ["light_direction_ws", "light_right_ws", "light_up_ws"])
        if (base[name]) changes[name] = turned(base[name]);
      if (axes && base.light_right_ws) [changes.light_right_ws, changes.light_up_ws] = axes;
      const factors = { texel_size_ws: wide, depth_range_ws: deep, bias_constant: 1 / deep, bias_slope: wide / deep };
      for (const [name, factor] of Object.entries(factors)) if (base[name]) changes[name] = [base[name][0] * factor];
      player.setUniforms(index, changes);
    }
  };
  return {
    isSun: !stays && !lamp,
    isFitted: isOfScene,
    stays,
    moveLight: stays ? () => {} : move,
    directionOf: ([yaw, pitch]) => transform(turnAround(middle, direction, yaw, pitch).forth, direction, 0),
  };
};

// Moves the camera of a frame: nothing is drawn but the run's own steps, with other matrices. Matrices are in
// columns, as uniforms have them.
const multiply = (a, b) =>
  Array.from({ length: 16 }, (_, i) => {
    const [column, row] = [i >> 2, i & 3];
    return [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + row] * b[4 * column + k], 0);
  });
const transform = (m, [x, y, z], w) =>
  [0, 1, 2].map((row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row] * w);
const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
const normalise = (v) => v.map((value) => value / (Math.hypot(...v) || 1));
const shiftBy = ([x, y, z]) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1];
const scaleBy = ([x, y, z]) => [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1];
// Source: Rodrigues' formula.
const rotateAbout = (axis, angle) => {
  const [x, y, z] = axis;
  const [c, s, t] = [Math.cos(angle), Math.sin(angle), 1 - Math.cos(angle)];
  return [
    ...[t * x * x + c, t * x * y + s * z, t * x * z - s * y, 0],
    ...[t * x * y - s * z, t * y * y + c, t * y * z + s * x, 0],
    ...[t * x * z + s * y, t * y * z - s * x, t * z * z + c, 0],
    ...[0, 0, 0, 1],
  ];
};
const turnAt = (pivot, turn) => multiply(multiply(shiftBy(pivot), turn), shiftBy(pivot.map((value) => -value)));
// A turn about the vertical, and before that one about what lies across a direction; and the same backwards.
const turnAround = (pivot, direction, yaw, pitch) => {
  const across = normalise(cross(direction, [0, 1, 0]));
  const up = [0, 1, 0];
  return {
    forth: turnAt(pivot, multiply(rotateAbout(up, yaw), rotateAbout(across, pitch))),
    back: turnAt(pivot, multiply(rotateAbout(across, -pitch), rotateAbout(up, -yaw))),
  };
};

// The vertices of a frame: middle and radius of their box, the largest coordinate, and a visit of each.
const findBounds = (frames, blobs, steps) => {
  const used = new Set(
    steps.map((index) => frames.steps[index].vertices?.blob).filter((each) => (each ?? null) !== null),
  );
  const forEach = (visit) => {
    for (const blob of used) {
      const stride = frames.blobs[blob].columns;
      const vertices = blobs[blob];
      // The first two vertices belong to no triangle.
      for (let i = 2 * stride; i + 2 < vertices.length; i += stride)
        visit(vertices[i], vertices[i + 1], vertices[i + 2]);
    }
  };
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  forEach((...place) => {
    for (let axis = 0; axis < 3; ++axis) {
      low[axis] = Math.min(low[axis], place[axis]);
      high[axis] = Math.max(high[axis], place[axis]);
    }
  });
  return {
    middle: low.map((value, i) => (value + high[i]) / 2),
    radius: Math.hypot(...low.map((value, i) => high[i] - value)) / 2,
    farthest: Math.max(...low.map(Math.abs), ...high.map(Math.abs)),
    forEach,
  };
};

const kTooLarge = "the scene has more triangles than go with a page";
const kOfCamera = ["clip_from_world", "camera_position_ws", "camera_forward_ws"];
const makeMotion = (player, frames, blobs, picture, fit) => {
  if (frames.check.whole) return { isSun: false, stays: kTooLarge, moveCamera: () => {}, moveLight: () => {} };
  const steps = [...player.listSteps(picture)].filter((index) => frames.steps[index].op === "draw");
  const labelOf = (index) => frames.programs[frames.steps[index].program].label;
  const uniformsOf = (index) => frames.steps[index].uniforms;
  const seen = steps.filter((index) => uniformsOf(index).camera_forward_ws);
  const casters = steps.filter((index) => labelOf(index).startsWith("depth"));
  const bounds = findBounds(frames, blobs, steps);
  const drawn = steps.find((index) => labelOf(index).startsWith("gbuffer"));
  const { camera_forward_ws: ahead, camera_position_ws: stand, clip_from_world: projection } = uniformsOf(drawn);
  const camera = { clip: projection, position: stand, forward: ahead, isTurned: false };

  const moveCamera = ([yaw, pitch]) => {
    camera.isTurned = yaw !== 0 || pitch !== 0;
    const { forth, back } = turnAround(bounds.middle, ahead, yaw, pitch);
    camera.position = transform(forth, stand, 1);
    camera.forward = transform(forth, ahead, 0);
    // What is not turned gets the run's own numbers again, to the last bit.
    const restored = Object.fromEntries(kOfCamera.map((name) => [name, null]));
    for (const index of seen) {
      const { clip_from_world: clip, camera_position_ws: position, camera_forward_ws: forward } = uniformsOf(index);
      const turned = {
        ...(clip && { clip_from_world: multiply(clip, back) }),
        camera_position_ws: transform(forth, position, 1),
        camera_forward_ws: transform(forth, forward, 0),
      };
      player.setUniforms(index, camera.isTurned ? turned : restored);
    }
  };
  return {
    moveCamera,
    ...makeLightMotion(player, { steps, casters, bounds, fit, uniformsOf, cameraNow: () => camera }),
  };
};

// Calls with the angles, radians, that a pointer's way over an element turns by.
const followDrags = (node, onTurn) => {
  const kTurnPerPixel = 0.006;
  let from = null;
  node.addEventListener("pointerdown", (event) => {
    node.setPointerCapture(event.pointerId);
    from = event;
  });
  node.addEventListener("pointermove", (event) => {
    if (!from) return;
    const [x, y] = [from.clientX - event.clientX, from.clientY - event.clientY];
    from = event;
    onTurn(x * kTurnPerPixel, y * kTurnPerPixel);
  });
  for (const end of ["pointerup", "pointercancel"]) node.addEventListener(end, () => (from = null));
};

// A reference where no rays were traced: the mean visibility of many maps, each drawn from another point of the light.
const kReferenceMaps = 256;
const kGoldenAngle = Math.PI * (3 - Math.sqrt(5));
const kOtherAngle = 2 * Math.PI * (Math.SQRT2 - 1);
// Points of a ball whose first two coordinates are spread evenly over a disk, by the spiral of a sunflower. With the third
// they look so from every side: they are points of a sphere in four dimensions less one coordinate, and any two of its
// coordinates are spread evenly over a disk (Archimedes' theorem of the sphere and the cylinder, two dimensions up).
const ballPoint = (i, count) => {
  const [squared, angle] = [(i + 0.5) / count, i * kGoldenAngle];
  const radius = Math.sqrt(squared);
  return [radius * Math.cos(angle), radius * Math.sin(angle), Math.sqrt(1 - squared) * Math.cos(i * kOtherAngle)];
};

// `frame` is that of a lookup without a filter.
const makeReference = (gl, { player, picture, lightSize }, motion, visibility) => {
  const { width, height } = player.textureOf(visibility);
  const fragment = `#version 300 es
    precision highp float;
    uniform sampler2D mean;
    uniform sampler2D next;
    uniform float share;
    out float visibility;
    void main() {
      ivec2 pixel = ivec2(gl_FragCoord.xy);
      visibility = mix(texelFetch(mean, pixel, 0).x, texelFetch(next, pixel, 0).x, share);
    }`;
  const program = linkProgram(gl, "the reference", kTriangle, fragment);
  const array = gl.createVertexArray();
  const means = [0, 1].map(() => makeTarget(gl, gl.R32F, width, height));
  let maps = 0;
  const add = (texture) => {
    const [from, to] = [means[maps % 2], means[(maps + 1) % 2]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, to.framebuffer);
    gl.viewport(0, 0, width, height);
    [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST].forEach((each) => gl.disable(each));
    gl.useProgram(program);
    [from.texture, texture].forEach((each, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, each);
      gl.bindSampler(unit, null);
      gl.uniform1i(gl.getUniformLocation(program, unit === 0 ? "mean" : "next"), unit);
    });
    gl.uniform1f(gl.getUniformLocation(program, "share"), 1 / ++maps);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };
  return {
    // Begins anew, since light or camera have moved.
    restart: () => (maps = 0),
    count: () => maps,
    texture: () => means[maps % 2].texture,
    read: () => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, means[maps % 2].framebuffer);
      return readValues(gl, width, height);
    },
    // Adds some maps from points of a light that is turned so.
    refine: (light, count) => {
      for (const last = Math.min(maps + count, kReferenceMaps); maps < last;) {
        const point = ballPoint(maps, kReferenceMaps).map((value) => 0.5 * lightSize * value);
        motion.moveLight(light, point);
        player.draw(visibility);
        add(player.textureOf(visibility).object);
      }
      motion.moveLight(light);
      return maps < kReferenceMaps;
    },
  };
};
