"""steady.py [--late SECONDS] COMMAND...: runs a test that presumes a machine that runs.

In real time a machine that stands still for longer than limits.stale_input_s causes the faults that docs/safety.md
promises, and a test that expects a run without faults fails. Virtual machines do stand still, and one processor of theirs
without the others: 0.1 to 0.3 s were measured. So this program looks at the clock every 10 ms on each processor beside the
test. Where the test failed and a processor stood still while it ran, its failure shows nothing, and it runs again, three
times at most; where the machine ran, it has failed. It exits like the test."""

import argparse
import os
import subprocess
import sys
import threading
import time

import outcome

EVERY = 0.01  # s
# s. This is below the smallest limits.stale_input_s of a configuration (0.1 s) and above what a loaded
# scheduler adds to a sleep.
LATE = 0.08
RUNS = 3


class Watch(threading.Thread):
    """Looks at the clock on one processor, from a time on until it is told to stop; `latest`: by how many seconds it was late at
    most."""

    def __init__(self, processor, begin):
        super().__init__(daemon=True)
        self.processor, self.begin, self.latest, self.over = processor, begin, 0, threading.Event()

    def run(self):
        os.sched_setaffinity(0, {self.processor})  # of this thread alone
        # Measured from one check to the next and not only over the sleep, because the processor may stand still at any
        # time, even before the first one.
        looked = self.begin
        while not self.over.wait(EVERY):
            now = time.monotonic()
            self.latest, looked = max(self.latest, now - looked - EVERY), now


def run(command):
    """The exit code of the command, and by how many seconds a processor was late at most while it ran."""
    # The command starts first: a child inherits the processors of the thread that starts it, and this one keeps all.
    begin = time.monotonic()
    child = subprocess.Popen(command)
    watches = [Watch(one, begin) for one in os.sched_getaffinity(0)]
    for one in watches:
        one.start()
    code = child.wait()
    for one in watches:
        one.over.set()
    for one in watches:
        one.join()
    return code, max(one.latest for one in watches)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--late", type=float, default=LATE)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    for attempt in range(1, RUNS + 1):
        code, latest = run(arguments.command)
        if code in (outcome.PASSED, outcome.SKIPPED) or latest < arguments.late or attempt == RUNS:
            break
        print(f"\na processor stood still for {latest * 1e3:.0f} ms while this test ran: run {attempt + 1} of {RUNS}\n",
              file=sys.stderr, flush=True)
    print(f"steady: a processor was late by at most {latest * 1e3:.0f} ms", flush=True)
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main())
