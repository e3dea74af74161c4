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
const makeMotion = (player, frames, blobs, picture, fit) => {
  if (frames.check.whole) return { isSun: false, stays: kTooLarge, moveCamera: () => {}, moveLight: () => {} };
  const steps = [...player.listSteps(picture)].filter((index) => frames.steps[index].op === "draw");
  const labelOf = (index) => frames.programs[frames.steps[index].program].label;
  const uniformsOf = player.uniformsOf;
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
  return { moveCamera, ...makeLightMotion(player, { steps, casters, bounds, fit, cameraNow: () => camera }) };
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
