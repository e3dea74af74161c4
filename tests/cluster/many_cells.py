#!/usr/bin/env python3
"""Makes the shards of a sweep of many cells from a small real run, for what `merge` and the report cost.

    python3 tests/cluster/many_cells.py --program build/release/shadowbench --cells 10000 --out sweep
    build/release/shadowbench merge sweep/shard* --out sweep/whole

The real run (--base, or one that this script makes) has cells of two scenes, without grids. Each is repeated under other lights,
map sizes, and values of one of its filter's parameters: settings and key say so, errors and times are those of the real cell
times a random factor, and pictures are hard links to the real ones, under a name of each cell's own. `merge` copies them all,
as it does those of a real run. Only Python's standard library is used; --seed repeats the numbers.
"""

import argparse
import copy
import itertools
import json
import math
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

EXPERIMENT = ["run", "--scene", "stack", "--scene", "cubes", "--filters",
              "none,pcf2x2,tent3x3,poisson:radius=2,poisson:radius=4,vsm:radius=2,vsm:radius=4,esm:radius=2,esm:radius=4,evsm4,pcss",
              "--map-size", "512", "--size", "240x135", "--rounds", "4", "--width", "own", "--no-grids", "--yes"]
# What a cell has of its own, and what cells of one view and map share.
OWN_IMAGES, SHARED_IMAGES = ("picture", "visibility", "values"), ("truth_picture", "truth_values")
RATES = ("error.flip", "artefact.acne", "artefact.leak", "artefact.contact_gap", "artefact.noise")


def dump_line(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def find_key(cell):
    """The key that the program gives to a cell of these settings: FNV-1a of their canonical JSON."""
    settings = {name: cell[name] for name in ("scene", "view", "filter", "params", "map_size", "map_format", "bias", "fit", "light")}
    settings["size"] = [cell["size"]["width"], cell["size"]["height"]]
    settings["range"] = [cell["range"][name] for name in ("border", "far_test", "behind_test")]
    value = 0xcbf29ce484222325
    for byte in dump_line(settings).encode():
        value = (value ^ byte) * 0x100000001b3 % (1 << 64)
    return f"{value:016x}"


def scale(value, factor):
    """All numbers of a value but counts, times a factor."""
    if isinstance(value, dict):
        return {name: each if name in ("n", "share") else scale(each, factor) for name, each in value.items()}
    if isinstance(value, list):
        return [scale(each, factor) for each in value]
    return value * factor if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def perturb(cell, rng):
    """Errors and artefacts move by one factor, times by another; each stays what it can be."""
    error, time = math.exp(rng.gauss(0.0, 0.3)), math.exp(rng.gauss(0.0, 0.1))
    cell["error"] = scale(cell["error"], error)
    cell["attribution"] = scale(cell["attribution"], error)
    cell["artefact"] = {name: value if value is None else min(1.0, value * error) for name, value in cell["artefact"].items()}
    cell["error"]["max"] = min(1.0, cell["error"]["max"])
    cell["time_ms"] = scale(cell["time_ms"], time)
    if cell["filter"] != "none":  # whose ratio to itself is 1
        cell["ratio_to_none"] = scale(cell["ratio_to_none"], time)


def list_settings(cell, count):
    """The parameters of the real cell, and more with other values of the first that is a real number and no width."""
    chosen = [name for name, value in sorted(cell["params"].items()) if name not in ("radius", "max_radius", "taps", "search_taps")
              and isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0]
    for i in range(count if chosen else 1):
        yield {**cell["params"], **({chosen[0]: cell["params"][chosen[0]] * (1.0 - 0.5 * i / count)} if i else {})}


def list_cells(base, arguments):
    """The first so many cells of the product, each as (cell, images of the real one by the name that they get)."""
    rng = random.Random(arguments.seed)
    made = 0
    for light in itertools.count():
        name = "scene" if light == 0 else f"{(light * 137.508) % 360:.3f},{25 + light % 50}"
        for real, map_size in itertools.product(base["cells"], (256 << i for i in range(arguments.maps))):
            for params in list_settings(real, arguments.settings):
                if made == arguments.cells:
                    return
                made += 1
                cell = copy.deepcopy(real)
                cell.update(params=params, map_size=map_size, light=name)
                cell["key"] = find_key(cell)
                perturb(cell, rng)
                cell["cost"]["map_bytes"] = cell["cost"]["map_bytes"] * map_size ** 2 // real["map_size"] ** 2
                stem = f"images/{cell['scene']}.map{map_size}.light{light}"
                links = {}
                for gone in ("supersampled", "truth_supersampled", "samples"):  # of what the page of `real` shows first
                    cell["images"].pop(gone, None)
                for image in OWN_IMAGES + SHARED_IMAGES:
                    if arguments.no_pictures or not real["images"][image]:
                        cell["images"][image] = None
                        continue
                    own = f"{stem}.{cell['filter']}-{cell['key']}" if image in OWN_IMAGES else stem
                    cell["images"][image] = f"{own}.{image}{Path(real['images'][image]).suffix}"
                    links[cell["images"][image]] = real["images"][image]
                yield cell, links


def write_shards(base, folder, arguments):
    """Every so many'th cell is one shard's, as `run --shard` deals them out."""
    out = arguments.out
    shards = [out / f"shard{i + 1}" for i in range(arguments.shards)]
    texts = [[] for _ in shards]
    for shard in shards:
        (shard / "cells").mkdir(parents=True)
        (shard / "images").mkdir()
        if (folder / "live").exists():
            shutil.copytree(folder / "live", shard / "live", copy_function=os.link)
    for i, (cell, links) in enumerate(list_cells(base, arguments)):
        shard = shards[i % len(shards)]
        for name, real in links.items():
            if not (shard / name).exists():
                os.link(folder / real, shard / name)
        (shard / "cells" / f"{cell['key']}.json").write_text(json.dumps({"cell": cell, "schema_version": base["schema_version"]}, indent=1))
        texts[i % len(shards)].append(dump_line(cell))
    run = {name: value for name, value in base.items() if name != "cells"}
    for i, (shard, cells) in enumerate(zip(shards, texts)):
        run["experiment"] = {**run["experiment"], "title": "many cells", "cells": arguments.cells, "shard": i + 1, "shards": len(shards)}
        head = json.dumps(run, indent=1)[:-2]
        (shard / "results.json").write_text(head + ",\n \"cells\": [\n  " + ",\n  ".join(cells) + "\n ]\n}\n")
    return shards


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=os.path.abspath, required=True)
    parser.add_argument("--cells", type=int, required=True)
    parser.add_argument("--out", type=Path, required=True, help="a folder that is not there; it gets shard1, shard2 and so on")
    parser.add_argument("--base", type=Path, help="the folder of a finished run on the same file system")
    parser.add_argument("--shards", type=int, default=4)
    parser.add_argument("--maps", type=int, default=4, help="map sizes, from 256 on")
    parser.add_argument("--settings", type=int, default=4, help="values of one parameter of a filter")
    parser.add_argument("--no-pictures", action="store_true", help="cells that name no picture")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True)
    base = arguments.base or arguments.out / "base"
    if not arguments.base:
        run = subprocess.run([arguments.program, *EXPERIMENT, "--out", base], capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"the real run ended with exit code {run.returncode}: {run.stderr[-2000:]}")
    results = json.loads((base / "results.json").read_text())
    wrong = [cell["key"] for cell in results["cells"] if find_key(cell) != cell["key"]]
    if wrong:
        sys.exit(f"the program makes keys in another way than this script: {wrong[0]}")
    write_shards(results, base, arguments)


if __name__ == "__main__":
    main()
