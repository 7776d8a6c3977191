"""The Foxglove protocol of hydro-scope, with Foxglove's own client from npm, against a stack that runs."""

import json
import os
import subprocess
import unittest

import scope_case
import stack
import web_socket

HERE = os.path.dirname(os.path.abspath(__file__))


class FoxgloveTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.scope = scope_case.Scope(self, stack.config("demo.toml"), "--set", f"bus.url={self.url}")
        self.log = self.path("run.lcmlog")
        self.launched = self.launch(stack.config("demo.toml"), "--duration", "0", "--log", self.log)
        self.wait_until(lambda: self.scope.status()["states"] > 0, "a state")

    # Tests that Foxglove's client reads the stack's messages, under both names of the protocol, with the values of the log.
    def test_clients(self):
        heard = []
        for subprotocol in ("foxglove.websocket.v1", "foxglove.sdk.v1"):
            client = subprocess.run(["node", os.path.join(HERE, "foxglove_client.mjs"), str(self.scope.port), scope_case.TOKEN,
                                     subprotocol], capture_output=True, text=True, timeout=stack.PATIENCE)
            self.assertEqual(client.returncode, 0, client.stderr)
            found = json.loads(client.stdout)
            self.assertEqual(found["problems"], [])
            self.assertEqual(found["subprotocol"], subprotocol)
            self.assertEqual({topic["encoding"] for topic in found["topics"].values()}, {"cdr"})
            self.assertEqual(found["topics"]["/hydro/state"]["schema"], "hydro_msgs/msg/State")
            self.assertGreater(len(found["topics"]["/hydro/motor_command"]["messages"]), 250)
            heard += found["topics"]["/hydro/state"]["messages"]
            self.assertEqual(found["topics"]["/hydro/loop_statistics"]["messages"][0]["host"], os.uname().nodename)
        self.run_program("hydro-launch", "--stop", stack.config("demo.toml"), "--set", f"bus.url={self.url}")
        table = self.path("run.csv")
        self.run_program("hydro-log", "export", self.log, "-o", table)
        with open(table) as file:
            names, *rows = (line.strip().split(",") for line in file)
        recorded = {int(float(row[names.index("tick")])): row for row in rows}
        self.assertEqual(len(heard), 600)
        for state in heard:
            row = recorded[state["tick"]]
            for field, column in (("time", "time_s"), ("p1", "p1_psi"), ("arm_angle", "arm_angle_rad"),
                                  ("motor_speed", "motor_speed_rad_s")):
                self.assertEqual(state[field], float(row[names.index(column)]))

    # Tests that it is read-only and needs the token, that a client that subscribes to nothing gets nothing, and one that asks
    # for what is not there is told so.
    def test_rules(self):
        with self.assertRaises(web_socket.Refused) as refused:
            web_socket.WebSocket(self.scope.port, "/", "foxglove.websocket.v1")
        self.assertEqual(refused.exception.args[0], 401)
        client = web_socket.WebSocket(self.scope.port, "/any?token=" + scope_case.TOKEN, "foxglove.websocket.v1")
        self.addCleanup(client.close)
        self.assertEqual(json.loads(client.receive()[1])["op"], "serverInfo")
        self.assertEqual(json.loads(client.receive()[1])["op"], "advertise")
        for message in ({"op": "advertise", "channels": []}, {"op": "subscribe"}, {"op": "setParameters", "parameters": []},
                        {"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]}, "nonsense", b"\x01publish"):
            client.send(message)
            answer = json.loads(client.receive()[1])
            self.assertEqual((answer["op"], answer["level"]), ("status", 2), message)
        client.send({"op": "subscribe", "subscriptions": [{"id": 5, "channelId": 1}]})
        binary, data = client.receive()
        self.assertTrue(binary)
        self.assertEqual(data[:5], b"\x01\x05\0\0\0")
        client.send({"op": "unsubscribe", "subscriptionIds": [5]})
        client.send({"op": "unsubscribe"})
        while client.receive()[0]:
            pass  # what was on its way, then the complaint


if __name__ == "__main__":
    unittest.main()
