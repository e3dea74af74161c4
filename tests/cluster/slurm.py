"""A Slurm of two nodes on this machine, for tests, which touches no Slurm that the machine may have.

    with Cluster(folder) as cluster:
        cluster.run("sbatch", "--wrap", "hostname")
        cluster.wait_until_empty()

A `munged`, a `slurmctld` and a `slurmd` for each node run as children of this process, on free ports of the loopback;
keys, states and logs are in `folder`. Commands find the cluster by SLURM_CONF, which `environment` holds.
"""

import ctypes
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

TOOLS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")
PATH = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin", "/sbin"])
SET_PARENT_DEATH_SIGNAL, SET_CHILD_SUBREAPER = 1, 36  # of prctl(2)

# All waits are as short as Slurm lets them be: a node that does not answer is down after SlurmdTimeout, and a job that
# was requeued starts when its credential, cred_expire, has expired.
CONFIGURATION = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
GresTypes=gpu
ReturnToService=2
SlurmdTimeout=3
MinJobAge=600
MaxArraySize=10
KillWait=1
MessageTimeout=3
TCPTimeout=1
BatchStartTimeout=3
InactiveLimit=0
JobRequeue=1
SchedulerParameters=bf_interval=1,sched_min_interval=100000,batch_sched_delay=0,sched_interval=1
PartitionName=all Nodes=ALL Default=YES MaxTime=60 State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus} Gres=gpu:1\n"


def say_what_is_missing():
    """One sentence about what keeps a cluster from being started here, or None."""
    missing = [tool for tool in TOOLS if shutil.which(tool, path=PATH) is None]
    if missing:
        return f"{', '.join(missing)} of Slurm (Debian: slurm-wlm, munge) is not installed"
    if os.geteuid() != 0:
        return "slurmd starts jobs as root only"
    return None


def find_free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def read_processes():
    """{process: its parent} of all processes that are not already dead."""
    parents = {}
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        if fields[0] not in "ZX":
            parents[int(entry.name)] = int(fields[1])
    return parents


def find_descendants(root):
    """The processes that `root`, and those that it has started, have started: parents before their children."""
    parents = read_processes()
    found, more = [], {root}
    while more:
        more = {process for process, parent in parents.items() if parent in more}
        found += sorted(more)
    return found


def send(number, processes):
    for process in processes:
        try:
            os.kill(process, number)
        except ProcessLookupError:
            pass


def end_descendants(root):
    """Ends all that `root` and those below it have started, at once: nobody is left who could start another."""
    processes = []
    while (found := find_descendants(root)) != processes:
        processes = found
        send(signal.SIGSTOP, processes)
    send(signal.SIGKILL, reversed(processes))  # a stopped group whose parent dies first hears SIGHUP, and says so


def keep(command):
    """Runs a daemon, and is the parent of all that it leaves behind; SIGTERM, or the end of the caller, ends them all."""
    libc = ctypes.CDLL(None)
    libc.prctl(SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    signal.signal(signal.SIGTERM, lambda *_: end_descendants(os.getpid()))
    libc.prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGTERM, 0, 0, 0)
    subprocess.Popen(command)
    while True:
        try:
            os.wait()
        except ChildProcessError:  # all have ended
            return 0


