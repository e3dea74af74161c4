#!/usr/bin/env python3
"""Checks that the folders are what CONTRIBUTING.md says of them. Standard library only.

A source is listed in its room's CMakeLists.txt. An include runs from a room to one that stands before it in ROOMS, never back
up. A room is one CMake target and one namespace, with the folders inside it that are no rooms. Every folder of sources has a
README and holds at most 40 files (the filters' own do not count). No source has more than 700 lines, none names a
filter, and none includes a library that belongs to another folder. No two sources of one namespace, product or
tests, define the same name for themselves: CMake joins sources into one (CMAKE_UNITY_BUILD), and a further file decides anew which.
"""
import argparse
import pathlib
import re
import sys

# From the ground up. What stands inside a room's folder and is not named here belongs to the room.
ROOMS = [
    "base", "filters", "reference/metrics", "reference/truth", "report/records", "report/images",
    "report/analysis", "report/document", "report/pages", "report/regress", "harness/gl", "harness/spirv", "harness/scene", "harness/gpu", "harness/render",
    "harness/options", "harness/live", "harness/measure", "harness/run", "harness/engines", "harness/tune", "harness/stress", "harness/view",
    "harness/cli"]
# What a room may not use, although it stands before it.
FORBIDDEN = {
    "reference/metrics": ["filters"], "harness/gl": ["reference/", "report/"],
    "harness/scene": ["reference/metrics", "report/", "harness/gl"],
    "harness/spirv": ["reference/", "report/"], "harness/gpu": ["reference/"],
    "harness/stress": ["harness/tune"]}
NAMESPACES = {"base": "shadowbench"}
# Libraries (as includes have them) and the folder that alone knows them.
KNOWN_IN = {r"OpenImageIO/": "report/images/", r"ft2build": "report/images/", r"glslang/": "harness/spirv/", r"spirv_cross": "harness/spirv/"}
REFERENCE = "none"  # what every filter is compared with
MOST_FILES = 40
MOST_LINES = 700
SOURCES = {".cpp", ".h"}
COUNTED_LINES = SOURCES | {".glsl", ".frag", ".vert", ".js", ".css", ".py"}
TOPS = ("base", "filters", "shaders", "reference", "report", "harness", "data", "tests")


def room_of(path):
    """The innermost room that a path (relative, as text) lies in."""
    within = [room for room in ROOMS if path.startswith(room + "/")]
    return max(within, key=len) if within else None


def check_names(root, name, text, faults):
    filters = "|".join(path.stem for path in root.glob("filters/*.glsl") if path.stem != REFERENCE)
    code = re.sub("//.*", "", text)
    for found in re.findall(rf'"({filters})[":]', code):
        faults.append(f"{name}: names the filter {found}")
    for library, folder in KNOWN_IN.items():
        if re.search(rf"#include <{library}", text) and not name.startswith(folder):
            faults.append(f"{name}: includes what {folder} alone knows")


def check_is_listed(root, room, path, faults):
    """CMake finds what a filter or an axis of `stress` is by its file; every other source is listed."""
    found = path.with_suffix(".glsl").exists() or path.parent.name == "axes"
    within = path.relative_to(root / room).as_posix()
    if not found and not re.search(rf"(?<![\w/]){re.escape(within)}(?!\w)", root.joinpath(room, "CMakeLists.txt").read_text(encoding="utf-8")):
        faults.append(f"{room}/{within}: is not listed in {room}/CMakeLists.txt")


def check_source(root, path, faults):
    name = path.relative_to(root).as_posix()
    text = path.read_text(encoding="utf-8")
    if path.suffix in COUNTED_LINES and text.count("\n") > MOST_LINES:
        faults.append(f"{name}: {text.count(chr(10))} lines; {MOST_LINES} are the most")
    room = room_of(name)
    if path.suffix not in SOURCES:
        return
    if room is None:
        faults.append(f"{name}: belongs to no room")
        return
    check_names(root, name, text, faults)
    wanted = NAMESPACES.get(room, "shadowbench::" + room.rsplit("/", 1)[-1])
    opened = set(re.findall(r"^namespace (shadowbench(?:::\w+)?) \{", text, re.MULTILINE))
    if opened - {wanted}:
        faults.append(f"{name}: opens {', '.join(sorted(opened - {wanted}))}; the room's namespace is {wanted}")
    if path.suffix == ".cpp":
        check_is_listed(root, room, path, faults)
    for number, line in enumerate(text.splitlines(), 1):
        include = re.match(r'#include "((?:base|filters|reference|report|harness)/[^"]+)"', line)
        other = room_of(include.group(1)) if include else None
        if other is None or other == room:
            continue
        if ROOMS.index(other) > ROOMS.index(room):
            faults.append(f"{name}:{number}: {room} uses {other}, which stands above it")
        elif any((other + "/").startswith(prefix) for prefix in FORBIDDEN.get(room, [])):
            faults.append(f"{name}:{number}: {room} uses {other}, which is none of its business")


