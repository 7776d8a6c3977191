"""How an end-to-end test ends: with 0 when all of its tests passed, 1 when one failed, and 77 when none failed and some
were skipped. ctest takes 77 for "Skipped" (SKIP_RETURN_CODE), so that a skip is never counted as a pass; the reasons are
printed, and scripts/run-tests shows them again at its end. Each *_test.py ends with `outcome.main()`."""

import sys
import unittest

PASSED, FAILED, SKIPPED = 0, 1, 77


def main():
    program = unittest.main(exit=False)
    result, total = program.result, program.test.countTestCases()
    sys.stdout.flush()
    for test, reason in result.skipped:
        print(f"SKIPPED {test}: {reason}", file=sys.stderr)
    if not result.wasSuccessful():
        sys.exit(FAILED)
    if total == 0:
        print("no test was found", file=sys.stderr)
        sys.exit(FAILED)
    if result.skipped:
        skipped = len({str(test) for test, _ in result.skipped})
        if skipped < total:
            print(f"SKIPPED {skipped} of {total} tests; the others passed", file=sys.stderr)
        sys.exit(SKIPPED)
    sys.exit(PASSED)
