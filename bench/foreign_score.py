"""How bench/gap_score judges: rules, goals and tables for the rigs of tests/foreign_rig.

A report may lack what contract files of later dates have (`partly`, `weight`, `share`, `gap.horizons`, `per_run`, `closure`, `explanations`,
`set_90`): it is then judged by what it has.
"""

import math

import foreign_exact
import foreign_explanations
import foreign_oracle

# A stand-in for the whole: every class, sizes mixed.
QUICK = [
    "amp.lag-8", "motor.cogging-8", "pump.pressure_friction-3", "pump.stribeck-8", "pump.friction_asymmetry-25", "pump.turbulent_leakage-8",
    "pump.flow_ripple-8", "fluid.entrained_air-25", "fluid.warming-8", "line.wave-8", "valve.relief-8", "actuator.seal_friction-8",
    "arm.flexure-8", "sensor.pressure_lag-8", "sensor.skew-8", "pair-1", "pair-2", "pair-3", "values-1", "coloured-1", "daily-1", "daily-2",
    "spikes-1", "filters-1", "bias-8a", "drift-8a", "newcomer-bar-1", "newcomer-voltage_sign-1", "newcomer-ms-1",
    "outside-2-15", "outside-3-3", "outside-7-15", "outside-8-1.5", "exact-amp.lag", "exact-sensor.sign-p1", "exact-pair-1", "exact-triple-1",
    "exact-noise_as_stated-1", "exact-noise_tripled-1", "parameter-b", "parameter-beta",
]

CLAIMS = ("named", "tied", "partly")  # verdicts whose effects are said to be there
SIZES = (("under 3", 0, 3), ("3 to 6", 3, 6), ("6 to 15", 6, 15), ("15 and more", 15, math.inf))
SEALED_FROM = 20000  # seeds' offsets below are for development; tests/foreign_rig/cases.h says what that means
WEIGHTS = ((0, 0.1), (0.1, 0.3), (0.3, 0.5), (0.5, 0.7), (0.7, 0.9), (0.9, 1.0))


# -- one case ---------------------------------------------------------------------------------------------------------------------------


def remark_found(groups, report):
    """Whether one remark has a word of each group."""
    remarks = [remark if isinstance(remark, str) else " ".join(str(v) for v in remark.values()) for remark in report.get("remarks") or []]
    return any(all(any(word.lower() in remark.lower() for word in group) for group in groups) for remark in remarks)


def closure_share(report):
    """Part of the held-out squared gap that the closure takes; None without one."""
    held_out = (report.get("closure") or {}).get("held_out") or {}
    before, after = held_out.get("before"), held_out.get("after")
    return 1 - (after / before) ** 2 if before and after is not None else None


def weights(key, report):
    """Every weight that a candidate has, and whether the candidate is what is in the rig.

    Ids of effects have a dot; a candidate without one is other values, which is right where nothing is missing. Where something outside the
    catalogue is, other values and closures are neither right nor wrong.
    """
    true = sorted(effect["id"] for effect in key["effects"])
    judged = []
    for candidate in report.get("candidates") or []:
        ids = sorted(part.split("(")[0].strip() for part in candidate["id"].split("+"))  # "sensor.skew (p1)"
        if not isinstance(candidate.get("weight"), (int, float)) or candidate["id"].startswith("closure."):
            continue
        if not any("." in part for part in ids):
            if key["outside"]:
                continue
            ids = []
        judged.append((candidate["weight"], ids == true and not key["outside"]))
    return judged


