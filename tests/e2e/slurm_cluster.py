"""A Slurm cluster of its own on this machine: munged, slurmctld and a slurmd for each node, on free ports, with a key, folders and logs
in a temporary folder. Nothing of /etc/slurm or /etc/munge, no service and no cgroup is used, and whoever starts it is its only user,
root or not. When it ends, so does every process that it or a job of it has started.

    with slurm_cluster.Cluster() as cluster:
        subprocess.run(["sbatch", ...], env=cluster.environment)

By hand: python3 -B tests/e2e/slurm_cluster.py COMMAND [ARGUMENT...] runs a command beside a cluster.
"""

import ctypes
import getpass
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PATIENCE = 60
# Debian installs daemons in folders that are not in a user's PATH.
PATH = os.environ.get("PATH", "") + os.pathsep + "/usr/sbin" + os.pathsep + "/sbin"
TOOLS = {"slurmctld": "slurmctld", "slurmd": "slurmd", "sbatch": "slurm-client", "munged": "munge"}

# Short times, so that tests need not wait: a node that does not answer is down within seconds, a job that was
# on it begins again `cred_expire` later, and finished jobs are soon forgotten. By default slurmctld looks for
# jobs to start only every 3 s.
_CONF = """\
ClusterName=hydro
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/run/munge.socket,cred_expire=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/run/slurmctld.pid
SlurmdPidFile={folder}/run/%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
SchedulerType=sched/backfill
"""
SETTINGS = {
    "SchedulerParameters": "batch_sched_delay=0,sched_interval=1,bf_interval=1",
    "MessageTimeout": "2",
    "TCPTimeout": "1",
    "SlurmdTimeout": "2",
    "SlurmctldTimeout": "2",
    "KillWait": "1",
    "MinJobAge": "10",
}


def missing():
    """What has to be installed before a cluster can be started; empty if nothing."""
    return sorted({package for tool, package in TOOLS.items() if shutil.which(tool, path=PATH) is None})


class _Ports:
    """TCP ports that nobody uses. They stay reserved as long as this object lives: who asks for a free one gets another, while
    Slurm, which sets SO_REUSEADDR, can listen on them."""

    def __init__(self, count):
        self._sockets = []
        for _ in range(count):
            held = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
            held.bind(("127.0.0.1", 0))
            self._sockets.append(held)
        for held in self._sockets:
            held.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.numbers = [held.getsockname()[1] for held in self._sockets]

    def close(self):
        for held in self._sockets:
            held.close()


