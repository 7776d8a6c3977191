"""Tests that a skip is never counted as a pass: what outcome.main() exits with, what ctest and scripts/run-tests make of it,
and that each end-to-end test is set up so."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import outcome

HERE = pathlib.Path(__file__).resolve().parent
RUN_TESTS = HERE.parents[1] / "scripts" / "run-tests"
BUILD = os.environ.get("HYDRO_BUILD")

TESTS = {
    "passes": "def test_a(self): pass",
    "skips_itself": "def test_a(self): self.skipTest('no board here')",
    "skips_one_of_two": "def test_a(self): self.skipTest('no board here')\n    def test_b(self): pass",
    "skips_a_part": "def test_a(self):\n        with self.subTest('x'): self.skipTest('no board here')",
    "skips_and_fails": "def test_a(self): self.skipTest('no board here')\n    def test_b(self): self.fail()",
    "fails": "def test_a(self): self.fail()",
    "is_empty": "pass",
}


def tests_of(build):
    """(command, properties) of each test of a build folder."""
    listing = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    for test in json.loads(listing.stdout)["tests"]:
        properties = {p["name"]: p["value"] for p in test.get("properties", [])}
        yield test.get("command", []), {name: "".join(value) if isinstance(value, list) else str(value)
                                        for name, value in properties.items()}


def is_program(command):
    """Whether a test runs a GoogleTest program."""
    return any(word.endswith("_test") for word in command)


class OutcomeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="hydro-outcome-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, body in TESTS.items():
            (self.folder / f"{name}.py").write_text(
                f"import sys\nsys.path.insert(0, {str(HERE)!r})\nimport outcome\nimport unittest\n"
                f"class ATest(unittest.TestCase):\n    {body}\noutcome.main()\n")

    def run_file(self, name):
        return subprocess.run([sys.executable, "-B", str(self.folder / f"{name}.py")], capture_output=True, text=True, check=False)

    # Tests the exit code of each outcome: only a complete run without a failure has passed.
    def test_exit_codes(self):
        for name, code in {"passes": 0, "skips_itself": 77, "skips_one_of_two": 77, "skips_a_part": 77, "skips_and_fails": 1,
                           "fails": 1, "is_empty": 1}.items():
            with self.subTest(name):
                run = self.run_file(name)
                self.assertEqual(run.returncode, code, run.stderr)

    # Tests that the reason is printed, and the number of skipped tests where only some were skipped.
    def test_reasons(self):
        self.assertRegex(self.run_file("skips_itself").stderr, r"(?m)^SKIPPED test_a .*: no board here$")
        partly = self.run_file("skips_one_of_two").stderr
        self.assertRegex(partly, r"(?m)^SKIPPED test_a .*: no board here$")
        self.assertRegex(partly, r"(?m)^SKIPPED 1 of 2 tests; the others passed$")
        self.assertNotIn("SKIPPED", self.run_file("passes").stderr)

    # Tests that ctest says "Skipped", that scripts/run-tests gives the reason before ctest's summary, and
    # that a failure stays one.
    def test_in_ctest(self):
        def run(*names):
            lines = "".join(f'add_test({name} "{sys.executable}" "-B" "{self.folder}/{name}.py")\n'
                            f"set_tests_properties({name} PROPERTIES LABELS e2e SKIP_RETURN_CODE {outcome.SKIPPED})\n"
                            for name in names)
            (self.folder / "CTestTestfile.cmake").write_text(lines)
            return subprocess.run([str(RUN_TESTS), str(self.folder), "e2e"], capture_output=True, text=True, check=False)

        good = run("passes", "skips_itself", "skips_one_of_two")
        self.assertEqual(good.returncode, 0, good.stdout + good.stderr)
        self.assertRegex(good.stdout, r"skips_itself \.*\*\*\*Skipped")
        self.assertRegex(good.stdout, r"passes \.* +Passed")
        self.assertRegex(good.stdout, r"(?m)^skipped: skips_itself: test_a .*: no board here$")
        self.assertRegex(good.stdout, r"(?m)^skipped: skips_one_of_two: test_a .*: no board here\n +1 of 2 tests; the others passed$")
        self.assertNotIn("skipped: passes", good.stdout)
        self.assertRegex(good.stdout, r"(?s)skipped: .*\n100% tests passed, 0 tests failed out of 3\n(?!.*skipped: )")
        bad = run("skips_itself", "skips_and_fails")
        self.assertNotEqual(bad.returncode, 0, bad.stdout)
        self.assertRegex(bad.stdout, r"skips_and_fails \.*\*\*\*Failed")

    # Tests that a GoogleTest program whose tests share a process is "Skipped" when some of them skipped and the
    # others passed, with each one's reason, and that a skip hides neither a failure nor what follows the tests.
    @unittest.skipUnless(BUILD, "needs HYDRO_BUILD, a build folder: ctest sets it")
    def test_programs(self):
        skip = "[ RUN      ] A.B\na_test.cc:7: Skipped\nno board here\n\n[  SKIPPED ] A.B (0 ms)\n"
        passed, listed = "[  PASSED  ] 1 test.\n", "[  SKIPPED ] 1 test, listed below:\n[  SKIPPED ] A.B\n"
        outputs = {"skips": (skip + passed + listed, 0), "passes": (passed, 0),
                   "fails": (skip + passed + listed + "[  FAILED  ] 1 test, listed below:\n[  FAILED  ] A.C\n", 1),
                   "leaks": (skip + passed + listed + "==7==ERROR: LeakSanitizer: detected memory leaks\n", 23)}
        known = {properties.get("SKIP_REGULAR_EXPRESSION", "") for command, properties in tests_of(BUILD) if is_program(command)}
        together = [expression for expression in known if "PASSED" in expression]
        if not together:
            self.skipTest("this build runs each test in a process of its own (HYDRO_UNITY is off)")
        lines = ""
        for name, (text, code) in outputs.items():
            (self.folder / f"{name}.py").write_text(f"import sys\nsys.stdout.write({text!r})\nsys.exit({code})\n")
            lines += f'add_test({name} "{sys.executable}" "{self.folder}/{name}.py")\n' \
                     f"set_tests_properties({name} PROPERTIES LABELS unit SKIP_REGULAR_EXPRESSION [==[{together[0]}]==])\n"
        (self.folder / "CTestTestfile.cmake").write_text(lines)
        run = subprocess.run([str(RUN_TESTS), str(self.folder), "unit"], capture_output=True, text=True, check=False)
        for name, result in {"skips": "Skipped", "passes": "Passed", "fails": "Failed", "leaks": "Failed"}.items():
            self.assertRegex(run.stdout, rf" {name} \.*[* ]+{result}")
        self.assertRegex(run.stdout, r"(?m)^skipped: skips: A\.B: no board here$")
        self.assertNotEqual(run.returncode, 0)

    # Tests that every end-to-end test ends with outcome.main().
    def test_all_end_so(self):
        for path in sorted(HERE.glob("*_test.py")):
            if path != pathlib.Path(__file__).resolve():
                self.assertTrue(path.read_text().endswith('if __name__ == "__main__":\n    outcome.main()\n'), path.name)

    # Tests that ctest knows the exit code of each of them, and GoogleTest's message about skips for each of its
    # programs. In a program that runs whole experiments a skip is a failure.
    @unittest.skipUnless(BUILD, "needs HYDRO_BUILD, a build folder: ctest sets it")
    def test_ctest_knows(self):
        python, programs = 0, 0
        for command, properties in tests_of(BUILD):
            scripts = [pathlib.Path(word) for word in command if word.endswith(".py")]
            if any(path.parent == HERE and path.name.endswith("_test.py") for path in scripts):
                self.assertEqual(properties.get("SKIP_RETURN_CODE"), str(outcome.SKIPPED), command)
                python += 1
            elif is_program(command):
                self.assertIn("SKIPPED", properties.get("SKIP_REGULAR_EXPRESSION", properties.get("FAIL_REGULAR_EXPRESSION", "")), command)
                programs += 1
            elif properties.get("SKIP_RETURN_CODE") == str(outcome.SKIPPED):  # tests of other folders that end like these
                for script in scripts:
                    text = script.read_text()
                    self.assertTrue("outcome.main()" in text or "skip" not in text, command)
            else:  # what is run otherwise never skips
                for script in scripts:
                    self.assertNotIn("skip", script.read_text(), command)
        self.assertEqual(python, len(list(HERE.glob("*_test.py"))))
        self.assertGreater(programs, 10)


if __name__ == "__main__":
    outcome.main()
