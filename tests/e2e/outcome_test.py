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

    # Tests that every end-to-end test ends with outcome.main().
    def test_all_end_so(self):
        for path in sorted(HERE.glob("*_test.py")):
            if path != pathlib.Path(__file__).resolve():
                self.assertTrue(path.read_text().endswith('if __name__ == "__main__":\n    outcome.main()\n'), path.name)

    # Tests that ctest knows the exit code of each of them, and also GoogleTest's message about skips for each
    # test that it runs alone. With several tests in one process ctest would only see that none failed, so
    # there a skip is a failure.
    @unittest.skipUnless(BUILD, "needs HYDRO_BUILD, a build folder: ctest sets it")
    def test_ctest_knows(self):
        listing = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], capture_output=True, text=True, check=True)
        python, alone, together = 0, 0, 0
        for test in json.loads(listing.stdout)["tests"]:
            properties = {p["name"]: str(p["value"]) for p in test.get("properties", [])}
            command = test.get("command", [])
            if any(word.startswith(f"{HERE}/") and word.endswith("_test.py") for word in command):
                self.assertEqual(properties.get("SKIP_RETURN_CODE"), str(outcome.SKIPPED), test["name"])
                python += 1
            elif any(word.startswith("--gtest_filter=") and "*" not in word for word in command):
                self.assertIn("SKIPPED", properties.get("SKIP_REGULAR_EXPRESSION", ""), test["name"])
                alone += 1
            elif "SKIPPED" in properties.get("FAIL_REGULAR_EXPRESSION", ""):
                together += 1
            elif properties.get("SKIP_RETURN_CODE") == str(outcome.SKIPPED):  # tests of other folders that end like these
                for script in (word for word in command if word.endswith(".py")):
                    text = pathlib.Path(script).read_text()
                    self.assertTrue("outcome.main()" in text or "skip" not in text, test["name"])
            else:  # what is run otherwise never skips
                for script in (word for word in command if word.endswith(".py")):
                    self.assertNotIn("skip", pathlib.Path(script).read_text(), test["name"])
        self.assertEqual(python, len(list(HERE.glob("*_test.py"))))
        self.assertGreater(together, 0)


if __name__ == "__main__":
    outcome.main()
