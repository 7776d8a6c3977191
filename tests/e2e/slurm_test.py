"""hydro-batch --slurm on a real Slurm cluster of two nodes, which the test starts and ends (slurm_cluster.py): the same tables as
locally, and nothing lost and nothing run twice whatever is killed, cancelled or full."""

import collections
import json
import os
import re
import shutil
import signal
import subprocess
import unittest

import outcome
import slurm_cluster
import stack

# A case notes that it began, waits for the gate unless it is one of the first, and notes that it ended.
CASE = """\
echo "$1" >>"$SIDE/begun"
[ "$1" -lt "$FREE" ] || while [ ! -e "$SIDE/gate" ]; do sleep 0.05; done
printf '{"y": %s}\\n' "$2" >out.json
echo "$1" >>"$SIDE/ended"
"""
STUDY = """\
name = "it's a \\"study\\", 100 %"
draws = 14
files = ["case.sh"]
[[step]]
run = ["sh", "{inputs}/case.sh", "{case}", "{value:x}"]
[[draw]]
key = "x"
distribution = "uniform"
min = 0
max = 1
[collect]
y = "out.json:/y"
"""
CASES = 14
# Paths that a script must not split.
FOLDER = "it's a \"fol%der\" $HOME"


def setUpModule():
    if lacking := slurm_cluster.missing():
        raise unittest.SkipTest("needs the packages " + ", ".join(lacking))


class ClusterCase(stack.TestCase):
    nodes, cpus, settings = 2, 2, None

    @classmethod
    def setUpClass(cls):
        # The end of each node's processes, and of all others, is part of the test, which fails when one is
        # left.
        cls.cluster = cls.enterClassContext(slurm_cluster.Cluster(cls.nodes, cls.cpus, cls.settings))

    def setUp(self):
        super().setUp()
        kept = dict(os.environ)
        self.addCleanup(lambda: (os.environ.clear(), os.environ.update(kept)))
        os.environ.clear()
        os.environ.update(self.cluster.environment, SIDE=self.folder, FREE="0", TMPDIR=self.folder)
        self.addCleanup(self.cluster.cancel_all)
        self.out = self.path(FOLDER)
        for name, text in (("case.sh", CASE), ("study.toml", STUDY)):
            with open(self.path(name), "w", encoding="utf-8") as file:
                file.write(text)

    def start_study(self, *options, free=0, out=None):
        os.environ["FREE"] = str(free)
        return self.start("hydro-batch", self.path("study.toml"), "--out", out or self.out, *options)

    def start_on_slurm(self, *options, free=0):
        """Two cases in a job; the first are run without waiting to measure how long they take, unless told."""
        return self.start_study("--slurm", "--case-time", "1", "--cases-per-job", "2", *options, free=free)

    def open_gate(self):
        with open(self.path("gate"), "w", encoding="utf-8"):
            pass

    def noted(self, name):
        """How often each case has begun or ended."""
        try:
            with open(self.path(name), encoding="utf-8") as file:
                return collections.Counter(map(int, file.read().split()))
        except FileNotFoundError:
            return collections.Counter()

    def wait_for_begun(self, count):
        """Until so many cases have begun in all; those beyond the free ones wait at the gate, or have been killed there."""
        self.wait_until(lambda: self.noted("begun").total() == count, f"{count} begun cases")

    def arrays(self):
        """The ids of the arrays that the study's folder tells of."""
        ids = []
        for number in sorted(os.listdir(os.path.join(self.out, "slurm"))):
            with open(os.path.join(self.out, "slurm", number, "array"), encoding="utf-8") as file:
                ids.append(re.search(r"^id = (\d+)$", file.read(), re.MULTILINE)[1])
        return ids

    def wait_for_end_of(self, job):
        ended = ("COMPLETED", "CANCELLED", "FAILED", "NODE_FAIL", "TIMEOUT")
        self.wait_until(lambda: all(state in ended for (id, _), state in self.cluster.tasks().items() if id == job), f"the end of {job}")

    def read_tables(self, folder):
        tables = {}
        for name in ("table.csv", "table.json"):
            with open(os.path.join(folder, name), "rb") as file:
                tables[name] = file.read()
        return tables

    def check_end(self, driver, once=True):
        """The study has ended well, with the tables of a local run, and each case ran to its end once."""
        self.assertEqual(driver.wait(), 0, driver.report())
        if once:
            self.assertEqual(self.noted("ended"), collections.Counter(range(CASES)), driver.report())
        self.assertEqual(self.cluster.queue(), [], driver.report())
        local = self.path("local")
        os.environ["SIDE"] = self.path("local.side")
        os.makedirs(self.path("local.side"))
        self.assertEqual(self.start_study(free=CASES, out=local).wait(), 0)
        self.assertEqual(self.read_tables(self.out), self.read_tables(local))
        self.assertIn(b"\n13,done,", self.read_tables(local)["table.csv"])


