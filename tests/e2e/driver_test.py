"""hydro-driver with the whole stack, on a simulated board: only libcomedi's functions are replaced, no code of ours."""

import json
import math
import os
import signal
import statistics

import board
import event_log
import outcome
import stack

STALE = 0.3  # s, above what wake-ups are late by here
SINE = 'reference={ signal = "arm_angle", kind = "sine", amplitude = 0.2, frequency_hz = 0.5 }'


class DriverCase(stack.TestCase):
    def setUp(self):
        super().setUp()
        os.environ["LD_PRELOAD"] = board.LIBRARY
        self.addCleanup(os.environ.pop, "LD_PRELOAD")
        self.board = board.Board(self)

    def options(self, the_board, *settings):
        # With a driver the default is "explicit", which fault_limits_test tests.
        options = [f"driver.device={the_board.file}", f"limits.stale_input_s={STALE}", 'limits.rearm="restart"', *settings]
        return [argument for option in options for argument in ("--set", option)]

    def run_by_hand(self, *settings, the_board=None, url=None, log=None, controllers=True, driven=True):
        """The stack with a reference that never settles and no end, its driver moving the arm."""
        the_board = the_board or self.board
        run = self.stack(stack.config("driver.toml"), "--duration", "0",
                         *self.options(the_board, SINE, *settings), url=url)
        if log:
            run.start("logger", "-o", log)
        if controllers:
            run.start("position_ctrl")
            run.start("pressure_ctrl")
        run.start("driver", *(["--expect", "logger"] if log else []))
        if controllers and driven:
            the_board.wait_until_driven()
        return run

    def assert_zero(self, the_board, what):
        registers = the_board.read()
        self.assertGreater(registers["nonzero_writes"], 20, what)  # or else zero would say nothing
        self.assertEqual(registers["output0"], board.ZERO_CODE, what)


# Real-time priorities where allowed, because the test machine may be busy with other work.
PRIORITY = 10
PROCESSES = "process=[" + ", ".join(
    f'{{ program = "{name}", priority = {PRIORITY} }}'
    for name in ("hydro-driver", "hydro-pressure-ctrl", "hydro-position-ctrl")) + "]"


