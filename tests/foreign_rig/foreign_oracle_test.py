"""What bench/foreign_oracle.py tells the gap finder, and how it compares what comes of it."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
sys.dont_write_bytecode = True  # nothing is left behind in the source
import foreign_oracle  # noqa: E402


def key(kind, effects=(), what="", outside=None):
    return {"class": kind, "what": what, "effects": [{"id": e, "parameters": {}} for e in effects], "outside": outside}


def with_horizon(refit_only, after, seconds=0.4):
    return {"gap": {"horizons": [{"seconds": 0.1, "held_out": {"refit_only": 99, "after": 98}},
                                 {"seconds": seconds, "held_out": {"before": 50, "refit_only": refit_only, "after": after}}]}}


class Oracle(unittest.TestCase):
    # Tests the ratio: over the better of both oracles, over the own refit where nothing is missing, none outside the catalogue.
    def test_ratio(self):
        k = key("single", ["amp.lag"])
        compared = foreign_oracle.compare(k, with_horizon(9, 3), with_horizon(2, 1.9), with_horizon(9, 2.5))
        self.assertEqual(compared, {"gap": 3, "oracle": 2, "ratio": 1.5})
        self.assertEqual(foreign_oracle.compare(k, with_horizon(9, 3), None, with_horizon(9, 1.5))["ratio"], 2)
        self.assertEqual(foreign_oracle.compare(key("nothing"), with_horizon(2, 2.5), None, None)["ratio"], 1.25)
        self.assertIsNone(foreign_oracle.compare(k, with_horizon(9, 3), None, None))
        self.assertIsNone(foreign_oracle.compare(k, with_horizon(9, 3, seconds=1.6), with_horizon(2, 2), None))
        self.assertIsNone(foreign_oracle.compare(k, with_horizon(9, None), with_horizon(2, 2), None))
        self.assertIsNone(foreign_oracle.compare(key("outside", outside={"what": "play"}), with_horizon(9, 3), None, None))
        self.assertIsNone(foreign_oracle.compare(key("newcomer", what="bar"), with_horizon(9, 3), None, None))
        self.assertIsNone(foreign_oracle.compare(k, None, with_horizon(2, 2), None)["ratio"])

    # Tests median and 90th percentile, that a diagnosis that never ended is worse than any, and that no oracle is no goal.
    def test_goals(self):
        case = lambda ratio: {"class": "single", "name": "case", "oracle": {"gap": 1, "oracle": 1, "ratio": ratio}}
        outcomes = [case(1 + 0.04 * i) for i in range(9)] + [case(None)]
        median, most = foreign_oracle.criteria(outcomes)
        self.assertEqual((median["was"], median["met"]), ("1.16", False))
        self.assertEqual((most["was"], most["met"]), ("1.32", False))
        self.assertEqual(foreign_oracle.criteria([case(1.0)] * 8 + [case(1.29), case(9.0)])[1]["met"], True)
        self.assertEqual(foreign_oracle.criteria([case(None)])[0]["was"], "inf")
        self.assertIsNone(foreign_oracle.criteria([{"oracle": None}])[0]["met"])
        self.assertIn("inf", foreign_oracle.lines(outcomes, [("single", outcomes)])[-2])

    # Tests the model that is told: as given, and each true effect with what the catalogue needs.
    def test_model(self):
        k = key("pair", ["valve.relief", "sensor.skew"])
        k["effects"][0].update(parameters={"set": 700}, nearest={"set": 700, "conductance": 0.01})
        k["effects"][1].update(parameters={"delay": 0.002}, signal="p2")
        text = foreign_oracle.model_text(k, '[parameters]\nk_1 = 4\n')
        self.assertEqual(text, '[parameters]\nk_1 = 4\n\n[effects."valve.relief"]\nset = 700\nconductance = 0.01\n\n'
                               '[effects."sensor.skew"]\ndelay = 0.002\nsignal = "p2"\n')
        self.assertEqual(foreign_oracle.effects_text(k), 'effects = ["valve.relief", "sensor.skew"]\n')
        self.assertIsNone(foreign_oracle.model_text(key("nothing"), ""))


if __name__ == "__main__":
    unittest.main()
