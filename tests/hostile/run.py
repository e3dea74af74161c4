#!/usr/bin/env python3
"""Hostile cases, made afresh from a seed, and what the program makes of them.

    python3 tests/hostile/run.py --program build/tests/shadowbench --cases 2000 --seed 1

A case is a command line and the files that it reads. Kinds of cases take turns: `mutant` (a real file of a format that
is read, with bytes flipped, cut, doubled or replaced), `foreign` (a folder to write into that somebody else filled), and
`planted` (a link to a file or folder outside, a pipe or a folder, in the place of something that is read or written).
Bad words, filters that misbehave, limits and killed runs have tests of their own, in tests/harness/cli.

Each case knows the exit codes that are right for it. What counts against the program:

- crash: it ended by a signal, or with 70, which is what it says of its own bugs
- hang: it took longer than --timeout
- code: another exit code than those that are right, or a failure without a message
- leftover: files besides those that it was asked to write
- outside: a file of somebody else was changed, removed, or copied to where a link led from

A case that went wrong is printed with the command that repeats it alone (--only N). Nothing but Python's standard
library is used; runs are small, and several go on at once.
"""

import argparse
import concurrent.futures
import os
import random
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SMALL = ["--size", "16x9", "--map-size", "16", "--rounds", "1", "--no-truth", "--no-grids", "--gl", "software",
         "--gpu", "none"]
RUN = ["run", "--out", "out", "--scene", "cubes", "--filters", "none", *SMALL]
SECRET = "of somebody else"
CHEAP = ["--scene", "cubes", "--map-size", "16", "--size", "16x9", "--gl", "software"]
# Every command that writes a folder; `whole` is a run's folder, `base` its baseline.
WRITERS = [RUN, ["merge", "whole", "--out", "out"], ["export", "cubes", "--out", "out", "--gl", "software"],
           ["stress", "--axes", "taps", "--filters", "poisson:taps=8", "--out", "out", "--gl", "software"],
           ["bias", *CHEAP, "--filters", "none", "--out", "out"],
           ["tune", *CHEAP, "--filters", "vsm", "--budget", "3", "--out", "out"],
           ["regress", "whole", "--baseline", "base", "--out", "out"]]
# Every command that reads a folder, or writes into one that it reads.
READERS = [["advise", "whole", "--max-rmse", "1"], ["merge", "whole", "--out", "new"],
           ["regress", "whole", "--baseline", "base", "--out", "new"],
           ["regress", "whole", "--baseline", "base", "--out", "new", "--accept"],
           ["score", "whole", "--name", "x", "--visibility", "whole/cubes.exr#none.visibility", "--gl", "software"],
           [*RUN[:1], "--out", "whole", *RUN[3:]],
           [*RUN[:1], "--out", "whole", "--fresh", *RUN[3:]]]
# What a folder to write into may hold that is not ours, or has one of our names.
NAMES = [".shadowbench-lock", ".shadowbench-folder", "index.html", "results.json", "stress.json", "tuned.json", "images",
         "cells", "live", "cubes", "regress.json", "bias", "bias/bias.json", "gpu-times", "sweep.json", "filters.json",
         "cells/0123456789abcdef.json", "images/a.png", ".worker-99999999/a", "b.shadowbench-tmp-99999999.png",
         "deep/er/a.txt"]
ANY_ANSWER = {0, 1, 2, 3, 5, 6}  # whatever it is, it is an answer


class Case:
    """A command in a folder of its own."""

    def __init__(self, number, kind, words, right, before, after=None):
        self.number, self.kind, self.words, self.right = number, kind, words, right
        self.before, self.after = before, after  # fills the folder; says what is wrong with it afterwards


def mutate(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8, 40])):
        if not data:
            break
        at, kind = rng.randrange(len(data)), rng.randrange(7)
        end = min(len(data), at + rng.choice([1, 4, 30, 300]))
        if kind == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            del data[at:end]
        elif kind == 2:
            data[at:at] = data[at:end]
        elif kind == 3:
            data[at:end] = bytes(rng.randrange(256) for _ in range(end - at))
        elif kind == 4:
            data[at:at] = rng.choice([b"-1", b"1e999", b"nan", b"99999999999999999999", b"\0", b"[[[[", b"{", b"\xff\xfe"])
        elif kind == 5:
            del data[at:]
        else:
            data[at:end] = data[rng.randrange(len(data)):][:end - at]
    return bytes(data)


