#!/usr/bin/env python3
"""Computes filters again from nothing but a run's EXR file, and compares them with what the run drew.

    python3 tests/exr/recompute.py --program build/tests/shadowbench

Each case below is run; then `oiiotool` (package openimageio-tools) unpacks the file's parts and its metadata, whose
`shadowbench:map.convention` says what this script does: a receiver's place in its layer of the map, its bias, and the
comparison of `none` (the texel that holds it) and `pcf2x2` (the four nearest, weighted bilinearly).
"""

import argparse
import math
import re
import struct
import subprocess
import sys
import tempfile
from array import array
from pathlib import Path

# Scene and options: a sun, a spot light, a cube's faces, cascades, and the curved maps.
CASES = [("stack", []), ("lamp", []), ("lantern", []), ("avenue", ["--fit", "cascades"]),
         ("avenue", ["--fit", "lispsm"]), ("avenue", ["--fit", "logpsm"]), ("lantern", ["--fit", "paraboloid"])]
SETTINGS = ["--filters", "none,pcf2x2", "--size", "112x63", "--map-size", "512", "--rounds", "1", "--phases", "1", "--gpu", "none",
            "--no-attribution", "--all-parts"]
# A receiver may lie on the border of a texel, or within rounding of the map's depth; more than that is a mistake.
MOST_DIFFERENT = 0.0005


def read_tiff(path):
    """Width, height, channels and values of an uncompressed little-endian TIFF of floats."""
    data = path.read_bytes()
    assert data[:4] == b"II*\0", "not a little-endian TIFF"
    tags = {}
    at = struct.unpack_from("<I", data, 4)[0]
    for i in range(struct.unpack_from("<H", data, at)[0]):
        tag, kind, count = struct.unpack_from("<HHI", data, at + 2 + 12 * i)
        code, size = {3: ("H", 2), 4: ("I", 4)}.get(kind, (None, 0))
        if code is None:
            continue
        place = at + 2 + 12 * i + 8
        if count * size > 4:
            place = struct.unpack_from("<I", data, place)[0]
        tags[tag] = struct.unpack_from(f"<{count}{code}", data, place)
    assert tags[258][0] == 32 and tags[259][0] == 1, "not uncompressed floats"
    values = array("f")
    for offset, count in zip(tags[273], tags[279]):
        values.frombytes(data[offset:offset + count])
    return tags[256][0], tags[257][0], tags[277][0], values


