"""What torture_real_test compares, without real processes: that its comparison notices what is different, and that no schedule of
tests/sim/torture/real depends on chance."""

import unittest

import fault_sequence
import outcome
import stack
import torture_schedule
from fault_sequence import Fault, difference

BEGINS = Fault(1.0, "plant", "stale_motor_command", True, False)
ENDS = Fault(2.0, "plant", "stale_motor_command", False, False)
OTHER = Fault(1.5, "pressure_ctrl", "stale_pressure_command", True, False)
# The same moment as ENDS, for another process.
CLOSE = Fault(2.0 + fault_sequence.RACE / 2, "pressure_ctrl", "stale_pressure_command", False, False)
EXPECTED = [BEGINS, OTHER, ENDS, CLOSE]


class DifferenceTest(unittest.TestCase):
    # Tests that only the order of the faults in the compared run matters, and not their times.
    def test_same(self):
        self.assertIsNone(difference(EXPECTED, EXPECTED))
        self.assertIsNone(difference(EXPECTED, [fault._replace(time=7.0) for fault in EXPECTED]))
        self.assertIsNone(difference([], []))

    # Tests that faults of two processes at the same moment may come in either order, and that others may not.
    def test_order_of_two_processes(self):
        self.assertIsNone(difference(EXPECTED, [BEGINS, OTHER, CLOSE, ENDS]))
        self.assertEqual(difference(EXPECTED, [OTHER, BEGINS, ENDS, CLOSE]),
                         "pressure_ctrl stale_pressure_command begins comes before plant stale_motor_command begins")
        self.assertIsNotNone(difference(EXPECTED, [BEGINS, ENDS, OTHER, CLOSE]))

    # Tests that each single fault is noticed that is missing, comes twice, comes from another process or is a
    # different one.
    def test_each_fault_counts(self):
        for n, fault in enumerate(EXPECTED):
            before, after = EXPECTED[:n], EXPECTED[n + 1:]
            for wrong in ([], [fault, fault], [fault._replace(source="logger")], [fault._replace(code="late_plant")],
                          [fault._replace(active=not fault.active)], [fault._replace(latched=True)]):
                self.assertIsNotNone(difference(EXPECTED, before + wrong + after), wrong)
        self.assertIsNotNone(difference([], [BEGINS]))
        self.assertIsNotNone(difference([BEGINS], []))

    # Tests that two faults of one process in the wrong order are noticed, however close they are.
    def test_order_of_one_process(self):
        close = ENDS._replace(time=1.001)
        self.assertIsNotNone(difference([BEGINS, close], [close, BEGINS]))


class ScheduleTest(stack.TestCase):
    def simulated(self, schedule, seed, later):
        path = self.path("run.torture")
        with open(path, "w", encoding="utf-8") as file:
            file.write(schedule.text(seed, later))
        return torture_schedule.simulate(self, torture_schedule.Schedule(path))

    # Tests that the simulator gives the same faults in the same order, whatever the latencies, the order in
    # which processes start and the phase of the reference are, so that differences with real processes are no
    # accident. Also tests that each schedule has faults and that no two schedules have the same ones, so that
    # none can pass for another.
    def test_no_chance(self):
        schedules = torture_schedule.all_schedules()
        self.assertEqual(len(schedules), 26)
        seen = []
        for schedule in schedules:
            first = self.simulated(schedule, seed=1, later=0)
            self.assertTrue(first, schedule.name)
            for other in (self.simulated(schedule, seed=2, later=0.137), self.simulated(schedule, seed=3, later=0.471)):
                self.assertIsNone(difference(first, other), schedule.name)
            for name, faults in seen:
                self.assertIsNotNone(difference(faults, first), f"{name} and {schedule.name} have the same faults")
            seen.append((schedule.name, first))


if __name__ == "__main__":
    outcome.main()
