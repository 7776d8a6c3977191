"""The death of each process of a launched stack, in either kind of time."""

import os
import signal
import time

import stack

ROLES = ("plant", "pressure_ctrl", "position_ctrl", "logger")


class LaunchedKills:
    """For a stack.TestCase whose start_launch() returns the launch and its processes' ids by role."""

    limit = None  # s, until the launch must have ended; None: it only has to end

    def kill_under_launch(self, victim):
        launch, pids = self.start_launch()
        since = time.monotonic()
        os.kill(pids[victim], signal.SIGKILL)
        self.assertEqual(launch.wait(), 1, launch.report())
        if self.limit is not None:
            self.assertLess(time.monotonic() - since, self.limit + stack.MACHINE_MARGIN)
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
