#!/usr/bin/env python3
"""Runs the commands of every README.md as they are printed there, and checks what else a README names.

    python3 tests/readme/run.py --program build/tests/shadowbench [--only filters/README.md]

Every README has a scratch folder of its own, in which its commands run in the order in which they are printed:
- A fenced block marked `sh` holds commands. The `run:` lines of a `yaml` block (a build server's job) are commands too.
- A fenced block whose first line names a file, as in ```glsl mine.glsl, is written to that file when its turn comes.
- Files that commands need and no README shows are in FIXTURES; COPIES are folders of this tree, copied, so that no
  command can change the tree itself.
- `shadowbench` is started with the words of the README, all of them. So that the test takes minutes, the options in
  CHEAPER are appended where the command does not have them itself; nothing else is changed.
- A command must end with exit code 0. A comment behind it may say otherwise: `# exit code 1` wants 1, and
  `# exit code 1 where ...` (or `if ...`) takes 0 or 1.
- Commands in NOT_RUN have to do with other programs, or with the build, and are let pass; presets, scripts and
  options of `harness/setup.sh` that they name must be there.

Of the text around the commands it is checked that every relative link leads somewhere, with its heading; that every
path of this tree in `code` exists; that every `--option` in `code` is one of the program's (or in OTHER_OPTIONS);
that commands of the program stand in blocks marked `sh`; and that lines and the first README are not too long.
CONTRIBUTING.md is treated as a README. Nothing but Python's standard library is used.
"""

import argparse
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRESETS = (ROOT / "CMakePresets.json").read_text(encoding="utf-8")
SETUP = (ROOT / "harness/setup.sh").read_text(encoding="utf-8")

# What is appended to a command that does not say it itself: (option, value).
CHEAPER = {
    "run": [("--size", "96x54"), ("--map-size", "128"), ("--rounds", "6"), ("--scene", "cubes"), ("--filters", "none,vsm"),
            ("--gpu", "none")],
    "bias": [("--size", "96x54"), ("--map-size", "128"), ("--filters", "none")],
    "stress": [("--axes", "vsm-cancellation")],
    "view": [("--size", "96x54"), ("--close-after", "0.5")],
    "tune": [("--size", "96x54"), ("--map-size", "128"), ("--scene", "cubes"), ("--budget", "3")],
}
# An experiment's own tables of filters are what its README shows: they are not overridden.
KEPT_BY_EXPERIMENT_FILES = {"--filters"}

# Files that commands name and no README shows: name in the scratch folder, and what of this tree it is.
FIXTURES = {"model.gltf": "tests/fuzz/corpus/gltf/tree.gltf"}

# Folders of this tree that commands may name; every README gets copies of its own.
COPIES = ["data/scenes", "data/experiments", "filters", "tests/golden"]

# Programs of others, and what this test cannot have: packages, a network, a screen, other build folders.
NOT_RUN = {"apt-get", "cd", "clang-format", "cmake", "cpack", "ctest", "curl", "dpkg", "gh", "git", "harness/setup.sh", "harness/slurm.sh", "man",
           "npm", "parallel", "python3", "sudo", "source", "tests/run.sh", "xdg-open", "xvfb-run"}
# Harmless programs that are really run, in the scratch folder.
RUN_AS_THEY_ARE = {"cp", "mkdir"}

# Options of other programs that texts name.
OTHER_OPTIONS = {"--gtest_filter", "--preset", "--config", "--prefix", "--exclusive", "--sshlogin", "--use-angle"}
# Paths that appear only when something is built or run.
GENERATED = ("build/", "report/out")

MOST_LINES_OF_FIRST_README = 100
MOST_COLUMNS = 120
SECONDS_PER_COMMAND = 300

FENCE = re.compile(r"^ {0,3}```(.*)$")
INLINE_CODE = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
EXIT_CODE = re.compile(r"exit code (\d+)( where| if)?")
COMMENT = re.compile(r"(?:^|\s)#\s*(.*)$")


class Block:
    """One fenced block: its language, the file it shows (or None), and its lines with their numbers in the README."""

    def __init__(self, info, line):
        self.language, self.file, *_ = [*info.split(), "", ""]
        self.line, self.lines = line, []


