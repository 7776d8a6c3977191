"""Reads the schedules of hydro-torture (docs/developers/torture.md)."""

import collections
import glob
import os

import fault_sequence

SHIPPED = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "sim", "torture", "real")
FOLDER = os.environ.get("HYDRO_SCHEDULES", SHIPPED)

Injection = collections.namedtuple("Injection", "at kind target duration amount seed")


class Schedule:
    def __init__(self, path):
        self.path = path
        self.name = os.path.splitext(os.path.basename(path))[0]
        self.injections = []
        with open(path, encoding="utf-8") as file:
            lines = [line.split() for line in file.read().splitlines()[1:] if line and not line.startswith("#")]
        for first, *words in lines:
            if first == "run":
                self.run = dict(word.split("=") for word in words)
                continue
            values = dict(word.split("=") for word in words[1:])
            self.injections.append(Injection(float(first), words[0], values["target"], float(values["for"]),
                                             float(values["amount"]), int(values["seed"])))

    @property
    def needs_hosts(self):
        return any(injection.kind in ("partition", "loss", "delay") for injection in self.injections)

    @property
    def until(self):
        return float(self.run["until"])

    def comparable(self, faults):
        """What of the faults in a run of it does not depend on chance."""
        for injection in self.injections:
            if injection.kind == "other_configuration":
                # These are the faults of the process that is refused. It leaves without a fault if it hears
                # the plant first, and reports another process if it hears that first.
                faults = [f for f in faults if (f.source, f.code) != (injection.target, "other_configuration")]
        return faults

    def logged(self, faults):
        """Those of a simulated run that its logger hears: what a process publishes while all that it sends is lost is in no log, and
        nothing is in that of a logger that is cut off."""
        for injection in self.injections:
            if injection.kind not in ("partition", "loss"):
                continue
            end = injection.at + injection.duration
            deaf = injection.kind == "partition" and injection.target == "logger"
            faults = [f for f in faults if not (deaf or f.source == injection.target) or not injection.at < f.time < end]
        return faults

    def text(self, seed, later):
        """The schedule with another seed of the run and with all faults later by that many s."""
        run = dict(self.run, seed=seed, until=self.until + later)
        text = "hydro-torture 1\nrun " + " ".join(f"{key}={value}" for key, value in run.items()) + "\n"
        for i in self.injections:
            text += f"{i.at + later} {i.kind} target={i.target} for={i.duration} amount={i.amount} seed={i.seed}\n"
        return text


def all_schedules():
    return [Schedule(path) for path in sorted(glob.glob(os.path.join(FOLDER, "*.torture")))]


def simulate(case, schedule):
    """The faults in the log of a simulated run, in which every invariant holds."""
    output = case.run_program("hydro-torture", "--replay", schedule.path, "--faults").stdout
    return schedule.comparable(schedule.logged(fault_sequence.of_simulation(output)))