class ExrFile:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder
        text = subprocess.run(["oiiotool", "--info", "-v", str(path)], check=True, capture_output=True, text=True).stdout
        self.metadata = dict(re.findall(r'^ *(shadowbench:\S.*?): "?(.*?)"?$', text, re.MULTILINE))

    def parts(self, *names):
        """The values of parts."""
        return [values for *_, values in self.unpack(*names)]

    def unpack(self, *names):
        """Width, height, channels and values of parts, in one start of oiiotool."""
        files = [self.folder / f"part{i}.tif" for i in range(len(names))]
        words = [word for name, file in zip(names, files) for word in (
            str(self.path), "--subimage", name, "--fullpixels", "-d", "float", "--compression", "none", "-o", str(file), "--pop")]
        subprocess.run(["oiiotool", *words], check=True)
        return [read_tiff(file) for file in files]

    def layers(self):
        names = re.findall(r"shadowbench:map\.layer(\d+)\.shape", "\n".join(self.metadata))
        return [Layer(self.metadata, int(i)) for i in sorted(set(names), key=int)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class Layer:
    def __init__(self, metadata, index):
        def get(key):
            return metadata[f"shadowbench:map.layer{index}.{key}"]

        self.index, self.metadata = index, metadata
        numbers = [float(x) for x in get("uv_depth_from_world").split()]
        self.rows = [numbers[4 * i:4 * i + 4] for i in range(4)]
        self.shape, self.share = get("shape").split(), get("share").split()
        self.range, self.texel_m = float(get("depth_range_m")), float(get("texel_m"))
        self.reference = metadata.get(f"shadowbench:map.layer{index}.texel_reference_m")
        if "shadowbench:light_position_ws" in metadata:
            self.lamp = [float(x) for x in metadata["shadowbench:light_position_ws"].split()]
        self.eye = [float(x) for x in metadata["shadowbench:camera_position_ws"].split()]
        self.ahead = [float(x) for x in metadata["shadowbench:camera_forward_ws"].split()]

    def find(self, p):
        """u, v, depth; nothing where the layer says nothing about the point."""
        x, y, depth, w = (dot(row, (*p, 1.0)) for row in self.rows)
        if self.shape[0] == "parallel":
            return x, y, depth
        if self.shape[0] == "paraboloid":
            cx, cy, radius, near = (float(self.shape[i]) for i in (2, 3, 5, 7))
            length = math.sqrt(x * x + y * y + depth * depth)
            scale = radius / (1.0 - depth / length)
            return cx + scale * x / length, cy + scale * y / length, (length - near) / self.range
        if w <= 0.0:
            return None
        if self.shape[0] == "logarithmic":
            return x / w, float(self.shape[2]) * math.log(w) + float(self.shape[4]), depth
        return x / w, y / w, depth

    def served(self, p):
        """The layer's share of a receiver."""
        if self.share[0] == "all":
            return 1.0
        if self.share[0] == "view":
            depth = dot([a - b for a, b in zip(p, self.eye)], self.ahead)
            a, b, c, d = (float(self.share[i]) for i in (2, 3, 5, 6))

            def ramp(start, end):
                return min(max((depth - start) / (end - start), 0.0), 1.0) if start < end else float(depth >= start)

            return ramp(a, b) - ramp(c, d)
        way = [a - b for a, b in zip(p, self.lamp)]
        if self.share[0] == "half":
            return float((way[1] <= 0.0) == (self.index == 0))
        sizes = [abs(x) for x in way]
        axis = sizes.index(max(sizes))
        return float(2 * axis + (way[axis] < 0.0) == int(self.share[2]))

    def texel(self, p, size):
        """The size of a texel at a point, metres."""
        if self.shape[0] == "parallel":
            return self.texel_m
        if self.shape[0] == "projective" and self.reference:
            return self.texel_m * dot(self.rows[3], (*p, 1.0)) / float(self.reference)
        axes = ((1e-4, 0.0, 0.0), (0.0, 1e-4, 0.0), (0.0, 0.0, 1e-4))
        ends = [[self.find([a + sign * b for a, b in zip(p, axis)]) for sign in (1.0, -1.0)] for axis in axes]
        along_u, along_v = ([size * (ahead[i] - behind[i]) / 2e-4 for ahead, behind in ends] for i in (0, 1))
        across = cross(along_u, along_v)
        return dot(across, across) ** -0.25

    def slopes(self, p, normal, size):
        """|dD/du| and |dD/dv| along the receiver's plane, for each texel, by central differences."""
        least = min(range(3), key=lambda i: abs(normal[i]))
        side = cross(normal, [float(i == least) for i in range(3)])
        length = math.sqrt(dot(side, side))
        side = [x / length for x in side]
        steps = []
        for way in (side, cross(normal, side)):
            ends = [self.find([a + sign * 1e-4 * b for a, b in zip(p, way)]) for sign in (1.0, -1.0)]
            steps.append([(a - b) for a, b in zip(*ends)])
        (u1, v1, d1), (u2, v2, d2) = steps
        area = u1 * v2 - u2 * v1
        along_u, along_v = (d1 * v2 - d2 * v1) / area, (u1 * d2 - u2 * d1) / area
        return abs(along_u) / size, abs(along_v) / size

    def bias(self, label, p, normal, size):
        words = self.metadata[f"shadowbench:bias.layer{self.index}.{label}"].split()
        amount = {words[i]: float(words[i + 1]) for i in range(0, 10, 2)}
        assert amount["slope"] == 0.0 and amount["normal_texels"] == 0.0, "the default bias has changed"
        most = amount["max_tangent"] * self.texel(p, size) / self.range
        return amount["constant"] + amount["plane_texels"] * sum(min(x, most) for x in self.slopes(p, normal, size))


def compare(label, layer, place, depth, depth_map, size, layers):
    def lit(i, j):
        if not (0 <= i < size and 0 <= j < size):
            return 1.0
        stored = depth_map[(size - 1 - j) * size * layers + layer * size + i]
        return float(depth <= stored)

    u, v = place[0] * size, place[1] * size
    if label == "none":
        return lit(math.floor(u), math.floor(v))
    i, j = math.floor(u - 0.5), math.floor(v - 0.5)
    s, t = u - 0.5 - i, v - 0.5 - j
    return ((1 - s) * (1 - t) * lit(i, j) + s * (1 - t) * lit(i + 1, j) + (1 - s) * t * lit(i, j + 1)
            + s * t * lit(i + 1, j + 1))


def check(program, scene, options, folder):
    out = folder / "run"
    subprocess.run([program, "run", "--scene", scene, *options, *SETTINGS, "--out", str(out), "--fresh"], check=True,
                   stdout=subprocess.DEVNULL)
    file = ExrFile(next(out.glob("*.exr")), folder)
    layers = file.layers()
    size = int(file.metadata["shadowbench:map_size"])
    labels = ("none", "pcf2x2")
    positions, normals, mask, depth_map, *visibilities = file.parts(
        "receiver.position", "receiver.normal", "truth.mask", "depth_map", *(f"{label}.visibility" for label in labels))
    wrong = 0
    for label, drawn in zip(labels, visibilities):
        compared = different = shadowed = 0
        for i in range(len(mask)):
            if mask[i] == 0.0:
                continue
            p, normal = positions[3 * i:3 * i + 3], normals[3 * i:3 * i + 3]
            visibility = 0.0
            for layer in layers:
                share = layer.served(p)
                if share == 0.0:
                    continue
                place = layer.find(p)
                own = 1.0
                if place and place[2] <= 1.0:
                    depth = place[2] - layer.bias(label, p, normal, size)
                    own = compare(label, layer.index, place, depth, depth_map, size, len(layers))
                visibility += share * own
            compared += 1
            shadowed += visibility < 0.5
            different += abs(visibility - drawn[i]) > 0.01
        name = " ".join([scene, *options[1:], label])
        print(f"{name}: {compared} receivers, {shadowed} in shadow, {different} differ")
        if compared < 1500 or shadowed < 100 or different > max(1, MOST_DIFFERENT * compared):
            print(f"FAILED: {name}")
            wrong += 1
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--only", help="cases of this scene")
    arguments = parser.parse_args()
    wrong = 0
    for scene, options in CASES:
        if arguments.only in (None, scene):
            with tempfile.TemporaryDirectory() as folder:
                wrong += check(arguments.program, scene, options, Path(folder))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
