"""What happens to a lockstep run when one of its processes dies or stalls: it ends by itself, and says who it was.

Documented outcome, by hand and under hydro-launch: within 2 s all others have ended with exit code 1 and have named the
missing process on stderr. No process waits for ever or goes on computing without an answer.
"""

import os
import signal
import time

import event_log
import outcome
import stack

ROLES = ("plant", "pressure_ctrl", "position_ctrl", "logger")
LIMIT = 2.0  # s, what is promised
# Far longer than the tests, so that no run ends by itself during a test.
OPTIONS = ("--time", "lockstep", "--duration", "3600")


class LockstepKillTest(stack.TestCase):
    def start_by_hand(self):
        run = self.stack(stack.config("demo.toml"), *OPTIONS)
        run.start_all(log=self.path("run.lcmlog")).wait_for_tick(200)
        return run

    def assert_others_end(self, run, since, victim):
        for role, process in run.others(victim).items():
            code = process.wait()
            elapsed = time.monotonic() - since
            self.assertEqual(code, 1, process.report())
            self.assertLess(elapsed, LIMIT + stack.MACHINE_MARGIN, process.report())

    def assert_named(self, run, victim):
        said = "".join(process.stderr for process in run.others(victim).values())
        what = "the plant has sent no state" if victim == "plant" else f"{victim} has not answered tick"
        self.assertIn(what, said)

    def check_log(self):
        log = event_log.Log(self.path("run.lcmlog"), torn_tail=True)
        last = log.states[-1].tick
        # Lockstep does not advance without an answer, so at most the last tick lacks one.
        self.assertLessEqual(last - max(c.tick for c in log.motor_commands), 1)
        return log

    def kill_by_hand(self, victim):
        run = self.start_by_hand()
        since = time.monotonic()
        run[victim].kill()
        self.assert_others_end(run, since, victim)
        return run

    # Tests the death of each process of a stack that was started by hand.
    def test_plant_killed(self):
        run = self.kill_by_hand("plant")
        log = self.check_log()
        # The pressure loop's last command to the actuator is zero volts.
        self.assertEqual((log.motor_commands[-1].status, log.motor_commands[-1].voltage), (event_log.STOPPED, 0))
        self.assertIn(log.stops[0].source, ("pressure_ctrl", "position_ctrl"))
        self.assertIn("the plant has sent no state", log.stops[0].reason)
        self.assert_named(run, "plant")

    def test_pressure_ctrl_killed(self):
        run = self.kill_by_hand("pressure_ctrl")
        log = self.check_log()
        self.assertEqual(log.stops[0].source, "plant")
        self.assertIn("pressure_ctrl has not answered tick", log.stops[0].reason)
        self.assert_named(run, "pressure_ctrl")

    def test_position_ctrl_killed(self):
        run = self.kill_by_hand("position_ctrl")
        log = self.check_log()
        self.assertEqual(log.stops[0].source, "plant")
        self.assertIn("position_ctrl has not answered tick", log.stops[0].reason)
        self.assert_named(run, "position_ctrl")

    def test_logger_killed(self):
        run = self.kill_by_hand("logger")
        self.check_log()
        self.assert_named(run, "logger")

    # Tests that a loop that stalls counts as dead, and is told so when it continues.
    def test_pressure_ctrl_stalled(self):
        run = self.start_by_hand()
        since = time.monotonic()
        run["pressure_ctrl"].send(signal.SIGSTOP)
        self.assert_others_end(run, since, "pressure_ctrl")
        self.assertEqual(self.check_log().stops[0].source, "plant")
        run["pressure_ctrl"].send(signal.SIGCONT)
        self.assertEqual(run["pressure_ctrl"].wait(), 1, run["pressure_ctrl"].report())
        self.assert_named(run, "pressure_ctrl")

    # Tests that a stall shorter than time.stall_timeout_s changes nothing but the duration of the run.
    def test_short_stall(self):
        lone = self.path("lone.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "4", "-o", lone)
        run = self.stack(stack.config("demo.toml"), "--time", "lockstep", "--duration", "4", "--set",
                         "time.stall_timeout_s=1.9")
        log_file = self.path("run.lcmlog")
        run.start_all(log=log_file).wait_for_tick(50)
        for role in ("pressure_ctrl", "position_ctrl", "logger", "plant"):
            if run[role].running:
                run[role].send(signal.SIGSTOP)
                time.sleep(0.2)  # the stall itself, two repetitions of the plant's question
                run[role].send(signal.SIGCONT)
        for process in run.processes.values():
            self.assertEqual(process.wait(), 0, process.report())
        self.assert_identical(lone, log_file)


class LaunchedLockstepKillTest(stack.TestCase):
    def start_launch(self):
        launch = self.launch(stack.config("demo.toml"), *OPTIONS, "--log", self.path("run.lcmlog"))
        log = stack.LiveLog(self, self.path("run.lcmlog"))
        log.wait_for_tick(200)
        pids = log.pids()
        self.assertEqual(set(pids), set(ROLES))
        return launch, pids

    def kill_under_launch(self, victim):
        launch, pids = self.start_launch()
        since = time.monotonic()
        os.kill(pids[victim], signal.SIGKILL)
        self.assertEqual(launch.wait(), 1, launch.report())
        self.assertLess(time.monotonic() - since, LIMIT + stack.MACHINE_MARGIN)
        self.assertRegex(launch.stderr, f"{stack.PROGRAMS[victim]} was killed by signal 9")
        self.assertEqual(stack.still_running(pids.values()), [])

    # Tests the death of each process of a launched stack: hydro-launch names it, ends with 1, and leaves no
    # orphan.
    def test_plant_killed(self):
        self.kill_under_launch("plant")

    def test_pressure_ctrl_killed(self):
        self.kill_under_launch("pressure_ctrl")

    def test_position_ctrl_killed(self):
        self.kill_under_launch("position_ctrl")

    def test_logger_killed(self):
        self.kill_under_launch("logger")

    # Tests that a loop that stalls also ends a launched run, and is not left behind.
    def test_pressure_ctrl_stalled(self):
        launch, pids = self.start_launch()
        os.kill(pids["pressure_ctrl"], signal.SIGSTOP)
        self.assertEqual(launch.wait(), 1, launch.report())
        self.assertIn("pressure_ctrl has not answered", launch.stderr)
        self.assertEqual(stack.still_running(pids.values()), [])

    # Tests that processes do not outlive a launch that is itself killed.
    def test_launch_killed(self):
        launch, pids = self.start_launch()
        launch.kill()
        launch.wait()
        self.wait_until(lambda: not stack.still_running(pids.values()), "the end of all processes")


if __name__ == "__main__":
    outcome.main()