def score(key, report, failure, seconds, told=None, sought=None):
    """What came of a case, in the terms of the goals. `told`, `sought`: reports of the oracle (foreign_oracle)."""
    outcome = {"class": key["class"], "what": key.get("what", ""), "truth": truth_text(key), "gap": key["gap"], "gap_reached": key["gap_reached"],
               "seconds": seconds, "verdict": None, "said": failure, "right": False, "ended": report is not None, "any_effect": False,
               "instead": False, "confident_wrong": False, "extra": 0, "weights": [], "held_out": None, "horizons": [], "closure": None,
               "function_of": (key["outside"] or {}).get("function_of", ""), "remarked": False, "per_run": [], "explanations": [], "set_90": None,
               "element": False, "effects": len(key["effects"]), "oracle": foreign_oracle.compare(key, report, told, sought)}
    if report is None:
        return outcome
    verdict, gap = report["verdict"], report.get("gap") or {}
    found = (report.get("effects") or []) if verdict in CLAIMS else []
    matched = [any(foreign_explanations.is_it(true, effect) for effect in found) for true in key["effects"]]
    extra = [effect for effect in found if not any(foreign_explanations.is_it(true, effect) for true in key["effects"])]
    outcome.update(verdict=verdict, said=said_text(report), any_effect=bool(found), extra=len(extra), weights=weights(key, report),
                   held_out=gap.get("held_out"), horizons=gap.get("horizons") or [], closure=closure_share(report),
                   per_run=[entry.get("name") for entry in report.get("per_run") or []], explanations=foreign_explanations.weights(key, report),
                   set_90=foreign_explanations.likeliest_set(key, report))
    kind = key["class"]
    if kind in foreign_exact.CLASSES:
        outcome.update(foreign_exact.score(key, report, found))
    elif kind in ("single", "pair", "bias", "drift"):
        outcome["right"] = all(matched)
        outcome["half"] = any(matched)
        outcome["instead"] = kind in ("bias", "drift") and bool(found) and not all(matched)
    elif kind == "nothing":
        outcome["right"] = not found
    elif kind == "newcomer":
        # An effect of the sensors may be a way of saying that the recording is wrong.
        outcome["remarked"] = remark_found(key["remark"], report)
        outcome["instead"] = any(not effect["id"].startswith("sensor.") for effect in found)
        outcome["right"] = outcome["remarked"] and not outcome["instead"]
    else:
        closure = (report.get("closure") or {}).get("id")
        said = [effect["id"] for effect in found] + ([closure] if closure else [])
        outcome["element"] = bool(foreign_explanations.explains(key, said))
        outcome["confident_wrong"] = verdict == "named" and bool(found) and not outcome["element"]
        outcome["right"] = not outcome["confident_wrong"]
    return outcome


def truth_text(key):
    words = [effect["id"] + (f"({effect['signal']})" if "signal" in effect else "") for effect in key["effects"]]
    if key["outside"]:
        words.append("outside: " + key["outside"]["what"])
    if key["class"] == "newcomer":
        words.append("mistake: " + key["what"])
    if key["class"] == "parameter":
        words += [f"{value['name']} {value['model']:.4g} should be {value['true']:.4g}" for value in foreign_exact.wrong_values(key)]
    return " + ".join(words) or f"nothing missing ({key.get('what', '')})"


def said_text(report):
    words = []
    for effect in report.get("effects") or []:
        ties = effect.get("tied_with") or []
        words.append(effect["id"] + (f" (tied with {', '.join(ties)})" if ties else ""))
    closure = report.get("closure") or {}
    if closure.get("id"):
        words.append(closure["id"])
    if report["verdict"] == "parameters":
        words += [f"{parameter['name']} = {figure(parameter.get('fitted'))}" for parameter in report.get("parameters") or []]
    return report["verdict"] + (": " + " + ".join(words) if words else "")


def figure(value):
    """A number as text; null, which JSON has for what is not a number, as a dash."""
    return format(value, ".3g") if isinstance(value, (int, float)) else "-"


# -- all cases --------------------------------------------------------------------------------------------------------------------------


def binomial_tail(n, k, p):
    """P(X >= k) of n trials."""
    if p <= 0 or p >= 1:
        return 1.0 if p >= 1 or k <= 0 else 0.0
    # By logarithms: of thousands of candidates, the coefficients are beyond any float.
    def term(i):
        return math.exp(math.lgamma(n + 1) - math.lgamma(i + 1) - math.lgamma(n - i + 1)
                        + i * math.log(p) + (n - i) * math.log1p(-p))
    return min(1.0, sum(term(i) for i in range(k, n + 1)))


def bound(good, n, upper):
    """One-sided 95 % bound of a proportion (Clopper and Pearson 1934)."""
    if n == 0:
        return None
    if good == (n if upper else 0):
        return 1.0 if upper else 0.0
    low, high = 0.0, 1.0
    for _ in range(50):
        middle = (low + high) / 2
        beyond = 1 - binomial_tail(n, good + 1, middle) < 0.05 if upper else binomial_tail(n, good, middle) > 0.05
        low, high = (low, middle) if beyond else (middle, high)
    return (low + high) / 2


