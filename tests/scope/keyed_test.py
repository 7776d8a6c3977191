"""hydro-scope beside a stack with a key: with the key it sees, sets and stops as without one; without it, it changes nothing."""

import os
import shutil
import signal

import scope_case  # makes tests/e2e known
import stack

import event_log
import outcome

NOBODY = 65534


def in_force(key, value):
    return lambda m: m["op"] == "tuning" and any(e["key"] == key and e["value"] == value for e in m["entries"])


class KeyedTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.keyed = self.key("key")
        self.log_file = self.path("run.lcmlog")
        self.bus = ("--set", f"bus.url={self.url}")

    def key(self, name):
        """Options for a new key."""
        options = ("--set", f"bus.key_file={self.path(name)}")
        self.run_program("hydro-launch", stack.config("demo.toml"), *options, "--make-key")
        return options

    def scope(self, *options, before=()):
        return scope_case.Scope(self, stack.config("demo.toml"), *self.bus, "--set", "scope.control=true", *options, before=before)

    def as_nobody(self):
        """What starts a program as another user, who may write into this test's folder."""
        os.chmod(self.folder, 0o777)
        return [shutil.which("setpriv"), f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]

    def start_stack(self):
        """Returns the log as it grows."""
        self.launched = self.launch(stack.config("demo.toml"), "--duration", "0", "--log", self.log_file, *self.keyed,
                                    "--set", "limits.stale_input_s=2")  # late wake-ups of a busy machine are no faults here
        return stack.LiveLog(self, self.log_file)

    def list_in_force(self):
        """What hydro-set lists. It looks for a stack for 3 s, in which a busy machine may not wake both."""

        def listed():
            asked = self.start("hydro-set", stack.config("demo.toml"), *self.bus, *self.keyed, "--list")
            return asked.stdout if asked.wait() == 0 else None

        return self.wait_until(listed, "hydro-set hears the stack")

    # Tests that with the key the states are seen, a value is set on the tick that the answer names, in the loop too, and a stop stops.
    def test_with_the_key(self):
        scope = self.scope(*self.keyed)
        log = self.start_stack()
        client = scope.live()
        client.until(in_force("position.c2", 1200))
        client.until(lambda m: m["op"] == "clock" and m["last"] >= 2.5)  # by now both loops have said by what they act
        reply = scope_case.ask(client, 1, op="set", entries=["position.c2=1400"])
        self.assertTrue(reply["ok"], reply)
        client.until(in_force("position.c2", 1400))
        tick = reply["data"]["tick"]
        log.wait_for("HYDRO_TUNING_STATUS", lambda s: s.role == "position_ctrl" and s.in_force == 1, "the position loop acts by it")
        log.wait_for_tick(tick + 100)
        client.send({"op": "get", "id": 2, "run": 0, "channels": ["p1"], "t0": 1, "t1": 2, "pixels": 4000})
        shown = client.until(lambda m: m["op"] == "bins")
        reply = scope_case.ask(client, 3, op="stop")
        self.assertTrue(reply["ok"], reply)
        self.assertEqual(self.launched.wait(), 0, self.launched.report())
        run = event_log.Log(self.log_file)
        self.assertNotIn("unauthenticated_command", {f.code for f in run.faults})
        self.assertEqual([stop.reason for stop in run.stops][:1], ["STOP on the page of hydro-scope"])
        self.assertEqual({s.acts_at for s in run.of("HYDRO_SETTINGS") if s.version == 1 and s.acts_at >= 0}, {tick})
        # From that tick on, or from the first after it at which a loop of a busy machine woke.
        since = {s.role: s.since for s in run.of("HYDRO_TUNING_STATUS") if s.in_force == 1}
        self.assertEqual(set(since), {"pressure_ctrl", "position_ctrl"})
        for role, kind in (("pressure_ctrl", "HYDRO_MOTOR_COMMAND"), ("position_ctrl", "HYDRO_PRESSURE_COMMAND")):
            self.assertEqual(since[role], min(c.tick for c in run.of(kind) if c.tick >= tick), role)
        recorded = {s.tick: s.p1 for s in run.states}
        minima, maxima = shown["channels"][0]
        seen = {round((shown["t0"] + (n + 0.5) * shown["width"]) * 1000): pair
                for n, pair in enumerate(zip(minima, maxima)) if pair[0] == pair[0]}
        due = [tick for tick in recorded if 1000 <= tick <= 2000]  # a late plant skips some
        self.assertGreater(len(due), 50)
        self.assertGreater(len(seen), 0.9 * len(due))
        for number, pair in seen.items():
            self.assertEqual(pair, (recorded[number], recorded[number]), number)

    # Tests that without the key the messages, which are sealed but not secret, are seen, and a change that is asked for is refused by the
    # plant and told as refused; that with another key nothing is seen either; and that in the end all is in force as it was.
    def test_without_the_key(self):
        log = self.start_stack()
        log.wait_for_tick(100)
        for options in ((), self.key("other")):
            scope = self.scope(*options)
            client = scope.live()
            if options:
                self.wait_until(lambda: scope.status()["messages_refused"] > 100, "it refuses the stack's messages")
                self.assertEqual(scope.status()["states"], 0)
            else:
                client.until(in_force("position.c2", 1200))
                client.until(lambda m: m["op"] == "clock" and m["last"] >= 2.5)
            for number, request in enumerate(({"op": "set", "entries": ["position.c2=1400"]}, {"op": "undo"}, {"op": "rearm"})):
                reply = scope_case.ask(client, number, **request)
                self.assertFalse(reply["ok"], reply)
                self.assertNotEqual(reply["text"], "")
        self.assertRegex(self.list_in_force(), r"(?m)^position\.c2 +1200 ")
        self.launched.send(signal.SIGINT)
        self.assertEqual(self.launched.wait(), 0, self.launched.report())
        run = event_log.Log(self.log_file)
        self.assertEqual({s.version for s in run.of("HYDRO_SETTINGS")}, {0})
        refused = [f.text for f in run.faults if f.source == "plant" and f.code == "unauthenticated_command" and f.active]
        self.assertTrue([text for text in refused if "HYDRO_TUNING_REQUEST" in text], run.faults)
        channels = {event.channel for event in run.events}
        for channel in ("HYDRO_TUNING_REQUEST", "HYDRO_REARM"):
            self.assertNotIn(channel, channels)
            self.assertIn("REFUSED_" + channel, channels)  # as it is recorded then

    # Tests that a stop without the key is the business of this machine: the stack's own user stops it over the local sockets, on which
    # nothing is sealed; anybody else has only the bus, where it is refused, and is told that nothing has ended.
    def test_stop_without_the_key(self):
        log = self.start_stack()
        log.wait_for_tick(100)
        if os.geteuid() == 0:
            reply = scope_case.ask(self.scope(before=self.as_nobody()).live(), 1, op="stop")
            self.assertFalse(reply["ok"], reply)
            fault = log.wait_for("HYDRO_FAULT", lambda f: f.source == "plant" and f.active and f.code == "unauthenticated_command",
                                 "the plant's refusal")
            self.assertIn("HYDRO_STOP", fault.text)
            log.wait_for_tick(fault.tick + 100)
            self.assertTrue(self.launched.running)
        reply = scope_case.ask(self.scope().live(), 1, op="stop")
        self.assertTrue(reply["ok"], reply)
        self.assertEqual(self.launched.wait(), 0, self.launched.report())


if __name__ == "__main__":
    outcome.main()