class Page:
    """One README, taken apart into its blocks and its text."""

    def __init__(self, path):
        self.path = path
        self.name = path.relative_to(ROOT).as_posix()
        self.lines = path.read_text(encoding="utf-8").split("\n")
        self.blocks = []
        self.text = []  # (number, line) outside of blocks
        block = None
        for number, line in enumerate(self.lines, 1):
            fence = FENCE.match(line)
            if fence and block is None:
                block = Block(fence.group(1), number)
            elif fence:
                self.blocks.append(block)
                block = None
            elif block is not None:
                block.lines.append((number, line))
            else:
                self.text.append((number, line))
        self.unclosed = block.line if block else None

    def anchors(self):
        """The names that a link's '#...' may have: headings in lower case, blanks as '-', other signs left out."""
        headings = [line.lstrip("#").strip() for _, line in self.text if re.match(r"#{1,6} ", line)]
        return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Report:
    """Collects what is wrong; every finding has a file and a line."""

    def __init__(self):
        self.findings = 0
        self.commands = 0

    def fail(self, page, line, message, output=""):
        self.findings += 1
        print(f"{page.name}:{line}: {message}", flush=True)
        for text in output.strip().split("\n")[-40:] if output.strip() else []:
            print(f"    {text}", flush=True)


def find_pages():
    """All READMEs of the tree, and CONTRIBUTING.md; not what was built or written by runs."""
    pages = [ROOT / "CONTRIBUTING.md"]
    for folder, folders, files in os.walk(ROOT):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in ("build", "out", "node_modules"))
        pages += [Path(folder) / "README.md"] if "README.md" in files else []
    return [Page(path) for path in sorted(pages)]


def join_lines(lines):
    """Joins lines that end in a backslash with the next; gives (number, text)."""
    joined, start = "", None
    for number, line in lines:
        start = start or number
        if line.endswith("\\"):
            joined += line[:-1] + " "
            continue
        yield start, joined + line
        joined, start = "", None


def list_commands(block):
    """Gives the command lines of a block as (number, text, comment)."""
    lines = list(join_lines(block.lines))
    if block.language == "yaml":
        runs = ((number, re.match(r"\s*-?\s*run: (.*)$", line)) for number, line in lines)
        lines = [(number, run.group(1)) for number, run in runs if run]
    elif block.language != "sh":
        return
    for number, line in lines:
        comment = COMMENT.search(line)
        text = line[: comment.start()].strip() if comment else line.strip()
        if text:
            yield number, text, comment.group(1) if comment else ""


def wanted_codes(comment):
    found = EXIT_CODE.search(comment)
    if not found:
        return {0}
    code = int(found.group(1))
    return {0, code} if found.group(2) else {code}


def append_cheaper(words):
    """Appends to a command of the program what CHEAPER has for it, and what it does not have itself."""
    if any(word in ("--help", "--list") for word in words):
        return words
    is_file = len(words) > 2 and words[2].endswith(".toml")
    result = list(words)
    for option, value in CHEAPER.get(words[1] if len(words) > 1 else "", []):
        given = any(word == option or word.startswith(option + "=") for word in words)
        if not given and not (is_file and option in KEPT_BY_EXPERIMENT_FILES):
            result += [option, value]
    return result


class Runner:
    """Runs the commands of one page in its scratch folder."""

    def __init__(self, page, options, scratch, report):
        self.page, self.options, self.report = page, options, report
        self.folder = scratch / page.name.replace("/", "_")
        self.environment = dict(os.environ, XDG_CACHE_HOME=str(scratch / "cache"), HOME=str(scratch))

    def run(self):
        self.folder.mkdir()
        for name, source in FIXTURES.items():
            shutil.copy(ROOT / source, self.folder / name)
        for folder in COPIES:
            shutil.copytree(ROOT / folder, self.folder / folder)
        for block in self.page.blocks:
            if block.file:
                path = self.folder / block.file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text("\n".join(line for _, line in block.lines) + "\n", encoding="utf-8")
            for number, text, comment in list_commands(block):
                self.run_line(number, text, comment)

    def run_line(self, number, text, comment):
        *first, last = [shlex.split(command) for command in text.split("&&")]
        if all(self.run_command(number, words, {0}) for words in first):
            self.run_command(number, last, wanted_codes(comment))

    def run_command(self, number, words, wanted):
        """Says whether the command did what it should; else that is reported."""
        if words[0] in NOT_RUN:
            unknown = [word for word, after in zip(words[1:], words) if after == "--preset" and f'"{word}"' not in PRESETS]
            unknown += [word for word in words[1:] if words[0] == "harness/setup.sh" and f" {word})" not in SETUP]
            unknown += [word for word in words[1:2] if words[0] == "python3" and not (ROOT / word).is_file()]
            if unknown:
                self.report.fail(self.page, number, f"there is no {unknown[0]} for {words[0]}")
            return not unknown
        if Path(words[0]).name == "shadowbench":
            command = [str(self.options.program)] + append_cheaper(words)[1:]
        elif words[0] in RUN_AS_THEY_ARE and not any(word.startswith("/") or ".." in word for word in words):
            command = words
        else:
            self.report.fail(self.page, number, f"'{words[0]}' is a command that tests/readme/run.py has no rule for")
            return False
        return self.start(number, command, wanted)

    def start(self, number, command, wanted):
        try:
            done = subprocess.run(command, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, text=True,
                                  errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  timeout=SECONDS_PER_COMMAND, check=False)
            code, output = done.returncode, done.stdout
        except subprocess.TimeoutExpired as expired:
            code, output = "none in time", str(expired.output or "")
        self.report.commands += 1
        if code in wanted:
            return True
        expected = " or ".join(str(each) for each in sorted(wanted))
        self.report.fail(self.page, number, f"exit code {code}, not {expected}: {shlex.join(command)}", output)
        return False


