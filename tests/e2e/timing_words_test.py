"""A stopped terminal, or a pipe that nobody empties, delays no loop."""

import os
import signal
import subprocess

import event_log
import outcome
import stack


class WordsTest(stack.TestCase):
    def full_pipe(self):
        """A pipe into which nothing more fits: (reading end, writing end)."""
        reading, writing = os.pipe()
        self.addCleanup(os.close, reading)
        os.set_blocking(writing, False)
        try:
            while True:
                os.write(writing, b"x" * 512)
        except BlockingIOError:
            pass
        try:
            while True:
                os.write(writing, b"x")
        except BlockingIOError:
            pass
        os.set_blocking(writing, True)
        return reading, writing

    # Tests that a plant whose output is not read continues to tick while it has something to print, at the
    # beginning and end of a fault. When its output is read at last, all of it is there.
    def test_full_pipe(self):
        log_file = self.path("run.lcmlog")
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", "--set",
                         "limits.stale_input_s=0.3")
        run.start("logger", "-o", log_file)
        run.start("position_ctrl")
        run.start("pressure_ctrl")
        reading, writing = self.full_pipe()
        plant = subprocess.Popen([stack.program("hydro-plant"), *map(str, run.arguments), "--expect", "logger"],
                                 stdin=subprocess.DEVNULL, stderr=writing)
        self.addCleanup(plant.wait)
        self.addCleanup(plant.kill)
        os.close(writing)
        live = stack.LiveLog(self, log_file)
        live.wait_for_tick(100)
        run["pressure_ctrl"].send(signal.SIGSTOP)
        fault = live.wait_for("HYDRO_FAULT", lambda f: f.code == "stale_motor_command" and f.active,
                              "stale_motor_command")
        live.wait_for_tick(fault.tick + 500)
        run["pressure_ctrl"].send(signal.SIGCONT)
        live.wait_for("HYDRO_FAULT", lambda f: f.code == "stale_motor_command" and not f.active, "its end")
        live.wait_for_tick(live.messages["HYDRO_STATE"][-1].tick + 500)
        plant.send_signal(signal.SIGTERM)
        live.wait_for("HYDRO_PROCESS_STATUS", lambda s: s.role == "plant" and s.state == event_log.DONE, "its end")
        words = b""
        while piece := os.read(reading, 65536):
            words += piece
        self.assertEqual(plant.wait(stack.PATIENCE), 0)
        self.assertIn(b"fault stale_motor_command: ", words)
        self.assertIn(b"fault stale_motor_command has gone", words)


if __name__ == "__main__":
    outcome.main()
