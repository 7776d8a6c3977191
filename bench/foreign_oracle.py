"""The oracle of bench/gap_score: what the same program predicts of a rig when it is told the rig's true form.

It is asked twice, and the better answer counts. *Told*: the model as given with the true effects in it, their parameters those of the key, and nothing
else to look for: `refit_only` then has the true form and fitted values. *Sought*: the model as given, and only the true effects to look for: `after` then
has their parameters fitted too, which matters where the rig's form is only near the catalogue's. The oracle ratio is the held-out gap of what the
program found by itself, over that. A program that found the truth has 1.
"""

import math

SECONDS = 0.4  # of prediction: at 0.1 s lags decide, at 1.6 s base values
GOALS = ((0.5, "median", 1.05), (0.9, "90th percentile", 1.3))


def has_oracle(key):
    """Whether the true form can be stated. Outside the catalogue it cannot, and a newcomer's recording is wrong, not the model."""
    return not key["outside"] and key["class"] != "newcomer"


def model_text(key, given):
    """The model file's text with the true effects in it; None where the model as given has the true form already."""
    if not has_oracle(key) or not key["effects"]:
        return None
    sections = []
    for effect in key["effects"]:
        values = [f"{name} = {value!r}" for name, value in effect.get("nearest", effect["parameters"]).items()]
        if "signal" in effect:
            values.append(f'signal = "{effect["signal"]}"')
        sections.append("\n".join([f'[effects."{effect["id"]}"]', *values]) + "\n")
    return given.rstrip("\n") + "\n\n" + "\n".join(sections)


def effects_text(key):
    """A file for --effects with the true ones only. A model that has them leaves nothing to look for."""
    return "effects = [" + ", ".join(f'"{effect["id"]}"' for effect in key["effects"]) + "]\n"


def gap_at(report, what):
    """A held-out gap at the oracle's horizon, noise units; None where the report has none."""
    for horizon in ((report or {}).get("gap") or {}).get("horizons") or []:
        value = (horizon.get("held_out") or {}).get(what)
        if abs(horizon.get("seconds", 0) - SECONDS) < 1e-6 and isinstance(value, (int, float)) and math.isfinite(value) and value > 0:
            return value
    return None


def compare(key, report, told, sought):
    """{"gap", "oracle", "ratio"} of a case; None where there is no oracle, or the program gives no gaps by horizon.

    Where nothing is missing the refit in the same report has the true form. A diagnosis that never ended has no gap and no ratio, and counts
    as worse than any: a program must not gain by failing on hard rigs.
    """
    if not has_oracle(key):
        return None
    gaps = [gap_at(told, "refit_only"), gap_at(sought, "after")] if key["effects"] else [gap_at(report, "refit_only")]
    oracle = min((gap for gap in gaps if gap is not None), default=None)
    found = gap_at(report, "after")
    if oracle is None or found is None and report is not None:
        return None
    return {"gap": found, "oracle": oracle, "ratio": None if found is None else found / oracle}


def percentile(ratios, part):
    """The least ratio that this part of them does not exceed."""
    return sorted(ratios)[max(0, math.ceil(part * len(ratios) - 1e-9) - 1)] if ratios else None


def ratios(outcomes):
    compared = [o["oracle"] for o in outcomes if o.get("oracle")]
    return [math.inf if c["ratio"] is None else c["ratio"] for c in compared]


def criteria(outcomes):
    """The goals, in the terms of foreign_score.judge."""
    all_ratios = ratios(outcomes)
    goals = []
    for part, name, limit in GOALS:
        value = percentile(all_ratios, part)
        goals.append({"what": f"held-out gap at {SECONDS:g} s over that of the rig's true form: {name}", "must": f"<= {limit:g}",
                      "was": "-" if value is None else f"{value:.3g}", "bound": None, "upper": True, "met": None if value is None else value <= limit})
    return goals


def lines(outcomes, groups):
    """The table by groups of cases: (title, outcomes)."""
    rows = [(title, ratios(group)) for title, group in groups]
    rows = [(title, of_group) for title, of_group in rows + [("all", ratios(outcomes))] if of_group]
    if not rows:
        return ["", "No case has an oracle ratio."]
    text = ["", f"{f'gap at {SECONDS:g} s over the oracle':34} {'cases':>6} {'median':>8} {'90 %':>8} {'worst':>8}"]
    text += [f"{title:34} {len(r):>6} {percentile(r, 0.5):>8.3g} {percentile(r, 0.9):>8.3g} {max(r):>8.3g}" for title, r in rows]
    worst = sorted(((r, o) for o, r in zip([o for o in outcomes if o.get("oracle")], ratios(outcomes)) if r > GOALS[1][2]), key=lambda pair: -pair[0])
    if worst:
        text.append("beyond that, worst first: " + ", ".join(f"{o['name']} {r:.3g}" for r, o in worst[:20]))
    return text
