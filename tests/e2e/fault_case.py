"""What the tests of docs/safety.md share: a stack that never rests, and what "zero volts after the fault" means."""

import os
import re
import signal

import event_log
import lcm_peer
import stack

RATE = 1000  # Hz, of demo.toml
# s, limits.stale_input_s. It is above the lateness of wake-ups on a shared machine (up to 150 ms), so that
# only the test's own actions cause a fault.
STALE = 0.3
# The promise of docs/safety.md: ticks from the detection of a fault to zero volts.
ZERO_WITHIN = 5


def of_code(code, active=True, source=None):
    return lambda f: f.code == code and bool(f.active) == active and source in (None, f.source)


class FaultCase(stack.TestCase):
    options = ()

    def setUp(self):
        super().setUp()
        self.log_file = self.path("run.lcmlog")

    def config_with(self, reference, name="moving.toml"):
        """demo.toml with another [reference], and with inputs that are stale only where a test makes them."""
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read()
        begin, end = text.index("[reference]"), text.index("[limits]")
        text = text[:begin] + "[reference]\n" + reference + "\n\n" + text[end:]
        text = re.sub(r"(?m)^stale_input_s = [0-9.]+", f"stale_input_s = {STALE}", text)
        text = text.replace("models/table1.toml", os.path.join(stack.CONFIG, "models", "table1.toml"))
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def moving(self):
        """A reference that never settles, so that the voltage of a running loop is never zero for long; and slow, so that
        an arm that coasts at zero volts, or under a voltage that was held, stays far from its ends."""
        return self.config_with('signal = "arm_angle"\nkind = "sine"\namplitude = 0.05\nfrequency_hz = 0.5')

    def start_stack(self, *options, config=None, duration=0, roles=("logger", "position_ctrl", "pressure_ctrl", "plant")):
        """Starts these of the four programs, the plant last; returns the log as it grows."""
        self.run_ = self.stack(config or self.moving(), "--time", "realtime", "--duration", duration, "--set",
                               f"limits.stale_input_s={STALE}", *options)
        for role in roles:
            self.run_.start(role, *{"logger": ("-o", self.log_file), "plant": ("--expect", "logger")}.get(role, ()))
        self.log = stack.LiveLog(self, self.log_file)
        return self.log

    def hashes(self):
        sample = self.path("sample.lcmlog")
        if not os.path.exists(sample):
            self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.02", "-o", sample)
        return lcm_peer.type_hashes(sample)

    def peer(self, **options):
        peer = lcm_peer.Peer(self.url, self.hashes(), **options)
        self.addCleanup(peer.close)
        return peer

    def loop(self, *arguments, **options):
        loop = lcm_peer.Loop(self.peer(), *arguments, **options)
        self.addCleanup(loop.close)
        return loop

    def wait_for_fault(self, code, active=True, source=None, start=0):
        return self.log.wait_for("HYDRO_FAULT", of_code(code, active, source), f"fault {code}, active {active}",
                                 start=start)

    def wait_for_states(self, count):
        """Waits for that many more states."""
        goal = self.log.count("HYDRO_STATE") + count
        self.wait_until(lambda: self.log.count("HYDRO_STATE") >= goal, f"{count} more states")

    def wait_for_voltage(self):
        """Waits for the next state under a voltage."""
        return self.log.wait_for("HYDRO_STATE", lambda s: s.voltage != 0, "a state under a voltage",
                                 start=self.log.count("HYDRO_STATE"))

    def finish(self, stopped="plant", expect=0, torn=False):
        """SIGTERM to the plant ends the run in order for all that live. `torn`: messages that cannot be decoded are in the
        log."""
        if self.run_[stopped].running:
            self.run_[stopped].send(signal.SIGTERM)
        for role, process in self.run_.processes.items():
            code = process.wait()
            if code != -signal.SIGKILL:  # whom the test has killed
                self.assertEqual(code, expect, process.report())
        return event_log.Log(self.log_file, foreign=torn)

    def states_during(self, log, code, source=None):
        """The states that the logger received between the first message of the fault and the one that ends it (or the
        end of the log)."""
        inside, states = False, []
        for kind, message in log.items:
            if kind == "HYDRO_FAULT" and message.code == code and source in (None, message.source):
                if inside and not message.active:
                    return states
                inside = inside or bool(message.active)
            elif kind == "HYDRO_STATE" and inside:
                states.append(message)
        self.assertTrue(inside, f"no fault {code} in the log: {[(f.source, f.code) for f in log.faults]}")
        return states

    def assert_zero_during(self, log, code, source=None, least=20):
        """While the fault lasts the voltage is zero within ZERO_WITHIN ticks, and stays zero. Returns after how many."""
        states = self.states_during(log, code, source)
        self.assertGreater(len(states), least)
        ticks = next((n for n, s in enumerate(states) if s.voltage == 0), len(states))
        print(f"{self.id().split('.')[-1]}: {code}: zero volts {ticks} ticks after its detection", flush=True)
        self.assertLessEqual(ticks, ZERO_WITHIN)
        for state in states[ticks:]:
            self.assertEqual(state.voltage, 0, state)
        return ticks

    def before_fault(self, log, code):
        """The (kind, message) that the logger received before the first message of the fault."""
        for n, (kind, message) in enumerate(log.items):
            if kind == "HYDRO_FAULT" and message.code == code:
                return log.items[:n]
        self.fail(f"no fault {code} in the log: {[(f.source, f.code) for f in log.faults]}")
        return []

    def assert_was_moving(self, log, code):
        """Before the fault there was a voltage to lose."""
        before = [message for kind, message in self.before_fault(log, code) if kind == "HYDRO_STATE"]
        self.assertTrue([s for s in before[-300:] if s.voltage != 0], "no voltage before the fault")
