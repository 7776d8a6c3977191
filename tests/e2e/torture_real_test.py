"""The schedules of tests/sim/torture/real, each in the simulator and on real processes over UDP: the same faults in the same order.

On request (scripts/torture --real), because it takes some five minutes. HYDRO_SCHEDULE=NAME runs one of them, and
HYDRO_SCHEDULES=FOLDER takes schedules of one's own."""

import os

import fault_case
import fault_sequence
import outcome
import process_network
import real_torture
import stack
import torture_schedule


ATTEMPTS = 3


def late(faults):
    """How often the plant found that it had been stopped."""
    return sum(fault.code == "late_plant" and fault.active for fault in faults)


class TortureRealTest(fault_case.FaultCase):
    def key_file(self):
        path = self.path("key")
        self.run_program("hydro-launch", stack.config("demo.toml"), "--set", f"bus.key_file={path}", "--make-key")
        return path

    def network(self, schedule):
        return process_network.Switch(self, real_torture.RealTorture.ROLES) if schedule.needs_hosts else process_network.Loopback()

    def real(self, schedule, network, key_file):
        url = self.url.replace("ttl=0", network.url_options)
        real = real_torture.RealTorture(self, schedule, network, url, self.hashes(), key_file)
        logs = real.run()
        return schedule.comparable(fault_sequence.of_logs(logs, real.began_us))

    def check(self, schedule):
        expected, network, key_file = torture_schedule.simulate(self, schedule), self.network(schedule), self.key_file()
        for left in reversed(range(ATTEMPTS)):
            found = self.real(schedule, network, key_file)
            different = fault_sequence.difference(expected, found)
            print(f"{schedule.name}: {different or f'{len(found)} faults, the same'}", flush=True)
            if not different:
                return
            # When a machine stalls a process for longer than its limit, the run has one fault more than the
            # schedule. The plant reports this. A plant that reports it in every attempt is wrong.
            if late(found) <= late(expected) or not left:
                self.fail(f"{different}\nsimulated:\n{fault_sequence.listed(expected)}real:\n{fault_sequence.listed(found)}")
            print(f"{schedule.name}: once more, because this machine has stalled the plant", flush=True)

    # Tests that it is noticed when the real processes meet something different from the simulated ones: here
    # a loop hangs for longer than its limit, there it does not.
    def test_another_run_is_noticed(self):
        schedule = torture_schedule.Schedule(os.path.join(torture_schedule.SHIPPED, "far_tick.torture"))
        expected = torture_schedule.simulate(self, schedule)
        hang = schedule.injections[0]
        self.assertEqual(hang.kind, "hang")
        schedule.injections[0] = hang._replace(duration=1.2)
        found = self.real(schedule, self.network(schedule), self.key_file())
        self.assertIsNotNone(fault_sequence.difference(expected, found))


def add_tests():
    """One test for each schedule."""
    for schedule in torture_schedule.all_schedules():
        setattr(TortureRealTest, f"test_{schedule.name}", lambda self, schedule=schedule: self.check(schedule))


add_tests()


def load_tests(loader, tests, _):
    """All of them, or the one that was asked for."""
    only = os.environ.get("HYDRO_SCHEDULE")
    return loader.loadTestsFromName(f"TortureRealTest.test_{only}", __import__("__main__")) if only else tests


if __name__ == "__main__":
    outcome.main()
