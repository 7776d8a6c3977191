"""Rows of docs/safety.md: a process dies, hangs or is late, in real time, with the real programs."""

import math
import resource
import signal

import event_log
import fault_case
import outcome
import stack
from fault_case import RATE, STALE

INTERVAL = 5  # ticks of the position loop, of demo.toml
HOLD = 1 + INTERVAL + math.ceil(STALE * RATE)  # ticks that a pressure reference is held
RAMP = 200  # ticks, the default of limits.pressure_ramp_s


class FaultLoopsTest(fault_case.FaultCase):
    def start_moving(self, *options):
        log = self.start_stack(*options)
        log.wait_for_tick(300)
        self.wait_for_voltage()

    def check_stale_motor_command(self, log):
        """The plant went to zero volts, and not before the limit: in ticks, by the states' own account."""
        self.assert_was_moving(log, "stale_motor_command")
        self.assertEqual(self.assert_zero_during(log, "stale_motor_command", "plant"), 0)
        fault = next(f for f in log.faults if f.code == "stale_motor_command")
        last = max((s for s in log.states if s.tick <= fault.tick and s.command_tick >= 0), key=lambda s: s.tick)
        held = fault.tick - last.command_tick
        slept = sum(s.skipped_ticks for s in log.states if last.command_tick < s.tick <= fault.tick)
        print(f"the newest command was {held} ticks old, {STALE * RATE:.0f} allowed", flush=True)
        self.assertGreaterEqual(held, STALE * RATE)
        self.assertLessEqual(held, STALE * RATE + fault_case.ZERO_WITHIN + slept)

    # Tests that without a pressure loop the plant goes to zero volts.
    def test_pressure_loop_dies(self):
        self.start_moving()
        self.run_["pressure_ctrl"].kill()
        self.wait_for_fault("stale_motor_command")
        self.wait_for_states(100)
        self.check_stale_motor_command(self.finish())

    # Tests the limit of a real-time machine, five ticks (config/realtime.toml), at a rate at which the late
    # wake-ups of this machine stay below a tick or two.
    def test_five_ticks(self):
        rate, limit = 50, 5
        voltage = self.config_with('signal = "voltage"\nkind = "steps"\ninitial = 1.5')
        self.start_stack("--set", f"plant.rate_hz={rate}", "--set", "position.sample_interval_s=0.02", "--set",
                         f"limits.stale_input_s={limit / rate}", config=voltage)
        self.log.wait_for_tick(20)
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].kill()
        killed = self.log.messages["HYDRO_STATE"][-1].tick
        fault = self.log.wait_for("HYDRO_FAULT", lambda f: f.code == "stale_motor_command" and f.tick >= killed, "a fault")
        self.wait_for_states(20)
        log = self.finish()
        last = max(c.tick for c in log.motor_commands if c.status == event_log.OPEN_LOOP)
        slept = sum(s.skipped_ticks for s in log.states if last < s.tick <= fault.tick)
        print(f"{fault.tick - last} ticks after the last command it was stale, {limit} allowed", flush=True)
        self.assertLessEqual(fault.tick - last, limit + 2 + slept)
        after = [s for s in log.states if s.tick > fault.tick]
        self.assertGreater(len(after), 10)
        self.assertEqual([s for s in after if s.voltage != 0], [])

    # Tests the same for a pressure loop that hangs, that its late answers to old states have no effect, and
    # that control returns when it continues.
    def test_pressure_loop_hangs(self):
        self.start_moving()
        self.run_["pressure_ctrl"].send(signal.SIGSTOP)
        self.wait_for_fault("stale_motor_command")
        self.wait_for_states(100)
        self.run_["pressure_ctrl"].send(signal.SIGCONT)
        self.wait_for_fault("stale_motor_command", active=False)
        self.wait_for_voltage()
        log = self.finish()
        self.check_stale_motor_command(log)
        slept = max(s.skipped_ticks for s in log.states)
        for state in log.states:
            if state.command_tick >= 0:
                self.assertLessEqual(state.tick - state.command_tick, STALE * RATE + 10 + 2 * slept, state)

    # Tests that without a position loop the last pressure reference is held for the stale limit and then goes
    # to zero in a line, after which the voltage is zero. The numbers of ticks are exact, because the pressure
    # loop counts ticks.
    def check_position_loop_gone(self, log):
        last = next(f for f in log.faults if f.code == "stale_pressure_command")
        newest = [m for kind, m in self.before_fault(log, last.code) if kind == "HYDRO_PRESSURE_COMMAND"][-1]
        stale = [c for c in log.motor_commands if c.pressure_command_tick == newest.tick and
                 c.status in (event_log.LAW, event_log.SAFE)]
        held = [c for c in stale if c.tick - newest.tick <= HOLD]
        ramp = [c for c in stale if HOLD < c.tick - newest.tick < HOLD + RAMP]
        done = [c for c in stale if c.tick - newest.tick >= HOLD + RAMP]
        print(f"{len(held)} commands held, {len(ramp)} on the ramp, {len(done)} safe; "
              f"detected {last.tick - newest.tick} ticks after the last pressure command", flush=True)
        for commands in (held, ramp, done):
            self.assertGreater(len(commands), 3)
        # The first state after the limit raised the fault. It is late only by ticks for which there was no
        # state.
        self.assertEqual(last.tick, min(c.tick for c in ramp))
        for c in held:
            self.assertEqual((c.status, c.pressure_ref), (event_log.LAW, newest.pressure_ref), c)
        for c in ramp:
            share = 1 - (c.tick - newest.tick - HOLD) / RAMP
            self.assertEqual(c.status, event_log.LAW, c)
            self.assertAlmostEqual(c.pressure_ref, newest.pressure_ref * share, delta=1e-9 * abs(newest.pressure_ref))
        for c in done:
            self.assertEqual((c.status, c.voltage), (event_log.SAFE, 0), c)
        self.assertFalse([f for f in log.faults if f.code == "stale_motor_command"], "the pressure loop went on")
        # The plant obeys: there is no voltage after the first safe command.
        safe = min(c.tick for c in done)
        later = [s for s in log.states if s.command_tick >= safe and s.command_tick in {c.tick for c in done}]
        self.assertGreater(len(later), 20)
        self.assertEqual([s for s in later if s.voltage != 0], [])

    def test_position_loop_dies(self):
        self.start_moving()
        self.run_["position_ctrl"].kill()
        fault = self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        self.log.wait_for_tick(fault.tick + RAMP)
        self.wait_for_states(100)
        self.check_position_loop_gone(self.finish())

    def test_position_loop_hangs(self):
        self.start_moving()
        self.run_["position_ctrl"].send(signal.SIGSTOP)
        fault = self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        self.log.wait_for_tick(fault.tick + RAMP)
        self.wait_for_states(100)
        self.run_["position_ctrl"].send(signal.SIGCONT)
        self.wait_for_fault("stale_pressure_command", active=False)
        self.wait_for_voltage()
        self.check_position_loop_gone(self.finish())

    # Tests that the pressure loop answers a hanging plant with zero volts, and that the plant, when it
    # continues, obeys no command from before but stays at zero volts until a command computed from a later
    # state.
    def test_plant_hangs(self):
        self.start_moving()
        self.run_["plant"].send(signal.SIGSTOP)
        self.wait_for_fault("stale_state", source="pressure_ctrl")
        self.log.update()
        command = self.log.messages["HYDRO_MOTOR_COMMAND"][-1]
        self.assertEqual((command.status, command.voltage), (event_log.SAFE, 0))
        self.run_["plant"].send(signal.SIGCONT)
        self.wait_for_fault("late_plant", source="plant")
        self.wait_for_fault("late_plant", active=False)
        self.wait_for_fault("stale_state", active=False)
        self.wait_for_voltage()
        log = self.finish()
        self.assertEqual(self.assert_zero_during(log, "late_plant", least=0), 0)
        fault = next(f for f in log.faults if f.code == "late_plant")
        awake = next(s for s in log.states if s.tick == fault.tick)
        self.assertGreater(awake.skipped_ticks, STALE * RATE)
        after = next(s for s in log.states if s.tick > fault.tick and s.command_tick >= 0)
        self.assertGreaterEqual(after.command_tick, fault.tick)
        # The position loop held its reference and returned from there. The replay does the same, because the
        # log holds the faults.
        self.assertIn("position: identical", self.run_program("hydro-log", "replay", self.log_file).stdout)

    # Tests that the pressure loop commands zero volts once when the plant has died.
    def test_plant_dies(self):
        self.start_moving()
        self.run_["plant"].kill()
        self.wait_for_fault("stale_state", source="pressure_ctrl")
        log = self.end_without_plant()
        last = [c for c in log.motor_commands if c.status != event_log.STOPPED][-1]
        self.assertEqual((last.status, last.voltage), (event_log.SAFE, 0))

    def end_without_plant(self):
        for role in ("pressure_ctrl", "position_ctrl", "logger"):
            self.run_[role].send(signal.SIGTERM)
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())
        return event_log.Log(self.log_file)

    def start_second_logger(self):
        second = self.start("hydro-logger", *self.run_.arguments, "-o", self.path("second.lcmlog"))
        second_log = stack.LiveLog(self, self.path("second.lcmlog"))
        second_log.wait_for("HYDRO_STATE", lambda s: True, "a state in the second log")
        return second, second_log

    def check_control_went_on(self, states, commands):
        answered = {c.tick for c in commands if c.status == event_log.LAW}
        self.assertGreater(len(states), 200)
        # Commands at the very end were overtaken by the run's end.
        self.assertEqual([s.tick for s in states if s.tick not in answered and s.tick < max(answered)], [])
        self.assertTrue([s for s in states if s.voltage != 0])

    # Tests that control continues without a logger, that the plant reports this, and that it notices when a
    # logger is back.
    def test_logger_dies(self):
        self.start_moving("--set", "limits.stale_logger_s=0.6")
        self.run_["logger"].kill()
        self.run_["plant"].wait_for("fault logger_gone: logger on .* silent for")
        second, log = self.start_second_logger()
        self.run_["plant"].wait_for("fault logger_gone has gone")
        self.wait_until(lambda: log.count("HYDRO_STATE") > 300, "300 states")
        self.run_["plant"].send(signal.SIGTERM)
        for process in (self.run_["plant"], self.run_["pressure_ctrl"], self.run_["position_ctrl"], second):
            self.assertEqual(process.wait(), 0, process.report())
        after = event_log.Log(self.path("second.lcmlog"))
        self.assertEqual({f.code for f in after.faults if f.active} - {"logger_gone"}, set())
        self.check_control_went_on(after.states[:-1], after.motor_commands)

    # Tests that a full disk ends the logger with 1 and a log that is readable up to that point, while control
    # continues and the plant says why the run is no longer recorded.
    def test_disk_full(self):
        self.start_stack(roles=())
        self.run_.start("logger", "-o", self.log_file)
        limit = 300_000  # bytes, about a second
        resource.prlimit(self.run_["logger"].pid, resource.RLIMIT_FSIZE, (limit, limit))
        for role in ("position_ctrl", "pressure_ctrl"):
            self.run_.start(role)
        self.run_.start("plant", "--expect", "logger")
        self.assertEqual(self.run_["logger"].wait(), 1, self.run_["logger"].report())
        self.assertRegex(self.run_["logger"].stderr, r"run\.lcmlog.*[Ff]ile too large")
        self.run_["plant"].wait_for("fault logger_gone: logger on .*[Ff]ile too large")
        second, log = self.start_second_logger()
        self.wait_until(lambda: log.count("HYDRO_STATE") > 300, "300 states")
        self.run_["plant"].send(signal.SIGTERM)
        for process in (self.run_["plant"], self.run_["pressure_ctrl"], self.run_["position_ctrl"], second):
            self.assertEqual(process.wait(), 0, process.report())
        after = event_log.Log(self.path("second.lcmlog"))
        self.check_control_went_on(after.states[:-1], after.motor_commands)
        info = self.run_program("hydro-log", "info", self.log_file)
        self.assertRegex(info.stdout, "HYDRO_STATE")
        full = event_log.Log(self.log_file)  # an error where an event is cut off
        self.assertGreater(len(full.states), 200)
        ticks = [s.tick for s in full.states]
        self.assertEqual(ticks, sorted(ticks))


if __name__ == "__main__":
    outcome.main()
