#!/usr/bin/env python3
"""Installs the built program, moves it elsewhere, uses it there, and reads the Debian package that cpack makes."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TINY = ["--size", "32x18", "--map-size", "32", "--rounds", "1", "--no-attribution", "--no-cache", "--gl", "software"]
OPENED_AT_RUN_TIME = ("fonts-dejavu-core", "libgl1-mesa-dri", "libosmesa6")
MOST_LIBRARIES = 50  # 37 on Debian 12
LINKED = (r"libembree\d-\d", r"libopenimageio[\d.]+")


def call(*words, **options):
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode}: {words}\n{done.stdout}{done.stderr}")
    return done.stdout


def expect(condition, message):
    if not condition:
        sys.exit(message)


def install(build, folder):
    """Installs into one folder and moves it to another, so that no path of the installation can be right by chance."""
    call("cmake", "--install", build, "--prefix", folder / "first", "--component", "program")
    (folder / "first").rename(folder / "moved")
    return folder / "moved"


def check_files(prefix):
    expect([file.name for file in (prefix / "bin").iterdir()] == ["shadowbench"], "bin/ holds more than the program")
    folders = sorted(folder.name for folder in (prefix / "share/shadowbench").iterdir())
    expect(folders == ["data", "engines", "filters", "shaders"], f"share/shadowbench/ holds {folders}")
    suffixes = {file.suffix for file in (prefix / "share/shadowbench").rglob("*") if file.is_file()}
    expect(suffixes == {".frag", ".geom", ".glsl", ".js", ".json", ".mjs", ".toml", ".vert"}, f"share/shadowbench/ holds files {suffixes}")
    help_text = call(prefix / "bin/shadowbench", "--help")
    commands = re.findall(r"^  ([a-z]+) {2,}\S", help_text, re.MULTILINE)
    expect("run" in commands, f"no commands in {help_text}")
    for page in ["shadowbench", *(f"shadowbench-{command}" for command in commands)]:
        expect((prefix / f"share/man/man1/{page}.1.gz").is_file(), f"there is no manual page {page}(1)")
    for file in ("bash-completion/completions/shadowbench", "zsh/vendor-completions/_shadowbench",
                 "doc/shadowbench/README.md", "doc/shadowbench/slurm.sh", "doc/shadowbench/CHANGELOG.md", "doc/shadowbench/copyright"):
        expect((prefix / "share" / file).is_file(), f"there is no {file}")


def complete(prefix, *words):
    """What bash offers for the last of these words."""
    script = (f"source {prefix}/share/bash-completion/completions/shadowbench\nCOMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n"
              "_shadowbench_words\necho ${COMPREPLY[@]}")
    return call("bash", "-c", script, "bash", prefix / "bin/shadowbench", *words).split()


def check_shell(prefix):
    """Manual pages have every option, and no mistake; the shell completes commands, options and values."""
    for page in sorted((prefix / "share/man/man1").iterdir()):
        words = page.name.removesuffix(".1.gz").split("-")[1:]
        text = call("sh", "-c", f"zcat {page} | groff -man -Tascii -ww -P-c -P-b -P-u 2>&1")
        expect("troff" not in text, f"{page.name}:\n{text}")
        options = set(re.findall(r"^  (?:-h,)?(--[a-z-]+)", call(prefix / "bin/shadowbench", *words, "--help-all"), re.MULTILINE))
        missing = {option for option in options if option not in text}
        expect(options and not missing, f"{page.name} lacks {missing}")
    for words, offered in ((["reg"], ["regress"]), (["list", ""], ["filters", "presets", "scenes", "lessons", "metrics", "gpus", "gl"]),
                           (["run", "--map"], ["--map-size", "--map-format"]), (["run", "--no-tr"], ["--no-truth"]),
                           (["run", "--border", ""], ["border", "edge", "repeat"]), (["run", "--border", "=", "e"], ["edge"]),
                           (["run", "--filters", "none,tent3"], ["none,tent3x3"]), (["bias", "--scene", "cub"], ["cubes"]),
                           (["run", "--work"], []), (["diff", "a", "b"], [])):
        found = complete(prefix, *words)
        expect(found == offered, f"{words}: {found} is offered, not {offered}")


def check_use(prefix, folder):
    """Only the prefix has this scene, and no longer has another: what the program finds, it finds there."""
    scenes = prefix / "share/shadowbench/data/scenes"
    (scenes / "ball.toml").unlink()
    text = (scenes / "cubes.toml").read_text(encoding="utf-8")
    (scenes / "moved.toml").write_text(re.sub(r'title = ".*"', 'title = "Of the moved prefix"', text), encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if name != "SHADOWBENCH_ROOT"}
    program = prefix / "bin/shadowbench"
    listed = call(program, "list", "scenes", env=environment)
    expect("Of the moved prefix" in listed and "ball" not in listed, f"these are not the prefix's scenes:\n{listed}")
    presets = call(program, "list", "presets", env=environment)
    expect("@godot " in presets and "castano3" in presets, f"the presets are not installed:\n{presets}")
    broken = prefix / "share/shadowbench/filters/esm.glsl"
    broken.unlink()
    filters = call(program, "list", "filters", env=environment)
    expect("vsm " in filters and "esm " not in filters, f"these are not the prefix's filters:\n{filters}")
    call(program, "run", "--scene", "moved", "--filters", "none,vsm", *TINY, "--out", folder / "out", env=environment)
    expect((folder / "out/index.html").is_file(), "the run wrote no report")


def check_start(prefix):
    """What few commands need, the program opens when they do: loading it takes ten times as long as all else at the start."""
    loaded = call("ldd", prefix / "bin/shadowbench")
    early = re.findall(r"OpenImageIO|OSMesa|LLVM", loaded)
    expect(not early and loaded.count("\n") <= MOST_LIBRARIES, f"{loaded}{early or 'too many'} are loaded at the start")


def check_missing(prefix, folder):
    """A library that is opened late is missed by what needs it alone: one sentence, and the exit code of what failed."""
    needed = call("readelf", "-d", prefix / "lib/shadowbench/shadowbench_openimageio.so")
    broken = folder / "broken"
    broken.mkdir()
    for name in (re.search(r"\[(libOpenImageIO\.so[\d.]+)\]", needed)[1], "libOSMesa.so.8"):
        (broken / name).write_text("no library", encoding="utf-8")
    environment = dict(os.environ, SHADOWBENCH_ROOT=str(prefix / "share/shadowbench"), LD_LIBRARY_PATH=str(broken))
    picture = prefix / "share/picture.ppm"
    picture.write_bytes(b"P6 1 1 255 abc")
    run = ["run", "--scene", "moved", "--filters", "none", *TINY, "--out", folder / "incomplete"]
    for words, code, told in ((["--version"], 0, "shadowbench "), (["list", "filters"], 0, "vsm"),
                              (["diff", picture, picture], 3, "libOpenImageIO"), (run, 6, "libOpenImageIO"),
                              ([*run[:-3], "osmesa", *run[-2:]], 4, "libOSMesa")):
        done = subprocess.run([str(word) for word in (prefix / "bin/shadowbench", *words)], text=True, capture_output=True, check=False,
                              env=environment)
        expect((done.returncode, told in done.stdout + done.stderr) == (code, True), f"{words}: exit code {done.returncode}\n{done.stderr}")
        expect(code == 0 or done.stderr.splitlines()[-1].count("; install ") == 1, f"{words}: what is to be installed?\n{done.stderr}")


def check_package(build, folder):
    call("cpack", "-G", "DEB", "--config", build / "CPackConfig.cmake", "-B", folder / "package")
    packages = list((folder / "package").glob("*.deb"))
    expect(len(packages) == 1, f"cpack made {packages}")
    expect(re.fullmatch(r"shadowbench_[\d.]+-[a-z0-9.]+_[a-z0-9]+\.deb", packages[0].name), f"a package named {packages[0].name}")
    depends = call("dpkg-deb", "--field", packages[0], "Depends")
    for package in OPENED_AT_RUN_TIME + LINKED:
        expect(re.search(rf"(^|, ){package}( |,|$)", depends), f"no dependency on {package} in: {depends}")
    expect(call("dpkg-deb", "--field", packages[0], "Section").strip() == "graphics", "another section than graphics")
    files = call("dpkg-deb", "--contents", packages[0])
    expect("./usr/bin/shadowbench\n" in files, f"no ./usr/bin/shadowbench in the package:\n{files}")
    foreign = re.compile(r" \./usr/(?!bin/|lib/$|lib/shadowbench/|share/|$)| \./(?!usr/)\w|_test|_bench")
    others = [line for line in files.splitlines() if foreign.search(line)]
    expect(not others, f"what is no part of the program is in the package: {others}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", required=True, type=Path, help="a folder in which everything is built")
    build = parser.parse_args().build.resolve()
    expect(shutil.which("dpkg-deb"), "dpkg-deb is missing: install dpkg-dev (harness/setup.sh does)")
    with tempfile.TemporaryDirectory(prefix="shadowbench.package.") as name:
        folder = Path(name)
        prefix = install(build, folder)
        check_files(prefix)
        check_shell(prefix)
        check_use(prefix, folder)
        check_start(prefix)
        check_missing(prefix, folder)
        check_package(build, folder)


if __name__ == "__main__":
    main()