def median(values):
    ordered = sorted(values)
    return ordered[len(ordered) // 2] if ordered else None


def judge(outcomes):
    """The goals: what must be reached, what was, its 95 % bound, and whether that is enough (None: no such case was run)."""
    criteria = []
    of = lambda *kinds: [o for o in outcomes if o["class"] in kinds]

    def goal(what, cases, good, limit, upper=False):
        n, count = len(cases), sum(1 for o in cases if good(o))
        criteria.append({"what": what, "must": f"{'<=' if upper else '>='} {100 * limit:.0f} %", "was": f"{count} of {n}",
                         "bound": bound(count, n, upper), "upper": upper,
                         "met": None if n == 0 else count <= limit * n + 1e-9 if upper else count >= limit * n - 1e-9})

    right = lambda o: o["right"]
    # A diagnosis that never ended named nothing wrong, but proves nothing either.
    ended = lambda *kinds: [o for o in of(*kinds) if o["ended"]]
    goal("ended with a report", outcomes, lambda o: o["ended"], 1.0)
    goal("single effects at 3 noise units and more: the right one or its tie class", [o for o in of("single") if o["gap"] >= 3], right, 0.95)
    goal("nothing missing: any effect named", ended("nothing"), lambda o: o["any_effect"], 0.02, upper=True)
    goal("bias, drift, a newcomer's mistake: a physical effect named instead", ended("bias", "drift", "newcomer"), lambda o: o["instead"], 0.02, upper=True)
    goal("outside the catalogue: a confident wrong name", ended("outside"), lambda o: o["confident_wrong"], 0.05, upper=True)
    visible = [o for o in of("outside") if o["gap"] >= 3 and o["function_of"]]
    goal("outside, a function of measured signals, 3 and more: a closure on the right element", visible, lambda o: o["element"], 0.80)
    goal("the same: the closure takes 70 % of the gap", visible, lambda o: (o["closure"] or 0) >= 0.7, 0.90)
    foreign_exact.goals(outcomes, goal)
    sets = [o for o in outcomes if o["set_90"]]
    goal("sets of 90 % that hold the truth", sets, lambda o: o["set_90"]["holds"], 0.90)
    for what, limit, value in (("explanations in such a set, median", 2.5, median([o["set_90"]["size"] for o in sets])),):
        criteria.append({"what": what, "must": f"<= {limit:g}", "was": "-" if value is None else f"{value:g}", "bound": None, "upper": True,
                         "met": None if value is None else value <= limit})
    criteria += foreign_oracle.criteria(outcomes)
    for what, limit, value in (("seconds, median", 6, median([o["seconds"] for o in outcomes])),
                               ("seconds, worst", 24, max([o["seconds"] for o in outcomes], default=None))):
        criteria.append({"what": what, "must": f"<= {limit}", "was": "-" if value is None else f"{value:.1f}", "bound": None, "upper": True,
                         "met": None if value is None else value <= limit})
    return criteria


def reliability(outcomes, of="weights"):
    """Rows of stated weight against how often candidates, or `of` "explanations", of that weight were right."""
    judged = [pair for o in outcomes for pair in o.get(of) or []]
    rows = []
    for low, high in WEIGHTS:
        inside = [(w, good) for w, good in judged if low <= w < high or high == 1.0 and w >= 1.0]
        if inside:
            count = sum(1 for _, good in inside if good)
            rows.append((low, high, sum(w for w, _ in inside) / len(inside), count, len(inside), bound(count, len(inside), upper=False)))
    return rows


def by_horizon(outcomes):
    """Median held-out gaps before, refitted and after, by seconds of prediction, of the cases named rightly and of the others."""
    rows = []
    for title, group in (("right", [o for o in outcomes if o["right"]]), ("not right", [o for o in outcomes if not o["right"]])):
        seconds = sorted({h["seconds"] for o in group for h in o["horizons"] if "seconds" in h})
        for s in seconds:
            at = [h.get("held_out") or {} for o in group for h in o["horizons"] if h.get("seconds") == s]
            values = [median([g[k] for g in at if isinstance(g.get(k), (int, float))]) for k in ("before", "refit_only", "after")]
            rows.append((title, s, len(at), values))
    return rows


def percent(part):
    return "" if part is None else f"{100 * part:.0f} %"


def table(outcomes, criteria, elapsed):
    lines = ["", f"{'goal':82} {'must':>8} {'was':>10} {'':>6} {'95 % bound':>12}"]
    for c in criteria:
        parts = c["was"].split(" of ")
        share = percent(int(parts[0]) / int(parts[1])) if len(parts) == 2 and int(parts[1]) else ""
        limit = "" if c["bound"] is None else ("<= " if c["upper"] else ">= ") + percent(c["bound"])
        lines.append(f"{c['what']:82} {c['must']:>8} {c['was']:>10} {share:>6} {limit:>12}  "
                     f"{'not run' if c['met'] is None else 'met' if c['met'] else 'MISSED'}")
    lines += class_lines(outcomes) + foreign_oracle.lines(outcomes, groups_of(outcomes)) + reliability_lines(outcomes)
    if any(o["explanations"] for o in outcomes):
        lines += reliability_lines(outcomes, "explanations")
    sets = [o["set_90"] for o in outcomes if o["set_90"]]
    if sets:
        held = sum(1 for s in sets if s["holds"])
        lines += ["", f"sets of 90 %: {held} of {len(sets)} hold the truth, {percent(held / len(sets))}; {median([s['size'] for s in sets]):g} explanations (median)"]
    lines += horizon_lines(outcomes) + miss_lines(outcomes) + foreign_exact.lines(outcomes)
    times = sorted(o["seconds"] for o in outcomes)
    ended = sum(1 for o in outcomes if o["ended"])
    if times:
        lines += ["", f"{len(outcomes)} cases in {elapsed:.0f} s, {ended} ended with a report; a diagnosis took {median(times):.1f} s (median), {times[-1]:.1f} s at most"]
    processor = [o["processor_s"] for o in outcomes if o.get("processor_s")]
    if processor:
        lines.append(f"of the processor, which other work does not change: {median(processor):.1f} s (median), {max(processor):.1f} s at most")
    return "\n".join(lines) + "\n"


def groups_of(outcomes):
    """(title, outcomes) by class and size."""
    groups = [(f"single, {title}", [o for o in outcomes if o["class"] == "single" and low <= o["gap"] < high]) for title, low, high in SIZES]
    groups += [("pair (both)", [o for o in outcomes if o["class"] == "pair"]), ("bias", [o for o in outcomes if o["class"] == "bias"]),
               ("drift", [o for o in outcomes if o["class"] == "drift"])]
    for kind in ("nothing", "newcomer"):
        for what in sorted({o["what"] for o in outcomes if o["class"] == kind}):
            groups.append((f"{kind}, {what}", [o for o in outcomes if o["class"] == kind and o["what"] == what]))
    groups += [(f"outside, {title}", [o for o in outcomes if o["class"] == "outside" and low <= o["gap"] < high]) for title, low, high in SIZES]
    return groups + foreign_exact.groups(outcomes)


def class_lines(outcomes):
    lines = ["", f"{'cases':34} {'right':>10} {'95 % bound':>11}   verdicts"]
    groups = groups_of(outcomes)
    for title, group in groups:
        if not group:
            continue
        good = sum(1 for o in group if o["right"])
        verdicts = {}
        for o in group:
            said = o["verdict"] or "none"
            verdicts[said] = verdicts.get(said, 0) + 1
        lines.append(f"{title:34} {good:>4} of {len(group):<3} {'>= ' + percent(bound(good, len(group), upper=False)):>11}   "
                     + ", ".join(f"{count} {said}" for said, count in sorted(verdicts.items())))
    halves = [o for o in outcomes if o["class"] == "pair" and o.get("half") and not o["right"]]
    if halves:
        lines.append(f"of pairs, one was found: {', '.join(o['name'] for o in halves)}")
    extras = [o for o in outcomes if o["class"] in ("single", "pair", "bias", "drift") and o["right"] and o["extra"]]
    if extras:
        lines.append(f"right, but with more effects than there are: {', '.join(o['name'] for o in extras)}")
    daily = [o for o in outcomes if o["class"] == "nothing" and o["what"] == "daily"]
    if daily:
        lines.append(f"values that differ from run to run: reported in {sum(1 for o in daily if o['per_run'])} of {len(daily)}")
    return lines


def reliability_lines(outcomes, of="weights"):
    rows = reliability(outcomes, of)
    if not rows:
        return ["", "No candidate has a weight."]
    head = "weight" if of == "weights" else of
    lines = ["", f"{head:15} mean weight    right        share   >= (95 %)"]
    return lines + [f"{low:.1f} to {high:.1f}      {mean:>11.2f}    {good:>4} of {n:<5} {percent(good / n):>6}   {percent(limit):>6}"
                    for low, high, mean, good, n, limit in rows]


def horizon_lines(outcomes):
    rows = by_horizon(outcomes)
    if not rows:
        return ["", "No report has gaps by horizon."]
    lines = ["", "held-out gap by horizon, medians, noise units: before, refitted, after"]
    return lines + [f"  {title:10} {s:>6g} s  {n:>4} cases  {figure(v[0]):>8} {figure(v[1]):>8} {figure(v[2]):>8}" for title, s, n, v in rows]


def miss_lines(outcomes):
    misses = [o for o in outcomes if not o["right"]]
    if not misses:
        return []
    lines = ["", "Misses: case (gap as made) | truth | what was said | held-out gap before, refitted, after | time"]
    for o in misses:
        gaps = ", ".join(figure((o["held_out"] or {}).get(k)) for k in ("before", "refit_only", "after"))
        lines.append(f"  {o['name']} ({o['gap']:.3g}) | {o['truth']} | {o['said']} | {gaps} | {o['seconds']:.0f} s")
    return lines