class DriverRunTest(DriverCase):
    def setUp(self):
        super().setUp()
        try:
            os.sched_setscheduler(self.board.actuator.pid, os.SCHED_FIFO, os.sched_param(PRIORITY))
        except PermissionError:
            pass

    def launched(self, *settings):
        settings = (PROCESSES, *settings)
        log_file, json_file = self.path("run.lcmlog"), self.path("summary.json")
        launch = self.launch(stack.config("driver.toml"), *self.options(self.board, *settings), "--log", log_file)
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.left = self.board.read()  # at once, because the pressures go on to leak
        self.run_program("hydro-log", "summary", log_file, "--json", json_file)
        with open(json_file, encoding="utf-8") as file:
            return event_log.Log(log_file), json.load(file)

    # Tests that the arm still reaches its reference when only hydro-driver replaces hydro-plant, that scales
    # and signs are those of the wiring, and that the watchdog line changes at each tick.
    def test_arm_reaches_its_reference(self):
        log, summary = self.launched()
        self.assertTrue(summary["tracking"]["at_target"], summary)
        self.assertEqual([f for f in log.faults if f.code != "stale_motor_command"], [])
        self.assertIn("driver", {s.role for s in log.statistics})
        self.assertEqual(log.descriptions[0].program, "hydro-driver")
        self.assertEqual([(s.source, s.exit_code) for s in log.stops], [("driver", 0)])
        # The board's output, read back after the last zero: half a step of 16 bits over 20 V, 2 V at the
        # motor per V.
        (left,) = log.outputs_left
        self.assertEqual((left.role, bool(left.accepted)), ("driver", True))
        self.assertLess(abs(left.voltage), 4e-4)

        registers = self.left
        self.assertAlmostEqual(registers["arm_angle"], 0.1, delta=0.01)  # the arm's own word
        last = log.states[-1]
        self.assertAlmostEqual(last.arm_angle, registers["arm_angle"], delta=0.002)
        for name in ("p1", "p2"):
            self.assertGreater(min(getattr(s, name) for s in log.states), 99)
            self.assertGreater(max(getattr(s, name) for s in log.states), 110)
            # They swing by several psi until the voltage is zero.
            mean = statistics.fmean(getattr(s, name) for s in log.states if s.time > last.time - 0.3)
            self.assertAlmostEqual(mean, registers[name], delta=5)
        # The encoder's counter has wrapped, but the angle has not.
        self.assertGreater(max(s.motor_angle for s in log.states), 1)
        counts = round(last.motor_angle / (2 * math.pi / 4096))
        self.assertAlmostEqual(counts & board.MAX_COUNT, registers["counter0"], delta=20)
        # Tachometer and encoder are inputs of different kinds. They agree, so the signs and scales of both
        # are right.
        turned = sum(b.motor_speed * (b.time - a.time) for a, b in zip(log.states, log.states[1:])
                     if b.arm_angle > 0.02 and b.time < 1.0)
        first, then = [[s for s in log.states if s.arm_angle > 0.02 and s.time < 1.0][i] for i in (0, -1)]
        self.assertGreater(turned, 1)
        self.assertAlmostEqual(turned, then.motor_angle - first.motor_angle, delta=0.15 * turned)

        # One voltage and one change of the watchdog line for each tick, plus the zeros at both ends.
        ticks = len(log.states) - 1
        self.assertEqual(registers["edges"] // 2 * 2, (ticks + 1) // 2 * 2)
        self.assertIn(registers["writes"] - ticks, (3, 4, 5))
        self.assertEqual(registers["directions"], 1)
        # Half a second after the run the watchdog takes the voltage. It does not count that as a trip, because
        # no driver has the board open then.
        self.assertEqual(registers["trips"], 0)
        self.assertEqual(registers["delayed_reads"], 4 * len(log.states))  # settle_ns, of the analog inputs only
        self.assert_zero(self.board, "complete run")
        self.assertEqual(registers["opened"], registers["closed"])

    # Tests the speed taken from the encoder where there is no tachometer.
    def test_speed_from_the_encoder(self):
        log, summary = self.launched('driver.motor_speed={ source = "derivative", low_pass_hz = 200 }')
        self.assertTrue(summary["tracking"]["at_target"], summary)
        self.assertAlmostEqual(self.board.arm_angle, 0.1, delta=0.01)
        self.assertGreater(max(s.motor_speed for s in log.states), 5)

    # Tests that the voltage limit holds at the terminal, and that states report the voltage that acted.
    def test_voltage_limit(self):
        log, _ = self.launched("driver.voltage.limit_V=0.5", "time.duration_s=1.5",
                               'reference={ signal = "voltage", steps = [[0.1, 3], [0.7, -3]] }')
        self.assertEqual({c.voltage for c in log.motor_commands if 200 < c.tick < 600}, {3})
        self.assertEqual(max(s.voltage for s in log.states), 0.5)
        self.assertEqual(min(s.voltage for s in log.states), -0.5)
        self.assert_zero(self.board, "limited run")

    # Tests that opening the board sets it to zero, and that no other output and no watchdog change follows
    # before all processes are present and a command has come.
    def test_zero_until_all_are_there(self):
        self.assertNotEqual(self.board.output0, board.ZERO_CODE)  # what a program that crashed has left
        run = self.run_by_hand(controllers=False)
        run["driver"].wait_for("waiting for pressure_ctrl, position_ctrl")
        registers = self.board.read()
        self.assertEqual((registers["output0"], registers["nonzero_writes"]), (board.ZERO_CODE, 0))
        self.assertEqual((registers["writes"], registers["edges"]), (1, 0))
        run.start("position_ctrl")
        run.start("pressure_ctrl")
        self.board.wait_until_driven()
        run["driver"].send(signal.SIGTERM)
        for process in run.processes.values():
            self.assertEqual(process.wait(), 0, process.report())


class WaysOutTest(DriverCase):
    """Zero volts on every way out of the process."""

    def leave(self, what, act, code, *settings, at_once=True, driven=True):
        drivers = []
        with self.subTest(what):
            the_board = board.Board(self, what.replace(" ", "_"))
            run = self.run_by_hand(*settings, the_board=the_board, url=self.new_url(), driven=driven)
            act(run["driver"], the_board)
            self.assertEqual(run["driver"].wait(), code, what + "\n" + run["driver"].report())
            if not at_once:
                the_board.wait_for(lambda b: b["output0"] == board.ZERO_CODE, f"zero after {what}")
            self.assert_zero(the_board, what)
            for process in run.others("driver").values():
                process.end()
            the_board.actuator.end()
            drivers.append(run["driver"])
        return drivers[0] if drivers else self.fail(what)

    def signal_(self, number):
        return lambda driver, _: driver.send(number)

    def order(self, name):
        return lambda _, the_board: the_board.order(name)

    # Tests the signals that stop a run in order.
    def test_stop_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.leave(number.name, self.signal_(number), 0)

    # Tests signals that end a process: first zero volts, then the process dies of the signal as it would have
    # without the handler.
    def test_ending_signals(self):
        for number in (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS, signal.SIGFPE, signal.SIGQUIT, signal.SIGPIPE,
                       signal.SIGUSR1, signal.SIGALRM, signal.SIGXCPU, signal.SIGRTMIN):
            self.leave(signal.Signals(number).name, self.signal_(number), -number)

    # Tests crashes from within, during a reading.
    def test_crashes(self):
        for name, code in (("null_pointer", -signal.SIGSEGV), ("stack_overflow", -signal.SIGSEGV),
                           ("abort", -signal.SIGABRT), ("terminate", -signal.SIGABRT),
                           ("throw_number", -signal.SIGABRT), ("throw", 1), ("exit", 3), ("quick_exit", 3)):
            self.leave(name, self.order(name), code)

    # Tests exits that leave the process no chance to act, so that its guardian writes the zero.
    def test_guardian(self):
        self.leave("SIGKILL", self.signal_(signal.SIGKILL), -signal.SIGKILL, at_once=False)
        self.leave("underscore_exit", self.order("underscore_exit"), 3, at_once=False)

    # Tests that an error of the board ends the run, with a zero if the board still takes one.
    def test_board_errors(self):
        for name in ("reads_fail", "next_write_fails"):
            driver = self.leave(name, self.order(name), 1)
            self.assertIn("board_error", driver.stderr)
            self.assertRegex(driver.stderr, "driver[.]\\w+: (reading|writing) subdevice")

    # Tests that the run ends with zero volts and the guardian's name when the guardian ends or stands still,
    # because killing the driver would then leave the voltage.
    def test_guardian_gone(self):
        for number in (signal.SIGKILL, signal.SIGSTOP):
            def act(driver, _, number=number):
                with open(f"/proc/{driver.pid}/task/{driver.pid}/children", encoding="ascii") as file:
                    os.kill(int(file.read()), number)

            driver = self.leave(f"guardian {number.name}", act, 1)
            self.assertIn("guardian_gone", driver.stderr)

    # Tests a stop message from another process, here the pressure loop's message when the motor exceeds its
    # speed limit.
    def test_stop_message(self):
        self.leave("stop message", lambda *_: None, 1, "limits.motor_speed=200", driven=False)
        self.assertTrue(any("fault motor_speed_limit" in p.stderr for p in self.processes))


class DriverFaultTest(DriverCase):
    def setUp(self):
        super().setUp()
        self.log_file = self.path("run.lcmlog")
        self.run_ = self.run_by_hand(log=self.log_file)
        self.log = stack.LiveLog(self, self.log_file)

    def finish(self):
        self.run_["driver"].send(signal.SIGTERM)
        for role in ("driver", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())
        self.assert_zero(self.board, "end")
        return event_log.Log(self.log_file)

    def wait_for_fault(self, code, active, start=0):
        return self.log.wait_for("HYDRO_FAULT", lambda f: f.code == code and bool(f.active) == active,
                                 f"fault {code}, active {active}", start=start)

    # Tests that a pressure sensor at the end of its range, and one with a broken wire, read NaN, give zero
    # volts and a fault that names the sensor, and that the run resumes when they are good again.
    def test_sensor_faults(self):
        spans = []
        for order, says in (("input0_high", "p1 reads 10 V"), ("input0_open", "p1 reads 0.0001526 V.*minimum_V")):
            count = self.log.count("HYDRO_FAULT")
            self.board.order(order)
            begin = self.wait_for_fault("sensor_p1", True, start=count)
            self.assertEqual(begin.source, "driver")
            self.assertRegex(begin.text, says)
            self.log.wait_for_tick(begin.tick + 100)
            self.assertEqual(self.board.output0, board.ZERO_CODE)
            self.board.order("nothing")
            end = self.wait_for_fault("sensor_p1", False, start=count)
            spans.append((begin.tick, end.tick))
            written = self.board.nonzero_writes
            self.board.wait_for(lambda b, w=written: b["nonzero_writes"] > w + 20, "a voltage again")
        log = self.finish()
        for begin, end in spans:
            during = [s for s in log.states if begin < s.tick <= end]
            self.assertGreater(len(during), 50)
            for state in during:
                self.assertEqual((state.voltage, state.command_tick), (0, -1), state)
            self.assertTrue(all(math.isnan(s.p1) for s in during if s.tick <= begin + 50))
            self.assertFalse(any(math.isnan(s.p2) for s in during))
        # "Good again" means ten readings in a row.
        good = [s for s in log.states if spans[0][0] < s.tick <= spans[0][1] and not math.isnan(s.p1)]
        self.assertGreaterEqual(len(good), 9)

    # Tests that a hanging driver keeps the voltage, which shows the purpose of the hardware watchdog: it
    # takes the voltage from the motor.
    def test_hang_is_for_the_watchdog(self):
        self.run_["driver"].send(signal.SIGSTOP)
        tripped = self.board.wait_for(lambda b: b["trips"] == 1 and b["enabled"] == 0, "the watchdog")
        self.assertEqual(tripped["voltage"], 0)
        self.run_["driver"].send(signal.SIGCONT)
        self.board.wait_for(lambda b: b["enabled"] == 1, "the watchdog line again")
        self.finish()

    # Tests Ctrl-Z: zero volts before the process stops, and a run that continues after it.
    def test_suspended(self):
        self.run_["driver"].send(signal.SIGTSTP)
        self.board.wait_for(lambda b: b["enabled"] == 0, "the driver to stop")
        self.assertEqual(self.board.output0, board.ZERO_CODE)
        written = self.board.nonzero_writes
        self.run_["driver"].send(signal.SIGCONT)
        self.board.wait_for(lambda b: b["nonzero_writes"] > written, "a voltage again")
        self.finish()

    # Tests that a board that no longer accepts anything ends the run with 1, and that only the watchdog is
    # left.
    def test_board_that_takes_no_zero(self):
        self.board.order("writes_fail")
        self.assertEqual(self.run_["driver"].wait(), 1, self.run_["driver"].report())
        self.assertIn("does not accept zero volts", self.run_["driver"].stderr)
        self.board.wait_for(lambda b: b["enabled"] == 0 and b["voltage"] == 0, "the watchdog")
        fault = [f for f in event_log.Log(self.log_file).faults if f.code == "board_error"][0]
        self.assertEqual((fault.source, bool(fault.latched)), ("driver", True))


class LaunchedDriverTest(DriverCase):
    # Tests that a driver killed under hydro-launch is named, that the output is zero and that no process is
    # left.
    def test_killed(self):
        launch = self.launch(stack.config("driver.toml"), "--duration", "0", *self.options(self.board, SINE))
        self.board.wait_until_driven()
        with open(f"/proc/{launch.pid}/task/{launch.pid}/children", encoding="ascii") as file:
            children = [int(pid) for pid in file.read().split()]
        driver = next(p for p in children if "hydro-driver" in os.readlink(f"/proc/{p}/exe"))
        with open(f"/proc/{driver}/task/{driver}/children", encoding="ascii") as file:
            guardian = int(file.read())
        os.kill(driver, signal.SIGKILL)
        self.assertEqual(launch.wait(), 1, launch.report())
        self.assertIn("hydro-driver was killed by signal 9", launch.stderr)
        self.board.wait_for(lambda b: b["output0"] == board.ZERO_CODE, "zero")
        self.wait_until(lambda: stack.still_running([*children, guardian]) == [], "the end of all")
        self.assert_zero(self.board, "killed")


class DriverInputTest(DriverCase):
    def refused(self, *settings, program="hydro-driver", more=()):
        process = self.run_program(program, stack.config("driver.toml"), "--set", f"bus.url={self.url}",
                                   *self.options(self.board, *settings), *more, expect=2)
        self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
        self.assertEqual(self.board.nonzero_writes, 0)
        return process.stderr

    # Tests that lockstep is refused, by the driver and before anything is started.
    def test_lockstep_is_refused(self):
        for program in ("hydro-driver", "hydro-launch"):
            self.assertRegex(self.refused(program=program, more=("--time", "lockstep")),
                             'time.mode: found "lockstep", allowed "realtime" with hydro-driver')
        self.assertEqual(self.board.opened, 0)

    # Tests that anything that the board lacks is named by its key.
    def test_board_without_it(self):
        for setting, says in (
                ("driver.device=/dev/no-such-board", "driver.device: found .*/dev/no-such-board.* .No such file"),
                ("driver.p1.channel=8", "driver.p1.channel: found 8, allowed 0 to 7"),
                ("driver.p1.subdevice=1", "driver.p1.subdevice: found 1, allowed .* an analog input"),
                ("driver.p2.range=3", "driver.p2.range: found 3, allowed 0 to 2"),
                ("driver.motor_angle.subdevice=0", "driver.motor_angle.subdevice: .* a counter"),
                ("driver.voltage.range=2", "driver.voltage.range: found 2, allowed 0 to 1"),
                ("driver.voltage.offset=40", "driver.voltage.offset: found 40, .*-10 to 10 V"),
                ("driver.watchdog.subdevice=3", "driver.watchdog.subdevice: .* a digital output")):
            self.assertRegex(self.refused(setting), says)

    # Tests that --check-sensors shows signals, writes no output, not even zero, and ends with 1 for a broken
    # wire.
    def test_check_sensors(self):
        arguments = (stack.config("driver.toml"), *self.options(self.board), "--check-sensors", "--duration", "0.2")
        good = self.run_program("hydro-driver", *arguments)
        self.assertRegex(good.stdout, r"p1 +analog 0/0 +\d+ +0[.]6999 V +99[.]966 psi\n")
        self.assertRegex(good.stdout, r"motor_angle +counter 3/0 +1677719\d +-0.03\d+ rad\n")
        self.assertRegex(good.stdout, r"arm_speed +rate of the angle +0 rad/s\n")
        self.board.order("input0_open")
        bad = self.run_program("hydro-driver", *arguments, expect=1)
        self.assertRegex(bad.stdout, r"p1 .* - +FAULT: p1 reads .*minimum_V.*broken wire")
        registers = self.board.read()
        self.assertEqual((registers["writes"], registers["line_writes"], registers["directions"]), (0, 0, 0))
        self.assertGreater(registers["reads"], 20)


if __name__ == "__main__":
    outcome.main()
