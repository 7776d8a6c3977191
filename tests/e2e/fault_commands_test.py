"""Rows of docs/safety.md: commands that are not what they should be.

The real plant, position loop, pressure loop and logger; the loop whose commands are bad is played by the test, tick by
tick, so that the bad one comes at a known tick between good ones.
"""

import struct

import event_log
import fault_case
import outcome
import stack
from fault_case import STALE

BAD = 100  # the tick of the first bad command
LIMIT = 10  # V, T_pmax/k_1 of Table 1
SLOW = 400  # Hz: slow enough for a loop written in Python on a busy machine


def repeated(session=4242, **fields):
    return {"voltage": 1.0, "status": event_log.LAW, "session": session, **fields}


class MotorCommandTest(fault_case.FaultCase):
    """The test plays the pressure loop: 1 V at each tick, except for what `bad` sends instead at tick BAD."""

    def run_with(self, bad, until=BAD + 100, options=()):
        def answer(state):
            if state.tick >= BAD and not self.done:
                return bad(state)
            return [repeated()]

        self.done = False
        self.start_stack("--set", f"plant.rate_hz={SLOW}", *options, roles=("logger", "position_ctrl"))
        self.pressure_loop = self.loop("pressure_ctrl", "HYDRO_MOTOR_COMMAND", answer)
        self.run_.start("plant", "--expect", "logger")
        self.log.wait_for_tick(until)

    def once(self, commands):
        """Sends these at BAD (or the first state behind it), and good ones again from then on."""
        def bad(state):
            self.done = True
            self.bad_tick = state.tick
            return commands(state)
        return bad

    def for_ticks(self, count, commands):
        def bad(state):
            self.done = state.tick >= BAD + count
            return commands(state)
        return bad

    def check_zero_and_back(self, code, least=0):
        self.wait_for_fault(code, active=False)
        self.wait_for_voltage()
        log = self.finish()
        self.assert_was_moving(log, code)
        self.assertEqual(self.assert_zero_during(log, code, "plant", least=least), 0)
        return log

    # Tests that a voltage that is not a number never acts.
    def test_nonfinite(self):
        self.run_with(self.for_ticks(120, lambda s: [repeated(voltage=float("nan"))]))
        log = self.check_zero_and_back("nonfinite_motor_command", least=5)
        fault = next(f for f in log.faults if f.code == "nonfinite_motor_command")
        self.assertEqual([s for s in log.states if s.voltage != s.voltage], [])
        self.assert_in_time(log, fault)

    # Tests that a command beyond the amplifier's limit has no effect, not even clipped; a rounding error is
    # allowed.
    def test_excessive(self):
        self.run_with(self.for_ticks(120, lambda s: [repeated(voltage=-LIMIT * 1.001)]))
        log = self.check_zero_and_back("excessive_motor_command", least=5)
        self.assertEqual({s.voltage for s in log.states} - {0, 1}, set())
        self.assert_in_time(log, next(f for f in log.faults if f.code == "excessive_motor_command"))

    def test_all_that_is_allowed(self):
        self.run_with(self.for_ticks(40, lambda s: [repeated(voltage=LIMIT * (1 + 1e-12))]))
        log = self.finish()
        self.assertEqual({f.code for f in log.faults} - {"late_plant"}, set())
        self.assertTrue([s for s in log.states if s.voltage >= LIMIT])

    def assert_in_time(self, log, fault):
        """Noticed at the tick at which the command would have acted: one later (plant.command_delay_ticks), and as many as
        the plant and the loop in Python were late by."""
        first = next(c.tick for c in log.motor_commands if c.voltage not in (0, 1))
        states = [s for s in log.states if first < s.tick <= fault.tick]
        print(f"{fault.code}: detected {len(states)} states after the bad command's own", flush=True)
        self.assertLessEqual(first, fault.tick - 1)
        acted = [s for s in log.states if s.command_tick >= first and s.tick <= fault.tick]
        self.assertEqual(acted, [])

    # Tests that repeated commands are not obeyed, do not count as a sign of life, and are reported.
    def test_repeated(self):
        last = {}

        def commands(state):
            last.setdefault("tick", state.tick)
            last.setdefault("sequence", self.pressure_loop.sequence - 1)  # of the last good one
            return [repeated(voltage=2.0, **last)]
        self.run_with(self.for_ticks(int(3 * STALE * SLOW), commands), until=BAD + int(3 * STALE * SLOW) + 20)
        self.wait_for_fault("repeated_motor_command")
        self.wait_for_fault("repeated_motor_command", active=False)
        log = self.check_zero_and_back("stale_motor_command", least=20)
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])

    # Tests that a command overtaken by newer ones (on another route through a network) is not obeyed when it
    # arrives, and that control continues with the newer ones.
    def test_reordered(self):
        self.run_with(self.once(lambda s: [repeated(), repeated(voltage=2.0, sequence=-1, tick=s.tick - 50)]))
        self.wait_for_fault("repeated_motor_command", source="plant")
        log = self.finish()
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])
        self.assertEqual({f.code for f in log.faults if f.tick >= BAD} - {"late_plant"}, {"repeated_motor_command"})

    # Tests the same for a command with a new number that was computed from an old state.
    def test_tick_goes_back(self):
        self.run_with(self.once(lambda s: [repeated(), repeated(voltage=2.0, tick=s.tick - 50)]))
        self.wait_for_fault("repeated_motor_command", source="plant")
        log = self.finish()
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])

    # Tests that every missing sequence number is counted and reported.
    def test_gaps(self):
        self.run_with(self.once(lambda s: [repeated(sequence=self.pressure_loop.sequence + 7)]))
        log = self.finish()
        whole = [s for s in log.statistics if s.role == "plant" and s.whole_run]
        self.assertEqual([s.lost_messages for s in whole], [7])
        self.assertEqual({f.code for f in log.faults} - {"late_plant"}, set())

    # Tests that a command for a future tick is refused and zeroes the voltage until a valid one comes.
    def test_future(self):
        self.run_with(self.for_ticks(120, lambda s: [repeated(voltage=2.0, tick=s.tick + 1000)]))
        log = self.check_zero_and_back("future_motor_command", least=5)
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])

    # Tests that after one command from the loop's own session for a tick that never comes, later commands do
    # not count as old.
    def test_one_far_tick(self):
        self.run_with(self.once(lambda s: [repeated(voltage=2.0, tick=1 << 62)]))
        self.wait_for_fault("future_motor_command")
        self.wait_for_fault("future_motor_command", active=False)
        log = self.finish()
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])
        self.assertNotIn("stale_motor_command", {f.code for f in log.faults})

    # Tests that it is told even where the good command has come before the plant looks, as on a busy machine.
    def test_one_far_tick_beside_a_good_one(self):
        self.run_with(self.once(lambda s: [repeated(voltage=2.0, tick=1 << 62), repeated()]))
        self.wait_for_fault("future_motor_command")
        self.wait_for_fault("future_motor_command", active=False)
        self.finish()

    # Tests the same for a sequence number that the loop never reaches.
    def test_one_far_number(self):
        def commands(state):
            self.pressure_loop.peer.publish("HYDRO_MOTOR_COMMAND", **repeated(tick=state.tick, sequence=1 << 62))
            return [repeated()]
        self.run_with(self.once(commands), until=BAD + int(3 * STALE * SLOW) + 20)
        self.wait_for_fault("repeated_motor_command")
        self.wait_for_fault("repeated_motor_command", active=False)
        log = self.finish()
        self.assertGreater(log.states[-1].command_tick, BAD + 2 * STALE * SLOW)

    # Tests that a loop that answers every state, but too late, counts as stale.
    def test_late(self):
        old = []
        delay = int(2 * STALE * SLOW)

        def commands(state):
            old.append(state.tick)
            return [repeated(voltage=2.0, tick=max(BAD - 1, state.tick - delay))]
        self.run_with(self.for_ticks(3 * delay, commands), until=BAD + 3 * delay + 50)
        log = self.check_zero_and_back("stale_motor_command", least=20)
        fault = next(f for f in log.faults if f.code == "stale_motor_command")
        late = [s for s in log.states if s.voltage == 2.0]
        for state in late:  # what was not yet too old
            self.assertLessEqual(state.tick, fault.tick, state)
        slept = sum(s.skipped_ticks for s in log.states if BAD <= s.tick <= fault.tick)
        self.assertLessEqual(fault.tick - BAD, STALE * SLOW + 5 + slept + 20)

    # Tests that neither of two motor-command senders is obeyed, that both are named, and that the first
    # resumes when the second has gone.
    def test_two_senders(self):
        second = 777
        self.run_with(self.for_ticks(120, lambda s: [repeated(), repeated(second, voltage=2.0, sequence=s.tick)]),
                      until=BAD + 60)
        self.peer().publish("HYDRO_PROCESS_STATUS", session=second, role="pressure_ctrl", host="elsewhere", pid=7,
                            state=event_log.RUNNING)
        log = self.check_zero_and_back("second_motor_command_sender", least=5)
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])
        fault = next(f for f in log.faults if f.code == "second_motor_command_sender")
        self.assertIn("pressure_ctrl on test (process 1)", fault.text)
        self.assertIn(f"(session {second})", fault.text)

    # Tests that a command of another type or version is not obeyed, but is counted and named.
    def test_undecodable(self):
        self.run_with(self.once(lambda s: [repeated()]))
        peer = self.peer()
        good = event_log.TYPES["HYDRO_MOTOR_COMMAND"]
        values = good.tuple(utime=0, tick=BAD, session=4242, sequence=1 << 40, voltage=2.0, pressure_ref=0,
                            pressure_command_tick=-1, saturated=0, status=0)
        peer.publish_bytes("HYDRO_MOTOR_COMMAND", good.encode(struct.pack(">q", 12345), values))  # another version
        peer.publish_bytes("HYDRO_MOTOR_COMMAND", good.encode(peer.hashes["HYDRO_MOTOR_COMMAND"], values)[:-3])  # torn
        peer.publish_bytes("HYDRO_MOTOR_COMMAND", b"")
        fault = self.wait_for_fault("undecodable_message", source="plant")
        self.assertIn("HYDRO_MOTOR_COMMAND", fault.text)
        self.wait_for_fault("undecodable_message", active=False)
        log = self.finish(torn=True)
        self.assertEqual([s for s in log.states if s.voltage == 2.0], [])
        self.assertEqual([s for s in log.states if s.tick > BAD + 5 and s.voltage != 1.0], [])  # control went on
        gone = [f for f in log.faults if f.code == "undecodable_message" and not f.active]
        self.assertTrue(gone)

    # Tests that another stack on this port and group is noticed and named, and that a stack of another group
    # on this port is not even heard.
    def test_other_stack(self):
        self.run_with(self.once(lambda s: [repeated()]))
        far, other = self.peer(group="239.255.76.99"), self.peer()
        for peer, session in (far, 444), (other, 555):
            for _ in range(4):
                peer.publish("HYDRO_RUN", session=session, program="hydro-plant", host="neighbour",
                             config_text=f'[bus]\nurl = "udpm://239.255.76.67:{peer.port}?ttl=0"\n')
                self.wait_for_states(50)
        fault = self.wait_for_fault("other_stack", source="plant")
        for part in ("hydro-plant on neighbour", "session 555", "239.255.76.67"):
            self.assertIn(part, fault.text)
        self.assertEqual(self.check_zero_and_back("other_stack", least=50).states[0].voltage, 0)


