"""Rules of bench/gap_score for rigs of which all is exact but what is hidden: the classes `exact` and `parameter` of tests/foreign_rig.

Nothing blurs what is in them, so that more is asked than of the others: the true effects and no further ones, `nothing_missing` where nothing is,
the number of a value that is wrong, and intervals that hold the truth.
"""

import math

import foreign_explanations

CLASSES = ("exact", "parameter")
CLOSE = 0.05  # of a wrong value, as far as what was found may be off


def wrong_values(key):
    return [value for value in key["parameters"] if value["true"] != value["model"]]


def score(key, report, found):
    """What came of a case, in the terms of `goals`. `found`: the report's effects where its verdict says that they are there."""
    outcome = {"effects": len(key["effects"]), "coverage": coverage(key, report, found)}
    if key["class"] == "parameter":
        fitted = {value["name"]: value["fitted"] for value in report.get("parameters") or [] if value["fitted"] is not None}
        right = report["verdict"] == "parameters" and all(abs(fitted.get(value["name"], math.inf) / value["true"] - 1) <= CLOSE
                                                          for value in wrong_values(key))
    elif not key["effects"]:
        right = report["verdict"] == "nothing_missing"
    else:
        right = foreign_explanations.are_they(key["effects"], found, with_ties=len(key["effects"]) == 1)
    return {**outcome, "right": right}


def coverage(key, report, found):
    """For every true number that the report gives with an interval: its name, and whether the interval holds it."""
    said = {value["name"]: value for value in report.get("parameters") or [] if report["verdict"] == "parameters"}
    numbers = [(value["name"], value["true"], said.get(value["name"], {})) for value in wrong_values(key)]
    for effect in found:
        true = next((true["parameters"] for true in key["effects"] if true["id"] == effect["id"] and not effect.get("tied_with")), {})
        numbers += [(f"{effect['id']} {name}", value, (effect.get("parameters") or {}).get(name) or {}) for name, value in true.items()]
    return [{"what": what, "true": true, "ci95": given["ci95"], "holds": given["ci95"][0] <= true <= given["ci95"][1]}
            for what, true, given in numbers if given.get("ci95") and None not in given["ci95"]]


def goals(outcomes, goal):
    """`goal` is that of foreign_score.judge."""
    exact = [o for o in outcomes if o["class"] == "exact"]
    effects = lambda *counts: [o for o in exact if o["effects"] in counts]
    right = lambda o: o["right"]
    # A sign has no size, and so no gap.
    seen = lambda cases: [o for o in cases if o["gap"] >= 3 or o["what"] == "sensor.sign"]
    goal("exact rigs, single effects at 3 noise units and more: it or its tie class alone", seen(effects(1)), right, 1.0)
    goal("exact rigs, pairs and triples: the exact set", effects(2, 3), right, 0.85)
    goal("exact rigs, nothing missing: `nothing_missing`", effects(0), right, 1.0)
    goal("one wrong value, at 3 noise units and more: `parameters`, within 5 %", seen([o for o in outcomes if o["class"] == "parameter"]), right, 0.90)
    intervals = [c for o in outcomes for c in o.get("coverage") or []]
    goal("exact rigs, 95 % intervals that hold the true number", intervals, lambda c: c["holds"], 0.90)


def groups(outcomes):
    """(title, outcomes), for tables."""
    exact = [o for o in outcomes if o["class"] == "exact"]
    titled = [(f"exact, {title}", [o for o in exact if o["effects"] == count]) for count, title in ((1, "single"), (2, "pair"), (3, "triple"))]
    titled += [(f"exact, {what}", [o for o in exact if o["what"] == what]) for what in sorted({o["what"] for o in exact if o["effects"] == 0})]
    return titled + [("parameter", [o for o in outcomes if o["class"] == "parameter"])]


def lines(outcomes):
    missed = [(o, c) for o in outcomes for c in o.get("coverage") or [] if not c["holds"]]
    if not missed:
        return []
    return ["", "Intervals that do not hold the true number:"] + [
        f"  {o['name']}: {c['what']} = {c['true']:.4g}, said [{c['ci95'][0]:.4g}, {c['ci95'][1]:.4g}]" for o, c in missed]