class Maker:
    """Makes the cases; `samples` has a real file, or a folder of them, for every format that is read."""

    def __init__(self, samples):
        self.samples = samples
        self.formats = [
            ("toml", samples / "cubes.toml", ["run", "--scene", "{}"], {0, 3}),
            ("gltf", samples / "small.gltf", ["run", "--scene", "{}"], {0, 3}),
            ("glb", ROOT / "tests" / "fuzz" / "corpus" / "gltf" / "meshopt.glb", ["run", "--scene", "{}"], {0, 3}),
            ("obj", samples / "small.obj", ["run", "--scene", "{}"], {0, 3}),
            ("glsl", ROOT / "filters" / "vsm.glsl", ["run", "--scene", "cubes", "--filters", "mutant", "--filter-file",
                                                     "{}"], {0, 2, 5}),
            ("glsl", ROOT / "filters" / "pcss.glsl", ["run", "--scene", "cubes", "--filters", "mutant", "--filter-file",
                                                      "{}"], {0, 2, 5}),
            ("toml", ROOT / "data" / "experiments" / "quick.toml", ["run", "{}", "--scene", "cubes", "--filters",
                                                                       "none"], {0, 2, 3}),
            ("exr", samples / "run" / "cubes.exr", ["diff", "{}#none.visibility", str(samples / "run" / "cubes.exr")
                                                    + "#none.visibility"], {0, 1, 2, 3}),
            ("png", samples / "run" / "cubes.grid.png", ["diff", "{}", str(samples / "run" / "cubes.grid.png")],
             {0, 1, 2, 3}),
            ("json", samples / "run" / "results.json", ["advise", "folder", "--max-rmse", "1"], {0, 1, 3}),
        ]

    def make(self, number, seed):
        rng = random.Random(f"{seed} {number}")
        kinds = [self.mutant, self.foreign, self.planted]
        return kinds[number % len(kinds)](number, rng)

    def mutant(self, number, rng):
        ending, source, words, right = rng.choice(self.formats)

        def write(folder):
            data = mutate(source.read_bytes(), rng)
            name = "mutant." + ending
            if ending == "json":
                (folder / "folder").mkdir()
                name = "folder/results.json"
            (folder / name).write_bytes(data)
            if ending in ("gltf", "obj"):
                for extra in ("small.bin", "small.mtl"):
                    if (self.samples / extra).exists():
                        shutil.copy(self.samples / extra, folder)

        filled = [word.replace("{}", "mutant." + ending) for word in words]
        extra = ["--out", "out", *SMALL, *([] if "--filters" in filled else ["--filters", "none"])]
        return Case(number, f"mutant {source.name}", [*filled, *(extra if filled[0] == "run" else [])], right, write)

    def copy_reports(self, folder):
        shutil.copytree(self.samples / "run", folder / "whole")
        shutil.copytree(self.samples / "base", folder / "base")

    def foreign(self, number, rng):
        name = rng.choice([name for name in NAMES if not name.startswith((".shadowbench", "cells/0"))])

        def fill(folder):
            self.copy_reports(folder)
            path = folder / "out" / name
            path.parent.mkdir(parents=True)
            path.write_text(SECRET)

        def look(folder):
            found = [path for path in (folder / "out").rglob("*") if not path.is_dir()]
            return None if [path.read_text(errors="replace") for path in found] == [SECRET] else f"now {found[:5]}"

        return Case(number, f"foreign {name}", rng.choice(WRITERS), {6}, fill, after=look)

    def planted(self, number, rng):
        reads = rng.random() < 0.5
        words = rng.choice(READERS if reads else WRITERS)
        planting, draw = rng.choice(["link", "link", "hard link", "pipe", "folder", "nowhere"]), rng.random()

        def plant(folder):
            self.copy_reports(folder)
            (folder / "outside" / "inner").mkdir(parents=True)
            for name in ("file", "inner/file"):
                (folder / "outside" / name).write_text(SECRET)
            if reads:
                every = sorted(path for name in ("whole", "base") for path in (folder / name).rglob("*"))
                place = every[int(draw * len(every))]
            else:
                (folder / "out").mkdir()
                (folder / "out" / ".shadowbench-folder").touch()
                place = folder / "out" / NAMES[int(draw * len(NAMES))]
            is_folder = place.is_dir() or not place.suffix and place.name in ("images", "cells", "live", "cubes", "bias")
            if place.is_dir():
                shutil.rmtree(place)
            place.unlink(missing_ok=True)
            place.parent.mkdir(parents=True, exist_ok=True)
            outside = folder / "outside" / ("inner" if is_folder else "file")
            if planting == "hard link" and not is_folder:
                place.hardlink_to(outside)
            elif planting == "pipe":
                os.mkfifo(place)
            elif planting == "folder":
                place.mkdir()
            else:
                place.symlink_to("nowhere" if planting == "nowhere" else outside)

        def look(folder):
            outside = sorted(path for path in (folder / "outside").rglob("*") if path.is_file())
            if [path.relative_to(folder / "outside").as_posix() for path in outside] != ["file", "inner/file"]:
                return f"now there are {outside[:5]}"
            if any(path.read_text(errors="replace") != SECRET for path in outside):
                return "a file outside was written"
            new = folder / ("new" if reads else "out")
            if planting != "hard link" and any(path.is_file() and not path.is_symlink() and SECRET.encode() in path.read_bytes()
                                               for path in new.rglob("*")):
                return "what a link leads to was copied"
            return None

        return Case(number, f"planted {planting}", words, ANY_ANSWER, plant, after=look)


