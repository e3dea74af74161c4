#!/usr/bin/env python3
"""Computes what `advise` says again, from nothing but a run's results.json and the rules in report/README.md.

    python3 tests/advice/recompute.py --program build/tests/shadowbench --runs 200   # runs that are made up
    python3 tests/advice/recompute.py --program build/tests/shadowbench report/out   # reports of real runs
"""

import argparse
import itertools
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

# By the number of groups, at 97 %: see reference/README.md.
STUDENT_T = {2: 21.20495, 3: 5.64278, 4: 3.89605, 5: 3.29763, 6: 3.00287, 7: 2.82893, 8: 2.71457}
SCENES = ["cubes", "stack", "fence"]
LIMITS = {"--max-rmse": ("error", "rmse"), "--max-leak": ("artefact", "leak")}


def mean_reach(values):
    """Half the 95 % interval of a mean."""
    mean = sum(values) / len(values)
    variance = sum((value - mean) ** 2 for value in values) / (len(values) - 1)
    return STUDENT_T[len(values)] * math.sqrt(variance / len(values))


class Configuration:
    """A filter, a map and a fit, with a cell on each scene; `cost_of` reads a cost with its quartiles and interval."""

    def __init__(self, cells, cost_of):
        self.cells = cells
        self.id = identify(cells[0])
        count, costs = len(cells), [cost_of(cell) for cell in cells]
        self.cost = sum(cost["median"] for cost in costs) / count
        spread = lambda low, high: [self.cost + sign * math.sqrt(sum((end(cost) - cost["median"]) ** 2 for cost in costs)) / count
                                    for sign, end in ((-1, low), (1, high))]
        self.quartiles = spread(lambda cost: cost["q1"], lambda cost: cost["q3"])
        self.interval = spread(lambda cost: cost["ci95"][0], lambda cost: cost["ci95"][1])
        errors = [cell["error"] for cell in cells]
        if any(error["rmse"] is None for error in errors):
            return
        rms = lambda values: math.sqrt(sum(value ** 2 for value in values) / count)
        self.rmse = rms([error["rmse"] for error in errors])
        groups = [error.get("rmse_replicates") or [] for error in errors]
        self.groups = [rms(each) for each in zip(*groups)] if len({len(each) for each in groups}) == 1 else []
        halves = [error["rmse_ci95"][1] - error["rmse"] for error in errors]
        self.reach = mean_reach(self.groups) if len(self.groups) > 1 else math.sqrt(
            sum((error["rmse"] * half) ** 2 for error, half in zip(errors, halves))) / (count * self.rmse)

    def keeps(self, limits):
        """A scene with nothing to see of a fault breaks no limit on it; where no scene has a value, nobody can say."""
        for option, most in limits.items():
            values = [cell[LIMITS[option][0]][LIMITS[option][1]] for cell in self.cells]
            known = [value for value in values if value is not None]
            if not known or max(known) > most:
                return False
        return True

    def is_clearly_better(self, other):
        reach = max(self.reach, other.reach)
        if len(self.groups) == len(other.groups) > 1:
            reach = mean_reach([a - b for a, b in zip(self.groups, other.groups)])
        return other.rmse - self.rmse - reach > 0

    def is_clearly_cheaper(self, other, exact):
        """Intervals of one map and fit are of the same rounds; else the quartiles decide."""
        if exact:
            return self.cost < other.cost
        own, its = (self.interval, other.interval) if self.id[2:] == other.id[2:] else (self.quartiles, other.quartiles)
        return own[1] < its[0]


def identify(cell):
    """What makes cells one configuration on all scenes: a radius that each scene's light set counts as one."""
    by_light = cell.get("kernel", {}).get("by_light")
    params = {**cell["params"], **({by_light: "light"} if by_light else {})}
    return cell["filter"], json.dumps(params, sort_keys=True), cell["map_size"], cell["fit"]


def read_time(cell):
    return cell["time_ms"]["moving"]


def is_judged(cells, scenes, cost_of, needs_rmse):
    return {cell["scene"] for cell in cells} == scenes and all(
        cell["status"] == "ok" and cost_of(cell) and (cell["error"]["rmse"] is not None or not needs_rmse) for cell in cells)


