"""The rules of bench/foreign_score.py."""

import importlib.util
import pathlib
import sys
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[2] / "bench"
sys.path.insert(0, str(BENCH))  # it has modules of its own beside it
import foreign_explanations  # noqa: E402

_spec = importlib.util.spec_from_file_location("foreign_score", BENCH / "foreign_score.py")
foreign_score = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(foreign_score)


def key(kind, effects=(), what="", outside=None, gap=8.0, remark=()):
    return {"class": kind, "what": what, "gap": gap, "gap_reached": True, "effects": [{"id": e, "parameters": {}} for e in effects],
            "outside": outside, "remark": list(remark)}


def report(verdict, effects=(), **further):
    return {"verdict": verdict, "effects": [{"id": e, "tied_with": list(ties)} for e, ties in effects], "parameters": [],
            "gap": {"held_out": {"before": 9, "refit_only": 5, "after": 1.0}}, **further}


def scored(k, r):
    return {**foreign_score.score(k, r, "", 1.0), "name": "case", "number": 1}


class Rules(unittest.TestCase):
    # Tests that an effect counts in each of the three verdicts, or by its tie class, and in no other verdict.
    def test_single(self):
        k = key("single", ["amp.lag"])
        for verdict in ("named", "tied", "partly"):
            self.assertTrue(scored(k, report(verdict, [("amp.lag", [])]))["right"])
        self.assertTrue(scored(k, report("tied", [("amp.delay", ["amp.lag"])]))["right"])
        self.assertFalse(scored(k, report("unexplained", [("amp.lag", [])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.delay", [])]))["right"])
        both = scored(k, report("partly", [("amp.lag", []), ("valve.relief", [])]))
        self.assertTrue(both["right"])
        self.assertEqual(both["extra"], 1)
        self.assertFalse(foreign_score.score(k, None, "not done in 150 s", 150.0)["right"])

    # Tests that an effect of one signal must be seen on it.
    def test_signal(self):
        k = key("single", ["sensor.skew"])
        k["effects"][0]["signal"] = "p2"
        r = report("named", [("sensor.skew", [])])
        r["effects"][0]["names"] = ["signal = p2"]
        self.assertTrue(scored(k, r)["right"])
        r["effects"][0]["names"] = ["signal = p1"]
        self.assertFalse(scored(k, r)["right"])

    # Tests that a pair needs both.
    def test_pair(self):
        k = key("pair", ["amp.lag", "valve.relief"])
        self.assertTrue(scored(k, report("partly", [("valve.relief", []), ("amp.lag", [])]))["right"])
        one = scored(k, report("partly", [("amp.lag", [])]))
        self.assertFalse(one["right"])
        self.assertTrue(one["half"])

    # Tests that any effect is a mistake where nothing is missing, and that other values or silence are none.
    def test_nothing(self):
        k = key("nothing", what="daily")
        self.assertTrue(scored(k, report("partly", [("amp.lag", [])]))["any_effect"])
        for verdict in ("parameters", "partly", "unexplained", "nothing_missing"):
            self.assertFalse(scored(k, report(verdict))["any_effect"])

    # Tests that a bias may be tied with an asymmetry but not be called one.
    def test_bias(self):
        k = key("bias", ["amp.bias"])
        self.assertTrue(scored(k, report("tied", [("pump.friction_asymmetry", ["amp.bias"])]))["right"])
        wrong = scored(k, report("named", [("pump.friction_asymmetry", [])]))
        self.assertTrue(wrong["instead"])
        self.assertFalse(scored(k, report("unexplained"))["instead"])

    # Tests that a newcomer's mistake needs a remark with a word of each group, in one remark.
    def test_newcomer(self):
        k = key("newcomer", what="bar", remark=[["p1", "p2"], ["bar", "14.5"]])
        self.assertTrue(scored(k, report("unexplained", remarks=["run1: p1 looks like Bar: scale = 14.5038"]))["right"])
        self.assertFalse(scored(k, report("unexplained", remarks=["p1 is noisy", "a barrier"]))["right"])
        named = scored(k, report("named", [("fluid.entrained_air", [])], remarks=["p1 and p2 are in bar"]))
        self.assertTrue(named["remarked"])
        self.assertTrue(named["instead"])
        self.assertFalse(named["right"])
        self.assertFalse(scored(k, report("named", [("sensor.pressure_gain", [])]))["instead"])

    # Tests that only `named` is a confident wrong name, and what a closure takes of the squared gap.
    def test_outside(self):
        k = key("outside", outside={"what": "a spring", "balance": "arm_torque", "function_of": "arm_angle"})
        self.assertTrue(scored(k, report("named", [("amp.lag", [])]))["confident_wrong"])
        self.assertFalse(scored(k, report("partly", [("amp.lag", [])]))["confident_wrong"])
        closed = scored(k, report("unexplained", closure={"id": "closure.arm_torque", "held_out": {"before": 10, "after": 5}}))
        self.assertAlmostEqual(closed["closure"], 0.75)
        self.assertIsNone(scored(k, report("unexplained", closure=None))["closure"])

    # Tests the bounds against Clopper and Pearson's closed forms at the ends, and a tabled value between.
    def test_bounds(self):
        self.assertAlmostEqual(foreign_score.bound(20, 20, upper=False), 0.05 ** (1 / 20), places=6)
        self.assertAlmostEqual(foreign_score.bound(0, 20, upper=True), 1 - 0.05 ** (1 / 20), places=6)
        self.assertAlmostEqual(foreign_score.bound(5, 10, upper=False), 0.2224, places=4)
        self.assertAlmostEqual(foreign_score.bound(5, 10, upper=True), 0.7776, places=4)
        self.assertIsNone(foreign_score.bound(0, 0, upper=True))
        # Binomial coefficients that no float holds: the normal approximation of the bound at 2000 +- 37 of 4000.
        self.assertAlmostEqual(foreign_score.bound(2000, 4000, upper=False), 0.5 - 1.645 * (0.25 / 4000) ** 0.5, places=3)

    # Tests the table of weights: by bins, an explanation of two effects as a whole, other values where nothing is missing, closures left out.
    def test_reliability(self):
        candidates = [{"id": "amp.lag", "weight": 0.95}, {"id": "amp.delay", "weight": 0.05}, {"id": "valve.relief"},
                      {"id": "closure.flow_1", "weight": 0.5}]
        single = scored(key("single", ["amp.lag"]), report("named", [("amp.lag", [])], candidates=candidates))
        pair = scored(key("pair", ["amp.lag", "valve.relief"]),
                      report("named", candidates=[{"id": "valve.relief + amp.lag", "weight": 1.0}, {"id": "amp.lag", "weight": 0.0}]))
        nothing = scored(key("nothing"), report("parameters", candidates=[{"id": "amp.lag", "weight": 0.05}, {"id": "parameters", "weight": 0.95}]))
        rows = foreign_score.reliability([single, pair, nothing])
        self.assertEqual([(low, good, n) for low, _, _, good, n, _ in rows], [(0, 0, 3), (0.9, 3, 3)])

    # Tests the limits of the goals: at 3 noise units, nine of ten, and one in twenty.
    def test_goals(self):
        met = lambda outcomes, what: next(c for c in foreign_score.judge(outcomes) if what in c["what"])["met"]
        good = scored(key("single", ["amp.lag"], gap=3.0), report("named", [("amp.lag", [])]))
        bad = scored(key("single", ["amp.lag"], gap=3.0), report("unexplained"))
        small = scored(key("single", ["amp.lag"], gap=2.9), report("unexplained"))
        self.assertTrue(met([good] * 19 + [bad, small], "single effects"))
        self.assertFalse(met([good] * 18 + [bad] * 2, "single effects"))
        calm, wrong = scored(key("nothing"), report("parameters")), scored(key("nothing"), report("tied", [("amp.lag", [])]))
        self.assertTrue(met([calm] * 49 + [wrong], "nothing missing"))
        self.assertFalse(met([calm] * 48 + [wrong] * 2, "nothing missing"))
        self.assertIsNone(met([calm], "single effects"))
        lost = {**foreign_score.score(key("nothing"), None, "not done in 150 s", 150.0), "name": "case", "number": 1}
        self.assertIsNone(met([lost] * 3, "nothing missing"))
        self.assertFalse(met([lost, calm], "ended with a report"))
        slow = dict(good, seconds=31.0)
        self.assertFalse(met([good] * 9 + [slow], "seconds, worst"))
        self.assertTrue(met([good] * 9 + [slow], "seconds, median"))

    # Tests that gaps by horizon are medians of those reports that have them.
    def test_horizons(self):
        r = report("named", [("amp.lag", [])])
        r["gap"]["horizons"] = [{"seconds": 0.1, "held_out": {"before": 9, "refit_only": 4, "after": 1.2}}]
        rows = foreign_score.by_horizon([scored(key("single", ["amp.lag"]), r), scored(key("single", ["amp.lag"]), report("unexplained"))])
        self.assertEqual(rows, [("right", 0.1, 1, [9, 4, 1.2])])

    # Tests which explanations are right: the true effects and no others, whatever values differ; a closure on the right element.
    def test_explanations(self):
        k = key("single", ["sensor.skew"])
        k["effects"][0]["signal"] = "p2"
        for changes, right in ((["sensor.skew(p2)"], True), (["sensor.skew", "value.T_s", "run.mgl"], True), (["sensor.skew (p1)"], False),
                               (["sensor.skew(p2)", "amp.lag"], False), (["sensor.skew", "closure.flow_1(dp)"], False), (["T_s"], False), ([], False)):
            self.assertEqual(foreign_explanations.explains(k, changes), right, changes)
        self.assertTrue(foreign_explanations.explains(key("nothing"), ["T_s"]))
        self.assertFalse(foreign_explanations.explains(key("nothing"), ["amp.lag"]))
        outside = key("outside", outside={"what": "a worn place", "balance": "flow_1", "function_of": "arm_angle, dp"})
        self.assertTrue(foreign_explanations.explains(outside, ["closure.flow_2(dp)"]))
        self.assertFalse(foreign_explanations.explains(outside, ["closure.arm_torque(arm_angle)"]))
        film = key("outside", outside={"what": "a film", "balance": "pump_torque", "function_of": "motor_speed", "catalogue": "pump.shear_thinning"})
        for said, right in ((["pump.shear_thinning"], True), (["closure.pump_torque(motor_speed)"], True), (["amp.lag"], False),
                            (["pump.shear_thinning", "amp.lag"], False)):
            self.assertEqual(foreign_explanations.explains(film, said), right, said)
            found = [(one, []) for one in said if not one.startswith("closure.")]
            outcome = scored(film, report("named", found))
            self.assertEqual(outcome["confident_wrong"], bool(found) and not right, said)
        self.assertFalse(foreign_explanations.explains(outside, ["closure.flow_1(dp)", "amp.lag"]))
        self.assertIsNone(foreign_explanations.explains(key("outside", outside={"what": "play", "balance": "arm_torque", "function_of": ""}), []))
        self.assertIsNone(foreign_explanations.explains(key("newcomer", what="bar"), []))

    # Tests weights of explanations, those that differ in values as one, and whether the set of 90 % holds the truth.
    def test_sets(self):
        said = [{"changes": ["amp.delay"], "weight": 0.5}, {"changes": ["amp.lag"], "weight": 0.3}, {"changes": ["amp.lag", "T_s"], "weight": 0.15},
                {"changes": ["nothing"], "weight": 0.05}]
        wide = scored(key("single", ["amp.lag"]), report("tied", [("amp.lag", [])], explanations=said, set_90=2))
        self.assertEqual([(round(w, 6), right) for w, right in wide["explanations"]], [(0.5, False), (0.45, True), (0.05, False)])
        self.assertEqual(wide["set_90"], {"size": 2, "holds": True})
        narrow = scored(key("single", ["amp.lag"]), report("tied", explanations=said, set_90=1))
        self.assertEqual(narrow["set_90"], {"size": 1, "holds": False})
        old = scored(key("single", ["amp.lag"]), report("tied"))
        self.assertEqual((old["explanations"], old["set_90"]), ([], None))
        rows = foreign_score.reliability([wide, old], "explanations")
        self.assertEqual([(low, good, n) for low, _, _, good, n, _ in rows], [(0, 0, 1), (0.3, 1, 1), (0.5, 0, 1)])
        criteria = {c["what"]: c for c in foreign_score.judge([wide, narrow, old])}
        self.assertEqual(criteria["sets of 90 % that hold the truth"]["was"], "1 of 2")
        self.assertIn("sets of 90 %: 1 of 2", foreign_score.table([{**o, "name": "case"} for o in (wide, narrow, old)], list(criteria.values()), 1.0))
        self.assertIsNone({c["what"]: c for c in foreign_score.judge([old])}["sets of 90 % that hold the truth"]["met"])


if __name__ == "__main__":
    unittest.main()