def start(program, case, folder):
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / ".cache"), "HOME": str(folder)}
    return subprocess.Popen([program, *case.words], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)


def wait(process, timeout):
    """Exit code, and what was said; nothing where it hangs."""
    try:
        out, err = process.communicate(timeout=timeout)
        return process.returncode, (out + err).decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return None, ""


def list_leftovers(folder, known):
    """Files in places where nothing was asked for, and what a run leaves while it goes on."""
    found = []
    for path in folder.rglob("*"):
        inside = path.relative_to(folder)
        if inside.parts[0] in (".cache", *known):
            continue
        temporary = path.name.startswith(".worker") or path.name.endswith((".part", ".tmp"))
        if inside.parts[0] != "out" or temporary:
            found.append(str(inside))
    return found


def try_case(program, case, timeout):
    """What went wrong: kind and words; nothing where all is right."""
    with tempfile.TemporaryDirectory(prefix="hostile-") as name:
        folder = Path(name)
        case.before(folder)
        known = [path.name for path in folder.iterdir()]
        process = start(program, case, folder)
        code, said = wait(process, timeout)
        if code is None:
            return "hang", f"more than {timeout} s"
        if code < 0 or code == 70 or code >= 126:
            return "crash", f"{code}: {said[-300:]}"
        if code not in case.right:
            return "code", f"{code}, right were {sorted(case.right)}: {said[-300:]}"
        if code not in (0, 1) and "shadowbench: " not in said:
            return "code", f"{code} without a message: {said[-300:]}"
        if case.after and (found := case.after(folder)):
            return "outside", found
        if case.after:
            return None
        leftovers = list_leftovers(folder, known)
        return ("leftover", ", ".join(leftovers[:5])) if leftovers else None


def make_samples(program, folder):
    """A real file of each format."""
    shutil.copy(ROOT / "data" / "scenes" / "cubes.toml", folder / "cubes.toml")
    subprocess.run([program, "run", "--out", str(folder / "run"), "--scene", "cubes", "--filters", "none", "--size", "64x36",
                    "--map-size", "32", "--rounds", "1"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run([program, "regress", str(folder / "run"), "--baseline", str(folder / "base"), "--accept"],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    (folder / "small.obj").write_text("mtllib small.mtl\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nvt 0 0\nvn 0 1 0\n"
                                      "usemtl a\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 1 2 5\nf -1 -2 -3\n")
    (folder / "small.mtl").write_text("newmtl a\nKd 0.5 0.5 0.5\nmap_Kd none.png\n")
    import struct
    points = [0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 1, 0]
    (folder / "small.bin").write_bytes(struct.pack("<12f", *points) + struct.pack("<6H", 0, 1, 2, 0, 2, 3))
    (folder / "small.gltf").write_text(
        '{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,1,0]}],'
        '"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],"materials":[{"name":"a",'
        '"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.5,1]}}],"buffers":[{"uri":"small.bin","byteLength":60}],'
        '"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],"accessors":[{'
        '"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,1]},{"bufferView":1,'
        '"componentType":5123,"type":"SCALAR","count":6}]}')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=Path)
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the case of this number alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--timeout", type=float, default=60.0)
    arguments = parser.parse_args()
    program = str(arguments.program.resolve())
    with tempfile.TemporaryDirectory(prefix="hostile-samples-") as samples:
        make_samples(program, Path(samples))
        maker = Maker(Path(samples))
        numbers = range(arguments.cases) if arguments.only is None else [arguments.only]
        cases = [maker.make(number, arguments.seed) for number in numbers]
        wrong, started = {}, time.monotonic()
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            for case, found in zip(cases, pool.map(lambda c: try_case(program, c, arguments.timeout), cases)):
                if not found:
                    continue
                wrong.setdefault(found[0], []).append(case.number)
                print(f"{found[0]}: case {case.number} ({case.kind}): {found[1]}\n  shadowbench {shlex.join(case.words)[:400]}\n"
                      f"  again: --seed {arguments.seed} --only {case.number}", flush=True)
        counts = ", ".join(f"{len(wrong.get(kind, []))} {kind}" for kind in ("crash", "hang", "code", "leftover", "outside"))
        print(f"{len(cases)} cases in {time.monotonic() - started:.0f} s: {counts}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