def compute_picks(cells, cost_of, exact, limits):
    """The names of the picks, each with what identifies its configuration."""
    cells = [cell for cell in cells if not cell["teaching"]]
    scenes, needs_rmse = {cell["scene"] for cell in cells}, any(cell["error"]["rmse"] is not None for cell in cells)
    groups = {}
    for cell in cells:
        groups.setdefault(identify(cell), []).append(cell)
    judged = [Configuration(own, cost_of) for own in groups.values() if is_judged(own, scenes, cost_of, needs_rmse)]
    if not needs_rmse:
        kept = [] if "--max-rmse" in limits else [each for each in judged if each.keeps(limits)]
        return {"fast": min(kept, key=lambda each: each.cost).id} if kept else {}
    judged.sort(key=lambda each: (each.cost, each.rmse))
    unfiltered = next((each for each in judged if each.id[0] == "none"), None)
    kept = [each for each in judged if each.keeps(limits)]
    front = [each for i, each in enumerate(kept) if all(other.rmse > each.rmse for other in kept[:i])]
    if not limits and unfiltered:
        front = [each for each in front if each.is_clearly_better(unfiltered)] or front
    if not front:
        return {}
    fast, least = front[0], min(front, key=lambda each: each.rmse)
    best = next(each for each in front if not least.is_clearly_better(each))
    if best is fast:
        return {"fast and best" if len(kept) > 1 else "fast": fast.id}
    picks = {"fast": fast.id, "best": best.id}
    if fast.is_clearly_cheaper(best, exact):
        below = lambda each: 1 - (each.cost - fast.cost) / (best.cost - fast.cost) - (each.rmse - best.rmse) / (fast.rmse - best.rmse)
        between = [each for each in front[1:front.index(best)]
                   if below(each) > 0 and each.is_clearly_better(fast) and each.is_clearly_cheaper(best, exact)]
        if between:
            picks["balanced"] = max(between, key=below).id
    return picks


def make_up_cells(template, draws):
    """Cells of filters, maps, fits and scenes: some errors and costs equal, some values and cells absent."""
    filters, maps, fits, scenes = (draws.randint(1, most) for most in (6, 3, 2, 3))
    is_truthless = draws.random() < 0.05
    cells = []
    for name, size, fit in itertools.product(range(filters), range(maps), range(fits)):
        ms, rmse, noise = (1 + size) * draws.randint(1, 30), 0.002 * draws.randint(1, 40), 0.0005 * draws.randint(1, 4)
        for scene in range(scenes):
            cell = json.loads(json.dumps(template))
            cell.update(scene=SCENES[scene], filter=f"f{name}" if name else "none", map_size=512 << size, fit=["tight", "sphere"][fit])
            cell["key"] = f"{len(cells):016x}"
            groups = [max(1e-4, rmse * (1 + 0.1 * scene) + draws.gauss(0, noise)) for _ in range(4)]
            mean, reach = sum(groups) / 4, mean_reach(groups)
            cell["error"].update(rmse=mean, rmse_replicates=groups, rmse_ci95=[mean - reach, mean + reach])
            cell["artefact"]["leak"] = 0.01 * draws.randrange(20)
            cell["time_ms"]["moving"] = {"median": ms, "q1": 0.97 * ms, "q3": 1.04 * ms, "n": 9, "ci95": [0.99 * ms, 1.01 * ms]}
            if is_truthless or draws.random() < 0.02:
                cell["error"].update(rmse=None, rmse_replicates=None, rmse_ci95=None)
                cell["absent"]["error.rmse"] = "made up"
            if draws.random() < 0.02:
                cell["status"], cell["message"] = "timeout", "made up"
            if draws.random() > 0.02:
                cells.append(cell)
    return cells


def ask(program, folder, words):
    done = subprocess.run([program, "advise", str(folder), "--json", "--cheapest", "time", *words], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{folder} {words}: {done.stderr}")
    return {each["name"]: identify(each["settings"]) for each in json.loads(done.stdout)["picks"]}


def check(program, folder, draws, count):
    """How many of `count` questions about a report are answered otherwise than here."""
    cells = json.loads((folder / "results.json").read_text())["cells"]
    wrong = 0
    for i in range(count):
        limits = {option: round(draws.uniform(0.005, 0.15), 3) for option in LIMITS if i > 0 and draws.random() < 0.6}
        said = ask(program, folder, [word for option, most in limits.items() for word in (option, str(most))])
        made = compute_picks(cells, read_time, False, limits)
        if said != made:
            wrong += 1
            print(f"{folder}, limits {limits}: the program says {said}, the rules {made}")
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--runs", type=int, default=0)
    parser.add_argument("reports", nargs="*", type=Path)
    arguments = parser.parse_args()
    draws, asked, wrong = random.Random(53), 0, 0
    for folder in arguments.reports:
        asked, wrong = asked + 8, wrong + check(arguments.program, folder, draws, 8)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch) / "made_up"
        if arguments.runs:
            subprocess.run([arguments.program, "run", "--scene", "cubes", "--filters", "none", "--size", "64x36", "--map-size", "64",
                            "--rounds", "1", "--gpu", "none", "--no-grids", "--out", str(folder)], check=True, capture_output=True)
            run = json.loads((folder / "results.json").read_text())
            template = run["cells"][0]
        for _ in range(arguments.runs):
            run["cells"] = make_up_cells(template, draws)
            if not run["cells"]:
                continue
            (folder / "results.json").write_text(json.dumps(run))
            asked, wrong = asked + 2, wrong + check(arguments.program, folder, draws, 2)
    print(f"{asked - wrong} passed, {wrong} failed")
    sys.exit(wrong > 0 or asked == 0)


if __name__ == "__main__":
    main()