def check_folder(root, folder, faults):
    name = folder.relative_to(root).as_posix()
    files = [path for path in folder.iterdir() if path.is_file()]
    own = [path for path in files if not (name == "filters" and folder.joinpath(path.stem + ".glsl").exists())]
    if len(own) > MOST_FILES:
        faults.append(f"{name}: {len(own)} files; {MOST_FILES} are the most")
    if any(path.suffix in SOURCES for path in files):
        if not folder.joinpath("README.md").exists():
            faults.append(f"{name}: has no README.md")
        if folder.joinpath("CMakeLists.txt").exists() and name not in ROOMS:
            faults.append(f"{name}: has a target of its own, and is no room")


def list_own_names(text):
    """What a source defines in its unnamed namespace: types, constants, and functions with their parameters."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', "", text, flags=re.DOTALL)
    for own in re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text, re.DOTALL | re.MULTILINE):
        yield from re.findall(r"^(?:struct|class|enum(?: class)?) (\w+)[^;]*$", own, re.MULTILINE)
        yield from re.findall(r"^(?:constexpr|const) [^=(]*?(\w+)(?:\[\w*\])* ?[={]", own, re.MULTILINE)
        yield from re.findall(r"^(?!TEST)\w[\w:<>,&* ]*[ &*](\w+\([^)]*\)) (?:const )?\{$", own, re.MULTILINE)


def check_own_names(root, faults):
    owners = {}
    for path in sorted(path for top in ("base", "filters", "reference", "report", "harness", "tests") for path in root.joinpath(top).rglob("*.cpp")):
        name, text = path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")
        space = re.findall(r"^namespace (\S+) \{$", text, re.MULTILINE)[:1]
        # Many programs have one of these two namespaces.
        folder = path.parent if space in (["shadowbench"], ["shadowbench::test"]) else name.startswith("tests/")
        program = (*space, folder, name.endswith("_gl_test.cpp"))
        for own in list_own_names(text):
            if owners.setdefault((program, own), name) != name:
                faults.append(f"{name}: defines {own}, as {owners[program, own]} does; give one another name")


def check_named_files(root, faults):
    """A source that a README names by its file's name alone must be somewhere."""
    known = {path.name for top in TOPS for path in root.joinpath(top).rglob("*")}
    for readme in [root / "CONTRIBUTING.md", *(path for top in TOPS for path in root.joinpath(top).rglob("README.md") if "node_modules" not in path.parts)]:
        for name in re.findall(r"`(?:[\w./]*/)?(\w+\.(?:h|cpp|js|py))`", readme.read_text(encoding="utf-8")):
            if name not in known:
                faults.append(f"{readme.relative_to(root)}: names {name}, which there is not")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    root = parser.parse_args().root
    faults = []
    for top in ("base", "filters", "shaders", "reference", "report", "harness"):
        for path in sorted(root.joinpath(top).rglob("*")):
            if {"out", "node_modules"} & set(path.relative_to(root).parts):
                continue
            check_folder(root, path, faults) if path.is_dir() else check_source(root, path, faults) if path.suffix in COUNTED_LINES else None
        check_folder(root, root.joinpath(top), faults)
    check_own_names(root, faults)
    check_named_files(root, faults)
    for room in ROOMS:
        if not root.joinpath(room, "CMakeLists.txt").exists():
            faults.append(f"{room}: has no CMakeLists.txt, so it is no target")
    print("\n".join(faults) if faults else f"{len(ROOMS)} rooms are as they should be")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
