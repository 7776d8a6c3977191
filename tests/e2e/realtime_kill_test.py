"""What happens to a run in real time when one of its processes dies.

Documented outcome, by hand: the others go on in a safe state and name the fault; when the process is started again the
fault ends and the run resumes. fault_loops_test.py kills the logger.
"""

import math
import os
import signal

import event_log
import outcome
import stack

RATE = 1000  # Hz, of demo.toml
RAMP = 200  # ticks, the default of limits.pressure_ramp_s
# s, limits.stale_input_s. It is above the lateness of wake-ups here (up to 150 ms), so that only a dead
# process is stale.
STALE = 0.3


def of_code(code, active):
    return lambda fault: fault.code == code and bool(fault.active) == active


class RealtimeKillTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.log_file = self.path("run.lcmlog")
        self.config = self.config_with_sine()
        self.run_ = self.stack(self.config, "--time", "realtime", "--duration", "0", "--set",
                               f"limits.stale_input_s={STALE}")
        self.log = self.run_.start_all(log=self.log_file)
        self.log.wait_for_tick(200)

    def config_with_sine(self):
        """demo.toml with a reference that never settles, so that the voltage of a running loop is never zero for
        long."""
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read()
        reference = text.index("[reference]")
        end = text.index("[limits]")
        text = (text[:reference] + '[reference]\nsignal = "arm_angle"\nkind = "sine"\namplitude = 0.2\n'
                "frequency_hz = 0.5\n\n" + text[end:])
        text = text.replace("models/table1.toml", os.path.join(stack.CONFIG, "models", "table1.toml"))
        path = self.path("sine.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def finish(self):
        """SIGTERM to the plant ends the run in order for all."""
        self.run_["plant"].send(signal.SIGTERM)
        for role in ("plant", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())
        return event_log.Log(self.log_file)

    def wait_for_fault(self, code, active, start=0):
        return self.log.wait_for("HYDRO_FAULT", of_code(code, active), f"fault {code}, active {active}", start=start)

    def wait_for_law(self, after_tick):
        return self.log.wait_for("HYDRO_MOTOR_COMMAND",
                                 lambda c: c.tick > after_tick and c.status == event_log.LAW and c.voltage != 0,
                                 "commands of the law again", start=self.log.count("HYDRO_MOTOR_COMMAND"))

    # Tests that without a pressure loop the plant goes to zero volts and says so, and that a new one takes
    # over.
    def test_pressure_ctrl_killed(self):
        self.run_["pressure_ctrl"].kill()
        self.run_["pressure_ctrl"].wait()
        fault = self.wait_for_fault("stale_motor_command", True)
        self.assertEqual(fault.source, "plant")
        self.log.wait_for_tick(fault.tick + 200)
        resumed_at = self.log.messages["HYDRO_STATE"][-1].tick
        self.run_.start("pressure_ctrl")
        self.wait_for_fault("stale_motor_command", False)
        self.wait_for_law(resumed_at)
        log = self.finish()

        first_session = log.motor_commands[0].session
        last_command = max(c.tick for c in log.motor_commands if c.session == first_session)
        safe = [s for s in log.states if s.tick > fault.tick + 1 and s.tick <= resumed_at]
        self.assertTrue(safe)
        for state in safe:
            self.assertEqual((state.voltage, state.command_tick), (0, -1), state)
        # The voltage was held no longer than the limit plus the ticks that it takes to notice: one for the
        # command's own delay, one to act, and those through which the plant slept.
        held = max(s.tick for s in log.states if s.command_tick == last_command)
        slept = max(s.skipped_ticks for s in log.states)
        self.assertLessEqual(held - last_command, STALE * RATE + 3 + slept + 2)

    # Tests that without a position loop the pressure loop goes to zero volts and says so, until there is a
    # position loop again. fault_loops_test.py tests how it gets there.
    def test_position_ctrl_killed(self):
        self.run_["position_ctrl"].kill()
        self.run_["position_ctrl"].wait()
        fault = self.wait_for_fault("stale_pressure_command", True)
        self.assertEqual(fault.source, "pressure_ctrl")
        self.log.wait_for_tick(fault.tick + RAMP + 200)
        self.run_.start("position_ctrl")
        gone = self.wait_for_fault("stale_pressure_command", False)
        self.wait_for_law(gone.tick)
        log = self.finish()
        between = [c for c in log.motor_commands if fault.tick + RAMP <= c.tick < gone.tick]
        self.assertTrue(between)
        for command in between:
            self.assertEqual((command.status, command.voltage), (event_log.SAFE, 0), command)
        self.assertFalse([f for f in log.faults if f.code == "stale_motor_command"])  # the pressure loop went on
        # The clock of both loops is the tick, so the fault came exactly where the command was too old.
        last = max(c.tick for c in log.pressure_commands if c.tick <= fault.tick)
        interval = 5
        limit = 1 + interval + math.ceil(STALE * RATE)
        first_safe = min(c.tick for c in log.motor_commands if c.status == event_log.SAFE)
        self.assertGreaterEqual(first_safe - last, limit + RAMP)

    # Tests that without a plant the pressure loop commands zero volts once and names the fault, and that a
    # new plant can continue with all the other processes.
    def test_plant_killed(self):
        self.run_["plant"].kill()
        self.run_["plant"].wait()
        fault = self.wait_for_fault("stale_state", True)
        self.assertEqual(fault.source, "pressure_ctrl")
        self.log.update()
        last = self.log.messages["HYDRO_MOTOR_COMMAND"][-1]
        self.assertEqual((last.status, last.voltage), (event_log.SAFE, 0))
        commands = self.log.count("HYDRO_MOTOR_COMMAND")
        states = self.log.count("HYDRO_STATE")
        self.run_.start("plant", "--expect", "logger")
        self.wait_for_fault("stale_state", False)
        self.log.wait_for("HYDRO_STATE", lambda s: s.tick >= 200, "tick 200 of the new plant", start=states)
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW and c.tick >= 200,
                          "commands for the new plant", start=commands)
        self.finish()


if __name__ == "__main__":
    outcome.main()
