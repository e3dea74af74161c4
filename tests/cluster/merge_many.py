#!/usr/bin/env python3
"""Merges a sweep of many cells, made by many_cells.py, and fails where that takes more than it may or loses a file.

    python3 tests/cluster/merge_many.py --program build/release/shadowbench --cells 10000 --seconds 30 --mebibytes 1024

Seconds are of processor time, so that a machine with other work to do judges as an idle one. Words after `--` go to
many_cells.py. Only Python's standard library is used.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

MAKER = Path(__file__).with_name("many_cells.py")
REPORT = {".shadowbench-folder", "index.html", "summary.md", "details.md", "results.json", "results.schema.json", "timings.csv", "accuracy.csv", "fronts.csv"}


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
    expected = REPORT.union(*(list_files(shard) for shard in shards))
    found = list_files(whole)
    faults = [f"{name} is missing" for name in sorted(expected - found)] + [f"{name} is too much" for name in sorted(found - expected)]
    dealt = [[cell["key"] for cell in json.loads((shard / "results.json").read_text())["cells"]] for shard in shards]
    wanted = [dealt[i % len(shards)][i // len(shards)] for i in range(cells)]
    if [cell["key"] for cell in json.loads((whole / "results.json").read_text())["cells"]] != wanted:
        faults.append("results.json has other cells than the shards, or another order")
    for table in ("timings.csv", "accuracy.csv"):
        if (whole / table).read_bytes().count(b"\n") != cells + 1:
            faults.append(f"{table} does not have a row for every cell")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=os.path.abspath, required=True)
    parser.add_argument("--cells", type=int, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--mebibytes", type=float, required=True)
    parser.add_argument("maker", nargs="*", help="options of many_cells.py")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "sweep"
        subprocess.run([sys.executable, MAKER, "--program", arguments.program, "--cells", str(arguments.cells), "--out", out,
                        *arguments.maker], check=True)
        shards = sorted(out.glob("shard*"), key=lambda shard: int(shard.name[5:]))
        seconds, mebibytes = measure([arguments.program, "merge", *shards, "--out", out / "whole"])
        faults = list_faults(shards, out / "whole", arguments.cells)
        print(f"{arguments.cells} cells: {seconds:.1f} s, {mebibytes:.0f} MiB, a page of "
              f"{(out / 'whole' / 'index.html').stat().st_size / 1e6:.1f} MB")
    if seconds > arguments.seconds:
        faults.append(f"merging took {seconds:.1f} s; it may take {arguments.seconds}")
    if mebibytes > arguments.mebibytes:
        faults.append(f"merging took {mebibytes:.0f} MiB; it may take {arguments.mebibytes}")
    sys.exit("\n".join(faults[:20]) or 0)


if __name__ == "__main__":
    main()
