"""Starting in any order and stopping by signal, by hand and under hydro-launch."""

import itertools
import os
import re
import signal

import event_log
import outcome
import stack


class StopTest(stack.TestCase):
    def check_end(self, log_file):
        """The actuator's last command is zero volts, the log is whole, and it ends where the run ended."""
        log = event_log.Log(log_file)
        self.assertEqual((log.motor_commands[-1].status, log.motor_commands[-1].voltage), (event_log.STOPPED, 0))
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        self.assertEqual(log.stops[0].exit_code, 0, log.stops)
        return log

    # Tests that a signal to hydro-launch ends the stack in order, and leaves no process behind.
    def test_launch_stopped(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for mode in ("realtime", "lockstep"):
                with self.subTest(signal=number, mode=mode):
                    log_file = self.path(f"{mode}-{number}.lcmlog")
                    launch = self.launch(stack.config("demo.toml"), "--time", mode, "--duration", "0", "--log",
                                         log_file)
                    live = stack.LiveLog(self, log_file)
                    live.wait_for_tick(100)
                    pids = set(live.pids().values())
                    launch.send(number)
                    self.assertEqual(launch.wait(), 0, launch.report())
                    self.assertEqual(len(pids), 4)
                    self.assertEqual(stack.still_running(pids), [])
                    self.check_end(log_file)

    # Tests that a stopped simulation says so, and when it stopped, and that its log is whole up to there and
    # says the same.
    def test_simulation_stopped(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                log_file = self.path(f"{number}.lcmlog")
                simulation = self.start("hydro-sim", stack.config("demo.toml"), "--duration", "100000", "-o", log_file)
                part = log_file + ".part"
                self.wait_until(lambda: os.path.exists(part) and os.path.getsize(part) > 0, "the log grows")
                simulation.send(number)
                self.assertEqual(simulation.wait(), 0, simulation.report())
                end = self.check_end(log_file).states[-1].time
                said = re.fullmatch(rf"hydro-sim: stopped by signal {number:d}: the run and its log {re.escape(log_file)} "
                                    r"end after (\S+) s of plant time\n", simulation.stderr)
                self.assertTrue(said, simulation.report())
                self.assertAlmostEqual(float(said[1]), end, delta=1e-5 * end)
                summary = self.run_program("hydro-log", "summary", log_file).stdout
                self.assertRegex(summary, rf"\Athe run was stopped at tick \d+: plant: hydro-sim was stopped by signal {number:d}\n")

    # Tests that the processes of a stack may start in any order: each waits until all are there, and none
    # hangs.
    def test_any_order(self):
        alone = self.path("alone.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.3", "-o", alone)
        for number, order in enumerate(itertools.permutations(("plant", "pressure_ctrl", "position_ctrl", "logger"))):
            with self.subTest(order=order):
                log_file = self.path(f"{number}.lcmlog")
                run = self.stack(stack.config("demo.toml"), "--time", "lockstep", "--duration", "0.3",
                                 url=self.new_url())
                for role in order:
                    run.start(role, *{"plant": ("--expect", "logger"), "logger": ("-o", log_file)}.get(role, ()))
                for process in run.processes.values():
                    self.assertEqual(process.wait(), 0, process.report())
                self.assert_identical(alone, log_file)

    # Tests that the plant waits for missing processes, names them, and gives up after time.start_timeout_s.
    def test_missing_participant(self):
        run = self.stack(stack.config("demo.toml"), "--set", "time.start_timeout_s=2.5")
        run.start("plant")
        run.start("pressure_ctrl")
        run["plant"].wait_for("waiting for position_ctrl$")
        for role in ("plant", "pressure_ctrl"):
            self.assertEqual(run[role].wait(), 1, run[role].report())


if __name__ == "__main__":
    outcome.main()
