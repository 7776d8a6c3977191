"""The study of machines that others built (examples/machines): what it writes of measurements, and of those that are not there."""

import os
import re
import subprocess
import sys
import unittest

import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
STUDY = os.path.join(ROOT, "examples", "machines", "machines.py")
DATA = os.environ.get("HYDRO_DATA", "")
FOLDERS = ("buoy_pto", "hsm150", "eha_cylinder", "ak80_pendulum", "kinova_joint7")
LONG = 500  # s; 20 on a quiet machine


class MachinesTest(stack.TestCase):
    def study(self, *arguments):
        return subprocess.run([sys.executable, "-B", STUDY, *arguments, "--diagnose", stack.program("hydro-diagnose"), "--out",
                               self.path("out")], capture_output=True, text=True, timeout=LONG, check=False)

    # Tests that the page says for each machine which measurements are missing, and where they can be found.
    def test_without_measurements(self):
        os.mkdir(self.path("empty"))
        run = self.study(self.path("empty"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stdout.count("The measurements were not there."), len(FOLDERS))
        self.assertEqual(run.stdout.count("- Source: github.com/"), len(FOLDERS))

    # Tests that mistakes are reported in one line.
    def test_mistakes(self):
        for arguments, said in ((["."] + ["--machine", "emps"], "found 'emps', allowed one of buoy_pto"),
                                ([self.path("none")], "found no such file, allowed a folder of measurements")):
            run = self.study(*arguments)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn(said, run.stderr)
            self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    # Tests that a machine's section has what the report says: the verdict, everything that the recordings
    # show, gaps, and what remains open.
    @unittest.skipUnless(os.path.isdir(os.path.join(DATA, "ak80_pendulum")),
                         "the measured data are not here: examples/machines/README.md says where they are")
    def test_one_machine(self):
        run = self.study(DATA, "--machine", "ak80_pendulum")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"\*\*(named|tied|partly|parameters|unexplained|nothing_missing)\*\* \(")
        self.assertIn("| Coulomb friction of about 0.2 N m |", run.stdout)
        for seconds in ("0.1", "0.4", "1.6"):
            self.assertRegex(run.stdout, rf"\| {re.escape(seconds)} s \| [\d.e+]+ \| ")
        self.assertIn("\nOpen: ", run.stdout)
        self.assertTrue(os.path.exists(os.path.join(self.path("out"), "ak80_pendulum", "report.html")))


if __name__ == "__main__":
    outcome.main()
