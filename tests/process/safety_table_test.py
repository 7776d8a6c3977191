"""Tests that the tests which the safety table (process/safety) names exist, and that those of tests/e2e hold its promise.

    safety_table_test.py SAFETY_PAGE     the program that prints the table
"""

import ast
import json
import pathlib
import re
import subprocess
import sys
import unittest

TESTS = pathlib.Path(__file__).resolve().parents[1]
UNIT = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)


def e2e_tests():
    """file.Class.method of each test of tests/e2e."""
    found = set()
    for path in (TESTS / "e2e").glob("*_test.py"):
        for group in ast.parse(path.read_text()).body:
            if isinstance(group, ast.ClassDef):
                found |= {f"{path.name.removesuffix('_test.py')}.{group.name}.{method.name}" for method in group.body
                          if isinstance(method, ast.FunctionDef) and method.name.startswith("test")}
    return found


def unit_tests():
    """folder/Suite.Name of each GoogleTest below tests/."""
    return {f"{path.parent.relative_to(TESTS).as_posix()}/{suite}.{name}" for path in TESTS.rglob("*_test.cc")
            for suite, name in UNIT.findall(path.read_text())}


def constant(file, name):
    """A number that a module of tests/e2e assigns, without importing it."""
    for statement in ast.parse((TESTS / "e2e" / file).read_text()).body:
        if isinstance(statement, ast.Assign) and [t.id for t in statement.targets if isinstance(t, ast.Name)] == [name]:
            return ast.literal_eval(statement.value)
    raise KeyError(name)


class SafetyTableTest(unittest.TestCase):
    table = {}

    def test_named_tests_exist(self):
        existing = e2e_tests() | unit_tests()
        self.assertGreater(len(existing), 500)
        named = [(row["id"], test) for row in self.table["rows"] for test in row["tests"]]
        self.assertGreater(len(named), 50)
        self.assertEqual([pair for pair in named if pair[1] not in existing], [])

    def test_each_test_of_a_row_is_named(self):
        """Tests that no test of the pages of docs/safety.md is forgotten in the table, those of RearmTest aside: they show
        "Faults that stay"."""
        named = {test for row in self.table["rows"] for test in row["tests"]}
        files = ("fault_commands", "fault_limits", "fault_loops", "fault_network", "fault_stop")
        there = {test for test in e2e_tests() if test.split(".")[0] in files and ".RearmTest." not in test}
        self.assertEqual(sorted(there - named - NO_ROW), [])
        self.assertEqual(sorted(NO_ROW - there), [])

    def test_end_to_end_tests_hold_the_promise(self):
        self.assertEqual(constant("fault_case.py", "ZERO_WITHIN"), self.table["zero_volts_within_ticks"])


# What is allowed, and how a launch ends.
NO_ROW = {
    "fault_commands.MotorCommandTest.test_all_that_is_allowed",
    "fault_commands.PressureCommandTest.test_all_that_is_allowed",
    "fault_stop.StopTest.test_logger_is_killed",
    "fault_stop.StopTest.test_nobody",
}

if __name__ == "__main__":
    SafetyTableTest.table = json.loads(subprocess.run([sys.argv[1], "--json"], check=True, capture_output=True).stdout)
    unittest.main(argv=sys.argv[:1] + ["-v"])
