"""The faults that the processes of a run publish, in order: those of hydro-torture's simulation and those in the log of real
processes, and what is different between the two."""

import collections
import re

import event_log

# s of simulated time. Two processes that notice faults closer together than this do so in either order, both
# with real processes and with another seed of the simulator. The faults that one process notices are always
# in order.
RACE = 0.02

Fault = collections.namedtuple("Fault", "time source code active latched")


def told(fault):
    return f"{fault.source} {fault.code} {'begins' if fault.active else 'ends'}{' latched' if fault.latched else ''}"


def listed(faults):
    return "".join(f"  {fault.time:8.3f} {told(fault)}\n" for fault in faults) or "  none\n"


def of_simulation(output):
    """Those that `hydro-torture --replay FILE --faults` has printed."""
    found = re.findall(r"^([\d.]+) (\w+) \d+: (\w+) (begins|ends)( latched)?$", output, re.MULTILINE)
    return [Fault(float(time), source, code, word == "begins", bool(latched)) for time, source, code, word, latched in found]


def of_logs(paths, start_us=0):
    """Those in the logs of one run, of which the second begins after the first and so on; times in s after `start_us`."""
    type_ = event_log.TYPES["HYDRO_FAULT"]
    faults = []
    for path in paths:
        for event in event_log.read_events(path):
            if event.channel == "HYDRO_FAULT":
                fault = type_.decode(event.data)
                faults.append(Fault((event.utime - start_us) * 1e-6, fault.source, fault.code, bool(fault.active),
                                    bool(fault.latched)))
    return faults


def difference(expected, found):
    """Why `found` is not the same faults in the same order as `expected`; None: it is."""
    for source in sorted({fault.source for fault in expected + found}):
        wanted = [told(fault) for fault in expected if fault.source == source]
        had = [told(fault) for fault in found if fault.source == source]
        for number, (a, b) in enumerate(zip(wanted + ["nothing more"], had + ["nothing more"])):
            if a != b:
                return f"fault {number} of {source} is: {b}; expected is: {a}"
    # Each process's own sequence is the same in both runs, so its n-th fault in one is its n-th fault in the
    # other.
    position = {}
    for number, fault in enumerate(found):
        position.setdefault(fault.source, []).append(number)
    places = [position[fault.source].pop(0) for fault in expected]
    for later, fault in enumerate(expected):
        for earlier in range(later):
            if fault.time - expected[earlier].time > RACE and places[earlier] > places[later]:
                return f"{told(fault)} comes before {told(expected[earlier])}"
    return None