class Help:
    """The help texts of the program and of its commands."""

    def __init__(self, program):
        self.program = program
        first = self.ask([])
        self.commands = re.findall(r"^  ([a-z]+) {2,}\S", first, re.MULTILINE)
        self.text = first + "".join(self.ask([command]) for command in self.commands)
        self.text += "".join(self.ask(["list", each]) for each in ("filters", "scenes", "metrics", "gl"))

    def ask(self, words):
        return subprocess.run([str(self.program), *words, "--help-all"], text=True, capture_output=True, check=False).stdout

    def has_option(self, option):
        return re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", self.text) is not None


def check_lengths(page, report):
    for number, line in enumerate(page.lines, 1):
        if len(line) > MOST_COLUMNS and not line.startswith("|"):  # a row of a table cannot be broken
            report.fail(page, number, f"{len(line)} columns; {MOST_COLUMNS} are the most")
    if page.name == "README.md" and len(page.lines) - 1 > MOST_LINES_OF_FIRST_README:
        report.fail(page, len(page.lines), f"{len(page.lines) - 1} lines; {MOST_LINES_OF_FIRST_README} are the most")
    if page.unclosed:
        report.fail(page, page.unclosed, "this block is never closed")


def check_links(page, report):
    for number, line in page.text:
        for target in LINK.findall(INLINE_CODE.sub("", line)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = page.path if not name else page.path.parent / name
            if not path.exists():
                report.fail(page, number, f"the link leads nowhere: {target}")
            elif anchor and anchor not in Page(path.resolve()).anchors():
                report.fail(page, number, f"no such heading: {target}")


def is_path(code):
    return re.fullmatch(r"[\w.*-]+(/[\w.*-]+)*/?", code) is not None and "/" in code and not code[0].isdigit()


def check_inline_code(page, help_text, report):
    for number, line in page.text:
        for code in INLINE_CODE.findall(line):
            option = re.match(r"--[a-z][a-z_-]*", code)
            if option and option.group(0) not in OTHER_OPTIONS and not help_text.has_option(option.group(0)):
                if option.group(0) not in (ROOT / "harness/setup.sh").read_text(encoding="utf-8"):
                    report.fail(page, number, f"the program has no option {option.group(0)}")
            command = re.match(r"shadowbench ([a-z]+)( .*)?$", code)
            if command and command.group(1) not in help_text.commands:
                report.fail(page, number, f"the program has no command '{command.group(1)}'")
            if command and command.group(2) and "--" in command.group(2):
                report.fail(page, number, f"a command belongs in a block marked sh: {code}")
            if is_path(code) and (ROOT / code.split("/")[0]).exists() and not code.startswith(GENERATED):
                if not glob.glob(str(ROOT / code)) and not glob.glob(str(page.path.parent / code)):
                    report.fail(page, number, f"there is no {code}")


def check_blocks(page, report):
    for block in page.blocks:
        for number, line in block.lines:
            if block.language not in ("sh", "yaml") and re.match(r"\s*(\$ )?(\S*/)?shadowbench [a-z]", line):
                report.fail(page, number, "a command belongs in a block marked sh")


def check_pages(options, scratch, report):
    help_text = Help(options.program)
    pages = [page for page in find_pages() if options.only in (None, page.name)]
    for page in pages:
        check_lengths(page, report)
        check_links(page, report)
        check_inline_code(page, help_text, report)
        check_blocks(page, report)
        if any(True for block in page.blocks for _ in list_commands(block)):
            Runner(page, options, scratch, report).run()
    return len(pages)


def main():
    parser = argparse.ArgumentParser(description="Runs the commands of every README.md.")
    parser.add_argument("--program", required=True, type=lambda name: Path(name).resolve(), help="the built shadowbench")
    parser.add_argument("--only", help="this README alone, by its path from the root")
    options = parser.parse_args()
    report = Report()
    with tempfile.TemporaryDirectory(prefix="readme-") as scratch:
        pages = check_pages(options, Path(scratch), report)
    if pages == 0:
        print(f"there is no README at {options.only}")
        return 2
    print(f"{pages} pages, {report.commands} commands run, {report.findings} findings")
    return 1 if report.findings else 0


if __name__ == "__main__":
    sys.exit(main())
