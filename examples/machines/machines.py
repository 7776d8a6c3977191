#!/usr/bin/env python3
"""Runs hydro-diagnose, with its default settings, on machines that others built and measured, and writes what it says as a page.

    machines.py DATA [--diagnose PROGRAM] [--out FOLDER] [--machine FOLDER]... [--jobs N] [--page FILE] [--kept]

DATA has a folder for each machine (machines.toml: their names, files and sources). A machine whose folder is not there is left out, and
the page says so. Reports are kept in --out. Without --page the page is printed. --kept makes the page of reports that are in --out already, and runs what is not.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time
import tomllib

HERE = os.path.dirname(os.path.abspath(__file__))
HORIZONS = (0.1, 0.4, 1.6)


def read_machines():
    with open(os.path.join(HERE, "machines.toml"), "rb") as file:
        return tomllib.load(file)["machine"]


def copy_inputs(machine, data, folder):
    """Tables, sidecars and model side by side: a sidecar stands beside its table."""
    source = os.path.join(data, machine["folder"])
    sidecars = os.path.join(HERE, machine["sidecars"]) if "sidecars" in machine else source
    tables = machine["runs"] + machine.get("hold_out", [])
    for table in tables:
        path = os.path.join(source, table)
        if not os.path.exists(path):
            sys.exit(f"machines.py: {path}: found no such file, allowed the tables of {machine['source']}")
        os.symlink(os.path.abspath(path), os.path.join(folder, table))
    for name in os.listdir(sidecars):
        if name.endswith(".toml"):
            shutil.copy(os.path.join(sidecars, name), os.path.join(folder, name))
    model = machine["model"]
    return os.path.join(HERE, model) if "sidecars" in machine else os.path.join(folder, model)


def diagnose(machine, options, out):
    """The report, its seconds of processor time (None: a kept report), or the line with which the program ended."""
    kept = os.path.join(out, "report.json")
    if options.kept and os.path.exists(kept):
        with open(kept, encoding="utf-8") as file:
            return json.load(file), None, ""
    with tempfile.TemporaryDirectory() as folder:
        model = copy_inputs(machine, options.data, folder)
        command = [options.diagnose, *machine["runs"], "--model", model, "--out", os.path.abspath(out), "--force",
                   "--jobs", str(options.jobs)]
        for run in machine.get("hold_out", []):
            command += ["--hold-out", run]
        begin = os.times()
        ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        end = os.times()
        seconds = end.children_user + end.children_system - begin.children_user - begin.children_system
        if ended.returncode != 0:
            return None, seconds, ended.stderr.strip().splitlines()[-1].replace(folder + "/", "")
    with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
        return json.load(file), seconds, ""


def number(value):
    return "-" if value is None else f"{value:.3g}"


def effect_ids(effect):
    return {effect["id"], *effect.get("tied_with", [])}


def how_effects(ids, report):
    for effect in report["effects"]:
        if effect["id"] in ids:
            return "named" if not effect["tied_with"] else "tied with " + ", ".join(effect["tied_with"])
        tied = effect_ids(effect) & set(ids)
        if tied:
            return f"tied: {effect['id']} is named"
    return None


def how_parameter(name, report, shown=None):
    for found in report["parameters"]:
        if found["name"] != name:
            continue
        low, high = found["ci95"]
        interval = "" if low is None else f" [{number(low)}, {number(high)}]"
        text = f"{name} = {number(found['fitted'])}{interval}"
        if shown is None:
            return text
        meets = low is not None and high >= shown["low"] and low <= shown["high"]
        inside = shown["low"] <= found["fitted"] <= shown["high"]
        return text + (": right" if inside else ": its interval holds it" if meets else ": **wrong**")
    return None


def how_said(shows, report):
    """How the report says what a recording shows; None: it does not."""
    if "late" in shows:
        late = {name for clock in report["recording"] for name in clock["signals"]}
        return "said" if set(shows["late"]) <= late else None
    said = how_effects(shows.get("effects", []), report)
    for value in report["per_run"]:
        if value["name"] in shows.get("per_run", []):
            return said or f"{value['name']} differs by run"
    for name in shows.get("parameters", []):
        said = said or how_parameter(name, report)
    if "value" in shows:
        said = said or how_parameter(shows["value"]["name"], report, shows["value"])
    if "says" in shows and any(shows["says"] in remark for remark in report["remarks"] + [report["sentence"]]):
        said = said or "in a remark"
    return said


def beyond(machine, report):
    """Effects that are named though nothing that is known of the machine shows them."""
    known = {effect for shows in machine["shows"] for effect in shows.get("effects", [])}
    return [effect["id"] for effect in report["effects"] if not effect_ids(effect) & known]


def gap_table(report):
    lines = ["| held out, typical gap in noise units over | as given | refitted | with what was found | found / refitted |",
             "|---|---|---|---|---|"]
    for horizon in report["gap"]["horizons"]:
        if not any(abs(horizon["seconds"] - one) < 1e-9 for one in HORIZONS):
            continue
        gap = horizon["typical"]
        ratio = gap["after"] / gap["refit_only"] if gap["after"] and gap["refit_only"] else None
        lines.append(f"| {horizon['seconds']:g} s | {number(gap['before'])} | {number(gap['refit_only'])} | "
                     f"{number(gap['after'])} | {number(ratio)} |")
    return lines


def left_of(signals):
    parts = [f"{name} {number(one['held_out']['before'])} to {number(one['held_out']['after'])} {one['unit']}"
             for name, one in signals.items()]
    return "; ".join(parts) + "."


def signal_lines(report):
    """What is left of each signal, as given and with what was found, in its own unit."""
    lines = []
    for horizon in report["gap"]["horizons"]:
        if abs(horizon["seconds"] - 0.4) < 1e-9:
            lines.append("Root mean square, as given to what was found: over 0.4 s " + left_of(horizon["signals"]))
    lines.append("Over whole held-out runs, each from one start: " + left_of(report["gap"]["signals"]))
    return lines


def about(machine):
    lines = ["", f"## {machine['name']}", "", machine["what"], "", f"- Source: {machine['source']}.",
             f"- Known beforehand: {machine['known']}"]
    if "published" in machine:
        lines.append(f"- Published: {machine['published']}")
    lines.append(f"- Command: `hydro-diagnose {' '.join(machine['runs'])}"
                 + "".join(f" --hold-out {run}" for run in machine.get("hold_out", []))
                 + f" --model {os.path.basename(machine['model'])} --out out`")
    lines.append(f"- To print: `machines/{machine['folder']}/report.html`")
    return lines


def section(machine, report, seconds, failure):
    lines = about(machine)
    if report is None:
        return lines + ["", f"hydro-diagnose ended without a report: `{failure}`"]
    took = "" if seconds is None else f", {seconds:.0f} s of processor time"
    lines += ["", f"**{report['verdict']}** (hydro {report['version']}{took}): {report['sentence']}", ""]
    lines += ["| the recordings show | the gap finder |", "|---|---|"]
    missed = []
    for shows in machine["shows"]:
        said = how_said(shows, report)
        if said is None or "wrong" in said:
            missed.append(shows["what"])
        lines.append(f"| {shows['what']} | {said or '**not said**'} |")
    lines += ["", *gap_table(report), "", *signal_lines(report), ""]
    extra = beyond(machine, report)
    if extra:
        lines.append("Named, though nothing known of the machine shows it: " + ", ".join(extra) + ".")
    lines.append("Open: " + ("; ".join(missed) if missed else "nothing of the list above") + ".")
    return lines


HEAD = """# Machines that others built

