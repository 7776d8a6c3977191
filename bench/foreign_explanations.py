"""Whether the effects of a report, its explanations, and its set that holds the truth nine times in ten, are what is in a rig of tests/foreign_rig."""

import itertools


def is_it(true, effect, with_ties=True):
    """Whether an effect that was found is the true one (its signal too, where there is one), or has it in its tie class."""
    if effect["id"] == true["id"]:
        said = [name.split("=")[1].strip() for name in effect.get("names") or [] if name.replace(" ", "").startswith("signal=")]
        return "signal" not in true or not said or true["signal"] in said
    return with_ties and true["id"] in (effect.get("tied_with") or [])


def are_they(true_effects, found, with_ties):
    """Whether the effects that were found are the true ones, one for one."""
    return len(true_effects) == len(found) and any(all(is_it(true, effect, with_ties) for true, effect in zip(order, found))
                                                   for order in itertools.permutations(true_effects))


def names_of(changes):
    """The changes that are effects or closures: their ids have a dot, as those of values ("T_s", "value.T_s") and of values of runs have not."""
    return [change for change in changes if "." in change and not change.startswith(("value.", "run.", "parameter"))]


def explains(key, changes):
    """Whether a set of changes is what is in the rig; None where that cannot be said.

    Effects must be the true ones, no more and no fewer, and closures none. Other values, and values of runs, are neither right nor wrong: every
    number of a rig's model is. Outside the catalogue a closure on the right element, and no effect, is right where a closure can be, and so is
    the effect that has said what it is since the rigs were written ("catalogue").
    """
    ids = [change.replace(" ", "") for change in names_of(changes)]
    closures = {change.split("(")[0].removeprefix("closure.") for change in ids if change.startswith("closure.")}
    effects = [change for change in ids if not change.startswith("closure.")]
    if key["class"] == "newcomer" or key["outside"] and not key["outside"]["function_of"]:
        return None
    if key["outside"]:
        if not closures and effects == [key["outside"].get("catalogue")]:
            return True
        one_flow = lambda balance: "flow" if balance.startswith("flow_") else balance  # leakage between the sides is in both
        return not effects and {one_flow(c) for c in closures} == {one_flow(key["outside"]["balance"])}
    said = sorted(effect.split("(")[0] for effect in effects)
    if closures or said != sorted(effect["id"] for effect in key["effects"]):
        return False
    signals = {effect["id"]: effect["signal"] for effect in key["effects"] if "signal" in effect}
    return all(signals.get(effect.split("(")[0], name) == name for effect in effects for name in [effect.partition("(")[2].rstrip(")")] if name)


def weights(key, report):
    """Weights of the report's explanations, with whether each is right: those that differ in values only count as one."""
    by_name = {}
    for explanation in report.get("explanations") or []:
        right = explains(key, explanation["changes"])
        if right is None or not isinstance(explanation.get("weight"), (int, float)):
            continue
        name = tuple(sorted(names_of(explanation["changes"])))
        by_name[name] = (by_name.get(name, (0, False))[0] + explanation["weight"], right)
    return list(by_name.values())


def likeliest_set(key, report):
    """Size of the set that is said to hold the truth nine times in ten, and whether it does; None without one."""
    size = report.get("set_90")
    judged = [explains(key, explanation["changes"]) for explanation in (report.get("explanations") or [])[:size or 0]]
    if not isinstance(size, int) or not judged or None in judged:
        return None
    return {"size": size, "holds": any(judged)}
