#!/usr/bin/env python3
"""Runs jobs on a Slurm of two nodes, which it starts on this machine and ends again.

    python3 tests/cluster/run.py --program build/tests/shadowbench [--only NAME]

Needs root, slurm-wlm and munge; touches no Slurm that the machine may have. See slurm.py.
"""

import argparse
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from slurm import Cluster, end_descendants, read_processes, say_what_is_missing, send  # noqa: E402
from sweep import FILE, LONG, Sweep, make_older  # noqa: E402


FILTER = """/*+++
title = "Mine"
source = "none"
kind = "comparison"
+++*/
float visibility(Receiver r) { return compare_nearest(r, vec2(0.0), r.depth); }
"""


def find_faketime(shift):
    """What the environment must hold for a program whose clock is wrong; files keep their times. None: not installed."""
    libraries = sorted(Path("/usr/lib").glob("*/faketime/libfaketimeMT.so.1"))
    if not libraries:
        return None
    return {"LD_PRELOAD": str(libraries[0]), "FAKETIME": shift, "NO_FAKE_STAT": "1", "FAKE_UTIME": "1", "DONT_FAKE_MONOTONIC": "1"}


def hide_tools(folder):
    """A PATH with the shell's own tools, and without those of Slurm."""
    folder.mkdir()
    for tool in ("sh", "setsid", "env"):
        (folder / tool).symlink_to(shutil.which(tool))
    return str(folder)


def find_processes(word):
    """The processes whose command line holds a word."""
    found = []
    for process in read_processes():
        try:
            if str(word).encode() in Path(f"/proc/{process}/cmdline").read_bytes():
                found.append(process)
        except OSError:  # it ended meanwhile
            pass
    return found


def test_cluster_runs_an_array_and_what_depends_on_it(program, cluster, folder):
    submit = ["sbatch", "--parsable", f"--chdir={folder}"]
    array = cluster.run(*submit, "--array=1-4", "--output=%a.txt", "--wrap", "sleep 0.2; echo $SLURMD_NODENAME").stdout.strip()
    cluster.run(*submit, f"--dependency=afterok:{array}", "--output=all", "--wrap", "cat *.txt")
    cluster.wait_until_empty()
    assert set(cluster.read_jobs().values()) == {"COMPLETED"}, cluster.read_jobs()
    assert set((folder / "all").read_text().split()) == set(cluster.nodes), "both nodes work, and then the dependent job"


def test_sweep_equals_one_run(program, cluster, folder):
    odd = folder / "it's 5%j"  # no shell and no pattern of Slurm's may read this name
    odd.mkdir()
    sweep = Sweep(program, cluster, odd, ["--attribution", "--map-size", "64"], tasks=3)
    sweep.submit("--time", 5, "--partition", "all", "--gres", "gpu:1", "--", "--comment=for all of us")
    jobs = cluster.run("scontrol", "show", "job").stdout.replace("gres/gpu", "gres:gpu")  # as Slurm 24 writes it
    for said in ("Comment=for all of us", "TimeLimit=00:05:00", "Partition=all", "gres:gpu:1"):
        assert said in jobs, f"sbatch did not hear {said}: {jobs}"
    sweep.wait()
    sweep.expect_same_as_one_run()
    cells = sweep.read_cells()
    sweep.submit()
    sweep.wait()
    sweep.expect_kept(cells)


def test_dry_run_writes_and_prints_only(program, cluster, folder):
    before = cluster.read_jobs()
    sweep = Sweep(program, cluster, folder)
    done = sweep.submit("--dry-run", "--time", 5, "--", "--comment=x")
    for script in ("truth.sbatch", "submit.sbatch", "merge.sbatch"):
        assert (sweep.out / script).exists() and script in done.stdout, (script, done)
        cluster.run("sbatch", "--test-only", sweep.out / script)
    assert cluster.read_jobs() == before and not sweep.list_cells(), "nothing is submitted, nothing measured"
    assert sweep.read_states() == ["waiting", "waiting"], sweep.read_status()
    sweep.refuse(["merge", "out"], 1, "cells")


def test_node_that_dies_costs_no_cell(program, cluster, folder):
    sweep = Sweep(program, cluster, folder, LONG)
    sweep.submit()
    sweep.wait_for_cells(1)
    job, node = cluster.find_running()
    cluster.kill_node(node)
    cells = sweep.expect_stopped_midway()
    cluster.notice_failure(node)
    cluster.restart_node(node)
    sweep.wait()
    assert "Restarts=1" in cluster.run("scontrol", "show", "job", job).stdout, "the job was requeued"
    sweep.expect_same_as_one_run()
    sweep.expect_kept(cells)


