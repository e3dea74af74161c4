#!/usr/bin/env python3
"""Measures an experiment with harness/slurm.sh on a Slurm of one node, which loses its power once. Standard library only.

    python3 tests/cluster/run.py --program build/tests/shadowbench

Needs root and slurm-wlm; touches no Slurm that the machine may have. All processes live in a namespace that ends with the test.
"""
import argparse
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "harness" / "slurm.sh"
TOOLS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo", "unshare")
PATH = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/sbin"])
WORDS = ["--scene", "cubes", "--scene", "stack", "--filters", "none,vsm,esm", "--size", "64x36", "--map-size", "64,128,256", "--rounds", "8",
         "--gpu", "none", "--gl", "software"]
SHARDS = 3
# Jobs are queued again only where they ask for it, and start again when their credential has expired.
CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
SlurmUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
MpiDefault=none
SlurmdParameters=config_overrides
ReturnToService=2
JobRequeue=0
SchedulerParameters=bf_interval=1,sched_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2
PartitionName=all Nodes=ALL Default=YES
"""


def wait_for(holds, what, seconds=60):
    end = time.monotonic() + seconds
    while not (answer := holds()):
        assert time.monotonic() < end, f"no {what} within {seconds} s"
        time.sleep(0.1)
    return answer


class Cluster:
    def __init__(self, folder, program):
        self.folder, self.host = folder, socket.gethostname().partition(".")[0]
        foreign = ("SLURM", "SBATCH", "SQUEUE", "SINFO")
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(foreign)}
        self.environment.update(PATH=PATH, SLURM_CONF=str(folder / "slurm.conf"), SHADOWBENCH=str(program))
        sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
        ports = [each.getsockname()[1] for each in sockets]
        for each in sockets:
            each.close()
        for name in ("state", "spool"):
            (folder / name).mkdir()
        (folder / "slurm.conf").write_text(CONFIGURATION.format(folder=folder, host=self.host, ports=ports))
        (folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")  # asks for no mount, which a container may lack
        for daemon in ("slurmctld", "slurmd"):
            with (folder / f"{daemon}.out").open("w") as output:
                subprocess.Popen([daemon, "-D"], env=self.environment, stdout=output, stderr=output)
        wait_for(lambda: "idle" in self.run("sinfo", "-ho", "%T", check=False), "idle node")

    def run(self, *words, check=True):
        done = subprocess.run([str(word) for word in words], env=self.environment, cwd=self.folder, capture_output=True, text=True, timeout=120)
        assert not check or done.returncode == 0, f"{words} ended with {done.returncode}: {done.stderr}{done.stdout}"
        return done.stdout

    def lose_node(self):
        self.run("scontrol", "update", f"nodename={self.host}", "state=down", "reason=lost")
        self.run("scontrol", "update", f"nodename={self.host}", "state=resume", check=False)  # refused where it came back by itself


def read_cells(folder):
    """The cells of a report but their times, and what a page shows first, which depends on them."""
    cells = json.loads((folder / "results.json").read_text())["cells"]
    for cell in cells:
        for name in ("time_ms", "ratio_to_none", "measured_s"):
            cell.pop(name)
        for name in ("frames", "supersampled", "truth_supersampled", "samples"):
            cell["images"].pop(name, None)
    return cells


def test_sweep(cluster, out):
    """A node that dies costs no finished cell, and the report is that of one run."""
    def list_finished():
        return {path: path.stat().st_mtime_ns for path in out.glob(f"*-of-{SHARDS}/cells/*.json") if len(path.stem) == 16}

    def is_empty():
        return not cluster.run("squeue", "-h")

    cluster.run(cluster.environment["SHADOWBENCH"], "run", *WORDS, "--no-grids", "--no-cache", "--out", "whole")
    submit = [SCRIPT, SHARDS, out, *WORDS]
    cluster.run(*submit)
    first = wait_for(list_finished, "finished cell")
    cluster.lose_node()
    assert len(list_finished()) < len(read_cells(cluster.folder / "whole")), "the node died too late"
    wait_for(is_empty, "empty queue", 120)
    assert "Restarts=1" in cluster.run("scontrol", "show", "job"), "no job was queued again"
    assert read_cells(out / "whole") == read_cells(cluster.folder / "whole"), "the report is another one than that of one run"
    finished = list_finished()
    assert first.items() <= finished.items(), "a finished cell was measured again"
    cluster.run(*submit)
    wait_for(is_empty, "empty queue", 120)
    assert finished == list_finished(), "the same command measures a finished cell again"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    missing = [tool for tool in TOOLS if shutil.which(tool, path=PATH) is None]
    if missing or os.geteuid() != 0:
        print(f"SKIPPED: {', '.join(missing)} (Debian: slurm-wlm) is not installed" if missing else "SKIPPED: slurmd starts jobs as root only")
        return 77
    if not arguments.inside:
        return subprocess.run(["unshare", "--pid", "--fork", "--kill-child", "--mount-proc", sys.executable, __file__, "--inside",
                               "--program", arguments.program]).returncode
    os.environ["PATH"] = PATH
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
        folder = Path(scratch)
        try:
            test_sweep(Cluster(folder, arguments.program.resolve()), folder / "it's a 'sweep'")
        except (AssertionError, subprocess.SubprocessError):
            for log in (*folder.glob("*.log"), *folder.glob("*/*.log")):
                print(f"{log.name}:\n{log.read_text(errors='replace')[-2000:]}", flush=True)
            raise
    return 0


if __name__ == "__main__":
    sys.exit(main())
