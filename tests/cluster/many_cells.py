#!/usr/bin/env python3
"""Merges a sweep of many cells that nobody measured, and fails where that takes more than it may or loses a file.

    python3 tests/cluster/many_cells.py --program build/release/shadowbench --cells 10000 --seconds 30 --mebibytes 1024

The cells are those of a small real run without grids, repeated under other lights, map sizes, and values of one of their filter's
parameters, with errors and times smaller by a random factor; pictures are hard links to the real ones. Seconds are of processor time.
Only Python's standard library is used.
"""

import argparse
import copy
import itertools
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

EXPERIMENT = ["run", "--scene", "stack", "--scene", "cubes", "--filters",
              "none,pcf2x2,tent3x3,poisson:radius=2,poisson:radius=4,vsm:radius=2,vsm:radius=4,esm:radius=2,esm:radius=4,evsm4,pcss",
              "--map-size", "512", "--size", "240x135", "--rounds", "4", "--width", "own", "--no-grids", "--yes"]
SHARDS = 4
REPORT = {".shadowbench-folder", "index.html", "summary.md", "details.md", "results.json", "results.schema.json", "timings.csv", "accuracy.csv"}
# What a cell has of its own, and what cells of one view and map share.
OWN_IMAGES, SHARED_IMAGES = ("picture", "visibility", "values"), ("truth_picture", "truth_values")


def dump_line(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def scale(value, factor):
    """All numbers of a value but counts, times a factor."""
    if isinstance(value, dict):
        return {name: each if name in ("n", "share") else scale(each, factor) for name, each in value.items()}
    if isinstance(value, list):
        return [scale(each, factor) for each in value]
    return value * factor if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def perturb(cell, rng):
    """Errors and artefacts shrink by one factor, times by another: each stays what it can be."""
    error, time = rng.uniform(0.5, 1.0), rng.uniform(0.5, 1.0)
    for group, factor in (("error", error), ("attribution", error), ("artefact", error), ("time_ms", time)):
        cell[group] = scale(cell[group], factor)
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
    rng = random.Random(1)
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
                cell["key"] = f"{made * 0x9e3779b97f4a7c15 % (1 << 64):016x}"  # spread as the program's are
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
    shards = [folder / f"shard{i + 1}" for i in range(SHARDS)]
    texts = [[] for _ in shards]
    for shard in shards:
        (shard / "cells").mkdir(parents=True)
        (shard / "images").mkdir()
        if (folder / "base/live").exists():
            shutil.copytree(folder / "base/live", shard / "live", copy_function=os.link)
    for i, (cell, links) in enumerate(list_cells(base, arguments)):
        shard = shards[i % SHARDS]
        for name, real in links.items():
            if not (shard / name).exists():
                os.link(folder / "base" / real, shard / name)
        (shard / "cells" / f"{cell['key']}.json").write_text(json.dumps({"cell": cell, "schema_version": base["schema_version"]}, indent=1))
        texts[i % SHARDS].append(dump_line(cell))
    run = {name: value for name, value in base.items() if name != "cells"}
    for i, (shard, cells) in enumerate(zip(shards, texts)):
        run["experiment"] = {**run["experiment"], "title": "many cells", "cells": arguments.cells, "shard": i + 1, "shards": SHARDS}
        head = json.dumps(run, indent=1)[:-2]
        (shard / "results.json").write_text(head + ",\n \"cells\": [\n  " + ",\n  ".join(cells) + "\n ]\n}\n")
    return shards


def list_files(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def measure(command):
    """Runs a command. Returns seconds of processor time and MiB at most."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{command[1]}: exit code {child.returncode}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def list_faults(shards, whole, cells):
    expected, found = REPORT.union(*(list_files(shard) for shard in shards)), list_files(whole)
    faults = [f"{name} is missing" for name in sorted(expected - found)] + [f"{name} is too much" for name in sorted(found - expected)]
    dealt = [[cell["key"] for cell in json.loads((shard / "results.json").read_text())["cells"]] for shard in shards]
    wanted = [dealt[i % SHARDS][i // SHARDS] for i in range(cells)]
    if [cell["key"] for cell in json.loads((whole / "results.json").read_text())["cells"]] != wanted:
        faults.append("results.json has other cells than the shards, or another order")
    return faults + [f"{table} does not have a row for every cell" for table in ("timings.csv", "accuracy.csv")
                     if (whole / table).read_bytes().count(b"\n") != cells + 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=os.path.abspath, required=True)
    parser.add_argument("--cells", type=int, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--mebibytes", type=float, required=True)
    parser.add_argument("--maps", type=int, default=4, help="map sizes, from 256 on")
    parser.add_argument("--settings", type=int, default=4, help="values of one parameter of a filter")
    parser.add_argument("--no-pictures", action="store_true", help="cells that name no picture")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([arguments.program, *EXPERIMENT, "--out", folder / "base"], capture_output=True, check=True)
        base = json.loads((folder / "base/results.json").read_text())
        shards, whole = write_shards(base, folder, arguments), folder / "whole"
        seconds, mebibytes = measure([arguments.program, "merge", *shards, "--out", whole])
        faults = list_faults(shards, whole, arguments.cells)
        print(f"{arguments.cells} cells: {seconds:.1f} s, {mebibytes:.0f} MiB, a page of {(whole / 'index.html').stat().st_size / 1e6:.1f} MB")
    for what, taken, most in (("seconds", seconds, arguments.seconds), ("MiB", mebibytes, arguments.mebibytes)):
        if taken > most:
            faults.append(f"merging took {taken:.1f} {what}; it may take {most}")
    sys.exit("\n".join(faults[:20]) or 0)


if __name__ == "__main__":
    main()
