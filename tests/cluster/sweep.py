"""A sweep that `shadowbench submit` distributes, and what its folder says."""

import json
import os
import re
import subprocess
import time

EXPERIMENT = """title = 'small'
scene = ['cubes', 'stack']
map_size = [32, 64]
size = '160x90'
phases = 1
rounds = 4
attribution = false
[[filter]]
id = 'none'
[[filter]]
id = 'vsm'
radius = [1, 2]
[[filter]]
id = 'esm'
"""
FILE = "an experiment.toml"
WORDS = [FILE, "--gl", "software", "--gpu", "none"]
LONG = ["--map-size", "32,40,48,64,80,96"]  # long enough to be stopped in the middle

# What two runs of one experiment need not share: the times, the load and the work that was done.
OF_ONE_CELL = {"time_ms", "ratio_to_none", "measured_s", "lights"}
OF_ONE_RUN = {"command", "work", "repeat", "filter_files"}  # a sweep forgets paths: its parts may have run elsewhere


def leave_out(record, names):
    return {name: value for name, value in record.items() if name not in names}


def read_report(folder):
    """A report without what differs from run to run: of the whole, and of each cell in their order."""
    whole = json.loads((folder / "results.json").read_text())
    cells = [leave_out(cell, OF_ONE_CELL) for cell in whole.pop("cells")]
    whole["machine"] = leave_out(whole["machine"], {"load_at_start"})
    return leave_out(whole, OF_ONE_RUN), cells


def expect_same_report(first, second):
    """Holds two report folders to be the same in everything but times, load and work done, their images included."""
    (one, cells), (other, other_cells) = read_report(first), read_report(second)
    for name in one.keys() | other.keys():
        assert one.get(name) == other.get(name), f"{name}: {one.get(name)} and {other.get(name)}"
    assert [cell["key"] for cell in cells] == [cell["key"] for cell in other_cells], "the same cells in the same order"
    for cell, other_cell in zip(cells, other_cells):
        for each in (cell, other_cell):
            each["images"].pop("frames", None)  # a file of frames is named for the cells that were drawn together
            for name in ("supersampled", "truth_supersampled", "samples"):
                each["images"].pop(name, None)  # of what a page shows first, which depends on all of its cells' times
        for name in cell.keys() | other_cell.keys():
            assert cell.get(name) == other_cell.get(name), f"{name} of {cell['key']}: {cell.get(name)} and {other_cell.get(name)}"
    images = [sorted(path.relative_to(folder) for path in (folder / "images").iterdir() if ".supersampled." not in path.name)
              for folder in (first, second)]
    assert images[0] == images[1], set(images[0]) ^ set(images[1])
    for image in images[0]:
        assert (first / image).read_bytes() == (second / image).read_bytes(), image


class Sweep:
    """An experiment in `folder` which is submitted into `folder`/out."""

    def __init__(self, program, cluster, folder, words=(), tasks=2):
        self.program, self.cluster, self.folder, self.out = program, cluster, folder, folder / "out"
        self.words = [*WORDS, *map(str, words)]
        self.options = ["--engine", "slurm", "--tasks", tasks]
        self.environment = dict(cluster.environment, XDG_CACHE_HOME=str(folder / "cache"))
        (folder / FILE).write_text(EXPERIMENT)

    def run(self, *words, code=0, **options):
        """The program, in the folder of the experiment; it is to end with `code`."""
        options.setdefault("env", self.environment)
        done = self.cluster.run(self.program, *words, check=False, cwd=self.folder, timeout=120, **options)
        assert done.returncode == code, f"{words} ended with {done.returncode}, not {code}: {done.stderr}{done.stdout}"
        return done

    def submit(self, *more, **options):
        return self.run("submit", *self.words, *self.options, "--out", "out", *more, **options)

    def refuse(self, words, code, *said):
        """One clear message, which says all of `said`, and the exit code."""
        done = self.run(*words, code=code)
        messages = [line for line in done.stderr.splitlines() if line.startswith("shadowbench: ")]
        assert len(messages) == 1, done.stderr
        for part in said:
            assert part in done.stderr, (part, done.stderr)

    def edit_jobs(self, pattern, replacement):
        """Changes what the sweep says of its jobs."""
        file = self.out / "tasks.json"
        text, changes = re.subn(pattern, replacement, file.read_text())
        assert changes, f"no {pattern} in {text}"
        file.write_text(text)

    def start_task(self, number, environment=None):
        """Starts a task by hand, as its job would."""
        folder = self.out / "tasks" / str(number)
        words = [self.program, "run", *self.words, "--no-grids", "--cache", self.out / "cache", "--out", self.out, "--task", folder]
        with (folder / "log.txt").open("a") as log:
            return subprocess.Popen(words, cwd=self.folder, env=environment or self.environment, stdout=log, stderr=log)

    def read_status(self, *more, env=None):
        """What `status` says; its exit code says whether something failed or was lost."""
        done = self.cluster.run(self.program, "status", "out", "--json", *more, check=False, cwd=self.folder, env=env or self.environment)
        status = json.loads(done.stdout)
        states = {task["state"] for task in status["truths"] + status["tasks"]}
        assert done.returncode == (1 if states & {"failed", "lost"} else 0), done
        return status

    def read_states(self, *more, env=None):
        """The states of the tasks that measure, in their order."""
        return [task["state"] for task in self.read_status(*more, env=env)["tasks"]]

    def expect_stopped_midway(self):
        """The cells that are finished by now; some are, and some are not."""
        cells = self.read_cells()
        assert 0 < len(cells) < self.read_status()["cells"], f"{len(cells)} cells"
        return cells

    def expect_finished(self):
        """All is measured, the report is written, and no temporary file stays."""
        status = self.read_status()
        assert status["report"] and status["measured"] == status["cells"], status
        assert {task["state"] for task in status["tasks"]} == {"finished"}, status
        assert not self.list_leftovers(), self.list_leftovers()

    def expect_same_as_one_run(self):
        """The report is that of `run` without grids, which is kept for the next who asks."""
        whole = self.folder.parent / "one_run" / " ".join(self.words).replace("/", "_")
        if not whole.exists():
            self.run("run", *self.words, "--no-grids", "--no-cache", "--out", whole)
        self.expect_finished()
        expect_same_report(whole, self.out)

    def read_cells(self):
        """{file: its content and the time at which it was written} of all finished cells."""
        return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in self.list_cells()}

    def list_cells(self):
        folder = self.out / "cells"
        return [path for path in folder.glob("*.json") if len(path.stem) == 16]  # not those that are being written

    def wait_for_cells(self, count, seconds=60):
        end = time.monotonic() + seconds
        while len(self.list_cells()) < count:
            assert time.monotonic() < end, f"fewer than {count} cells within {seconds} s: {self.read_log()}"
            time.sleep(0.01)

    def expect_kept(self, cells):
        now = self.read_cells()
        for name, cell in cells.items():
            assert now[name] == cell, f"{name} was measured again"

    def wait(self, seconds=90):
        """Until no job is left."""
        self.cluster.wait_until_empty(seconds)

    def read_log(self):
        logs = [*sorted(self.out.glob("t*/*/log.txt")), *self.out.glob("*.log")]
        return "\n".join(f"{path.relative_to(self.out)}:\n{path.read_text()[-1500:]}" for path in logs)

    def list_leftovers(self):
        """Temporary files, of which none is to stay."""
        return [str(path) for path in self.out.rglob("*") if ".shadowbench-tmp-" in path.name or path.name.startswith((".worker-", ".gpu-"))]


def make_older(path, seconds):
    then = time.time() - seconds
    os.utime(path, (then, then))
