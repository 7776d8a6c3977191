"""steady.py [--late SECONDS] COMMAND...: runs a test that presumes a machine that runs.

In real time a machine that stands still for longer than limits.stale_input_s causes the faults that docs/safety.md
promises, and a test that expects a run without faults fails. Virtual machines do stand still: 0.1 to 0.3 s were measured.
So this program looks at the clock every 10 ms beside the test. Where the test failed and the machine stood still while it
ran, its failure shows nothing, and it runs again, three times at most; where the machine ran, it has failed. It exits like
the test."""

import argparse
import subprocess
import sys
import time

import outcome

EVERY = 0.01  # s
# s. This is below the smallest limits.stale_input_s of a configuration (0.1 s) and above what a loaded
# scheduler adds to a sleep.
LATE = 0.08
RUNS = 3


def run(command):
    """The exit code of the command, and by how many seconds this process woke up late at most while it ran."""
    # Measured from one check to the next and not only over the sleep, because the machine may stand still at
    # any time, even while the command starts.
    latest, looked = 0, time.monotonic()
    with subprocess.Popen(command) as child:
        running = True
        while running:
            time.sleep(EVERY)
            running = child.poll() is None
            now = time.monotonic()
            latest, looked = max(latest, now - looked - EVERY), now
    return child.returncode, latest


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--late", type=float, default=LATE)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    for attempt in range(1, RUNS + 1):
        code, latest = run(arguments.command)
        if code in (outcome.PASSED, outcome.SKIPPED) or latest < arguments.late or attempt == RUNS:
            break
        print(f"\nthe machine stood still for {latest * 1e3:.0f} ms while this test ran: run {attempt + 1} of {RUNS}\n",
              file=sys.stderr, flush=True)
    print(f"steady: the machine was late by at most {latest * 1e3:.0f} ms", flush=True)
    return code if code >= 0 else 128 - code


if __name__ == "__main__":
    sys.exit(main())
