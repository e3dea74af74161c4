#!/usr/bin/env python3
"""Runs jobs on a Slurm of two nodes, which it starts on this machine and ends again.

    python3 tests/cluster/run.py --program build/tests/shadowbench [--only NAME]

Needs root, slurm-wlm and munge; touches no Slurm that the machine may have. See slurm.py.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from slurm import Cluster, say_what_is_missing  # noqa: E402


def submit(cluster, folder, script, *options):
    """The job's id; what it prints is in FOLDER/ID.txt, or ID_TASK.txt of an array's task."""
    name = "%A_%a" if any(option.startswith("--array") for option in options) else "%j"
    (folder / "job.sh").write_text(f"#!/bin/sh\n{script}\n")
    return cluster.run("sbatch", "--parsable", f"--output={folder}/{name}.txt", *options, folder / "job.sh").stdout.strip()


def test_cluster_runs_an_array_and_what_depends_on_it(program, cluster, folder):
    array = submit(cluster, folder, "sleep 0.2; echo $SLURMD_NODENAME", "--array=1-4")
    after = submit(cluster, folder, f"cat {folder}/{array}_*.txt", f"--dependency=afterok:{array}")
    cluster.wait_until_empty()
    assert set(cluster.read_jobs().values()) == {"COMPLETED"}, cluster.read_jobs()
    assert len((folder / f"{after}.txt").read_text().split()) == 4, "the dependent job ran last"


def test_cluster_requeues_the_job_of_a_node_that_died(program, cluster, folder):
    job = submit(cluster, folder, "echo $$ on $SLURMD_NODENAME >> times; sleep 3", "--nodelist=node1", f"--chdir={folder}")
    cluster.wait_for_job(job, "RUNNING")
    cluster.wait_for(lambda: (folder / "times").exists(), 5, "job's file")
    cluster.kill_node("node1")
    process = (folder / "times").read_text().split()[0]
    assert not Path(f"/proc/{process}").exists(), "the job died with its node"
    cluster.wait_for_job(job, "PENDING")
    cluster.restart_node("node1")
    cluster.wait_until_empty()
    assert cluster.read_jobs()[job] == "COMPLETED", cluster.read_jobs()
    assert (folder / "times").read_text().count("on node1") == 2, "the job ran again"


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
    with tempfile.TemporaryDirectory() as scratch, Cluster(Path(scratch) / "slurm") as cluster:
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
    print(f"{len(tests) - len(failed)} of {len(tests)} passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