def test_requeued_task_goes_on(program, cluster, folder):
    sweep = Sweep(program, cluster, folder, LONG, tasks=1)
    sweep.submit()
    sweep.wait_for_cells(1)
    job, _ = cluster.find_running()
    cluster.run("scontrol", "requeue", job)
    cluster.wait_for_job(job, "PENDING")
    cells = sweep.expect_stopped_midway()
    jobs = cluster.read_jobs()
    sweep.submit()
    assert cluster.read_jobs().keys() == jobs.keys(), "what waits in the queue is not submitted twice"
    sweep.wait()
    sweep.expect_same_as_one_run()
    sweep.expect_kept(cells)


def test_cancelled_sweep_is_continued(program, cluster, folder):
    sweep = Sweep(program, cluster, folder, [*LONG, "--rounds", 24], tasks=4)
    sweep.submit()
    sweep.wait_for_cells(26)  # two nodes, 12 cells a task: one is finished, and a third begun
    cluster.run("scancel", "--user=root")
    sweep.wait()
    states, cells = sweep.read_states(), sweep.expect_stopped_midway()
    # A process that was not yet there to say that it is stopped leaves what Slurm printed, as one that may yet begin.
    assert "finished" in states, states
    begun = {task["task"] for task in sweep.read_status("--silent-after", 0.001)["tasks"] if "ended without a word" in task["message"]}
    assert all(state in ("finished", "failed", "waiting") or number in begun for number, state in enumerate(states, 1)), states
    sweep.refuse(["merge", "out"], 1, "cells")
    left = {number for number, state in enumerate(states, 1) if state != "finished"}
    before = cluster.read_jobs()
    sweep.submit()
    submitted = {int(name.rpartition("_")[2]) for name in cluster.read_jobs() if "_" in name and name not in before}
    assert submitted == left, f"{submitted} were submitted, where {left} were left"
    sweep.wait_for_cells(len(cells) + 1)
    cluster.run("scancel", "--user=root")
    sweep.submit()  # while they are still ending
    sweep.wait()
    sweep.expect_same_as_one_run()
    sweep.expect_kept(cells)


def test_failed_tasks_say_why_and_are_mended(program, cluster, folder):
    mine, experiment = folder / "mine.glsl", folder / FILE
    mine.write_text(FILTER)
    sweep = Sweep(program, cluster, folder, ["--filter-file", mine])
    for file, broken, said in ((experiment, experiment.read_text().replace("[1, 2]", "[1, 3]"), "no longer what was submitted"),
                               (mine, None, "mine.glsl")):
        text = file.read_text()
        cluster.hold()
        sweep.submit()
        file.write_text(broken) if broken else file.unlink()
        cluster.release()
        sweep.wait()
        file.write_text(text)
        status = sweep.read_status()
        failed = [task for task in status["truths"] + status["tasks"] if task["state"] == "failed"]
        assert failed and not status["report"], f"{said}: {status}\n{sweep.read_log()}"
        for task in failed:
            assert said in task["message"], task
        assert said in sweep.run("status", "out", code=1).stdout
    sweep.submit()
    sweep.wait()
    sweep.expect_same_as_one_run()


def test_two_tasks_on_one_cell(program, cluster, folder):
    sweep = Sweep(program, cluster, folder, tasks=1)
    sweep.submit("--dry-run")
    both = [sweep.start_task(1) for _ in range(2)]
    for process in both:
        assert process.wait(120) == 0, sweep.read_log()
    sweep.run("merge", "out")
    sweep.expect_same_as_one_run()


def test_silent_task_is_lost_whatever_the_clock_says(program, cluster, folder):
    sweep = Sweep(program, cluster, folder)
    sweep.submit("--dry-run")
    alive = sweep.out / "tasks" / "2" / "alive"
    alive.write_text("process 1 on nowhere\n")
    assert sweep.read_states() == ["waiting", "running"], sweep.read_status()
    make_older(alive, 60)
    assert sweep.read_states() == ["waiting", "running"], sweep.read_status()
    assert sweep.read_states("--silent-after", 30) == ["waiting", "lost"], sweep.read_status()
    make_older(alive, 3600)
    assert sweep.read_states() == ["waiting", "lost"], sweep.read_status()
    sweep.submit()
    sweep.wait()
    sweep.expect_same_as_one_run()


def test_clocks_may_differ(program, cluster, folder):
    late = find_faketime("+1h")
    if late is None:
        return "SKIPPED: faketime is not installed"
    sweep = Sweep(program, cluster, folder, LONG, tasks=1)
    sweep.submit("--dry-run")
    late = dict(sweep.environment, **late)
    task = sweep.start_task(1, late)
    sweep.wait_for_cells(1)
    for environment in (sweep.environment, late):
        assert sweep.read_states(env=environment) == ["running"], sweep.read_status(env=environment)
    assert task.wait(120) == 0, sweep.read_log()
    sweep.run("merge", "out", env=late)
    sweep.expect_same_as_one_run()


