#!/usr/bin/env python3
"""Measures what splitting a sweep costs: the processor time of all its tasks, one after the other, over that of one process that
does the same cells. Standard library only; no scheduler is needed.

    tests/cluster/overhead.py --program build/release/shadowbench --cells 1000 --tasks 100
"""
import argparse
import pathlib
import resource
import shlex
import subprocess
import sys
import tempfile
import time

SCENES = ["cubes", "fence", "stack", "steps", "ball"]
MAPS = [512, 1024]
OPTIONS = ["--size", "320x180", "--rounds", "8", "--gpu", "navi21"]


def list_filters(count):
    """Filters of the usual kinds and widths, so many."""
    filters = ["none", "pcf2x2", "tent3x3", "box4x4"]
    for i in range(count):
        radius = 1 + i % 8
        filters += [f"vsm:radius={radius},bleed_reduction={0.05 * (i // 8):g}", f"esm:radius={radius},c={20 + 3 * (i // 8)}",
                    f"poisson:radius={radius},taps={4 << i // 8 % 4}"]
    return filters[:count]


def read_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Cost:
    """Runs commands, and adds up what they cost."""

    def __init__(self):
        self.processor_s, self.wall_s = 0.0, 0.0

    def run(self, words):
        before, start = read_children(), time.monotonic()
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{shlex.join(map(str, words))[:200]} ...: exit code {done.returncode}: {done.stderr}")
        self.processor_s += read_children() - before
        self.wall_s += time.monotonic() - start
        return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--cells", type=int, default=1000)
    parser.add_argument("--tasks", type=int, default=100)
    parser.add_argument("options", nargs="*", default=OPTIONS, help="options of run, after --, in place of small pictures")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    per_map = arguments.cells // (len(SCENES) * len(MAPS))
    words = [word for scene in SCENES for word in ("--scene", scene)] + arguments.options
    words += ["--map-size", ",".join(map(str, MAPS)), "--filters", ",".join(list_filters(per_map))]
    with tempfile.TemporaryDirectory(prefix="shadowbench.overhead.") as scratch:
        folder = pathlib.Path(scratch)
        whole, split, planning = Cost(), Cost(), Cost()
        whole.run([program, "run", *words, "--yes", "--no-grids", "--cache", folder / "own", "--out", folder / "whole"])
        sweep = folder / "sweep"
        planning.run([program, "submit", *words, "--engine", "slurm", "--dry-run", "--tasks", str(arguments.tasks), "--out", sweep])
        for kind in ("truth", "tasks"):
            for task in sorted((sweep / kind).iterdir(), key=lambda path: int(path.name)):
                split.run([program, "run", *words, "--no-grids", "--cache", sweep / "cache", "--out", sweep, "--task", task])
        split.run([program, "merge", sweep])
        tasks = len(list((sweep / "tasks").iterdir()))
        cells = len(list((sweep / "cells").iterdir()))
        print(f"{cells} cells in one process: {whole.processor_s:.0f} s of processor time, {whole.wall_s:.0f} s of wall time")
        print(f"in {tasks} tasks and the truth: {split.processor_s:.0f} s, {split.wall_s:.0f} s; "
              f"{split.processor_s / whole.processor_s:.3f} of the processor time, {split.wall_s / whole.wall_s:.3f} of the wall time")
        print(f"a task: {(split.processor_s - whole.processor_s) / tasks:.2f} s of processor time, "
              f"{(split.wall_s - whole.wall_s) / tasks:.2f} s of wall time beside its cells")
        print(f"planning: {planning.processor_s:.1f} s of processor time, {planning.wall_s:.1f} s of wall time")


if __name__ == "__main__":
    main()
