"""hydro-scope beside a stack that runs: it shows what the log has, stops the stack, and takes no part in it."""

import unittest

import scope_case
import stack


class LiveTest(stack.TestCase):
    def pair(self, *options):
        """A stack that records itself, and a scope that listens."""
        url = self.new_url()
        scope = scope_case.Scope(self, stack.config("demo.toml"), "--set", f"bus.url={url}", *options)
        log = self.path("run.lcmlog")
        launch = self.launch(stack.config("demo.toml"), "--duration", "0", "--log", log, *options, url=url)
        return scope, launch, log

    def until_time(self, client, t):
        return client.until(lambda m: m["op"] == "clock" and m["last"] >= t)

    # Tests that what is shown live is what the log has, to the last bit, and that the stack does not know of the scope.
    def test_shows_what_is_recorded(self):
        scope, launch, log = self.pair()
        client = scope.live()
        self.assertEqual(client.until(lambda m: m["op"] == "hello")["runs"][0]["kind"], "live")
        client.send({"op": "view", "id": 1, "run": 0, "channels": ["p1", "arm_angle"], "span": 1, "pixels": 100})
        self.assertGreater(client.until(lambda m: m["op"] == "bins")["bins"], 0)
        self.until_time(client, 1.5)
        processes = client.until(lambda m: m["op"] == "processes" and len(m["list"]) == 4)
        self.assertEqual({p["role"] for p in processes["list"]}, {"plant", "pressure_ctrl", "position_ctrl", "logger"})
        client.send({"op": "get", "id": 2, "run": 0, "channels": ["p1", "voltage_asked"], "t0": 0.5, "t1": 1, "pixels": 4000})
        shown = client.until(lambda m: m["op"] == "bins" and m["id"] == 2)
        reply = scope_case.ask(client, 3, op="stop")
        self.assertTrue(reply["ok"], reply)
        self.assertEqual(launch.wait(), 0, launch.report())
        recorded = scope_case.Scope(self, log).live()
        recorded.send({"op": "get", "id": 2, "run": 0, "channels": ["p1", "voltage_asked"], "t0": 0.5, "t1": 1, "pixels": 4000})
        kept = recorded.until(lambda m: m["op"] == "bins")
        self.assertEqual(shown["bins"], kept["bins"])
        self.assertEqual(str(shown["channels"]), str(kept["channels"]))  # NaN where a tick is missing
        said = [line for line in self.run_program("hydro-log", "info", log).stdout.splitlines() if "scope" in line and not line.startswith("config")]
        self.assertEqual(len(said), 1, said)  # the stack knows of it by its stop alone
        self.assertIn("scope: STOP on the page of hydro-scope", said[0])

    # Tests that faults are told, and that re-arming and setting need [scope] control.
    def test_read_only(self):
        scope, launch, _ = self.pair()
        client = scope.live()
        self.until_time(client, 0.3)
        for number, op in enumerate(("rearm", "set", "undo")):
            reply = scope_case.ask(client, 10 + number, op=op, entries=["position.c2=900"])
            self.assertFalse(reply["ok"])
            self.assertIn("control = true", reply["text"])
        scope_case.ask(client, 20, op="stop")
        stop = scope.live().until(lambda m: m["op"] == "event" and m["kind"] == "stop")
        self.assertEqual((stop["source"], stop["text"]), ("scope", "STOP on the page of hydro-scope"))
        launch.wait()

    # Tests that a stack that starts again is a new run under the old number, and the one before stays.
    def test_restart(self):
        scope, launch, _ = self.pair()
        client = scope.live()
        self.until_time(client, 0.5)
        scope_case.ask(client, 1, op="stop")
        launch.wait()
        url = next(a for a in scope.process.argv if a.startswith("bus.url="))[len("bus.url="):]
        again = self.launch(stack.config("demo.toml"), "--duration", "0", url=url)
        client.until(lambda m: m["op"] == "event" and m["kind"] == "restart")
        runs = client.until(lambda m: m["op"] == "runs" and len(m["runs"]) == 2)["runs"]
        self.assertEqual([run["kind"] for run in runs], ["live", "past"])
        scope_case.ask(client, 2, op="stop")
        again.wait()

    # Tests that the ghost beside a running stack appears; that its residuals are noise with the plant's own model, and stand out
    # with another one that the scope was given.
    def test_ghost(self):
        scope, launch, _ = self.pair()
        url = next(a for a in scope.process.argv if a.startswith("bus.url="))
        other = scope_case.Scope(self, stack.config("demo.toml"), "--set", url, "--set",
                                 "model.file=models/table1_gravity.toml")
        residuals = [self.median_residual(one) for one in (scope, other)]
        self.assertLess(residuals[0], 5)
        self.assertGreater(residuals[1], 3 * residuals[0])
        scope_case.ask(scope.live(), 3, op="stop")
        launch.wait()

    def median_residual(self, scope):
        client = scope.live()
        self.until_time(client, 1.3)
        reply = scope_case.ask(client, 1, op="ghost", run=0, on=True, resync_s=0.5)
        self.assertTrue(reply["ok"], reply)
        client.until(lambda m: m["op"] == "runs" and any(c["id"] == "ghost.p1" for c in m["runs"][0]["channels"]))
        self.until_time(client, 3)
        client.send({"op": "get", "id": 2, "run": 0, "channels": ["residual.p1", "p1"], "t0": 2.2, "t1": 2.7, "pixels": 4000})
        values, states = ([v for v in channel[0] if v == v] for channel in client.until(lambda m: m["op"] == "bins")["channels"])
        self.assertGreater(len(states), 50)  # a late plant leaves ticks out
        self.assertGreater(len(values), 0.6 * len(states))
        return sorted(map(abs, values))[len(values) // 2]

    # Tests that with [scope] control a gain that is set acts from a tick on, is shown as in force and told as an event; that one
    # that would be unstable is refused with the reason; and that the last one can be taken back.
    def test_tuning(self):
        scope, launch, _ = self.pair("--set", "scope.control=true")
        client = scope.live()

        def in_force(key, value):
            return lambda m: m["op"] == "tuning" and any(e["key"] == key and e["value"] == value for e in m["entries"])

        first = client.until(in_force("position.c2", 1200))
        self.assertTrue(first["control"])
        self.until_time(client, 2.5)  # every controller has said once in two seconds what it acts by
        reply = scope_case.ask(client, 1, op="set", entries=["position.c2=1400", "position.c1=6500"])
        self.assertTrue(reply["ok"], reply)
        self.assertGreater(reply["data"]["tick"], 2500)
        self.assertAlmostEqual(reply["data"]["t"], reply["data"]["tick"] / 1000)
        other = scope.live()  # hears what the first one missed while it waited for its answers
        event = other.until(lambda m: m["op"] == "event" and m["kind"] == "tuning")
        self.assertIn("position.c2 = 1400", event["text"])
        self.assertAlmostEqual(event["t"], reply["data"]["t"], 6)
        client.until(in_force("position.c2", 1400))
        reply = scope_case.ask(client, 2, op="set", entries=["position.c2=1"])
        self.assertFalse(reply["ok"])
        self.assertIn("unstable", reply["text"])
        for entries in ([], ["nonsense"], ["bus.url=x"]):
            self.assertFalse(scope_case.ask(client, 3, op="set", entries=entries)["ok"], entries)
        reply = scope_case.ask(client, 4, op="undo")
        self.assertTrue(reply["ok"], reply)
        client.until(in_force("position.c2", 1200))
        scope_case.ask(client, 5, op="stop")
        launch.wait()


if __name__ == "__main__":
    unittest.main()
