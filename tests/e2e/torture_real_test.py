"""The schedules of tests/torture/real, each in the simulator and on real processes over UDP: the same faults in the same order.

On request (scripts/torture --real), because it takes some four minutes. HYDRO_SCHEDULE=NAME runs one of them."""

import os

import event_log
import fault_case
import fault_sequence
import lcm_peer
import outcome
import real_torture
import stack
import torture_schedule


class TortureRealTest(fault_case.FaultCase):
    def key_file(self):
        path = self.path("key")
        self.run_program("hydro-launch", stack.config("demo.toml"), "--set", f"bus.key_file={path}", "--make-key")
        return path

    def check(self, schedule):
        expected = fault_sequence.of_simulation(torture_schedule.simulate(self, schedule.path))
        real = real_torture.RealTorture(self, schedule, self.hashes(), self.key_file())
        found = fault_sequence.of_logs(real.run(), real.start_us)
        for injection in schedule.injections:
            if injection.kind == "other_configuration":
                # Whether it hears the plant first, and leaves, or another process that it complains of, is a race.
                expected = fault_sequence.without(expected, injection.target, "other_configuration")
                found = fault_sequence.without(found, injection.target, "other_configuration")
        different = fault_sequence.difference(expected, found)
        print(f"{schedule.name}: {different or f'{len(found)} faults, the same'}", flush=True)
        self.assertIsNone(different, f"\nsimulated:\n{fault_sequence.listed(expected)}"
                                     f"real:\n{fault_sequence.listed(found)}")


def add_tests():
    """One test for each schedule."""
    for schedule in torture_schedule.all_schedules():
        if os.environ.get("HYDRO_SCHEDULE", schedule.name) != schedule.name:
            continue
        setattr(TortureRealTest, f"test_{schedule.name}", lambda self, schedule=schedule: self.check(schedule))


add_tests()

if __name__ == "__main__":
    outcome.main()