class PressureCommandTest(fault_case.FaultCase):
    """The test plays the position loop: 50 psi at each sample, except for what `bad` sends for a while from tick BAD on."""

    LIMIT = 500 / 3.68  # psi, limits.arm_torque / k_2 of demo.toml
    SPAN = 100  # ticks

    def run_with(self, bad):
        def answer(state):
            tick = state.tick
            return bad(tick) if BAD <= tick < BAD + self.SPAN else [{"pressure_ref": 50.0 + tick % 10}]

        self.start_stack(roles=("logger", "pressure_ctrl"))
        self.position_loop = self.loop("position_ctrl", "HYDRO_PRESSURE_COMMAND", answer, interval=5)
        self.run_.start("plant", "--expect", "logger")
        self.log.wait_for_tick(BAD + self.SPAN + 200)

    def check(self, code):
        self.wait_for_fault(code, active=False)
        self.wait_for_voltage()
        log = self.finish()
        self.assert_was_moving(log, code)
        self.assert_zero_during(log, code, "pressure_ctrl", least=5)
        return log

    # Tests that a reference that is not a number, or beyond the limit, moves nothing.
    def test_nonfinite(self):
        self.run_with(lambda tick: [{"pressure_ref": float("inf")}])
        self.check("nonfinite_pressure_command")

    def test_excessive(self):
        self.run_with(lambda tick: [{"pressure_ref": -1.001 * self.LIMIT}])
        log = self.check("excessive_pressure_command")
        self.assertEqual([c for c in log.motor_commands if c.status == event_log.LAW and c.pressure_ref < -1], [])

    def test_all_that_is_allowed(self):
        self.run_with(lambda tick: [{"pressure_ref": self.LIMIT}])
        log = self.finish()
        self.assertEqual({f.code for f in log.faults if f.source == "pressure_ctrl"} - {"stale_state"}, set())

    # Tests that a reference for a tick far in the future is refused, and zeroes the voltage until a valid one
    # comes.
    def test_future(self):
        self.run_with(lambda tick: [{"pressure_ref": 100.0, "tick": tick + 5000}])
        log = self.check("future_pressure_command")
        self.assertEqual([c for c in log.motor_commands if c.pressure_ref == 100.0], [])

    # Tests that a loop that answers every sample, but too late, counts as stale: its reference goes to zero,
    # then the voltage.
    def test_late(self):
        hold = 6 + int(STALE * fault_case.RATE)
        self.SPAN = 2 * hold + 400
        self.run_with(lambda tick: [{"pressure_ref": 100.0, "tick": max(0, tick - 2 * hold)}])
        fault = self.wait_for_fault("stale_pressure_command")
        self.wait_for_fault("stale_pressure_command", active=False)
        log = self.finish()
        safe = [c for c in log.motor_commands if c.status == event_log.SAFE and c.tick >= fault.tick]
        self.assertGreater(len(safe), 3)
        self.assertEqual([c for c in safe if c.voltage != 0], [])
        # The first commands, for tick 0, were not too old yet. After that, the reference never has its full
        # value.
        whole = [c for c in log.motor_commands if c.pressure_ref == 100.0]
        self.assertEqual([c for c in whole if c.tick > hold], [])

    # Tests that neither of two pressure-command senders is obeyed, and that both are named.
    def test_two_senders(self):
        self.run_with(lambda tick: [{"pressure_ref": 50.0},
                                    {"pressure_ref": 100.0, "session": 777, "sequence": self.position_loop.sequence}])
        log = self.check("second_pressure_command_sender")
        fault = next(f for f in log.faults if f.code == "second_pressure_command_sender")
        self.assertIn("position_ctrl on test (process 1)", fault.text)
        self.assertIn("(session 777)", fault.text)
        self.assertEqual([c for c in log.motor_commands if c.pressure_ref == 100.0], [])

    # Tests that repeated or overtaken commands are not obeyed, and that the command in force becomes stale.
    def test_repeated(self):
        self.SPAN = int(STALE * fault_case.RATE) + 700
        self.run_with(lambda tick: [{"pressure_ref": 100.0, "sequence": -1, "tick": tick}])
        self.wait_for_fault("stale_pressure_command", active=False)
        log = self.finish()
        self.assertEqual([c for c in log.motor_commands if c.pressure_ref == 100.0], [])
        safe = [c for c in log.motor_commands if c.status == event_log.SAFE]
        self.assertGreater(len(safe), 3)
        self.assertEqual([c for c in safe if c.voltage != 0], [])


