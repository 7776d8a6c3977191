"""What the timing tests share: runs in real time that are disturbed, and what must hold of their logs all the same."""

import signal
import time

import event_log
import stack

RATE = 1000  # Hz, of demo.toml
INTERVAL = 5  # ticks, of demo.toml
DELAY = 1  # ticks
ROLES = ("plant", "pressure_ctrl", "position_ctrl", "logger")


class TimingCase(stack.TestCase):
    def start_stack(self, *options, few_may_wait=None):
        """The four processes in real time, without an end. Of `few_may_wait`, a role, the receive buffer is small."""
        self.log_file = self.path("run.lcmlog")
        self.run_ = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", *options)
        for role, more in (("logger", ("-o", self.log_file)), ("position_ctrl", ()), ("pressure_ctrl", ()),
                           ("plant", ("--expect", "logger"))):
            if role == few_may_wait:
                more += ("--set", f"bus.url={self.url}&recv_buf_size=32768")
            self.run_.start(role, *more)
        self.live = stack.LiveLog(self, self.log_file)
        self.live.wait_for_tick(200)

    def hold(self, role, seconds):
        """Stops a process for at least that long."""
        self.run_[role].send(signal.SIGSTOP)
        self.held_from = time.time()
        time.sleep(seconds)  # the disturbance itself, not a wait for something
        self.held_until = time.time()
        self.run_[role].send(signal.SIGCONT)

    def while_held(self, messages):
        """Those that were sent while the last process that was stopped stood still."""
        return [m for m in messages if self.held_from < 1e-6 * m.utime < self.held_until]

    def finish(self):
        self.run_["plant"].send(signal.SIGTERM)
        for role in ROLES:
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())
        return event_log.Log(self.log_file)

    def totals(self, log):
        """{role: its report on its whole run}"""
        return {s.role: s for s in log.statistics if s.whole_run}

    def histogram(self, log, role, quantity):
        """The last one that a process sent; None where it never had such a value."""
        found = [h for h in log.histograms if h.role == role and h.quantity == quantity]
        return found[-1] if found else None

    def laws(self, log):
        """The motor commands that answer a state: without those of zero volts that a process says on its own account."""
        return [c for c in log.motor_commands if c.status in (event_log.LAW, event_log.SAFE)
                and c.pressure_command_tick >= 0]

    def check_ticks(self, log):
        """Late ticks are skipped and counted, never doubled."""
        expected = 0
        for state in log.states:
            self.assertEqual(state.tick, expected + state.skipped_ticks)
            self.assertGreaterEqual(state.skipped_ticks, 0)
            expected = state.tick + 1
        skipped = sum(s.skipped_ticks for s in log.states)
        plant = self.totals(log)["plant"]
        self.assertEqual(plant.missed_deadlines, skipped)
        self.assertEqual(plant.cycles, len(log.states) - 1)  # but for tick 0, which is not waited for
        in_a_row = self.histogram(log, "plant", "skipped")
        runs = [s.skipped_ticks for s in log.states if s.skipped_ticks]
        self.assertEqual(in_a_row.count if in_a_row else 0, len(runs))
        if runs:
            self.assertEqual((in_a_row.lowest, in_a_row.highest), (min(runs), max(runs)))
        return skipped

    def check_phase(self, log):
        """The slow loop acts on every INTERVAL-th tick and on no other, once; those it could not act on it counted."""
        ticks = [c.tick for c in log.pressure_commands]
        self.assertEqual([t for t in ticks if t % INTERVAL], [])
        self.assertEqual(ticks, sorted(set(ticks)))
        self.assertEqual([r.tick for r in log.arm_references], ticks)
        states = {s.tick for s in log.states}
        self.assertLessEqual(set(ticks), states)
        position = self.totals(log)["position_ctrl"]
        self.assertEqual(position.cycles, len(ticks))
        self.assertEqual(position.missed_deadlines, (ticks[-1] - ticks[0]) // INTERVAL + 1 - len(ticks))
        return ticks

    def check_cause_and_effect(self, log):
        """Nothing is computed from what had not been sent, by the senders' own stamps (one machine, one clock)."""
        state = {s.tick: s for s in log.states}
        pressure = {c.tick: c for c in log.pressure_commands}
        motor = {}
        for command in self.laws(log):
            self.assertNotIn(command.tick, motor, "answered twice")
            motor[command.tick] = command
            self.assertIn(command.tick, state)
            self.assertLessEqual(state[command.tick].utime, command.utime)
            used = command.pressure_command_tick
            self.assertLessEqual(used, command.tick - DELAY)
            self.assertLessEqual(pressure[used].utime, command.utime)
        order = [c.tick for c in self.laws(log)]
        self.assertEqual(order, sorted(order))
        for command in log.pressure_commands:
            self.assertLessEqual(state[command.tick].utime, command.utime)
        newest = -1
        for after, before in zip(log.states[1:], log.states):
            if after.command_tick < 0:
                self.assertEqual(after.voltage, 0)
                continue
            self.assertGreaterEqual(after.command_tick, newest, "an older command came back")
            newest = after.command_tick
            self.assertLessEqual(after.command_tick, before.tick - DELAY)
            if after.command_tick in motor:
                self.assertEqual(after.voltage, motor[after.command_tick].voltage)
                self.assertLessEqual(motor[after.command_tick].utime, after.utime)
        return motor
