"""Rows of docs/safety.md: exceeded limits, and how a latched fault ends (limits.rearm), with the real programs."""

import json

import event_log
import fault_case
import lcm_peer
import outcome

# A pressure that drives the arm in one direction for as long as it is commanded; a negative one drives it the
# other way.
PUSH = 'signal = "pressure"\nkind = "steps"\nsteps = [[0.1, {}]]'


class LimitTest(fault_case.FaultCase):
    """With the default, limits.rearm = "restart": the run ends with exit code 1."""

    def run_to_limit(self, option, code, measured, limit, push=100):
        self.log_file = self.path(f"run{push}.lcmlog")
        self.start_stack("--set", f"{option}={limit}", config=self.config_with(PUSH.format(push)))
        for role in ("plant", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 1, self.run_[role].report())
        self.assertRegex(self.run_["plant"].stderr, f"fault {code}: tick .*{option}")
        log = event_log.Log(self.log_file)
        faults = {f.source: f for f in log.faults if f.code == code}
        passed = next(s for s in log.states if measured(s) > limit)
        fault = faults["plant"]
        print(f"{code}: passed at tick {passed.tick}, detected at tick {fault.tick}", flush=True)
        self.assertEqual(fault.tick, passed.tick)  # in the very tick
        self.assertEqual((fault.latched, fault.active), (1, 1))
        self.assertAlmostEqual(fault.value, measured(passed), delta=1e-9 * fault.value)
        self.assertAlmostEqual(fault.limit, limit)
        self.assertEqual([s for s in log.states if s.tick > fault.tick and s.voltage != 0], [])
        self.assertTrue([s for s in log.states if s.voltage != 0])
        self.assertTrue([s for s in log.stops if s.exit_code == 1 and code in s.reason])
        last = log.motor_commands[-1]
        self.assertEqual((last.status, last.voltage), (event_log.STOPPED, 0))
        # The pressure loop finds the same fault by itself, unless the plant's stop arrived first.
        self.assertLessEqual(set(faults), {"plant", "pressure_ctrl"})

    # Tests that a pressure above its limit, on either side, zeroes the voltage in the tick that measures it
    # and ends the run.
    def test_pressure(self):
        for push in (100, -100):
            with self.subTest(push=push):
                self.run_to_limit("limits.pressure", "pressure_limit", lambda s: max(s.p1, s.p2), 115, push)

    def test_motor_speed(self):
        self.run_to_limit("limits.motor_speed", "motor_speed_limit", lambda s: abs(s.motor_speed), 30, -100)

    # Tests the arm's limit, which lies far before V_1 or V_2 is 0, where the model itself would fail.
    def test_arm_angle(self):
        for push in (100, -100):
            with self.subTest(push=push):
                self.run_to_limit("limits.arm_angle", "arm_angle_limit", lambda s: abs(s.arm_angle), 0.05, push)

    # Tests that a run whose arm is driven to its end is stopped by the default limit, 0.98 V_ms/c.
    def test_arm_angle_default(self):
        self.start_stack(config=self.config_with(PUSH.format(100)))
        fault = self.wait_for_fault("arm_angle_limit", source="plant")
        self.assertAlmostEqual(fault.limit, 0.98 * 3.16 / 3.68379, places=6)
        for role in ("plant", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 1, self.run_[role].report())
        self.assertFalse([f for f in event_log.Log(self.log_file).faults if f.code == "model_error"])


