#!/usr/bin/env python3
"""Configures the project as users do, with flags and parts of their own choice, and reads what CMake makes of that."""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PARTS = {"WINDOW": "gui.cpp", "OSMESA": "context_osmesa.cpp", "EGL": "context_egl.cpp", "GPU_ESTIMATES": "null_device.cpp",
         "LIVE_PAGE": "webgl.cpp", "MESHOPT": "gltf_meshopt.cpp"}
DEFINED = {"GPU_ESTIMATES", "LIVE_PAGE"}  # a source without its part says so
EVERYTHING_LEFT_OUT_BUT_EGL = [f"-DSHADOWBENCH_WITH_{part}=OFF" for part in PARTS if part != "EGL"]
AVAILABLE = set(PARTS)  # on this machine: Debian 14 will have no OSMesa


def expect(condition, message):
    if not condition:
        sys.exit(message)


class Configuration:
    """A build folder that was configured; nothing is compiled in it."""

    def __init__(self, source, *words, flags=None):
        self.folder = tempfile.TemporaryDirectory(prefix="shadowbench.build.")
        environment = {name: value for name, value in os.environ.items() if name not in ("CXXFLAGS", "CFLAGS")}
        if flags:
            environment["CXXFLAGS"] = flags
        gone = [f"-DSHADOWBENCH_WITH_{part}=OFF" for part in set(PARTS) - AVAILABLE]
        done = subprocess.run(["cmake", "-G", "Ninja", "-S", source, "-B", self.folder.name, *gone, *words], env=environment,
                              text=True, capture_output=True, check=False)
        self.exit_code, self.output = done.returncode, " ".join((done.stdout + done.stderr).split())

    def levels(self, source):
        """The levels of optimisation that a source is compiled with, in order; the last one counts."""
        commands = json.loads((Path(self.folder.name) / "compile_commands.json").read_text(encoding="utf-8"))
        command = next(each["command"] for each in commands if each["file"].endswith(source))
        return [word for word in command.split() if word.startswith("-O")]

    def parts(self):
        """The parts whose own sources are compiled, or whose contents are."""
        commands = json.loads((Path(self.folder.name) / "compile_commands.json").read_text(encoding="utf-8"))
        compiled = {Path(each["file"]).name: each["command"] for each in commands}
        return {part for part, source in PARTS.items() if source in compiled and
                (part not in DEFINED or f"-DSHADOWBENCH_HAS_{part}" in compiled[source])}


def check_flags(source):
    """The user's flags are the last word; without any, what computes pixels gets more than the rest."""
    wanted = [
        ((), None, ["-O1"], ["-O1", "-O3"]),
        ((), "-O2", ["-O2"], ["-O2"]),
        (("-DCMAKE_CXX_FLAGS_RELEASE=-Os",), None, ["-Os"], ["-Os"]),
        (("-DCMAKE_BUILD_TYPE=Debug",), None, [], []),
    ]
    for words, flags, of_most, of_pixels in wanted:
        made = Configuration(source, *words, flags=flags)
        expect(made.exit_code == 0, f"{words} {flags}: {made.output}")
        found = made.levels("harness/cli/main.cpp"), made.levels("reference/truth/occluders.cpp")
        expect(found == (of_most, of_pixels), f"{words} {flags}: the levels of optimisation are {found}")
        expect(made.parts() == AVAILABLE, f"these parts are there: {made.parts()}")


def check_parts(source):
    least = Configuration(source, *EVERYTHING_LEFT_OUT_BUT_EGL)
    expect(least.exit_code == 0 and least.parts() == {"EGL"}, f"{least.parts()}: {least.output}")
    none = Configuration(source, *EVERYTHING_LEFT_OUT_BUT_EGL, "-DSHADOWBENCH_WITH_EGL=OFF")
    expect(none.exit_code != 0 and "Nothing is left that could draw" in none.output, none.output)
    missing = Configuration(source, "-DCMAKE_DISABLE_FIND_PACKAGE_meshoptimizer=ON")
    sentence = ("Left out: models that meshoptimizer compressed, since this was not found: meshoptimizer. Install "
                "libmeshoptimizer-dev to have it.")
    expect(missing.exit_code == 0 and sentence in missing.output, missing.output)
    expect(missing.parts() == AVAILABLE - {"MESHOPT"}, f"these parts are there: {missing.parts()}")
    packed = subprocess.run(["cpack", "-G", "DEB"], cwd=missing.folder.name, text=True, capture_output=True, check=False)
    expect(packed.returncode != 0 and "-DSHADOWBENCH_WITH_MESHOPT=OFF" in packed.stdout + packed.stderr,
           f"a package without a part that nobody left out: {packed.stdout}{packed.stderr}")
    asked = Configuration(source, "-DCMAKE_DISABLE_FIND_PACKAGE_meshoptimizer=ON", "-DSHADOWBENCH_WITH_MESHOPT=ON")
    expect(asked.exit_code != 0 and "Install libmeshoptimizer-dev, or configure with" in asked.output, asked.output)


def check_embree(source):
    missing = Configuration(source, "-DCMAKE_DISABLE_FIND_PACKAGE_embree=ON")
    expect(missing.exit_code != 0 and "Embree 3 or 4 is needed" in missing.output
           and "libembree-dev" in missing.output, missing.output)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", required=True, type=Path, help="the checkout")
    source = parser.parse_args().source.resolve()
    AVAILABLE.intersection_update(Configuration(source).parts())
    expect("EGL" in AVAILABLE and "MESHOPT" in AVAILABLE, f"these parts are there: {AVAILABLE}")
    check_flags(source)
    check_parts(source)
    check_embree(source)


if __name__ == "__main__":
    main()
