#!/usr/bin/env python3
"""Breaks the GLSL of every filter, one thing at a time, and requires that a test goes red for each.

Works on copies: the test programs read filters below SHADOWBENCH_ROOT, which is a temporary folder here. Prints a table of
mutants with the test that caught each first; one that does not compile is the compiler's, and proves nothing of a test. Exit code 1
where a mutant survives or hangs, where a filter can be broken in fewer than three ways that compile, or where tests are red without
a mutant.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True  # the checkout stays as it was
from operators import OPERATORS, Mutant, make_mutants  # noqa: E402

FEWEST_MUTANTS = 3
FEWEST_OPERATORS = 3
MUTANT_LIMIT_S = 120
ALL_LIMIT_S = 600
RENDER, GOLDEN = "harness_render_gl_test", "golden_test"
COMPILER = "the compiler"


@dataclass(frozen=True)
class Stage:
    """Tests of one program; `{id}` in the patterns is the filter's."""

    name: str
    program: str
    patterns: tuple


# Cheap ones first: a mutant is dead with the first red test.
STAGES = (
    Stage("contract", RENDER, ("*Contract.*/{id}", "*LinearKernel.*/{id}", "*Blocker.*/{id}")),
    Stage("model", RENDER, ("*ModelAgreement.*_{id}", "*ModelVariants.*/{id}_*", "*ReceiverPlaneModel.*_{id}")),
    Stage("goldens", GOLDEN, ("*/{id}", "*_{id}", "*_{id}_*")),
    Stage("outside", RENDER, ("*MapRange.*/{id}",)),
)


@dataclass
class Verdict:
    filter: str
    line: int  # of the file
    mutant: Mutant
    caught_by: str = ""  # empty: survived
    fault: str = ""  # why what happened proves nothing
    seconds: float = 0.0


@dataclass
class Outcome:
    red: str  # first red test; empty where all are green
    output: str
    tests: int


