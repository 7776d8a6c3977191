"""Two hosts whose wall clocks differ, drift and are set: control and statistics do not care. A library that is preloaded
shifts CLOCK_REALTIME of the programs on one host, as shifted_clock.c says; the monotonic clock, by which nothing compares
hosts, is what it is."""

import os
import shutil
import subprocess

import event_log
import outcome
import two_hosts


# Voltages that do not move the arm. Messages are enough here, and the ticks for which the test machine is
# late do not matter.
STILL = ("--set", "reference.signal=voltage", "--set", "reference.steps=[[0.2, 0.2]]")


class ClocksTest(two_hosts.TestCase):
    def setUp(self):
        super().setUp()
        compiler = shutil.which("cc") or shutil.which("gcc")
        if compiler is None:
            self.skipTest("needs a C compiler, for shifted_clock.c")
        self.library = self.path("shifted_clock.so")
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "shifted_clock.c")
        subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", self.library, source, "-lm"], check=True)

    def shifted(self, offset_s, drift=0.0, step_s=0.0, step_after_s=0.0):
        return {"LD_PRELOAD": self.library, "HYDRO_CLOCK_OFFSET_S": offset_s, "HYDRO_CLOCK_DRIFT": drift,
                "HYDRO_CLOCK_STEP_S": step_s, "HYDRO_CLOCK_STEP_AFTER_S": step_after_s}

    def clock_difference(self, log):
        """s, that the desk's clock is ahead of the rig's, of each pressure command and the state that it answers."""
        sent = {s.tick: s.utime for s in log.states}
        return [(c.utime - sent[c.tick]) * 1e-6 for c in log.pressure_commands if c.tick in sent]

    # Tests that a lockstep run over hosts whose clocks are 10 s apart and drift by 1 % is that of hydro-sim,
    # bit by bit.
    def test_lockstep(self):
        self.run_both("--time", "lockstep", "--duration", "1", environments={"desk": self.shifted(10, drift=0.01)})
        log_file = self.log_of("desk")
        self.assertGreater(min(self.clock_difference(event_log.Log(log_file))), 9)
        simulated = self.path("sim.lcmlog")
        self.run_program("hydro-sim", self.config, "--duration", "1", "-o", simulated)
        self.assert_identical(log_file, simulated)

    def assert_nothing_but_the_clock(self, log):
        """No fault, nothing lost, and no statistic spoilt by a clock that is off."""
        self.assertEqual({f.code for f in log.faults} - {"late_plant"}, set(), log.faults)
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        self.assertEqual({s.role for s in log.statistics}, {"plant", "pressure_ctrl", "position_ctrl", "logger"})
        for report in log.statistics:
            for name in ("interval_s", "period_p50_us", "period_max_us", "latency_p50_us", "latency_max_us"):
                value = getattr(report, name) * (1 if name == "interval_s" else 1e-6)
                self.assertGreaterEqual(value, 0, (report.role, name))
                self.assertLess(value, 9, (report.role, name))
            self.assertEqual(report.lost_messages, 0, report)

    # Tests that in real time a clock that is 10 s behind, drifts, and jumps forward by 30 s during the run
    # disturbs nothing.
    def test_realtime_forward(self):
        self.run_both("--time", "realtime", "--duration", "3", *STILL, *two_hosts.PATIENT,
                      environments={"desk": self.shifted(-10, drift=0.005, step_s=30, step_after_s=1.5)})
        log = event_log.Log(self.log_of("desk"))
        difference = self.clock_difference(log)
        self.assertLess(difference[0], -9)
        self.assertGreater(difference[-1], 19)
        self.assert_nothing_but_the_clock(log)

    # Tests the same for the clock of the plant's host, which is set back during the run.
    def test_realtime_back(self):
        self.run_both("--time", "realtime", "--duration", "3", *STILL, *two_hosts.PATIENT,
                      environments={"rig": self.shifted(10, drift=-0.005, step_s=-30, step_after_s=1.5)})
        log = event_log.Log(self.log_of("desk"))
        difference = self.clock_difference(log)
        self.assertLess(difference[0], -9)
        self.assertGreater(difference[-1], 19)
        self.assert_nothing_but_the_clock(log)


if __name__ == "__main__":
    outcome.main()
