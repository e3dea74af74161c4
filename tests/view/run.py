#!/usr/bin/env python3
"""Uses the window of `shadowbench view` as a person does, on a display that nobody sees.

    python3 tests/view/run.py --program build/tests/shadowbench [--only NAME]

Needs Xvfb, xdotool and oiiotool.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from window import Display, Window

FIXED = ["--size", "480x270", "--map-size", "256"]
TALL = ["--size", "480x850", "--map-size", "256"]  # all widgets of the panels are seen
FILTER = """/*+++
title = "Halved"
source = "none"
kind = "other"
[param.factor]
default = 0.5
min = 0.0
max = 1.0
unit = "1"
text = "what visibility is multiplied by"
+++*/
float visibility(Receiver r) { return factor * compare_nearest(r, vec2(0.0), r.depth); }
"""


def test_no_display_is_code_4(program, folder):
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([program, "view", "cubes"], env=environment, capture_output=True, text=True)
    assert done.returncode == 4, done
    assert done.stderr.count("\n") == 1 and "display" in done.stderr.lower(), done.stderr


def test_bad_input_is_refused_before_a_window_opens(program, folder):
    for arguments, code in ((["nowhere"], 2), (["cubes", "--left", "vsn"], 2), (["cubes", "--left", "none,vsm"], 2), (["cubes", "--size", "12"], 2), (["--lesson", "acme"], 2), (["cubes", "--lesson", "acne"], 2), (["three_lights", "--light-name", "sum"], 2),
                            (["cubes", "--filter-file", str(folder / "none.glsl")], 5), (["missing.toml"], 3)):
        done = subprocess.run([program, "view", *arguments], capture_output=True, text=True, timeout=60)
        assert done.returncode == code, (arguments, done)
        assert done.stderr.count("\n") == 1, done.stderr


def test_divider_follows_the_mouse(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--right", "none"]) as window:
        window.drag(window.place("divider"), (-120, 0))
        assert abs(window.last()["divider"] - (0.5 - 120 / 480)) < 0.02, window.last()
        assert not any(frame["drawn"] for frame in window.frames[-4:]), "a divider that moves draws no pass anew"


def test_parameter_is_seen_in_the_next_frame(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--left", "vsm", "--right", "none"]) as window:
        before = window.last()["left.radius"]
        changed = window.after(lambda: window.click("left.radius", 0.5), "another radius", lambda frame: frame["left.radius"] != before)
        assert changed["drawn"], "the frame that takes the value draws with it"


def test_mouse_turns_camera_and_light(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--right", "none"]) as window:
        first = window.picture("left.visibility")
        window.drag((120, 200), (60, 0))
        assert window.picture("left.visibility") != first, "a drag orbits"
        window.key("r")
        window.pause(0.5)
        assert window.picture("left.visibility") == first, "R goes back"
        window.send("keydown", "shift")
        window.after(lambda: window.drag((120, 200), (60, 0)), "a drawing")
        window.send("keyup", "shift")
        assert window.picture("left.visibility") != first, "the light moves"
        window.after(lambda: window.send("keydown", "w"), "a flight")
        window.send("keyup", "w")


def test_saved_filter_is_live(program, folder):
    file, tree = folder / "halved.glsl", folder / "tree"
    file.write_text(FILTER)
    for name in ("filters", "shaders", "data"):
        shutil.copytree(Path(__file__).resolve().parents[2] / name, tree / name)
    with Window(program, folder, ["cubes", *FIXED, "--filter-file", str(file), "--right", "none"], {"SHADOWBENCH_ROOT": str(tree)}) as window:

        def edit(old, new, what, holds=lambda frame: frame["drawn"]):
            return window.after(lambda: file.write_text(FILTER.replace(old, new)), what, holds)

        first = window.picture("left.visibility")
        begun = time.monotonic()
        frame = edit("factor * compare", "0.25 * factor * compare", "a drawing")
        seconds = frame["t"] + 1e-3 * frame["ms"] - begun
        second = window.picture("left.visibility")
        lit = first[2].index(0.5)
        assert second[2][lit] == 0.125, second[2][lit]
        # A mistake is said with file and line over the last good image.
        frame = edit("compare_nearest(", "max(1.0, 2, 3) * compare_neerest(", "a fault", lambda frame: frame["left.fault"])
        line = FILTER.count("\n")
        assert f"halved.glsl:{line}" in frame["left.fault"] and "compare_neerest" in frame["left.fault"], frame["left.fault"]
        _, top, _, bottom = window.widgets["fault"]
        assert 0 < bottom - top < 200, "not every overload of max"
        assert window.picture("left.visibility") == second, "the good image stays"
        # The front matter too.
        edit("min = 0.0", "minimum = 0.0", "a message", lambda frame: "halved.glsl" in frame["message"])
        edit("", "", "the end of the fault", lambda frame: not frame["left.fault"] and not frame["message"])
        assert window.picture("left.visibility") == first, "mended"
        # A built-in filter of a tree, too.
        before = window.picture("right.visibility")[2]
        built_in = tree / "filters" / "none.glsl"
        dimmed = built_in.read_text().replace("return compare_nearest", "return 0.25 * compare_nearest")
        window.after(lambda: built_in.write_text(dimmed), "a drawing")
        after = window.picture("right.visibility")[2]
        assert {pair for pair in zip(before, after) if pair[0] != pair[1]} == {(1.0, 0.25)}
    return f"a saved file was live after {seconds:.2f} s"


def test_truth_comes_while_the_window_answers(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--right", "truth"]) as window:
        assert "scale.left" not in window.widgets, "a picture has no scale"
        window.key("Next")
        window.key("Next")
        window.wait("the error's layer", lambda frame: frame["layer"] == "error")
        window.wait("the whole truth", lambda frame: frame["truth"] == 1.0, 120.0)
        left, top, right, bottom = window.widgets["scale.left"]
        assert 0.0 <= left < right <= 480.0 and 0.0 <= top < bottom <= 270.0, "the error's scale stands on the picture"
        assert "scale.right" not in window.widgets, "what means the same on both sides is said once"
        error = window.picture("truth.area")[2]
        assert min(error) == 0.0 and max(error) == 1.0, "shadow and light"
        window.move(120, 200)
        reading = window.wait("a value under the pointer", lambda frame: "signed error" in frame["reading"])["reading"]
        x, y, shown = map(float, re.match(r"pixel (\d+), (\d+), signed error (\S+) visibility, \S+ m away$", reading).groups())
        place = int(y) * 480 + int(x)
        assert abs(shown - (window.picture("left.visibility")[2][place] - error[place])) < 1e-5, reading
        # A moment after a drag there is no truth yet: the picture waits for it.
        window.drag((120, 200), (40, -20))
        assert window.last()["truth"] == 0.0
        truth = window.picture("right.visibility")[2]
        assert min(truth) == 0.0 and max(truth) == 1.0 and truth != error, "shadow and light"


def test_every_key_and_panel(program, folder):
    with Window(program, folder, ["lamp", "--size", "640x800", "--map-size", "256", "--left", "none", "--right", "vsm"]) as window:
        for key in ("F1", "n", "space", "space", "t", "x", "c", "l", "h", "h", "F1", *["Next"] * 12, *["Prior"] * 3, "r"):
            window.key(key)
            window.pause(0.25)
        assert window.last()["left"] == "vsm", "X exchanges the sides"
        window.key("space")
        window.wait("all of the left side", lambda frame: frame["divider"] == 1.0)
        window.key("t")
        window.wait("both sides", lambda frame: frame["divider"] == 0.5)
        window.choose("map_size", "512")
        window.choose("map_format", "d16")
        for filter_id, name in (("ray-traced truth", "truth"), ("pcss", "pcss")):
            window.after(lambda: window.choose("right.filter", filter_id), filter_id, lambda frame: frame["right"] == name)


def test_window_opens_as_large_as_the_screen_allows(program, folder):
    with Window(program, folder, ["cubes"]) as window:
        shape = window.geometry()
        assert 0.9 * Display.WIDTH < shape[0] <= Display.WIDTH and 0.9 * Display.HEIGHT < shape[1] <= Display.HEIGHT, shape
        window.wait("an error", lambda frame: "left.rmse" in frame, 120.0)
        cut = {name: place for name, place in window.widgets.items() if place[2] > shape[0] or place[3] > shape[1]}
        assert "bias" in window.widgets and not cut, cut


def test_scenes_and_lessons_are_chosen(program, folder):
    own = folder / "mine.toml"
    shutil.copy(Path(__file__).resolve().parents[2] / "data/scenes/ball.toml", own)
    with Window(program, folder, [str(own), *TALL, "--left", "vsm"]) as window:
        window.choose("scene", "lantern")
        window.wait("a scene of teaching", lambda frame: frame["scene"] == "lantern" and frame["left"] == "vsm" and not frame["message"])
        window.choose("lesson", "Acne against contact gap")
        frame = window.wait("a lesson", lambda frame: frame["lesson"] and frame["scene"] == "cubes" and "left.rmse" in frame, 60.0)
        assert frame["left"] == "none" and "map.image" in window.widgets, frame
        window.click("lesson.instead", 0.05)
        window.wait("less acne", lambda seen: seen.get("left.rmse", 1.0) < 0.5 * frame["left.rmse"], 30.0)
        own.unlink()
        window.choose("scene", str(own))
        window.wait("a message", lambda frame: own.name in frame["message"] and frame["scene"] == "cubes")


def test_lesson_opens_by_name(program, folder):
    with Window(program, folder, ["--lesson", "esm-overflow", *FIXED[:2]]) as window:
        frame = window.wait("the lesson", lambda frame: frame["lesson"] == "ESM overflows" and "map.image" in window.widgets)
        assert frame["scene"] == "cubes" and frame["left"] == "esm" and abs(frame["divider"] - 0.85) < 1e-6, frame


def test_picture_is_halved_while_something_is_dragged(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--left", "vsm:radius=6", "--right", "none"]) as window:
        window.move(120, 200)
        window.pause(0.3)

        def drag():
            window.send("mousedown", 1)
            window.pause(0.3)
            window.send("mousemove_relative", "--", 20, 0)

        window.after(drag, "half of the picture", lambda frame: frame["width"] == 240)
        window.after(lambda: None, "all of it again, at rest", lambda frame: frame["width"] == 480)
        window.send("mouseup", 1)
        window.poll()
        since = len(window.frames)
        window.click("divider")
        assert all(frame["width"] == 480 for frame in window.frames[since:]), "a click moves nothing"


def test_light_is_saved_as_a_scene(program, folder):
    with Window(program, folder, ["cubes", *TALL, "--right", "none"]) as window:
        first = window.picture("left.visibility")
        window.click("azimuth", 0.2)
        window.click("light.save", 0.5)
        scene = Path(window.wait_event("saved scene") + ".toml")
    with Window(program, folder, [str(scene), *TALL, "--right", "none"]) as window:
        assert window.last()["scene"] == scene.stem
        assert window.picture("left.visibility") != first, "another light"
        experiment = Path(window.save("ctrl+e", "experiment") + ".toml").read_text()
        assert "scene = 'cubes-" in experiment and "id = 'none'" in experiment, experiment


def test_saved_picture_has_captions_and_says_what_its_colours_mean(program, folder):
    with Window(program, folder, ["cubes", *FIXED, "--left", "none", "--right", "vsm"]) as window:
        window.wait("errors", lambda frame: "right.rmse" in frame, 60.0)

        def read_codes(place):
            picture = window.save("ctrl+p", "picture") + ".png"
            subprocess.run(["oiiotool", picture, "--cut", place, "-o", str(folder / "cut.ppm")], check=True)
            return (folder / "cut.ppm").read_bytes().split(b"255\n", 1)[1]

        for place in ("70x10+6+8", "70x10+404+8"):
            codes = read_codes(place)
            assert min(codes) < 60 and max(codes) > 220, f"no text on a dark ground at {place}"
        window.send("key", "3")
        window.key("Next")
        window.key("Next")
        window.wait("the layer", lambda frame: frame["layer"] == "error")
        codes = read_codes("300x1+7+40")
    pixels = [tuple(codes[i:i + 3]) for i in range(0, len(codes), 3)]
    bar = [i for i, (red, green, blue) in enumerate(pixels) if abs(red - blue) > 60]
    assert len(bar) > 40 and bar[-1] - bar[0] < 100, f"a bar of colours: {pixels}"
    first, last = pixels[bar[0]], pixels[bar[-1]]
    assert first[2] > first[0] and last[0] > last[2], f"blue is darker, red lighter: {first} to {last}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    missing = [tool for tool in ("Xvfb", "xdotool", "oiiotool") if shutil.which(tool) is None]
    if missing:
        print(f"SKIPPED: {', '.join(missing)} is not installed")
        return 77
    display = Display()
    failed = []
    tests = [(name[5:], test) for name, test in globals().items() if name.startswith("test_") and arguments.only in name]
    for name, test in tests:
        with tempfile.TemporaryDirectory() as folder:
            begun = time.monotonic()
            try:
                note = test(program, Path(folder))
                print(f"ok      {name} ({time.monotonic() - begun:.1f} s){': ' + note if note else ''}", flush=True)
            except (AssertionError, subprocess.SubprocessError, StopIteration) as error:
                failed.append(name)
                print(f"FAILED  {name}: {error!r}", flush=True)
    display.close()
    print(f"{len(tests) - len(failed)} of {len(tests)} passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
