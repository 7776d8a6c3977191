"""How tests are run on a machine that may stand still: steady.py repeats what failed on one that did, and nothing else."""

import os
import subprocess
import sys
import tempfile
import unittest

import outcome

STEADY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "steady.py")
NEVER, ALWAYS = "1e9", "-1"  # --late: no machine is ever that late; each is


class SteadyTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="hydro-e2e-")
        self.addCleanup(self.folder.cleanup)
        self.runs = os.path.join(self.folder.name, "runs")

    def steady(self, late, script):
        """The result of a shell script under steady.py; it finds the number of its run in $run."""
        command = f'echo >> {self.runs}; run=$(wc -l < {self.runs}); {script}'
        return subprocess.run([sys.executable, "-B", STEADY, "--late", late, "sh", "-c", command], capture_output=True,
                              text=True, check=False)

    def count(self):
        with open(self.runs, encoding="utf-8") as file:
            return len(file.readlines())

    # Tests that a test that fails on a steady machine has failed, at once.
    def test_steady_machine(self):
        self.assertEqual(self.steady(NEVER, "exit 1").returncode, 1)
        self.assertEqual(self.count(), 1)

    # Tests that a test that fails three times has failed, whatever the machine did.
    def test_always_fails(self):
        failed = self.steady(ALWAYS, "exit 3")
        self.assertEqual(failed.returncode, 3)
        self.assertEqual(self.count(), 3)
        self.assertRegex(failed.stderr, "stood still for .* ms while this test ran: run 3 of 3")

    # Tests that a test that passes on repetition has passed, and that it is not repeated after that.
    def test_passes_later(self):
        self.assertEqual(self.steady(ALWAYS, 'test "$run" -ge 2').returncode, 0)
        self.assertEqual(self.count(), 2)

    # Tests that a test that passed or was skipped is not repeated.
    def test_passed(self):
        self.assertEqual(self.steady(ALWAYS, "exit 0").returncode, 0)
        self.assertEqual(self.steady(ALWAYS, "exit 77").returncode, 77)
        self.assertEqual(self.count(), 2)

    # Tests that a standstill of the machine is noticed: this process stops steady.py for 0.3 s, on a busy
    # machine before it has heard that its child runs.
    def test_standing_still_is_seen(self):
        script = 'if [ "$run" = 1 ]; then kill -STOP $PPID; sleep 0.3; kill -CONT $PPID; exit 1; fi'
        self.assertEqual(self.steady("0.2", script).returncode, 0)
        self.assertEqual(self.count(), 2)

    # Tests that a standstill of one processor is noticed, beside others that run: a process of real-time priority takes it.
    def test_one_processor_standing_still_is_seen(self):
        taken = min(os.sched_getaffinity(0))
        burn = (f"import os, time; os.sched_setaffinity(0, {{{taken}}}); os.sched_setscheduler(0, os.SCHED_FIFO, "
                "os.sched_param(50)); end = time.monotonic() + 0.3\nwhile time.monotonic() < end: pass")
        if subprocess.run([sys.executable, "-c", burn], capture_output=True, check=False).returncode:
            self.skipTest("no permission for real-time priority")
        script = f'if [ "$run" = 1 ]; then {sys.executable} -c "{burn}"; exit 1; fi'
        self.assertEqual(self.steady("0.2", script).returncode, 0)
        self.assertEqual(self.count(), 2)

    # Tests that a test that was ended by a signal has failed, as in a shell.
    def test_signal(self):
        self.assertEqual(self.steady(NEVER, "kill -SEGV $$").returncode, 128 + 11)


if __name__ == "__main__":
    outcome.main()
