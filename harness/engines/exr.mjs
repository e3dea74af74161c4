// Writes an OpenEXR file: one part, scan lines from top to bottom, 32-bit floats, not compressed.
// The layout is that of "OpenEXR File Layout" (openexr.com/en/latest/OpenEXRFileLayout.html).
import { writeFileSync } from "node:fs";

const int = (...values) => Buffer.from(new Int32Array(values).buffer); // least byte first, as EXR has it
const float = (...values) => Buffer.from(new Float32Array(values).buffer);
const text = (word) => Buffer.from(word + "\0", "latin1");
const attribute = (name, type, value) => Buffer.concat([text(name), text(type), int(value.length), value]);

// `channels`: by name, such as "lit.R", an array of width x height floats.
export const writeExr = (file, width, height, channels) => {
  const names = Object.keys(channels).sort(); // readers rely on the order of names
  const kFloat = 2;
  const window = int(0, 0, width - 1, height - 1);
  const channelList = names.map((name) => Buffer.concat([text(name), int(kFloat, 0, 1, 1)]));
  const head = Buffer.concat([
    int(20000630, 2), // magic number and version
    attribute("channels", "chlist", Buffer.concat([...channelList, Buffer.of(0)])),
    attribute("compression", "compression", Buffer.of(0)),
    attribute("dataWindow", "box2i", window),
    attribute("displayWindow", "box2i", window),
    attribute("lineOrder", "lineOrder", Buffer.of(0)),
    attribute("pixelAspectRatio", "float", float(1)),
    attribute("screenWindowCenter", "v2f", float(0, 0)),
    attribute("screenWindowWidth", "float", float(1)),
    Buffer.of(0),
  ]);
  const lineBytes = 4 * width * names.length;
  const first = head.length + 8 * height; // after a table of where each line is
  const places = new BigUint64Array(height).map((_, y) => BigInt(first + y * (8 + lineBytes)));
  const lines = Array.from({ length: height }, (_, y) => [
    int(y, lineBytes),
    ...names.map((name) => float(...channels[name].subarray(y * width, (y + 1) * width))),
  ]);
  writeFileSync(file, Buffer.concat([head, Buffer.from(places.buffer), ...lines.flat()]));
};