class SlurmTest(ClusterCase):
    # Tests that a study of simulations gives the same on the cluster as here, to the bit, with jobs of any
    # size.
    def test_simulations(self):
        with open(self.path("sims.toml"), "w", encoding="utf-8") as file:
            file.write(f"""\
config = {json.dumps(stack.config("demo.toml"))}
set = ["time.duration_s=0.3"]
draws = 6
[[draw]]
key = "model:T_s"
distribution = "uniform"
min = 3
max = 5
[collect]
rms = "summary.json:/tracking/rms_error_rad"
""")
        tables = {}
        for out, options in (("here", ()), ("cluster", ("--slurm", "--cases-per-job", "1", "--case-time", "1"))):
            self.run_program("hydro-batch", self.path("sims.toml"), "--out", self.path(out), *options)
            tables[out] = self.read_tables(self.path(out))
        self.assertEqual(tables["cluster"], tables["here"])
        self.assertEqual(tables["here"]["table.csv"].count(b",done,"), 6)

    # Tests that the jobs' size is chosen so that starting one costs less than a twentieth of it, and is
    # reported with its reason.
    def test_grouping(self):
        self.open_gate()
        driver = self.start_study("--slurm", "--case-time", "3")
        self.check_end(driver)
        found = re.search(r"(\d+) jobs? with (\d+) cases each, so that starting a job costs less than a twentieth of it: "
                          r"a case takes 3 s, starting a job up to 1.1 s", driver.stderr)
        self.assertIsNotNone(found, driver.report())
        self.assertGreaterEqual(int(found[2]) * 3, 20 * 1.1)

    # Tests that a driver that was killed finds its jobs again when it is started, and submits nothing twice.
    def test_killed_driver(self):
        first = self.start_on_slurm()
        self.wait_for_begun(4)
        first.kill()
        first.wait()
        second = self.start_on_slurm()
        second.wait_for("found array")
        self.assertEqual(len(self.arrays()), 1)
        self.assertRegex(self.run_program("hydro-batch", "--status", self.out).stdout, r"4 jobs run, 3 wait")
        self.open_gate()
        self.check_end(second)
        self.assertEqual(len(self.arrays()), 1)

    # Tests that a driver killed after it submitted an array and before it could record that runs nothing
    # twice.
    def test_killed_while_submitting(self):
        tools = self.path("tools")
        os.makedirs(tools)
        with open(os.path.join(tools, "sbatch"), "w", encoding="utf-8") as file:
            os.fchmod(file.fileno(), 0o755)
            file.write(f'#!/bin/sh\n{shutil.which("sbatch")} "$@"\nkill -9 $PPID\n')
        path = os.environ["PATH"]
        os.environ["PATH"] = tools + os.pathsep + path
        self.open_gate()
        first = self.start_on_slurm()
        self.assertEqual(first.wait(), -signal.SIGKILL)
        self.assertEqual(list(self.cluster.tasks().values()).count("PENDING"), 7)
        os.environ["PATH"] = path
        self.check_end(self.start_on_slurm())

    # Tests that the cases of a cancelled array are submitted again, except those that ended, and that Ctrl-C
    # cancels the jobs.
    def test_cancelled(self):
        driver = self.start_on_slurm(free=4)
        self.wait_for_begun(8)
        subprocess.run(["scancel", self.arrays()[0]], check=True)
        driver.wait_for("no job has them any more")
        self.wait_for_begun(12)
        self.assertNotEqual(self.cluster.queue(), [])
        driver.send(signal.SIGINT)
        self.assertEqual(driver.wait(), 1, driver.report())
        self.assertIn("its jobs are cancelled; the same command goes on", driver.stderr)
        self.assertEqual(self.cluster.queue(), [])
        self.assertEqual(sorted(self.noted("ended")), [0, 1, 2, 3])
        self.open_gate()
        self.check_end(self.start_on_slurm())

    # Tests that a study is given up, with the reason, when its jobs repeatedly end without a case.
    def test_given_up(self):
        os.environ["TMPDIR"] = "/proc"  # where no case can have its folder
        driver = self.start_on_slurm()
        self.assertEqual(driver.wait(), 1, driver.report())
        self.assertEqual(len(self.arrays()), 3)
        self.assertRegex(driver.stderr, r"14 of 14 cases are missing.*a job said: hydro-batch: /proc/")
        self.assertIn("given up", driver.stderr)
        self.assertIn("0 done, 0 failed, 14 missing", driver.stdout)
        os.environ["TMPDIR"] = self.folder
        self.open_gate()
        self.check_end(self.start_on_slurm())

    # Tests that --detach leaves the jobs running by themselves, and that the same command then makes the
    # tables.
    def test_detached(self):
        driver = self.start_on_slurm("--detach", "--jobs-at-once", "3")
        self.assertEqual(driver.wait(), 0, driver.report())
        self.assertIn("run on", driver.stderr)
        self.wait_for_begun(3)
        self.open_gate()
        self.wait_for_end_of(self.arrays()[0])
        self.assertIn("14 done, 0 failed, 0 missing", self.run_program("hydro-batch", "--status", self.out).stdout)
        self.check_end(self.start_on_slurm())
        self.assertEqual(len(self.arrays()), 1)

    # Tests that a refusal by Slurm is reported in one line and leaves nothing in the queue.
    def test_refused(self):
        driver = self.start_on_slurm("--partition", "nowhere")
        self.assertEqual(driver.wait(), 2)
        self.assertRegex(driver.stderr, r"\Ahydro-batch: sbatch: .*[Ii]nvalid partition.*\n\Z")
        self.assertEqual(self.cluster.queue(), [])

    # Tests that a full disk loses nothing: the driver says so, and continues when there is room again.
    def test_full_disk(self):
        os.makedirs(self.out)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "hydro-test", self.out], capture_output=True, text=True)
        if mounted.returncode != 0:
            self.skipTest("cannot mount a small disk: " + mounted.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "--lazy", self.out], check=True)
        driver = self.start_on_slurm(free=4)
        self.wait_for_begun(8)
        stored = self.noted("ended")
        self.wait_until(lambda: "4 done" in self.run_program("hydro-batch", "--status", self.out).stdout, "4 stored cases")
        ballast = os.path.join(self.out, "ballast")
        with open(ballast, "wb", buffering=0) as file:
            try:
                while file.write(bytes(4096)):
                    pass
            except OSError:
                pass
        self.open_gate()
        self.assertEqual(driver.wait(), 1, driver.report())
        self.assertRegex(driver.stderr.splitlines()[-1], "No space left on device")
        os.remove(ballast)
        self.check_end(self.start_on_slurm(), once=False)
        self.assertEqual({case: self.noted("ended")[case] for case in stored}, dict.fromkeys(range(4), 1))

    # Tests that the cases of a node that dies are run again, and that those of the other node and those that
    # ended are not.
    def test_dead_node(self):
        driver = self.start_on_slurm("--sbatch=--no-requeue", free=4)
        self.wait_for_begun(8)
        self.cluster.kill_node("n1")
        self.open_gate()
        self.check_end(driver)
        self.assertEqual(len(self.arrays()), 2, driver.report())
        self.cluster.start_node("n1")
        self.wait_until(lambda: self.cluster.node_states()["n1"] == "idle", "n1 is back")


class NoSlurmTest(stack.TestCase):
    # Tests that a machine without Slurm says so in one line.
    def test_no_sbatch(self):
        with open(self.path("study.toml"), "w", encoding="utf-8") as file:
            file.write('draws = 2\n[[step]]\nrun = ["/bin/true"]\n[[draw]]\nkey = "x"\ndistribution = "uniform"\nmin = 0\nmax = 1\n')
        path = os.environ["PATH"]
        os.environ["PATH"] = self.folder
        self.addCleanup(os.environ.update, PATH=path)
        driver = self.run_program("hydro-batch", self.path("study.toml"), "--out", self.path("out"), "--slurm", expect=2)
        self.assertRegex(driver.stderr, r"\Ahydro-batch: --slurm: found no sbatch on this machine, .*\n\Z")


if __name__ == "__main__":
    outcome.main()
