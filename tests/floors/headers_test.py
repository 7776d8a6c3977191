"""Tests that every header of a room is included by a test: what no test includes, no test calls directly.

ROOMS are those where this holds. A header that needs no test of its own is in EXEMPT, with the reason."""

import pathlib
import re
import unittest

from floors_test import read_rooms, room_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)

ROOMS = {
    "firmware", "model/equations", "model", "process/timing", "pressure_ctrl", "pressure_ctrl/law", "position_ctrl",
    "position_ctrl/law", "logger", "process/safety", "sim", "tools/hydro_plot", "tune/design",
    "experiments", "diagnose/recording", "diagnose/fit", "diagnose/balances", "diagnose/evidence", "diagnose/say",
    "diagnose/prove", "diagnose/report", "diagnose",
}
# From a header's path to the reason.
EXEMPT = {
    "diagnose/balances/column_maker.h": "what the makers of columns share: column_test reads every column",
    "diagnose/evidence/normal_equations.h": "inside of SetEvidence, which set_evidence_test compares with a dense reference",
    "diagnose/evidence/set_solution.h": "inside of SetEvidence",
    "diagnose/evidence/grams.h": "inside of SetEvidence",
    "diagnose/say/common_factor.h": "a part of the sentence, which bare_motor_test reads",
    "diagnose/say/found_values.h": "a part of what found.h describes, which found_test and diagnose_test read as a whole",
    "diagnose/prove/whole_runs.h": "a stage of prove.h: gap_closed_test and own_effect_test read what it finds",
    "diagnose/prove/proof_sets.h": "what prove.h chooses among: whole_proofs_test reads what comes of it",
    "diagnose/evidence/late_signals.h": "what clocks.h estimates with: clocks_test reads the clocks",
    "diagnose/evidence/run_values.h": "what per_run.h judges: per_run_test reads the values of runs",
    "diagnose/prove/progress.h": "one struct without a function",
    "pressure_ctrl/own_pressure_loop.h": "a whole program: e2e.own_controller runs the example that stands on it",
    "firmware/board.h": "what a board provides: e2e.front_end_firmware runs those that exist",
    "firmware/device_frames.h": "the inside of device.h, for two files",
    "model/start_from.h": "where Respond and StartedActuator begin: their tests go through it",
    "model/response_pass.h": "the inside of Respond, for two files: the tests of response.h go through it",
}


def headers_of(names, rooms):
    """The headers of these rooms; those of a room inside another are that room's own."""
    found = set()
    for room in names:
        for path in (ROOT / room).rglob("*.h"):
            name = path.relative_to(ROOT).as_posix()
            if room_of(name, rooms) == room:
                found.add(name)
    return found


def included_by(folder):
    """All paths that the sources of the folder include, as they are written."""
    sources = [path for ending in ("*.cc", "*.h") for path in folder.rglob(ending)]
    return {name for path in sources for name in INCLUDE.findall(path.read_text())}


class HeadersTest(unittest.TestCase):
    rooms = read_rooms((ROOT / "cmake/rooms.txt").read_text())

    # Tests that clang-tidy looks into the headers of every folder.
    def test_clang_tidy_sees_all(self):
        listed = re.search(r"HeaderFilterRegex: '\(([\w|]+)\)/", (ROOT / ".clang-tidy").read_text())[1].split("|")
        self.assertEqual(listed, sorted({name.split("/")[0] for name in self.rooms} - {"lcmtypes"}))

    def test_rooms_exist(self):
        self.assertEqual(ROOMS - set(self.rooms), set())
        self.assertEqual({room for room in ROOMS if not headers_of({room}, self.rooms)}, set())

    def test_every_header_is_included_by_a_test(self):
        missing = headers_of(ROOMS, self.rooms) - included_by(ROOT / "tests") - set(EXEMPT)
        self.assertEqual(sorted(missing), [], "no file of tests/ includes these: write a test, or give the reason in EXEMPT")

    def test_exemptions_are_needed(self):
        headers, included = headers_of(set(self.rooms), self.rooms), included_by(ROOT / "tests")
        for header, reason in EXEMPT.items():
            self.assertIn(header, headers)
            self.assertNotIn(header, included, "a test includes it: take it out of EXEMPT")
            self.assertTrue(reason.strip())


if __name__ == "__main__":
    unittest.main()
