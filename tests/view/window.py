"""Drives `shadowbench view` with real key and mouse events (xdotool), and reads what it says in its log."""

import atexit
import json
import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "exr"))
from recompute import ExrFile  # noqa: E402


class Window:
    """A running window. Call it inside an X display of its own; see run.py."""

    def __init__(self, program, folder, arguments, more_environment=None):
        self.log = folder / "view.log"
        self.log.unlink(missing_ok=True)
        self.errors = folder / "stderr.txt"
        self.widgets, self.frames, self.events, self.read = {}, [], [], 0
        command = [str(program), "view", *arguments, "--out", str(folder / "saved"), "--log", str(self.log)]
        # A cache of its own, or a truth that an earlier test traced would be there at once.
        environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"), **(more_environment or {}))
        self.folder = folder
        self.process = subprocess.Popen(command, env=environment, stdout=self.errors.open("w"), stderr=subprocess.STDOUT)
        atexit.register(self.process.kill)  # where no first frame comes
        self.wait("the first frame", lambda frame: True, 60.0)
        # Nobody else on this display gives a window the keyboard.
        self.send("search", "--sync", "--name", "^shadowbench: ", "windowfocus", "--sync")
        self.pause(0.3)

    def poll(self):
        if not self.log.exists():
            return
        with self.log.open() as file:
            file.seek(self.read)
            for line in file:
                if not line.endswith("\n"):
                    break
                self.read += len(line.encode())
                entry = json.loads(line)
                (self.frames if entry["event"] == "frame" else self.events).append(entry)
                self.widgets.update(entry.get("widgets", {}))

    def wait(self, what, holds, seconds=10.0, since=0):
        """The first frame from the `since`-th on for which `holds` is true."""
        end = time.monotonic() + seconds
        while True:
            self.poll()
            for frame in self.frames[since:]:
                if holds(frame):
                    return frame
            if self.process.poll() is not None:
                raise AssertionError(f"the window is gone ({self.process.returncode}) before {what}: {self.errors.read_text()}")
            if time.monotonic() > end:
                raise AssertionError(f"no {what} within {seconds} s; the last frame: {self.frames[-1:]}")
            time.sleep(0.01)

    def wait_event(self, what, seconds=20.0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.poll()
            for event in self.events:
                if event["event"] == what:
                    self.events.remove(event)
                    return event["what"]
            time.sleep(0.02)
        raise AssertionError(f"no '{what}' within {seconds} s; the last frame: {self.frames[-1:]}")

    def pause(self, seconds):
        time.sleep(seconds)
        self.poll()

    def after(self, act, what, holds=lambda frame: frame["drawn"]):
        """Acts, and waits for the first frame since for which `holds` is true."""
        self.poll()
        since = len(self.frames)
        act()
        return self.wait(what, holds, since=since)

    @staticmethod
    def send(*words):
        subprocess.run(["xdotool", *map(str, words)], check=True)

    @staticmethod
    def geometry():
        """Width and height in pixels."""
        told = subprocess.run(["xdotool", "search", "--name", "^shadowbench: ", "getwindowgeometry", "--shell"], check=True,
                              capture_output=True, text=True).stdout
        sizes = dict(line.split("=") for line in told.splitlines())
        return int(sizes["WIDTH"]), int(sizes["HEIGHT"])

    def key(self, name):
        self.send("key", name)

    def place(self, widget, x=0.5, y=0.5):
        """A place in a widget, in parts of its width and height."""
        left, top, right, bottom = self.widgets[widget]
        return round(left + x * (right - left)), round(top + y * (bottom - top))

    def move(self, x, y):
        self.send("mousemove", x, y)

    def click(self, widget, x=0.25):
        """Clicks on the left half of a widget: its label stands on the right."""
        self.move(*self.place(widget, x))
        self.pause(0.3)
        self.send("mousedown", 1)
        self.pause(0.15)
        self.send("mouseup", 1)
        self.pause(0.15)

    def drag(self, start, by, steps=6, button=1):
        self.move(*start)
        self.pause(0.3)
        self.send("mousedown", button)
        for _ in range(steps):
            self.pause(0.1)
            self.send("mousemove_relative", "--", round(by[0] / steps), round(by[1] / steps))
        self.pause(0.2)
        self.send("mouseup", button)
        self.pause(0.2)

    def choose(self, widget, choice):
        self.click(widget)
        name = f"{widget}={choice}"
        self.wait(name, lambda frame: name in self.widgets)
        self.pause(0.3)  # a list has its place from its second frame on
        self.click(name)

    def last(self):
        self.poll()
        return self.frames[-1]

    def save(self, key, what):
        self.key(key)
        return self.wait_event(f"saved {what}")

    def picture(self, part):
        """Saves a picture; gives width, height and first channel of one of its parts."""
        ((width, height, channels, values),) = ExrFile(Path(self.save("ctrl+p", "picture") + ".exr"), self.folder).unpack(part)
        return width, height, list(values)[::channels]

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind:
            self.process.kill()
            self.process.wait()
            return
        self.key("ctrl+q")
        code = self.process.wait(timeout=30)
        said = self.errors.read_text()
        assert code == 0 and not said, f"exit code {code}: {said}"


class Display:
    """An X server that nobody sees."""

    WIDTH, HEIGHT = 1700, 1000

    def __init__(self):
        reader, writer = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{self.WIDTH}x{self.HEIGHT}x24", "-nolisten", "tcp", "-noreset"],
                                       pass_fds=[writer], stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader) as file:
            os.environ["DISPLAY"] = ":" + file.readline().strip()

    def close(self):
        self.server.terminate()
        self.server.wait()
        del os.environ["DISPLAY"]
