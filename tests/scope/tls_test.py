"""hydro-scope behind TLS, as docs/scope.md describes it: examples/scope_tls in nginx, with a certificate made by the page's command."""

import json
import os
import re
import shlex
import shutil
import signal
import socket
import ssl
import subprocess
import tempfile

import scope_case  # makes tests/e2e known
import stack
import web_socket

import outcome

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLE = os.path.join(ROOT, "examples", "scope_tls", "nginx.conf")
PAGE = os.path.join(ROOT, "docs", "scope.md")
NAME = "rig.lab"  # of the rig in the example
NOBODY = 65534
# An ordinary user's PATH lacks the folder that Debian's nginx is in.
PATH = os.environ.get("PATH", os.defpath) + os.pathsep + "/usr/sbin"
FOREIGN = "https://evil.example"


def with_changed(text, changes):
    """Each is there exactly once: the test runs the example as it is, but for these words."""
    for old, new in changes.items():
        assert text.count(old) == 1, f"{EXAMPLE}: {text.count(old)} times {old!r}"
        text = text.replace(old, new)
    return text


def listening_addresses(pid):
    """The addresses of this machine on which a process listens, as the kernel lists them: "0100007F:1F90"."""
    mine = set()
    for number in os.listdir(f"/proc/{pid}/fd"):
        found = re.match(r"socket:\[(\d+)\]", os.readlink(f"/proc/{pid}/fd/{number}"))
        if found:
            mine.add(found[1])
    addresses = []
    for table in ("tcp", "tcp6"):
        with open(f"/proc/{pid}/net/{table}") as file:
            rows = [line.split() for line in file][1:]
        addresses += [row[1] for row in rows if row[3] == "0A" and row[9] in mine]
    return addresses


class TlsTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.nginx = shutil.which("nginx", path=PATH)
        if self.nginx is None:
            self.skipTest("needs nginx: apt-get install nginx-light")
        self.port = self.reserve_port()
        self.address = f"{NAME}:{self.port}"
        self.log = self.path("run.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "-o", self.log, "--duration", "4")
        # No stack runs: it shows the log that is handed in.
        self.scope = scope_case.Scope(self, stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--set",
                                      f'scope.hosts=["{self.address}"]')
        self.make_folder()
        self.start_server()
        with open(self.log, "rb") as file:
            self.run_number = self.scope.json("POST", "/api/open?name=run.lcmlog", file.read())["run"]

    def reserve_port(self):
        """A TCP port for nginx. As long as this socket is bound nobody else is given it; nginx, which reuses addresses, can listen."""
        holder = socket.socket()
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        holder.bind(("127.0.0.1", 0))
        self.addCleanup(holder.close)
        return holder.getsockname()[1]

    def make_folder(self):
        """The folder of the instructions: the example with this test's ports, and what the page's command makes."""
        self.web = tempfile.mkdtemp(prefix="hydro-tls-")
        self.addCleanup(shutil.rmtree, self.web, ignore_errors=True)
        with open(EXAMPLE, encoding="utf-8") as file:
            text = with_changed(file.read(), {"listen 8443 ssl;": f"listen 127.0.0.1:{self.port} ssl;",
                                              "http://127.0.0.1:8765;": f"http://127.0.0.1:{self.scope.port};"})
        with open(os.path.join(self.web, "nginx.conf"), "w", encoding="utf-8") as file:
            file.write(text)
        with open(PAGE, encoding="utf-8") as file:
            command = re.search(r"^ *(openssl req .*)$", file.read(), re.MULTILINE)[1]
        subprocess.run(shlex.split(command), cwd=self.web, check=True, capture_output=True)
        self.tls = (ssl.create_default_context(cafile=os.path.join(self.web, "rig.crt")), NAME)

    def start_server(self):
        """nginx as a user without rights, in the foreground; waits until it answers."""
        before = []
        if os.geteuid() == 0:
            before = [shutil.which("setpriv"), f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
            for path in (self.web, *(os.path.join(self.web, name) for name in os.listdir(self.web))):
                os.chown(path, NOBODY, NOBODY)
        command = [*before, self.nginx, "-e", "stderr", "-p", self.web, "-c", "nginx.conf", "-g", "daemon off;"]
        self.server = self.start(*command, label="nginx")
        self.addCleanup(self.end_server)
        self.wait_until(self.accepts, "nginx listens")

    def end_server(self):
        """Killed, it would leave its worker behind."""
        if self.server.running:
            self.server.send(signal.SIGTERM)
        self.server.wait()

    def accepts(self):
        self.assertTrue(self.server.running, self.server.report())
        try:
            socket.create_connection(("127.0.0.1", self.port), timeout=stack.PATIENCE).close()
            return True
        except ConnectionRefusedError:
            return False

    def request(self, method, path, body=None, token=scope_case.TOKEN, headers=None, host=None):
        return web_socket.request(self.port, method, path, body, token, {"Host": host or self.address, **(headers or {})}, tls=self.tls)

    def socket(self, path, host=None, origin=None):
        client = web_socket.WebSocket(self.port, path, "hydro.scope.v1", origin=origin or f"https://{self.address}",
                                      host=host or self.address, tls=self.tls)
        self.addCleanup(client.close)
        return client

    # Tests that the page comes through TLS to everybody, and everything else to those with the token, under this name only, and not to
    # pages of other origins.
    def test_access(self):
        status, headers, page = self.request("GET", "/", token=None)
        self.assertEqual(status, 200)
        self.assertIn("connect-src 'self'", headers["Content-Security-Policy"])
        script = re.search(rb'src="(/?assets/[^"]+\.js)"', page)[1].decode()
        self.assertEqual(self.request("GET", "/" + script.lstrip("/"), token=None)[0], 200)
        status, _, data = self.request("GET", "/api/status")
        self.assertEqual(status, 200)
        self.assertEqual(json.loads(data)["runs"][-1]["name"], "run.lcmlog")
        for token in (None, "0" * len(scope_case.TOKEN)):
            self.assertEqual(self.request("GET", "/api/status", token=token)[0], 401, token)
        self.assertEqual(self.request("GET", "/api/status", headers={"Origin": f"https://{self.address}"})[0], 200)
        self.assertEqual(self.request("GET", "/api/status", headers={"Origin": FOREIGN})[0], 403)
        self.assertEqual(self.request("GET", "/api/status", host="evil.example")[0], 403)

    # Tests that a web socket streams through TLS what it streams without, and is refused as it is without.
    def test_web_socket(self):
        path = "/live?token=" + scope_case.TOKEN
        question = {"op": "get", "id": 1, "run": self.run_number, "channels": ["p1", "arm_angle"], "t0": 0, "t1": 4, "pixels": 5000}
        answers = []
        for client in (self.socket(path), self.scope.live()):
            self.assertEqual(client.until(lambda m: m["op"] == "hello")["runs"][-1]["last"], 4)
            client.send(question)
            answers.append(client.until(lambda m: m["op"] == "bins"))
        self.assertGreaterEqual(answers[0]["bins"], 4000)
        self.assertEqual(str(answers[0]), str(answers[1]))  # NaN where there is nothing
        for path, more, status in (("/live", {}, 401), ("/live?token=" + "0" * 20, {}, 401), (path, {"origin": FOREIGN}, 403),
                                   (path, {"host": "evil.example"}, 403)):
            with self.assertRaises(web_socket.Refused) as refused:
                self.socket(path, **more)
            self.assertEqual(refused.exception.args[0], status, (path, more))

    # Tests that a log goes up and a window of it comes down as it was: neither is too large for the server in front.
    def test_files(self):
        with open(self.log, "rb") as file:
            log = file.read()
        self.assertGreater(len(log), 1 << 20)  # the most that nginx takes by itself
        status, _, data = self.request("POST", "/api/open?name=again.lcmlog", log)
        again = self.run_number + 1
        self.assertEqual((status, json.loads(data)), (200, {"run": again, "name": "again.lcmlog", "problem": ""}))
        cut = json.dumps({"run": again, "t0": 0, "t1": 4, "format": "csv"})
        status, _, table = self.request("POST", "/api/cut", cut)
        self.assertEqual((status, table), (200, self.scope.request("POST", "/api/cut", cut)[2]))
        self.assertEqual(len(table.splitlines()), 1 + 4001)

    # Tests that the port speaks TLS only, and that hydro-scope itself is reached from this machine only.
    def test_nothing_in_plain_text(self):
        status, headers, body = web_socket.request(self.port, "GET", "/", headers={"Host": self.address})
        self.assertEqual(status, 400)
        self.assertNotIn("Content-Security-Policy", headers)
        self.assertNotIn(b"hydro", body)
        with self.assertRaises(web_socket.Refused) as refused:
            web_socket.WebSocket(self.port, "/live?token=" + scope_case.TOKEN, "hydro.scope.v1", host=self.address)
        self.assertEqual(refused.exception.args[0], 400)
        for process, port in ((self.scope.process, self.scope.port), (self.server, self.port)):
            self.assertEqual(listening_addresses(process.pid), [f"0100007F:{port:04X}"], process.label)

    # Tests that the token, which a web socket's address has, is in nothing that the server in front writes, also when it complains, and
    # that without hydro-scope it says so and lives.
    def test_token_is_not_logged(self):
        client = self.socket("/live?token=" + scope_case.TOKEN)
        client.until(lambda m: m["op"] == "hello")
        self.scope.process.kill()
        self.scope.process.wait()
        with self.assertRaises(ConnectionError):
            client.until(lambda m: False)
        self.assertEqual(self.request("GET", "/api/status?token=" + scope_case.TOKEN, token=None)[0], 502)
        self.server.send(signal.SIGTERM)
        self.assertEqual(self.server.wait(), 0, self.server.report())
        self.assertNotIn(scope_case.TOKEN, self.server.stdout + self.server.stderr)
        files = [os.path.join(folder, name) for folder, _, names in os.walk(self.web) for name in names]
        self.assertGreaterEqual(len(files), 3)
        for path in files:
            with open(path, "rb") as file:
                self.assertNotIn(scope_case.TOKEN.encode(), file.read(), path)


if __name__ == "__main__":
    outcome.main()