`examples/machines/machines.py` runs `hydro-diagnose` with its **default settings** on measurements of machines that nobody of this
project built, and writes this page. The measurements are not part of the project; each section names its source. What is wrong
here stays written as wrong: nothing in the gap finder is set for these machines. *The recordings show* is what least squares of our own on
single balances find, or what the source says. A gap is the root mean square of what a simulation misses over stretches of a held-out run, each from a
start of its own, in units of the sensors' noise (1: nothing is left).

```
examples/machines/machines.py DATA --page docs/machines.md       # DATA has a folder for each machine
```

The study keeps a report of each machine, `machines/FOLDER/report.html` (`--out`). It is made to be printed: its first page is the
one to keep beside the machine, and [gap_finder.md](gap_finder.md#how-to-read-the-page) says how to print it.
"""


def head_lines():
    """Its paragraphs as one line each."""
    blocks = HEAD.strip().split("\n\n")
    lines = []
    for block in blocks:
        lines += [*(block.splitlines() if block.startswith("```") else [block.replace("\n", " ")]), ""]
    return lines[:-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", metavar="DATA")
    parser.add_argument("--diagnose", default=shutil.which("hydro-diagnose") or
                        os.path.join(HERE, "..", "..", "build", "bin", "hydro-diagnose"))
    parser.add_argument("--out", default="machines")
    parser.add_argument("--machine", action="append", default=[])
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--page")
    parser.add_argument("--kept", action="store_true")
    options = parser.parse_args()
    options.diagnose = os.path.abspath(options.diagnose)
    machines = read_machines()
    known = [machine["folder"] for machine in machines]
    for name in options.machine:
        if name not in known:
            sys.exit(f"machines.py: --machine: found {name!r}, allowed one of {', '.join(known)}")
    for path, what in ((options.data, "a folder of measurements"), (options.diagnose, "the program hydro-diagnose")):
        if not os.path.exists(path):
            sys.exit(f"machines.py: {path}: found no such file, allowed {what}")
    lines = head_lines()
    for machine in machines:
        if options.machine and machine["folder"] not in options.machine:
            continue
        if not os.path.isdir(os.path.join(options.data, machine["folder"])):
            lines += about(machine) + ["", "The measurements were not there."]
            continue
        begin = time.monotonic()
        out = os.path.join(options.out, machine["folder"])
        lines += section(machine, *diagnose(machine, options, out))
        print(f"{machine['folder']}: {time.monotonic() - begin:.0f} s", file=sys.stderr)
    page = "\n".join("\n".join(textwrap.wrap(line, 140, break_long_words=False, break_on_hyphens=False))
                     if line and not line.startswith(("|", "```", "#", "-")) else line for line in lines) + "\n"
    if options.page is None:
        sys.stdout.write(page)
        return
    with open(options.page, "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