class RearmTest(fault_case.FaultCase):
    """With limits.rearm = "explicit": the stack stays up at zero volts until hydro-launch --rearm."""

    def start_explicit(self, *options, **more):
        self.start_stack("--set", 'limits.rearm="explicit"', *options, **more)

    def rearm(self, expect):
        return self.run_program("hydro-launch", *self.run_.arguments, "--rearm", expect=expect)

    def check_forecast(self, log, told):
        """What was told of the way back is what the position loop then asked for, in the same words for people and programs."""
        [forecast] = told["forecasts"]
        self.assertRegex(told["text"], "^re-armed: ended .*; the arm is at .* rad; its reference comes back to .* rad: the reference moves by ")
        self.assertTrue(told["text"].endswith(forecast["text"]), told)
        accepted = next(r for r in log.rearms if r.kind == 1)
        state = next(s for s in log.states if s.tick >= accepted.tick - 1)
        self.assertAlmostEqual(forecast["present"], state.arm_angle, delta=0.01)
        back = accepted.tick + round(forecast["return_s"] * 1000)
        reference = next(r.value for r in log.of("HYDRO_ARM_REFERENCE") if r.tick >= back + 20)
        self.assertGreaterEqual(reference, forecast["lowest"] - 1e-3)
        self.assertLessEqual(reference, forecast["highest"] + 1e-3)
        if forecast["lowest"] == forecast["highest"]:
            self.assertAlmostEqual(reference, forecast["target"], delta=1e-6)

    # Tests that the voltage stays zero long after the pressure has fallen, that a re-arm ends this, and that
    # exceeding the limit again raises the fault again.
    def test_pressure(self):
        self.start_explicit("--set", "limits.pressure=115", config=self.config_with(PUSH.format(100)))
        fault = self.wait_for_fault("pressure_limit", source="plant")
        self.assertEqual(fault.latched, 1)

        def has_fallen():  # the arm swings out: the limit is exceeded again and again for about a second
            self.log.count("HYDRO_STATE")
            last = self.log.messages["HYDRO_STATE"][-300:]
            return last[0].tick > fault.tick + 10 and max(max(s.p1, s.p2) for s in last) < 114

        self.wait_until(has_fallen, "less pressure for 300 states")
        states = self.log.count("HYDRO_STATE")
        answer = self.rearm(0)
        self.assertRegex(answer.stdout, "re-armed: ended .*pressure_limit")
        gone = self.wait_for_fault("pressure_limit", active=False, source="plant")
        again = self.log.wait_for("HYDRO_STATE", lambda s: s.voltage != 0, "a voltage", start=states)
        self.assertGreater(again.tick, gone.tick)
        self.wait_for_fault("pressure_limit", source="plant", start=self.log.messages["HYDRO_FAULT"].index(gone))
        log = self.finish()
        self.assertEqual(self.assert_zero_during(log, "pressure_limit", "plant", least=300), 0)
        self.assertEqual([(r.kind, r.source) for r in log.rearms[:2]], [(0, "launch"), (1, "plant")])

    # Tests that the fault does not end by itself when an input is good again.
    def test_stale_command(self):
        self.start_explicit()
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].kill()
        fault = self.wait_for_fault("stale_motor_command")
        self.assertEqual(fault.latched, 1)
        refused = self.rearm(1)
        self.assertRegex(refused.stderr, "refused by the plant: stale_motor_command persists: tick .* no motor command")
        self.run_["pressure_ctrl"].wait()
        self.run_.start("pressure_ctrl", label="second")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW, "commands again",
                          start=self.log.count("HYDRO_MOTOR_COMMAND"))
        self.wait_for_states(300)
        told = json.loads(self.run_program("hydro-launch", *self.run_.arguments, "--rearm", "--json").stdout)
        self.assertEqual(told["rearmed"], True)
        self.wait_for_fault("stale_motor_command", active=False)
        self.wait_for_voltage()
        self.wait_for_states(800)
        log = self.finish()
        self.check_forecast(log, told)
        self.assertEqual(self.assert_zero_during(log, "stale_motor_command", "plant", least=300), 0)

    # Tests that the pressure loop's faults are latched too, and that its safe output keeps the voltage at
    # zero afterwards.
    def test_controller_fault(self):
        self.start_explicit("--set", "limits.pressure_ramp_s=0")
        self.wait_for_voltage()
        self.run_["position_ctrl"].kill()
        self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        fault = self.wait_for_fault("controller_fault", source="plant")
        self.assertEqual(fault.latched, 1)
        self.assertRegex(self.rearm(1).stderr, "controller_fault persists")
        self.run_["position_ctrl"].wait()
        self.run_.start("position_ctrl", label="second")
        self.wait_for_fault("stale_pressure_command", active=False)
        self.wait_for_states(300)
        self.rearm(0)
        self.wait_for_voltage()
        log = self.finish()
        self.assertEqual(self.assert_zero_during(log, "controller_fault", "plant", least=300), 0)

    # Tests that in a stack with a key a re-arm and a stop need the key, and that with the key they work as
    # they do in a stack without one.
    def test_with_a_key(self):
        key = ("--set", f"bus.key_file={self.path('bus.key')}")
        self.run_program("hydro-launch", self.moving(), *key, "--make-key")
        self.start_explicit(*key)
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].kill()
        self.wait_for_fault("stale_motor_command")
        self.run_["pressure_ctrl"].wait()
        self.run_.start("pressure_ctrl", label="second")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW, "commands again",
                          start=self.log.count("HYDRO_MOTOR_COMMAND"))
        arguments = [a for a in self.run_.arguments if not str(a).startswith("bus.key_file")]
        at = arguments.index("--set", arguments.index('limits.rearm="explicit"'))
        stranger = self.run_program("hydro-launch", *arguments[:at], *arguments[at + 1:], "--rearm", expect=1)
        self.assertRegex(stranger.stderr, "the plant does not answer")
        self.rearm(0)
        self.wait_for_voltage()
        stopped = self.run_program("hydro-launch", *self.run_.arguments, "--stop")
        self.assertRegex(stopped.stdout, "processes have ended")
        for role in ("plant", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())

    # Tests that a limit that is still exceeded prevents a re-arm.
    def test_refused_while_the_cause_persists(self):
        self.start_explicit("--set", "limits.arm_angle=0.05", config=self.config_with(PUSH.format(100)))
        fault = self.wait_for_fault("arm_angle_limit", source="plant")
        self.wait_for_states(100)
        self.assertRegex(self.rearm(1).stderr, "arm_angle_limit persists: tick .* the arm is at")
        self.wait_for_states(100)
        log = self.finish()
        self.assertEqual(self.assert_zero_during(log, "arm_angle_limit", "plant", least=200), 0)
        self.assertEqual([f for f in log.faults if f.code == fault.code and not f.active], [])

    # Tests that a re-arm meant for another run (as in a played log), or an old one, has no effect.
    def test_requests_of_another_run(self):
        self.start_explicit()
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].kill()
        self.wait_for_fault("stale_motor_command")
        self.run_["pressure_ctrl"].wait()
        self.run_.start("pressure_ctrl", label="second")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW, "commands again",
                          start=self.log.count("HYDRO_MOTOR_COMMAND"))
        self.rearm(0)  # from here on its bytes are known
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].kill()
        begun = self.wait_for_fault("stale_motor_command", start=self.log.count("HYDRO_FAULT"))
        self.run_["pressure_ctrl"].wait()
        self.run_.start("pressure_ctrl", label="third")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW, "commands again",
                          start=self.log.count("HYDRO_MOTOR_COMMAND"))
        hashes = lcm_peer.type_hashes(self.copy_of_log())
        peer = lcm_peer.Peer(self.url, hashes)
        self.addCleanup(peer.close)
        state = self.log.messages["HYDRO_STATE"][-1]
        peer.publish("HYDRO_REARM", addressee=state.session + 1, tick=state.tick)
        peer.publish("HYDRO_REARM", addressee=state.session, tick=state.tick - 6000)
        self.log.wait_for("HYDRO_REARM", lambda r: r.kind == 2 and "names tick" in r.text, "a refusal")
        self.wait_for_states(100)
        log = self.finish()
        after = [s for s in log.states if s.tick > begun.tick]
        self.assertGreater(len(after), 100)
        self.assertEqual([s for s in after if s.voltage != 0], [])

    def copy_of_log(self):
        """What the logger has written so far, in whole events."""
        with open(self.log_file, "rb") as file:
            data = file.read()
        whole, at = 0, 0
        while (found := event_log._event_at(data, at)) is not None:  # noqa: SLF001
            whole = at = found[1]
        with open(self.path("copy.lcmlog"), "wb") as file:
            file.write(data[:whole])
        return self.path("copy.lcmlog")

    # Tests that there is nothing to re-arm where faults end by themselves, and that a re-arm without a stack
    # says so.
    def test_nothing_to_rearm(self):
        self.start_stack()
        self.wait_for_voltage()
        self.assertRegex(self.rearm(1).stderr, 'refused by the plant: limits.rearm is "restart"')
        self.finish()
        self.assertRegex(self.rearm(1).stderr, "no plant or driver is heard")

    # The same with limits.rearm = "explicit", for people and for programs.
    def test_no_latched_fault(self):
        self.start_explicit()
        self.wait_for_voltage()
        self.assertRegex(self.rearm(1).stderr, "refused by the plant: no fault is latched")
        told = json.loads(self.run_program("hydro-launch", *self.run_.arguments, "--rearm", "--json", expect=1).stdout)
        self.assertEqual((told["rearmed"], told["forecasts"]), (False, []))
        self.finish()

    # Tests that a run that ends at zero volts, never re-armed, has failed.
    def test_ends_latched(self):
        self.start_explicit("--set", "limits.pressure=115", duration=1.2,
                            config=self.config_with(PUSH.format(100)))
        self.assertEqual(self.run_["plant"].wait(), 1, self.run_["plant"].report())
        self.assertRegex(self.run_["plant"].stderr, "stopped by .*pressure_limit and not re-armed")


if __name__ == "__main__":
    outcome.main()
