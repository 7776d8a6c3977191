"""The rules of bench/foreign_exact.py: what is right on rigs of which all is exact but what is hidden."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
sys.dont_write_bytecode = True  # nothing is left behind in the source
import foreign_exact  # noqa: E402
import foreign_score  # noqa: E402


def key(kind, effects=(), what="", wrong=None, gap=8.0):
    values = [{"name": "b", "true": 0.02, "model": 0.02}, {"name": "J", "true": 0.03, "model": 0.03}]
    if wrong:
        values[0]["model"] = wrong
    return {"class": kind, "what": what, "gap": gap, "gap_reached": True, "effects": [{"id": e, "parameters": {"tau": 2.0}} for e in effects],
            "parameters": values, "outside": None, "remark": []}


def report(verdict, effects=(), parameters=()):
    return {"verdict": verdict, "parameters": list(parameters), "gap": {},
            "effects": [{"id": e, "tied_with": list(ties), "parameters": {"tau": {"value": 2.1, "ci95": [1.9, 2.3]}}} for e, ties in effects]}


def fitted(value, ci95=(0.019, 0.021)):
    return {"name": "b", "model": 0.03, "fitted": value, "ci95": list(ci95)}


def scored(k, r):
    return {**foreign_score.score(k, r, "", 1.0), "name": "case", "number": 1}


def goal(outcomes, words):
    return next(c for c in foreign_score.judge(outcomes) if words in c["what"])


class Exact(unittest.TestCase):
    # Tests that a single effect counts by itself or by its tie class, on its signal, and not with further ones.
    def test_single(self):
        k = key("exact", ["amp.lag"], what="amp.lag")
        for verdict in ("named", "tied", "partly"):
            self.assertTrue(scored(k, report(verdict, [("amp.lag", [])]))["right"])
        self.assertTrue(scored(k, report("tied", [("amp.delay", ["amp.lag"])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.delay", [])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.lag", []), ("valve.relief", [])]))["right"])
        self.assertFalse(scored(k, report("unexplained", [("amp.lag", [])]))["right"])
        self.assertFalse(foreign_score.score(k, None, "exit 2: no", 1.0)["right"])
        k["effects"][0]["signal"] = "p2"
        r = report("named", [("amp.lag", [])])
        r["effects"][0]["names"] = ["signal = p1"]
        self.assertFalse(scored(k, r)["right"])

    # Tests that pairs and triples need the exact set, in any order, without ties.
    def test_sets(self):
        k = key("exact", ["amp.lag", "valve.relief"], what="pair")
        self.assertTrue(scored(k, report("named", [("valve.relief", []), ("amp.lag", [])]))["right"])
        self.assertFalse(scored(k, report("tied", [("valve.relief", []), ("amp.delay", ["amp.lag"])]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.lag", [])]))["right"])
        triple = key("exact", ["amp.lag", "valve.relief", "line.wave"], what="triple")
        self.assertFalse(scored(triple, report("named", [("valve.relief", []), ("amp.lag", [])]))["right"])

    # Tests that other values are a mistake where nothing is missing and all values are right.
    def test_nothing(self):
        k = key("exact", what="noise tripled")
        self.assertTrue(scored(k, report("nothing_missing"))["right"])
        for verdict in ("parameters", "unexplained", "named"):
            self.assertFalse(scored(k, report(verdict))["right"])

    # Tests that the wrong value must be found within 5 %, and that null, which stands for a missing number, is a miss and no crash.
    def test_wrong_value(self):
        k = key("parameter", what="b", wrong=0.03)
        self.assertTrue(scored(k, report("parameters", parameters=[fitted(0.0209)]))["right"])
        self.assertFalse(scored(k, report("parameters", parameters=[fitted(0.0211)]))["right"])
        self.assertFalse(scored(k, report("named", [("amp.lag", [])], [fitted(0.02)]))["right"])
        self.assertFalse(scored(k, report("parameters"))["right"])
        missing = scored(k, report("parameters", parameters=[fitted(None, (None, None))]))
        self.assertFalse(missing["right"])
        self.assertEqual(missing["coverage"], [])
        self.assertIn("b 0.03 should be 0.02 | parameters: b = -", foreign_score.table([missing], foreign_score.judge([missing]), 1.0))

    # Tests that intervals count where the effect or the value is the true one and not tied, and that those which miss it are listed.
    def test_coverage(self):
        k = key("exact", ["amp.lag"], what="amp.lag")
        held = scored(k, report("named", [("amp.lag", [])]))
        self.assertEqual([c["holds"] for c in held["coverage"]], [True])
        self.assertEqual(scored(k, report("named", [("amp.delay", [])]))["coverage"], [])
        self.assertEqual(scored(k, report("tied", [("amp.lag", ["amp.delay"])]))["coverage"], [])
        value = scored(key("parameter", what="b", wrong=0.03), report("parameters", parameters=[fitted(0.0205, (0.0201, 0.021))]))
        self.assertEqual([c["holds"] for c in value["coverage"]], [False])
        self.assertEqual(goal([held, value], "intervals")["was"], "1 of 2")
        self.assertIn("case: b = 0.02, said [0.0201, 0.021]", foreign_score.table([value], foreign_score.judge([value]), 1.0))

    # Tests the limits: no miss of singles from 3 noise units on nor of nulls, 1 of 12 of pairs and triples, 1 of 10 of wrong values.
    def test_goals(self):
        named = report("named", [("amp.lag", [])])
        single, miss = (scored(key("exact", ["amp.lag"], what="amp.lag", gap=3.0), r) for r in (named, report("unexplained")))
        self.assertTrue(goal([single] * 9, "single effects at 3 noise units and more: it")["met"])
        self.assertFalse(goal([single] * 9 + [miss], "single effects at 3 noise units and more: it")["met"])
        small = scored(key("exact", ["amp.lag"], what="amp.lag", gap=2.9), report("unexplained"))
        sign = scored(key("exact", ["sensor.sign"], what="sensor.sign", gap=0), report("unexplained"))
        self.assertTrue(goal([single, small], "single effects at 3 noise units and more: it")["met"])
        self.assertFalse(goal([single, sign], "single effects at 3 noise units and more: it")["met"])
        pair, wrong = (scored(key("exact", ["amp.lag", "valve.relief"], what="pair"), r)
                       for r in (report("named", [("amp.lag", []), ("valve.relief", [])]), named))
        self.assertTrue(goal([pair] * 11 + [wrong], "pairs and triples")["met"])
        self.assertFalse(goal([pair] * 10 + [wrong] * 2, "pairs and triples")["met"])
        calm, other = (scored(key("exact", what="noise halved"), r) for r in (report("nothing_missing"), report("parameters")))
        self.assertFalse(goal([calm] * 11 + [other], "`nothing_missing`")["met"])
        found, lost = (scored(key("parameter", what="b", wrong=0.03), r) for r in (report("parameters", parameters=[fitted(0.02)]), report("parameters")))
        self.assertTrue(goal([found] * 9 + [lost], "one wrong value")["met"])
        self.assertFalse(goal([found] * 8 + [lost] * 2, "one wrong value")["met"])
        self.assertIsNone(goal([found], "pairs and triples")["met"])
        rows = {title: len(group) for title, group in foreign_exact.groups([single, pair, calm, found])}
        self.assertEqual(rows, {"exact, single": 1, "exact, pair": 1, "exact, triple": 0, "exact, noise halved": 1, "parameter": 1})


if __name__ == "__main__":
    unittest.main()
