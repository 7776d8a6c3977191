"""hydro-scope with a log: what it serves, to whom, and what hostile or slow clients can do to it (nothing)."""

import glob
import json
import signal
import socket
import unittest

import scope_case
import stack
import web_socket


class ServerTest(stack.TestCase):
    def recorded(self, name, *options):
        file = self.path(name)
        self.run_program("hydro-sim", stack.config("demo.toml"), "-o", file, *options)
        return file

    def scope(self):
        return scope_case.Scope(self, self.recorded("run.lcmlog", "--duration", "3"))

    # Tests that the page is for everybody on this machine, everything else for those with the token, and nothing for pages of
    # other origins or under another name of this machine.
    def test_access(self):
        scope = self.scope()
        status, headers, _ = scope.request("GET", "/", token=None)
        self.assertEqual(status, 200)
        self.assertIn("default-src 'self'", headers["Content-Security-Policy"])
        self.assertIn("frame-ancestors 'none'", headers["Content-Security-Policy"])
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
        for path in ("/api/status", "/api/jobs/1", "/nothing"):
            self.assertEqual(scope.request("GET", path, token=None)[0], 401, path)
            self.assertEqual(scope.request("GET", path, token="0" * 20)[0], 401, path)
        self.assertEqual(scope.request("GET", "/api/status?token=" + scope_case.TOKEN, token=None)[0], 200)
        for header in ({"Origin": "http://evil.example"}, {"Origin": "null"}, {"Host": "evil.example"}):
            self.assertEqual(scope.request("GET", "/api/status", headers=header)[0], 403, header)
            self.assertEqual(scope.request("GET", "/", token=None, headers=header)[0], 403, header)
        for path, more, status in (("/live", {}, 401), ("/live?token=" + "0" * 20, {}, 401),
                                   ("/live?token=" + scope_case.TOKEN, {"origin": "http://evil.example"}, 403),
                                   ("/live?token=" + scope_case.TOKEN, {"host": "evil.example"}, 403),
                                   ("/live?token=" + scope_case.TOKEN, {"subprotocol": "other"}, 404)):
            with self.assertRaises(web_socket.Refused) as refused:
                web_socket.WebSocket(scope.port, path, **more)
            self.assertEqual(refused.exception.args[0], status, (path, more))

    # Tests that no file but the page's is served, however the path is written.
    def test_only_the_page(self):
        scope = self.scope()
        for path in ("/assets/../scope_app.cc", "/assets/%2e%2e/%2e%2e/etc/passwd", "/assets//etc/passwd", "/assets/package.json",
                     "/assets/.git/config", "/assets/node_modules/x.js"):
            self.assertEqual(scope.request("GET", path, token=None)[0], 404, path)

    # Tests that a window is cut out as a log that describes itself, and as a table, with the values of the run.
    def test_cut(self):
        scope = self.scope()
        window = {"run": 0, "t0": 1, "t1": 1.5}
        status, headers, data = scope.request("POST", "/api/cut", {**window, "format": "lcmlog"})
        self.assertEqual(status, 200, data)
        self.assertEqual(headers["Content-Disposition"], 'attachment; filename="run_cut.lcmlog"')
        cut = self.path("cut.lcmlog")
        with open(cut, "wb") as file:
            file.write(data)
        info = self.run_program("hydro-log", "info", cut).stdout
        self.assertIn("log: complete", info)
        self.assertIn("model: Table 1", info)
        exported = self.path("cut.csv")
        self.run_program("hydro-log", "export", cut, "-o", exported)
        status, _, table = scope.request("POST", "/api/cut", {**window, "format": "csv"})
        self.assertEqual(status, 200)
        with open(exported, "rb") as file:
            self.assertEqual(table, file.read())
        rows = table.decode().splitlines()
        self.assertEqual(len(rows), 1 + 501)
        whole = self.path("run.csv")
        self.run_program("hydro-log", "export", self.path("run.lcmlog"), "-o", whole)
        with open(whole) as file:
            self.assertEqual(file.read().splitlines()[1001:1501], rows[1:501])  # the last row's voltage came later
        si = scope.request("POST", "/api/cut", {**window, "format": "csv", "si": True})[2].decode().splitlines()
        column = si[0].split(",").index("p1_Pa")
        self.assertAlmostEqual(float(si[1].split(",")[column]), float(rows[1].split(",")[column]) * 6894.757293168, 3)

    # Tests that logs and tables that are handed in are runs beside the first, and can be closed.
    def test_open(self):
        scope = self.scope()
        with open(self.recorded("other.lcmlog", "--duration", "1", "--seed", "5"), "rb") as file:
            other = file.read()
        opened = scope.json("POST", "/api/open?name=../x%22other.lcmlog", other)
        self.assertEqual(opened, {"run": 1, "name": "x_other.lcmlog", "problem": ""})
        self.assertEqual([run["last"] for run in scope.status()["runs"]], [3, 1])
        table = scope.request("POST", "/api/cut", {"run": 1, "t0": 0, "t1": 1, "format": "csv"})[2]
        self.assertEqual(scope.json("POST", "/api/open?name=table.csv", table)["run"], 2)
        self.assertNotIn("problem", scope.status()["runs"][2])  # a table has no configuration, and needs none
        torn = scope.json("POST", "/api/open?name=torn.lcmlog", other[: len(other) // 2])
        self.assertNotEqual(torn["problem"], "")
        for run in (1, 2, 3):
            scope.json("POST", "/api/close", {"run": run})
        self.assertEqual(len(scope.status()["runs"]), 1)

    # Tests that a window is diagnosed: its job ends with a verdict and a report, which is shown without the token, in a sandbox.
    def test_diagnose(self):
        scope = self.scope()
        self.assertEqual(scope.request("GET", "/api/jobs/1")[0], 404)
        job = scope.json("POST", "/api/diagnose", {"run": 0, "t0": 0.1, "t1": 0.6})["job"]
        self.assertEqual(scope.request("POST", "/api/diagnose", {"run": 0, "t0": 0, "t1": 1})[0], 400)  # one at a time
        status = {}

        def ended():
            status.update(scope.json("GET", f"/api/jobs/{job}"))
            return status["state"] != "running"

        self.wait_until(ended, "the diagnosis ends", timeout=600)  # it gives way to everybody on the machine
        self.assertEqual(status["state"], "done", status)
        self.assertNotEqual(status["sentence"], "")
        code, headers, report = scope.request("GET", status["report"], token=None)
        self.assertEqual(code, 200)
        self.assertIn("sandbox allow-scripts;", headers["Content-Security-Policy"])
        self.assertIn(b"<html", report)
        self.assertEqual(scope.request("GET", "/api/reports/" + "0" * 32, token=None)[0], 404)
        failed = scope.json("POST", "/api/diagnose", {"run": 0, "t0": 50, "t1": 51})["job"]
        self.wait_until(lambda: scope.json("GET", f"/api/jobs/{failed}")["state"] == "failed", "the other one fails", timeout=300)

    # Tests that bad requests are answered by what was found and what is allowed.
    def test_bad_requests(self):
        scope = self.scope()
        for path, body, words in (
                ("/api/cut", "no json", "JSON"),
                ("/api/cut", {"run": 7, "t0": 0, "t1": 1, "format": "csv"}, "run: found 7"),
                ("/api/cut", {"run": -1, "t0": 0, "t1": 1, "format": "csv"}, "run: found -1"),
                ("/api/cut", {"run": 0, "t0": "x", "t1": 1, "format": "csv"}, "t0: found"),
                ("/api/cut", {"run": 0, "t0": 0, "t1": 1, "format": "exe"}, 'format: found \\"exe\\"'),
                ("/api/cut", {"run": 0, "t0": 50, "t1": 51, "format": "csv"}, "found no state"),
                ("/api/open?name=x.lcmlog", b"\0" * 1000, "x.lcmlog"),
                ("/api/open?name=x.csv", b"a,b\n1,2\n", "x.csv"),
                ("/api/close", {"run": 9}, "run: found 9")):
            status, _, data = scope.request("POST", path, body)
            self.assertEqual(status, 400, (path, body, data))
            self.assertIn(words, data.decode())
            json.loads(data)
        self.assertEqual(scope.request("POST", "/api/cut", "x" * 70000)[0], 413)
        self.assertEqual(scope.request("DELETE", "/api/status")[0], 405)
        self.assertEqual(scope.request("GET", "/api/nothing")[0], 404)

    # Tests that a get gives the samples of the log, bit by bit, and values those of a tick.
    def test_values(self):
        scope = self.scope()
        table = self.path("run.csv")
        self.run_program("hydro-log", "export", self.path("run.lcmlog"), "-o", table)
        with open(table) as file:
            names, *rows = (line.strip().split(",") for line in file)
        p1 = [float(row[names.index("p1_psi")]) for row in rows]
        client = scope.live()
        client.send({"op": "get", "id": 1, "run": 0, "channels": ["p1"], "t0": 0, "t1": 3, "pixels": 4000})
        bins = client.until(lambda m: m["op"] == "bins")
        self.assertEqual(bins["bins"], 3001)
        self.assertEqual(list(bins["channels"][0][0]), p1)
        self.assertEqual(list(bins["channels"][0][1]), p1)
        client.send({"op": "get", "id": 2, "run": 0, "channels": ["p1"], "t0": 0, "t1": 3, "pixels": 30})
        coarse = client.until(lambda m: m["op"] == "bins")
        self.assertEqual(max(coarse["channels"][0][1]), max(p1))
        self.assertEqual(min(coarse["channels"][0][0]), min(p1))
        reply = scope_case.ask(client, 3, op="values", run=0, channels=["p1"], t=1.2345)
        self.assertEqual(reply["data"], {"t": 1.234, "values": [p1[1234]]})

    # Tests that ten clients are served beside one that asks and never reads, one that sends half a request and one that vanishes.
    def test_many_clients(self):
        scope = self.scope()
        stuck = scope.live()
        for number in range(40):
            stuck.send({"op": "get", "id": number, "run": 0, "channels": ["p1"] * 16, "t0": 0, "t1": 3, "pixels": 3000})
        half = socket.create_connection(("127.0.0.1", scope.port))
        self.addCleanup(half.close)
        half.sendall(b"POST /api/cut HTTP/1.1\r\nHost: 127.0.0.1:")
        vanished = scope.live()
        vanished.send({"op": "view", "id": 1, "run": 0, "channels": ["p1"], "span": 3, "pixels": 100})
        vanished.close()
        before = scope.status()["memory_bytes"]
        clients = [scope.live() for _ in range(10)]
        for client in clients:
            client.send({"op": "get", "id": 9, "run": 0, "channels": ["p1"], "t0": 0, "t1": 3, "pixels": 100})
        for client in clients:
            self.assertEqual(client.until(lambda m: m["op"] == "bins")["bins"], 100)
        self.assertEqual(scope.status()["memory_bytes"], before)
        self.wait_until(lambda: scope.status()["clients"] == 11, "the vanished client is gone")

    # Tests that a client that breaks the rules of its protocol is closed, and nobody else.
    def test_rude_clients(self):
        scope = self.scope()
        polite = scope.live()
        for frame in ((1, b"x" * 70000), (1, b"\xff\xfe"), (3, b"reserved")):
            rude = scope.live()
            rude.send_frame(*frame)
            with self.assertRaises((ConnectionError, OSError)):
                while True:
                    rude.receive()
        rude = scope.live()
        for _ in range(20):
            rude.send("nonsense")
        with self.assertRaises((ConnectionError, OSError)):
            while True:
                rude.receive()
        self.assertTrue(scope_case.ask(polite, 5, op="values", run=0, channels=["p1"], t=1)["ok"])

    # Tests that a signal ends it with exit code 0, with clients there, and that its files are gone.
    def test_ends(self):
        scope = self.scope()
        scope.live()
        with open(self.path("run.lcmlog"), "rb") as file:
            scope.json("POST", "/api/open?name=x.lcmlog", file.read())
        self.assertEqual(len(glob.glob(self.path("hydro-scope.*/*.lcmlog"))), 1)
        scope.process.send(signal.SIGTERM)
        self.assertEqual(scope.process.wait(), 0, scope.process.report())
        self.assertEqual(glob.glob(self.path("hydro-scope.*")), [])

    # Tests that a bad start is one line and exit code 2.
    def test_bad_start(self):
        for arguments, words in ((("nothing.lcmlog",), "nothing.lcmlog"), ((__file__,), "found"),
                                 ((stack.config("demo.toml"), "--port", "70000"), "--port: found 70000"),
                                 ((stack.config("demo.toml"), "--set", "scope.port=-1"), "scope.port: found -1"),
                                 ((stack.config("demo.toml"), "--set", "scope.hosts=['http://x']"), "scope.hosts: found"),
                                 ((stack.config("demo.toml"), "--page", "/nowhere"), "--page /nowhere")):
            result = self.run_program("hydro-scope", *arguments, expect=2)
            self.assertIn(words, result.stderr)
        scope = self.scope()
        result = self.run_program("hydro-scope", self.path("run.lcmlog"), "--port", str(scope.port), expect=2)
        self.assertIn(f"cannot listen on 127.0.0.1:{scope.port}", result.stderr)


if __name__ == "__main__":
    unittest.main()