def test_what_sbatch_refuses_is_one_message(program, cluster, folder):
    sweep = Sweep(program, cluster, folder)
    before = cluster.read_jobs()
    words = ["submit", *sweep.words, *sweep.options, "--out", "out"]
    sweep.refuse([*words, "--partition", "nosuch"], 2, "sbatch", "partition")
    sweep.refuse([*words, "--", "--nosuch=3"], 2, "sbatch", "nosuch")
    assert cluster.read_jobs() == before, "nothing was submitted"
    sweep.options[3] = 16  # the truth is submitted by then
    sweep.refuse(["submit", *sweep.words, *sweep.options, "--out", "out"], 2, "sbatch", "array")
    assert not cluster.read_jobs("pending,running"), "no job stays"
    sweep.options[3] = 2
    sweep.submit("--dry-run")
    assert len(sweep.read_states()) == 2, "a plan that was refused is made anew"
    sweep.environment["PATH"] = hide_tools(folder / "bin")
    sweep.refuse(words, 2, "no sbatch")
    sweep.refuse(["submit", *sweep.words, "--engine", "slrm", "--out", "out"], 2, "slurm")
    sweep.refuse(["status", "nowhere"], 3, "nowhere")


def test_parallel_does_it_on_one_machine(program, cluster, folder):
    if shutil.which("parallel") is None:
        return "SKIPPED: parallel is not installed"
    sweep = Sweep(program, cluster, folder, LONG, tasks=3)
    sweep.options[1] = "parallel"
    sweep.submit("--dry-run")
    assert not sweep.list_cells(), "nothing is measured"
    script = int(re.search(r"job (\d+)@", sweep.submit().stdout)[1])
    sweep.wait_for_cells(1)
    send(signal.SIGTERM, [script])
    cluster.wait_for(lambda: not find_processes(sweep.out), 60, "end of what the script had started")
    assert sweep.read_states()[1:] == ["waiting", "waiting"] and not (sweep.out / "alive").exists(), sweep.read_status()
    before = len(sweep.list_cells())
    sweep.submit("--", "--jobs", 2)
    sweep.wait_for_cells(before + 1)
    scripts = find_processes(sweep.out / "submit.sh")
    assert scripts, "the script runs on"
    for script in scripts:
        end_descendants(script)
    send(signal.SIGKILL, scripts)
    cells = sweep.expect_stopped_midway()
    for alive in sweep.out.glob("**/alive"):
        make_older(alive, 3600)
    assert "lost" in sweep.read_states(), sweep.read_status()
    sweep.submit()
    cluster.wait_for(lambda: time.time() - (sweep.out / "alive").stat().st_mtime < 60, 10, "sign of life")
    scripts = find_processes(sweep.out / "submit.sh")
    send(signal.SIGSTOP, scripts)  # it neither ends nor goes on to the report
    for there in (False, True):
        if there:  # as if begun on another machine, whose processes have other numbers
            sweep.edit_jobs(rf'"\d+@{socket.gethostname()}"', '"1@elsewhere"')
        assert "nothing is left to submit" in sweep.submit().stdout, "the script has the tasks before it"
    send(signal.SIGCONT, scripts)
    cluster.wait_for(lambda: sweep.read_status()["report"], 60, "report")
    sweep.expect_same_as_one_run()
    sweep.expect_kept(cells)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    if missing := say_what_is_missing():
        print(f"SKIPPED: {missing}")
        return 77
    failed = []
    tests = [(name[5:], test) for name, test in globals().items() if name.startswith("test_") and arguments.only in name]
    if not tests:
        parser.error(f"--only: no test has '{arguments.only}' in its name")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch, Cluster(Path(scratch) / "slurm") as cluster:
        for name, test in tests:
            folder = Path(scratch) / name
            folder.mkdir()
            begun = time.monotonic()
            try:
                note = test(program, cluster, folder)
                print(f"ok      {name} ({time.monotonic() - begun:.1f} s){': ' + note if note else ''}", flush=True)
            except (AssertionError, subprocess.SubprocessError, OSError, LookupError) as error:
                failed.append(name)
                print(f"FAILED  {name}: {error!r}\n{cluster.read_logs()}", flush=True)
            cluster.tidy()
            send(signal.SIGKILL, find_processes(folder))  # what a test that failed left running
    print(f"{len(tests) - len(failed)} of {len(tests)} passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