class Cluster:
    def __init__(self, folder, nodes=2, cpus=2):
        self.folder = Path(folder).resolve()
        self.folder.mkdir(parents=True, exist_ok=True)
        self.nodes = [f"node{number + 1}" for number in range(nodes)]
        self.daemons = {}
        self.configuration = self.folder / "slurm.conf"
        foreign = ("SLURM", "SBATCH", "SQUEUE", "SCANCEL", "SINFO")
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(foreign)}
        self.environment.update(PATH=PATH, SLURM_CONF=str(self.configuration))
        self._configure(cpus)

    def __enter__(self):
        try:
            self._start_daemon("munged", "--foreground", "--force", *(f"--{what}={self.folder}/munge.{what[:-5]}" for what in (
                "key-file", "pid-file", "log-file", "seed-file")), f"--socket={self.folder}/munge.socket")
            self.wait_for(lambda: (self.folder / "munge.socket").exists(), 10, "munged's socket")
            self._start_daemon("slurmctld", "-D", "-c")
            for name in self.nodes:
                self.restart_node(name)
            self.wait_until_idle()
        except BaseException:
            print(self.read_logs(), file=sys.stderr)
            self.close()
            raise
        return self

    def __exit__(self, *_):
        self.close()

    def _configure(self, cpus):
        for name in ("state", *self.nodes):
            (self.folder / name).mkdir(exist_ok=True)
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(os.urandom(128))
        ports = find_free_ports(1 + len(self.nodes))
        host = socket.gethostname().partition(".")[0]
        nodes = "".join(NODE.format(name=name, host=host, port=port, cpus=cpus) for name, port in zip(self.nodes, ports[1:]))
        self.configuration.write_text(CONFIGURATION.format(folder=self.folder, host=host, ports=ports) + nodes)
        (self.folder / "gres.conf").write_text("Name=gpu File=/dev/null\n")
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")  # asks for no mount, which a container may lack

    def _start_daemon(self, *command, name=None):
        name = name or command[0]
        words = [sys.executable, __file__, shutil.which(command[0], path=PATH), *command[1:]]
        with (self.folder / f"{name}.out").open("ab") as output:
            self.daemons[name] = subprocess.Popen(words, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                                  stdout=output, stderr=output)

    def wait_for(self, holds, seconds, what):
        end = time.monotonic() + seconds
        while True:
            answer = holds()
            if answer:
                return answer
            ended = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if ended or time.monotonic() > end:
                raise AssertionError(f"no {what} within {seconds} s{''.join(f'; {name} has ended' for name in ended)}")
            time.sleep(0.1)

    def read_logs(self, lines=12):
        """The last lines of every daemon's log."""
        logs = {path.name: [line for line in path.read_text(errors="replace").splitlines() if "pmix" not in line]
                for path in sorted(self.folder.glob("*.log"))}
        return "\n".join("\n  ".join([f"{name}:", *text[-lines:]]) for name, text in logs.items() if text)

    def run(self, *words, check=True, timeout=30, **options):
        """A command in the cluster's environment, with its output as text."""
        done = subprocess.run([str(word) for word in words], env=options.pop("env", self.environment), capture_output=True, text=True,
                              timeout=timeout, **options)
        if check and done.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, words))} ended with {done.returncode}: {done.stderr}{done.stdout}")
        return done

    def read_nodes(self):
        """{node: its state in small letters}, with Slurm's mark `*` for one that does not answer."""
        done = self.run("sinfo", "--noheader", "--Node", "--format=%N %T", check=False)
        return dict(line.split() for line in done.stdout.splitlines())

    def read_jobs(self, states="all"):
        """{job or task of an array, such as '7' or '7_2': its state}, of the jobs that Slurm still remembers."""
        done = self.run("squeue", "--noheader", "--array", f"--states={states}", "--format=%i %T")
        return dict(line.split() for line in done.stdout.splitlines())

    def wait_until_idle(self, seconds=30):
        self.wait_for(lambda: self.read_nodes() == dict.fromkeys(self.nodes, "idle"), seconds, "idle nodes")

    def wait_until_empty(self, seconds=60):
        """Until no job waits or runs. One whose dependency cannot be satisfied any more counts as waiting."""
        self.wait_for(lambda: not self.read_jobs("pending,running,suspended,completing"), seconds, "empty queue")

    def wait_for_job(self, job, state, seconds=30):
        self.wait_for(lambda: self.read_jobs().get(job) == state, seconds, f"{state} of job {job}")

    def find_running(self):
        """(job, node) of one that runs."""
        def read():
            return self.run("squeue", "--noheader", "--array", "--states=running", "--format=%i %N").stdout.split()[:2]
        return self.wait_for(read, 30, "running job")

    def hold(self):
        """Nodes start no job until release()."""
        self.run("scontrol", "update", f"nodename={','.join(self.nodes)}", "state=drain", "reason=test")

    def release(self):
        self.run("scontrol", "update", f"nodename={','.join(self.nodes)}", "state=resume")

    def kill_node(self, name):
        """Ends a node and all that runs on it at once, as a machine that loses its power."""
        keeper = self.daemons.pop(name)
        keeper.terminate()
        keeper.wait()

    def notice_failure(self, name):
        """What Slurm does of itself some ten seconds after a node has died."""
        self.run("scontrol", "update", f"nodename={name}", "state=down", "reason=dead")

    def restart_node(self, name):
        self._start_daemon("slurmd", "-D", "-N", name, name=name)

    def tidy(self):
        """Cancels all jobs, and starts the nodes that were killed again."""
        self.run("scancel", "--user=root", check=False)
        for name in self.nodes:
            if name not in self.daemons:
                self.restart_node(name)
        self.wait_until_empty()
        self.wait_until_idle()

    def close(self):
        """Ends every process of the cluster."""
        for keeper in self.daemons.values():
            keeper.terminate()
        for keeper in self.daemons.values():
            keeper.wait()
        self.daemons.clear()


if __name__ == "__main__":
    sys.exit(keep(sys.argv[1:]))
