"""The scoring rules of bench/gap_score, and the program itself with stand-ins for the rig and the gap finder."""

import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCORE = pathlib.Path(__file__).resolve().parents[2] / "bench" / "gap_score"
_loader = importlib.machinery.SourceFileLoader("gap_score", str(SCORE))
gap_score = importlib.util.module_from_spec(importlib.util.spec_from_loader("gap_score", _loader))
_loader.exec_module(gap_score)


def key(kind, effects=(), parameters=(), outside=None):
    return {"class": kind, "size": "plain", "noise": 1, "gap": 15, "gap_reached": True,
            "effects": [{"id": e, "parameters": {"tau": 2.0}} for e in effects], "parameters": list(parameters),
            "outside": outside}


def report(verdict, effects=(), parameters=(), after=1.0):
    return {"verdict": verdict, "parameters": list(parameters),
            "effects": [{"id": e, "tied_with": list(ties), "parameters": {"tau": {"value": 2.1, "ci95": [1.9, 2.3]}}}
                        for e, ties in effects],
            "gap": {"held_out": {"before": 9, "refit_only": 5, "after": after}}}


def scored(k, r):
    return gap_score.score(k, r, "", 1.0)


class Rules(unittest.TestCase):
    # Tests that a single effect counts when named, or when tied with the one named, and not with extras.
    def test_single(self):
        k = key("single", ["amp.lag"])
        self.assertTrue(scored(k, report("named", [("amp.lag", [])]))["right"])
        self.assertTrue(scored(k, report("tied", [("amp.delay", ["amp.lag"])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.delay", [])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.lag", []), ("valve.relief", [])]))["right"])
        self.assertFalse(scored(k, report("unexplained"))["right"])
        self.assertFalse(gap_score.score(k, None, "exit 2: no", 1.0)["right"])

    # Tests that an effect of one channel must be seen on that channel.
    def test_signal(self):
        k = key("single", ["sensor.skew"])
        k["effects"][0]["signal"] = "p2"
        r = report("named", [("sensor.skew", [])])
        r["effects"][0]["names"] = ["signal = p2"]
        self.assertTrue(scored(k, r)["right"])
        r["effects"][0]["names"] = ["signal = p1"]
        self.assertFalse(scored(k, r)["right"])

    # Tests that a table of weights says how often what had a weight was right, and that shares have their bounds.
    def test_weights_and_bounds(self):
        r = report("named", [("amp.lag", [])])
        r["candidates"] = [{"id": "amp.lag", "weight": 0.95}, {"id": "amp.delay", "weight": 0.05}, {"id": "amp.bias", "weight": None}]
        outcome = scored(key("single", ["amp.lag"]), r)
        self.assertEqual(outcome["weights"], [(0.95, True), (0.05, False)])
        outcome.update(number=1, name="amp.lag-plain")
        text = gap_score.table([outcome], gap_score.judge([outcome]), 1.0)
        self.assertRegex(text, r"1 of 1 +100 % +>= 5 %")  # 0.05^(1/1)
        self.assertRegex(text, r"0\.9 to 1\.0 +0\.95 +1 of 1 ")

    # Tests that nulls, which stand for missing numbers, are misses and no crash.
    def test_nulls(self):
        k = key("parameter", parameters=[{"name": "b", "true": 0.02, "model": 0.03}])
        r = report("parameters", parameters=[{"name": "b", "fitted": None, "model": 0.03, "ci95": [None, None]}], after=None)
        outcome = scored(k, r)
        self.assertFalse(outcome["right"])
        self.assertEqual(outcome["coverage"], [])
        outcome.update(number=1, name="parameter-b")
        self.assertIn("b = -", gap_score.table([outcome], gap_score.judge([outcome]), 1.0))

    # Tests that pairs need the exact set, in any order, and that a tie is distinguished from it.
    def test_pair(self):
        k = key("pair", ["amp.lag", "valve.relief"])
        self.assertTrue(scored(k, report("named", [("valve.relief", []), ("amp.lag", [])]))["right"])
        tied = scored(k, report("tied", [("valve.relief", []), ("amp.delay", ["amp.lag"])]))
        self.assertFalse(tied["right"])
        self.assertTrue(tied["right_with_ties"])
        self.assertFalse(scored(k, report("named", [("amp.lag", [])]))["right"])

    # Tests that nothing missing is broken by a name, and differently by other values.
    def test_nothing(self):
        self.assertTrue(scored(key("nothing"), report("nothing_missing"))["right"])
        self.assertTrue(scored(key("nothing"), report("named", [("amp.lag", [])]))["false_name"])
        changed = scored(key("nothing"), report("parameters"))
        self.assertFalse(changed["right"])
        self.assertFalse(changed["false_name"])

    # Tests that a wrong value must be found within 5 %.
    def test_parameter(self):
        k = key("parameter", parameters=[{"name": "b", "true": 0.02, "model": 0.03}])
        fitted = lambda value: [{"name": "b", "fitted": value, "model": 0.03, "ci95": [0.019, 0.021]}]
        self.assertTrue(scored(k, report("parameters", parameters=fitted(0.0209)))["right"])
        self.assertFalse(scored(k, report("parameters", parameters=fitted(0.0211)))["right"])
        self.assertFalse(scored(k, report("named", [("amp.lag", [])]))["right"])

    # Tests that an effect outside the catalogue calls for `unexplained`, and that `tied` is wrong but not confident.
    def test_outside(self):
        k = key("outside", outside={"what": "a spring"})
        self.assertTrue(scored(k, report("unexplained"))["right"])
        self.assertTrue(scored(k, report("named", [("amp.lag", [])]))["confident_wrong"])
        self.assertFalse(scored(k, report("tied", [("amp.lag", ["amp.delay"])]))["confident_wrong"])

    # Tests that intervals are counted where the effect is right, a phase by whole turns.
    def test_coverage(self):
        k = key("single", ["amp.lag"])
        self.assertEqual([c["holds"] for c in scored(k, report("named", [("amp.lag", [])]))["coverage"]], [True])
        self.assertEqual(scored(k, report("named", [("amp.delay", [])]))["coverage"], [])
        self.assertTrue(gap_score.interval_holds("phase", 6.2, [-0.2, 0.0]))
        self.assertFalse(gap_score.interval_holds("tau", 6.2, [-0.2, 0.0]))

    # Tests that the limits of the criteria are the limits: 1 false name of 20 is allowed and 2 are not.
    def test_limits(self):
        good = scored(key("nothing"), report("nothing_missing"))
        bad = scored(key("nothing"), report("named", [("amp.lag", [])]))
        false_names = lambda outcomes: next(c for c in gap_score.judge(outcomes) if "false names" in c["what"])["met"]
        self.assertTrue(false_names([good] * 19 + [bad]))
        self.assertFalse(false_names([good] * 18 + [bad] * 2))
        self.assertIsNone(false_names([]))


