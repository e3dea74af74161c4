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
