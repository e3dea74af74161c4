// Moves the camera and the sun of a frame: nothing is drawn but the run's own steps, with other matrices. Matrices are in
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
// A turn about the vertical, and before that one about what lies across a direction; and the same backwards.
const turnAround = (pivot, direction, yaw, pitch) => {
  const across = normalise(cross(direction, [0, 1, 0]));
  const up = [0, 1, 0];
  const about = (turn) => multiply(multiply(shiftBy(pivot), turn), shiftBy(pivot.map((value) => -value)));
  return {
    forth: about(multiply(rotateAbout(up, yaw), rotateAbout(across, pitch))),
    back: about(multiply(rotateAbout(across, -pitch), rotateAbout(up, -yaw))),
  };
};

// Middle and radius of the vertices of a frame.
const findBounds = (frames, blobs, steps) => {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const blob of new Set(
    steps.map((index) => frames.steps[index].vertices?.blob).filter((each) => each !== undefined && each !== null),
  )) {
    const stride = frames.blobs[blob].columns;
    const vertices = blobs[blob];
    for (let i = 2 * stride; i + 2 < vertices.length; i += stride) {
      // the first two vertices belong to no triangle
      for (let axis = 0; axis < 3; ++axis) {
        low[axis] = Math.min(low[axis], vertices[i + axis]);
        high[axis] = Math.max(high[axis], vertices[i + axis]);
      }
    }
  }
  return {
    middle: low.map((value, i) => (value + high[i]) / 2),
    radius: Math.hypot(...low.map((value, i) => high[i] - value)) / 2,
  };
};

const kOfCamera = ["clip_from_world", "camera_position_ws", "camera_forward_ws"];
const kOfLight = [
  ...["clip_from_world", "uv_depth_from_world", "light_direction_ws", "light_right_ws", "light_up_ws"],
  ...["texel_size_ws", "depth_range_ws", "bias_constant", "bias_slope"],
];
const makeMotion = (player, frames, blobs, picture) => {
  const steps = [...player.listSteps(picture)].filter((index) => frames.steps[index].op === "draw");
  const labelOf = (index) => frames.programs[frames.steps[index].program].label;
  const uniformsOf = player.uniformsOf;
  const seen = steps.filter((index) => uniformsOf(index).camera_forward_ws);
  const lit = steps.filter((index) => uniformsOf(index).uv_depth_from_world);
  const casters = steps.filter((index) => labelOf(index).startsWith("depth"));
  const { middle, radius } = findBounds(frames, blobs, steps);
  const drawn = steps.find((index) => labelOf(index).startsWith("gbuffer"));
  const own = lit.length > 0 ? uniformsOf(lit[0]) : null;
  // A sun whose map has one layer and no warp: its window can be turned, and made as large as it must be.
  const isSun =
    own !== null &&
    lit.every((index) => {
      const m = uniformsOf(index).uv_depth_from_world;
      return m[3] === 0 && m[7] === 0 && m[11] === 0 && m.every((value, i) => value === own.uv_depth_from_world[i]);
    });
  const direction = steps.map((index) => uniformsOf(index).light_direction_ws).find(Boolean);

  // What is not turned gets the run's own numbers again, to the last bit.
  const restore = (indices, names) => {
    for (const index of indices) player.setUniforms(index, Object.fromEntries(names.map((name) => [name, null])));
  };
  const moveCamera = ([yaw, pitch]) => {
    if (yaw === 0 && pitch === 0) return restore(seen, kOfCamera);
    const base = uniformsOf(drawn);
    const { forth, back } = turnAround(middle, base.camera_forward_ws, yaw, pitch);
    for (const index of seen) {
      const { clip_from_world: clip, camera_position_ws: position, camera_forward_ws: forward } = uniformsOf(index);
      player.setUniforms(index, {
        ...(clip && { clip_from_world: multiply(clip, back) }),
        camera_position_ws: transform(forth, position, 1),
        camera_forward_ws: transform(forth, forward, 0),
      });
    }
  };
  // The window's own half-width in metres follows from the length of a row of its matrix: a metre is so much of it.
  const growth = (row) => {
    const m = own.uv_depth_from_world;
    const perMetre = Math.hypot(m[row], m[4 + row], m[8 + row]);
    const center = transform(m, middle, 1)[row];
    return Math.max(1, 2 * (radius * perMetre + Math.abs(center - 0.5)));
  };
  // `tilt` turns the sun a little more, about an axis across it: the axis's angle, and that of the turn.
  const moveLight = ([yaw, pitch], tilt = [0, 0]) => {
    const isMoved = yaw !== 0 || pitch !== 0;
    if (!isMoved && tilt[1] === 0)
      return restore(
        steps.filter((index) => !seen.includes(index) || !uniformsOf(index).clip_from_world),
        kOfLight,
      );
    const [u, v, depth] = isMoved ? [0, 1, 2].map(growth) : [1, 1, 1];
    const wide = Math.max(u, v);
    const { forth, back } = turnAround(middle, direction, yaw, pitch);
    const across = normalise(cross(direction, Math.abs(direction[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]));
    const other = cross(direction, across);
    const axis = across.map((value, i) => Math.cos(tilt[0]) * value + Math.sin(tilt[0]) * other[i]);
    const about = (angle) =>
      multiply(multiply(shiftBy(middle), rotateAbout(axis, angle)), shiftBy(middle.map((value) => -value)));
    const toOwn = multiply(about(-tilt[1]), back);
    const turned = (vector) => transform(forth, transform(about(tilt[1]), vector, 0), 0);
    const uv = multiply(
      shiftBy([0.5, 0.5, 0.5]),
      multiply(scaleBy([1 / wide, 1 / wide, 1 / depth]), shiftBy([-0.5, -0.5, -0.5])),
    );
    const clip = multiply(
      shiftBy([0, 0, 0.5]),
      multiply(scaleBy([1 / wide, 1 / wide, 1 / depth]), shiftBy([0, 0, -0.5])),
    );
    for (const index of steps) {
      const base = uniformsOf(index);
      const changes = {};
      if (base.uv_depth_from_world)
        changes.uv_depth_from_world = multiply(uv, multiply(base.uv_depth_from_world, toOwn));
      if (casters.includes(index)) changes.clip_from_world = multiply(clip, multiply(base.clip_from_world, toOwn));
      for (const name of ["light_direction_ws", "light_right_ws", "light_up_ws"])
        if (base[name]) changes[name] = turned(base[name]);
      const factors = {
        texel_size_ws: wide,
        depth_range_ws: depth,
        bias_constant: 1 / depth,
        bias_slope: wide / depth,
      };
      for (const [name, factor] of Object.entries(factors)) if (base[name]) changes[name] = [base[name][0] * factor];
      player.setUniforms(index, changes);
    }
  };
  const directionOf = ([yaw, pitch]) => transform(turnAround(middle, direction, yaw, pitch).forth, direction, 0);
  return { isSun, moveCamera, moveLight, directionOf };
};

// Calls with the angles, radians, that a pointer's way over an element turns by, where it begins as `begins` says.
const followDrags = (node, onTurn, begins = () => true) => {
  const kTurnPerPixel = 0.006;
  let from = null;
  node.addEventListener("pointerdown", (event) => {
    if (!begins(event)) return;
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
