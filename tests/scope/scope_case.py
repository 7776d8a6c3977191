"""Starts hydro-scope for a test, and talks to it."""

import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "e2e"))

import stack  # noqa: E402
import web_socket  # noqa: E402

TOKEN = "0123456789abcdef0123"
os.environ["HYDRO_SCOPE_TOKEN"] = TOKEN


class Scope:
    """A hydro-scope on a port of its own. `before`: a command that starts it, e.g. as another user."""

    def __init__(self, case, *arguments, before=()):
        self.case = case
        os.environ["TMPDIR"] = case.folder  # where it makes a folder for its files: a killed one leaves that behind
        self.process = case.start(*before, stack.program("hydro-scope"), *arguments, "--port", "0", label="hydro-scope")
        self.port = int(self.process.wait_for(r"open http://127\.0\.0\.1:(\d+)/#token=" + TOKEN).group(1))

    def request(self, method, path, body=None, token=TOKEN, **more):
        if isinstance(body, dict):
            body = json.dumps(body)
        return web_socket.request(self.port, method, path, body, token, **more)

    def json(self, method, path, body=None):
        status, _, data = self.request(method, path, body)
        assert status == 200, data
        return json.loads(data)

    def status(self):
        return self.json("GET", "/api/status")

    def live(self, **more):
        client = web_socket.WebSocket(self.port, "/live?token=" + TOKEN, "hydro.scope.v1", **more)
        self.case.addCleanup(client.close)
        return client


def ask(client, number, **request):
    """Sends a request and waits for its reply."""
    client.send({"id": number, **request})
    return client.until(lambda message: message["op"] == "reply" and message["id"] == number)
