"""bench/gap_score with stand-ins for the rig and the gap finder."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCORE = pathlib.Path(__file__).resolve().parents[2] / "bench" / "gap_score"

RIG = """#!{python}
import json, pathlib, sys
if "--list" in sys.argv:
    print("1 amp.lag-8 single 5\\n2 daily-1 nothing 6")
    sys.exit(0)
value = lambda name: sys.argv[sys.argv.index(name) + 1]
assert "--rate" not in sys.argv and value("--seconds") == "5"
out = pathlib.Path(value("--out"))
out.mkdir(parents=True, exist_ok=True)
for name in ("run1", "held1"):
    (out / (name + ".csv")).write_text("time\\n0\\n")
(out / "model.toml").write_text("")
effects = [] if "daily" in value("--case") else [{{"id": "amp.lag", "parameters": {{}}}}]
pathlib.Path(value("--key")).write_text(json.dumps({{"class": "single" if effects else "nothing", "what": "" if effects else "daily", "gap": 8, "gap_reached": True,
    "effects": effects, "outside": None, "remark": []}}))
"""
FINDER = """#!{python}
import json, pathlib, sys
held_out = [sys.argv[i + 1] for i, word in enumerate(sys.argv) if word == "--hold-out"]
assert [pathlib.Path(h).name for h in held_out] == ["held1.csv"], sys.argv
assert sum("run1.csv" in word for word in sys.argv) == 1
model = pathlib.Path(sys.argv[sys.argv.index("--model") + 1])
result = {report}
if "--effects" in sys.argv:
    assert pathlib.Path(sys.argv[sys.argv.index("--effects") + 1]).read_text() == 'effects = ["amp.lag"]\\n'
    assert ("amp.lag" in model.read_text()) == (model.name == "true_form.toml")
    result["gap"]["horizons"][0]["held_out"] = {{"refit_only": 0.5, "after": 0.6}}
pathlib.Path(sys.argv[sys.argv.index("--out") + 1], "report.json").write_text(json.dumps(result))
"""


class Program(unittest.TestCase):
    def run_score(self, folder, finder, *options):
        folder = pathlib.Path(folder)
        for name, text in (("hydro-foreign-rig", RIG.format(python=sys.executable)), ("finder", finder)):
            (folder / name).write_text(text)
            (folder / name).chmod(0o755)
        return subprocess.run([sys.executable, "-B", str(SCORE), "--bin", str(folder), "--diagnose", str(folder / "finder"),
                               "--out", str(folder / "out"), *options], capture_output=True, text=True)

    # Tests the whole way: runs held out are passed as such, the table names the miss, and the exit code says that a goal was missed.
    def test_names_the_misses(self):
        ends = [{"seconds": 0.4, "held_out": {"refit_only": 2.0, "after": 1.0}}]
        report = {"verdict": "named", "effects": [{"id": "amp.lag", "tied_with": []}], "parameters": [],
                  "gap": {"held_out": {"before": 9, "refit_only": 5, "after": 1.0}, "horizons": ends}}
        finder = FINDER.format(python=sys.executable, report=report)
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, finder)
            self.assertEqual(ended.returncode, 1, ended.stderr)
            self.assertIn("case (gap as made)", ended.stdout)
            self.assertIn("daily-1 (8) | nothing missing", ended.stdout)
            self.assertIn("2 ended with a report", ended.stdout)
            self.assertIn("seeds + 0, for development", ended.stdout)
            cases = json.loads((pathlib.Path(folder) / "out/score.json").read_text())["cases"]
            self.assertEqual([case["oracle"]["ratio"] for case in cases], [2.0, 0.5])

    # Tests that without a miss the exit code is 0, and that --only leaves out the others.
    def test_all_met(self):
        report = {"verdict": "named", "effects": [{"id": "amp.lag", "tied_with": []}], "parameters": [], "gap": {"horizons": [{}]}}
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, FINDER.format(python=sys.executable, report=report), "--only", "amp.lag*", "--oracle", "none")
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            self.assertIn("1 ended with a report", ended.stdout)

    # Tests that a finder that fails or does not end is a miss with its reason, and that scoring continues.
    def test_failures_are_misses(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, "#!/bin/sh\necho 'run.csv: no time' >&2\nexit 2\n")
            self.assertEqual(ended.returncode, 1)
            self.assertIn("daily-1 (8) | nothing missing (daily) | exit 2: run.csv: no time", ended.stdout)
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, "#!/bin/sh\nexec sleep 20\n", "--time-limit", "0.3")
            self.assertIn("not done in 0.3 s", ended.stdout)

    # Tests that having nothing to run is reported.
    def test_bad_use(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run([sys.executable, "-B", str(SCORE), "--bin", folder], capture_output=True, text=True)
            self.assertEqual(ended.returncode, 2)
            self.assertIn("hydro-foreign-rig", ended.stderr)
            ended = self.run_score(folder, "", "--only", "no.such.case")
            self.assertEqual(ended.returncode, 2)


if __name__ == "__main__":
    unittest.main()