RIG = """#!{python}
import json, pathlib, sys
if "--list" in sys.argv:
    print("1 amp.lag-plain single 5\\n2 nothing-1 nothing 6")
    sys.exit(0)
value = lambda name: sys.argv[sys.argv.index(name) + 1]
out = pathlib.Path(value("--out"))
out.mkdir(parents=True, exist_ok=True)
(out / "run1.csv").write_text("time_s\\n0\\n")
(out / "model.toml").write_text("")
effects = [] if "nothing" in value("--case") else [{{"id": "amp.lag", "parameters": {{}}}}]
pathlib.Path(value("--key")).write_text(json.dumps({{"class": "single" if effects else "nothing", "size": "", "noise": 1, "gap": 15,
    "gap_reached": True, "effects": effects, "parameters": [], "outside": None}}))
"""
FINDER = """#!{python}
import json, pathlib, sys
pathlib.Path(sys.argv[sys.argv.index("--out") + 1], "report.json").write_text(json.dumps({report}))
"""


class Program(unittest.TestCase):
    def run_score(self, folder, finder, *options):
        folder = pathlib.Path(folder)
        for name, text in (("hydro-hidden-rig", RIG.format(python=sys.executable)), ("finder", finder)):
            (folder / name).write_text(text)
            (folder / name).chmod(0o755)
        return subprocess.run([sys.executable, "-B", str(SCORE), "--bin", str(folder), "--diagnose", str(folder / "finder"),
                               "--out", str(folder / "out"), *options], capture_output=True, text=True)

    # Tests exit codes and that misses are named: a finder that always sees a lag is right once and wrong once.
    def test_names_the_misses(self):
        finder = FINDER.format(python=sys.executable, report=report("named", [("amp.lag", [])]))
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, finder)
            self.assertEqual(ended.returncode, 1, ended.stderr)
            self.assertIn("nothing-1 (15): nothing missing | named: amp.lag", ended.stdout)
            self.assertTrue(json.loads((pathlib.Path(folder) / "out/score.json").read_text())["criteria"])
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, finder, "--only", "amp.lag*")
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    # Tests that a finder that fails or does not end is a miss with its reason, and that scoring continues.
    def test_failures_are_misses(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, "#!/bin/sh\necho 'run.csv: no time' >&2\nexit 2\n")
            self.assertEqual(ended.returncode, 1)
            self.assertIn("exit 2: run.csv: no time", ended.stdout)
        with tempfile.TemporaryDirectory() as folder:
            ended = self.run_score(folder, "#!/bin/sh\nexec sleep 20\n", "--time-limit", "0.3")
            self.assertIn("not done in 0.3 s", ended.stdout)

    # Tests that having nothing to run is reported.
    def test_bad_use(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run([sys.executable, "-B", str(SCORE), "--bin", folder], capture_output=True, text=True)
            self.assertEqual(ended.returncode, 2)
            self.assertIn("hydro-hidden-rig", ended.stderr)
            ended = self.run_score(folder, "", "--only", "no.such.case")
            self.assertEqual(ended.returncode, 2)


if __name__ == "__main__":
    unittest.main()