class StateTest(fault_case.FaultCase):
    """The test plays the plant: its sensors read values that are not finite from tick BAD to tick GOOD."""

    GOOD = BAD + 50

    def run_with(self, **bad):
        self.start_stack(roles=("logger", "pressure_ctrl", "position_ctrl"))
        for role in ("pressure_ctrl", "position_ctrl"):
            self.log.wait_for("HYDRO_PROCESS_STATUS", lambda s, r=role: s.role == r, role)
        plant = self.peer()
        commands = {"HYDRO_MOTOR_COMMAND": {}, "HYDRO_PRESSURE_COMMAND": {}}

        def answered(kind, tick):
            for channel, data in plant.receive(stack.PATIENCE if tick not in commands[kind] else 0):
                if channel in commands:
                    command = event_log.TYPES[channel].decode(data)
                    commands[channel].setdefault(command.tick, command)
            return tick in commands[kind]

        for tick in range(self.GOOD + 50):
            state = {"p1": 100.0, "p2": 120.0, "motor_speed": 3.0, "arm_angle": 0.05 + 1e-4 * tick}
            if BAD <= tick < self.GOOD:
                state.update(bad)
            plant.publish("HYDRO_STATE", tick=tick, sequence=tick, session=6, time=tick / fault_case.RATE,
                          command_tick=-1, **state)
            for kind in commands if tick % 5 == 0 else ["HYDRO_MOTOR_COMMAND"]:
                self.wait_until(lambda k=kind, t=tick: answered(k, t), f"{kind} of tick {tick}")
        return commands["HYDRO_MOTOR_COMMAND"]

    # Tests that a pressure or a speed that is not a number is answered with zero volts in the same tick.
    def test_pressures_and_speed(self):
        commands = self.run_with(p2=float("nan"), motor_speed=float("inf"))
        self.wait_for_fault("nonfinite_state", source="pressure_ctrl")
        self.wait_for_fault("nonfinite_state", active=False)
        for tick, command in commands.items():
            if BAD <= tick < self.GOOD:
                self.assertEqual((command.status, command.voltage), (event_log.SAFE, 0), command)
            else:
                self.assertEqual(command.status, event_log.LAW, command)
        self.assertNotEqual(commands[BAD - 1].voltage, 0)
        self.assertNotEqual(commands[self.GOOD].voltage, 0)

    # Tests that without the arm's angle the position loop commands zero volts, which are in force a tick
    # later.
    def test_arm_angle(self):
        commands = self.run_with(arm_angle=float("nan"))
        self.wait_for_fault("nonfinite_arm_angle", source="position_ctrl")
        self.wait_for_fault("nonfinite_arm_angle", active=False)
        for tick in range(BAD + 1, self.GOOD):
            self.assertEqual((commands[tick].status, commands[tick].voltage), (event_log.OPEN_LOOP, 0), commands[tick])
        self.assertNotEqual(commands[BAD - 1].voltage, 0)
        self.assertNotEqual(commands[self.GOOD + 1].voltage, 0)


if __name__ == "__main__":
    outcome.main()