class Cluster:
    """`nodes` nodes of `cpus` processors each, all of them this machine's; a node's name is n1, n2, ... `settings` are lines of
    slurm.conf that replace those of SETTINGS; one that is None is left to Slurm's default."""

    def __init__(self, nodes=2, cpus=2, settings=None):
        if lacking := missing():
            raise FileNotFoundError("a Slurm cluster needs the packages " + ", ".join(lacking))
        self.nodes = [f"n{number + 1}" for number in range(nodes)]
        self._cpus = cpus
        self._settings = {**SETTINGS, **(settings or {})}
        self._daemons = {}

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="hydro-slurm-")
        self._ports = _Ports(1 + len(self.nodes))
        self.environment = {**{name: value for name, value in os.environ.items() if not name.startswith(("SLURM_", "SBATCH_"))},
                            "PATH": PATH, "SLURM_CONF": self._path("slurm.conf")}
        try:
            self._start()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(self, *_):
        """Ends everything, and fails if something of it still lives."""
        try:
            self._end_all()
        finally:
            self._ports.close()
            shutil.rmtree(self.folder, ignore_errors=True)

    def _path(self, *parts):
        return os.path.join(self.folder, *parts)

    def _start(self):
        os.chmod(self.folder, 0o711)  # munged wants its socket to be within everybody's reach
        for name in ("run", "state", "log", *(f"spool/{node}" for node in self.nodes)):
            os.makedirs(self._path(name))
        with open(self._path("munge.key"), "wb") as file:
            os.fchmod(file.fileno(), 0o400)
            file.write(os.urandom(128))
        self._write_conf()
        self._launch("munged", "--foreground", "--socket=" + self._path("run/munge.socket"), "--key-file=" + self._path("munge.key"),
                     "--pid-file=" + self._path("run/munged.pid"), "--seed-file=" + self._path("run/munged.seed"))
        self._wait_until(lambda: os.path.exists(self._path("run/munge.socket")), "munged's socket")
        self.start_controller()
        for node in self.nodes:
            self.start_node(node)
        self._wait_until(lambda: all(state == "idle" for state in self.node_states().values()), "idle nodes")

    def _write_conf(self):
        host = socket.gethostname().split(".")[0]
        text = _CONF.format(host=host, port=self._ports.numbers[0], user=getpass.getuser(), folder=self.folder)
        text += "".join(f"{name}={value}\n" for name, value in self._settings.items() if value is not None)
        for node, port in zip(self.nodes, self._ports.numbers[1:]):
            text += f"NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={self._cpus} State=UNKNOWN\n"
        text += f"PartitionName=all Nodes={','.join(self.nodes)} Default=YES MaxTime=INFINITE State=UP\n"
        with open(self._path("slurm.conf"), "w", encoding="utf-8") as file:
            file.write(text)
        # Without accounting and cgroups nothing here is used, but where the file is missing slurmd looks in
        # /etc/slurm.
        with open(self._path("cgroup.conf"), "w", encoding="utf-8"):
            pass

    def _launch(self, program, *arguments, label=None):
        label = label or program
        with open(self._path("log", label + ".out"), "ab") as out:
            self._daemons[label] = subprocess.Popen([shutil.which(program, path=PATH), *arguments], cwd=self.folder, env=self.environment,
                                                    stdin=subprocess.DEVNULL, stdout=out, stderr=out, start_new_session=True,
                                                    preexec_fn=_end_with_parent)

    def start_controller(self):
        self._launch("slurmctld", "-D", "-f", self._path("slurm.conf"))

    def kill_controller(self):
        _kill(self._daemons["slurmctld"].pid)
        self._daemons["slurmctld"].wait()

    def start_node(self, node):
        self._launch("slurmd", "-D", "-N", node, "-f", self._path("slurm.conf"), label=node)

    def restart_slurmd(self, node):
        """Its jobs go on; it tells slurmctld that it is there."""
        self._daemons[node].terminate()
        self._daemons[node].wait()
        self.start_node(node)

    def kill_node(self, node):
        """As if the machine had lost its power: its slurmd, the steps of its jobs and all that these have started end at once."""
        for pid in [self._daemons[node].pid, *self.processes({"SLURMD_NODENAME": node}), *self._steps(node)]:
            _kill(pid)
        self._daemons[node].wait()

    def _steps(self, node):
        """The slurmstepds of a node: children of its slurmd, until it ends, and named after their jobs."""
        jobs = {line.split()[0] for line in self.ask("squeue", "-h", "-w", node, "-o", "%A").splitlines()}
        for pid in self.processes():
            name = _command_line(pid)
            if name.startswith("slurmstepd: [") and name.split("[")[1].split(".")[0] in jobs:
                yield pid

    def ask(self, *command):
        """What a command of Slurm prints; empty if it failed, as while slurmctld starts."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=PATIENCE).stdout

    def node_states(self):
        """{node: state}, as sinfo names them: idle, mixed, allocated, down, with * for one that does not answer."""
        states = dict(line.split("=") for line in self.ask("sinfo", "-h", "-N", "-o", "%N=%T").splitlines())
        return {node: states.get(node, "unknown") for node in self.nodes}

    def tasks(self):
        """{(job, index): state} of the tasks of arrays that slurmctld knows, ended ones too for as long as MinJobAge."""
        lines = self.ask("squeue", "-h", "-r", "-t", "all", "-o", "%F %K %T").splitlines()
        return {(job, index): state for job, index, state in map(str.split, lines)}

    def queue(self):
        """The tasks that wait or run, each as "JOB INDEX STATE". One whose node still tidies up after it (COMPLETING) has ended."""
        return [task for task in self._whole_queue() if not task.endswith(" COMPLETING")]

    def _whole_queue(self):
        answers = []

        def ask():
            done = subprocess.run(["squeue", "-h", "-r", "-o", "%F %K %T"], env=self.environment, capture_output=True, text=True,
                                  timeout=PATIENCE, check=False)
            answers.append(done)
            return done.returncode == 0

        self._wait_until(ask, "squeue answers")
        return answers[-1].stdout.splitlines()

    def cancel_all(self):
        """Ends all jobs, and waits until the queue is empty."""
        self.ask("scancel", "--state=PENDING", "--user=" + getpass.getuser())
        self.ask("scancel", "--user=" + getpass.getuser())
        self._wait_until(lambda: not self._whole_queue(), "an empty queue")

    def processes(self, variables=None):
        """The process ids of all that belongs to this cluster, its jobs too, or of those with these variables in their environment."""
        wanted = {"SLURM_CONF": self._path("slurm.conf"), **(variables or {})}
        wanted = {f"{name}={value}".encode() for name, value in wanted.items()}
        return [int(pid) for pid in os.listdir("/proc") if pid.isdigit() and wanted <= _environment(pid)]

    def _end_all(self):
        daemons = list(self._daemons.values())
        for daemon in reversed(daemons):
            daemon.terminate()
        deadline = time.monotonic() + 5
        for daemon in reversed(daemons):
            try:
                daemon.wait(max(0.0, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        own = str(os.getpid())

        def left():
            return [pid for pid in self.processes() if str(pid) != own]

        def kill_those_left():
            for pid in left():
                _kill(pid)
            return not left()

        self._wait_until(kill_those_left, "the end of all processes")

    def _wait_until(self, condition, what):
        deadline = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"waited {PATIENCE} s in vain: {what}\n{self.report()}")
            for label, daemon in self._daemons.items():
                if daemon.poll() not in (None, 0, -signal.SIGKILL, -signal.SIGTERM):
                    raise AssertionError(f"{label} ended with {daemon.returncode}\n{self.report()}")
            time.sleep(0.02)

    def report(self):
        """The ends of all logs."""
        parts = []
        for name in sorted(os.listdir(self._path("log"))):
            with open(self._path("log", name), encoding="utf-8", errors="replace") as file:
                parts.append(f"--- {name}\n{file.read()[-3000:]}")
        return "\n".join(parts)


def _end_with_parent():
    """A cluster does not outlive a test that was killed."""
    ctypes.CDLL(None).prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG


def _environment(pid):
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:
            return set(file.read().split(b"\0"))
    except OSError:
        return set()


def _command_line(pid):
    try:
        with open(f"/proc/{pid}/cmdline", encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""


def _kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def main():
    with Cluster() as cluster:
        return subprocess.run(sys.argv[1:], env=cluster.environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