class Tests:
    """The test programs, run over a folder of filters."""

    def __init__(self, programs, source):
        self.programs = programs
        self.source = source

    def make_root(self, folder, replaced):
        """Lays the program's folders out with copies of the filters, of which some are replaced."""
        for name in ("shaders", "data"):
            (folder / name).symlink_to(self.source / name)
        (folder / "filters").mkdir()
        for path in sorted((self.source / "filters").glob("*.glsl")):
            (folder / "filters" / path.name).write_text(replaced.get(path.stem, path.read_text()))
        return folder

    def run(self, stage, ids, root, limit_s):
        patterns = ":".join(p.format(id=each) for each in ids for p in stage.patterns)
        command = [self.programs / stage.program, f"--gtest_filter={patterns}", "--gtest_fail_fast"]
        environment = dict(os.environ, SHADOWBENCH_ROOT=str(root))
        done = subprocess.run(command, env=environment, text=True, errors="replace", timeout=limit_s,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        red = re.search(r"^\[  FAILED  \] (\S+?),? ", done.stdout, re.M)
        count = re.search(r"^\[==========\] Running (\d+) test", done.stdout, re.M)
        ended = red.group(1) if red else f"{stage.program} ended with {done.returncode}" if done.returncode else ""
        return Outcome(ended, done.stdout, int(count.group(1)) if count else 0)


def read_filter(path):
    """Gives the front matter of a filter's file, with its end, and the GLSL that follows."""
    text = path.read_text()
    end = text.index("+++*/") + len("+++*/")
    return text[:end], text[end:]


def judge(tests, verdict, front_matter):
    """Runs one mutant through the stages until a test goes red."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="shadowbench-mutant-") as folder:
        root = tests.make_root(Path(folder), {verdict.filter: front_matter + verdict.mutant.body})
        for stage in STAGES:
            try:
                outcome = tests.run(stage, [verdict.filter], root, MUTANT_LIMIT_S)
            except subprocess.TimeoutExpired:
                verdict.fault = f"no answer from {stage.name} in {MUTANT_LIMIT_S} s"
                break
            if "does not compile" in outcome.output:
                verdict.caught_by = COMPILER
                break
            if outcome.red:
                verdict.caught_by = outcome.red
                break
    verdict.seconds = time.monotonic() - begun
    return verdict


def cut_out(output, red):
    """Gives what one test printed."""
    begin = output.find(f"[ RUN      ] {red}")
    end = output.find(f"[  FAILED  ] {red}", begin)
    return output[begin:end] if 0 <= begin < end else output[-2000:]


def require_green(tests, ids):
    """Gives what is wrong with the tests themselves: red ones without a mutant, or none for a filter."""
    faults = []
    with tempfile.TemporaryDirectory(prefix="shadowbench-mutant-") as folder:
        root = tests.make_root(Path(folder), {})
        for stage in STAGES:
            outcome = tests.run(stage, ids, root, ALL_LIMIT_S)
            print(f"{stage.name}: {outcome.tests} tests without a mutant, {outcome.red or 'all green'}", flush=True)
            if outcome.red:
                faults.append(f"{outcome.red} is red without a mutant:\n{cut_out(outcome.output, outcome.red)}")
            if not outcome.tests:
                faults.append(f"no test of {stage.program} matches {stage.patterns}")
    return faults


def print_table(verdicts):
    rows = [("filter", "line", "broken", "before", "after", "caught first by", "s")]
    for v in verdicts:
        rows.append((v.filter, str(v.line), v.mutant.operator, v.mutant.before, v.mutant.after,
                     v.fault or v.caught_by or "SURVIVED", f"{v.seconds:.1f}"))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())


def list_uncaught(verdicts):
    return [f"{v.filter}.glsl:{v.line}: {v.mutant.operator}: '{v.mutant.after}': {v.fault or 'no test went red'}"
            for v in verdicts if v.fault or not v.caught_by]


def list_unbroken(verdicts, ids):
    """Gives the filters that the operators hardly touch."""
    faults = []
    for name in ids:
        operators = [v.mutant.operator for v in verdicts if v.filter == name and v.caught_by != COMPILER]
        if len(operators) < FEWEST_MUTANTS or len(set(operators)) < FEWEST_OPERATORS:
            faults.append(f"{name}.glsl: {len(operators)} mutants of {len(set(operators))} kinds; at least {FEWEST_MUTANTS} "
                          f"of {FEWEST_OPERATORS} are asked for: add an operator to operators.py")
    return faults


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=Path, required=True, help="folder of the test programs")
    parser.add_argument("--source", type=Path, default=Path(__file__).resolve().parents[2], help="checkout of the project")
    parser.add_argument("--filter", action="append", help="id of a filter to break; all by default")
    parser.add_argument("--operator", action="append", choices=OPERATORS, help="ways to break it; all by default")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    return parser.parse_args()


def judge_all(tests, files, ids, arguments):
    planned = [Verdict(each, files[each][0].count("\n") + m.line, m) for each in ids for m in make_mutants(files[each][1])]
    planned = [v for v in planned if not arguments.operator or v.mutant.operator in arguments.operator]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        return list(pool.map(lambda v: judge(tests, v, files[v.filter][0]), planned))


def main():
    arguments = parse_arguments()
    begun = time.monotonic()
    tests = Tests(arguments.programs.resolve(), arguments.source.resolve())
    files = {path.stem: read_filter(path) for path in sorted((tests.source / "filters").glob("*.glsl"))}
    ids = arguments.filter or list(files)
    faults = [f"there is no filter '{each}'" for each in ids if each not in files] or require_green(tests, ids)
    verdicts = []
    if not faults:
        verdicts = judge_all(tests, files, ids, arguments)
        print_table(verdicts)
        faults = list_uncaught(verdicts) + ([] if arguments.operator else list_unbroken(verdicts, ids))
    caught = sum(1 for v in verdicts if v.caught_by and not v.fault)
    print(f"\n{caught} of {len(verdicts)} mutants caught, {time.monotonic() - begun:.0f} s")
    for fault in faults:
        print(f"error: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
