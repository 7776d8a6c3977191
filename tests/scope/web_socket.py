"""A web socket client and HTTP requests for tests, of the standard library alone: also requests that no browser would send."""

import base64
import http.client
import json
import os
import socket
import struct
import time

PATIENCE = 60  # s


def connect(port, tls=None, timeout=PATIENCE):
    """A socket to a port of this machine; tls: the ssl.SSLContext and the name that the server's certificate is to have."""
    plain = socket.create_connection(("127.0.0.1", port), timeout=timeout)
    return tls[0].wrap_socket(plain, server_hostname=tls[1]) if tls else plain


def request(port, method, path, body=None, token=None, headers=None, tls=None, timeout=PATIENCE):
    """Status, headers and body of one request."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=timeout)
    connection.sock = connect(port, tls, timeout)
    sent = dict(headers or {})
    if token is not None:
        sent["Authorization"] = "Bearer " + token
    connection.request(method, path, body=body, headers=sent)
    response = connection.getresponse()
    data = response.read()
    connection.close()
    return response.status, dict(response.getheaders()), data


class Refused(Exception):
    """The server did not accept the web socket; its argument is the status."""


class WebSocket:
    """A client's end. Messages come as (True, bytes) or (False, text)."""

    def __init__(self, port, path, subprotocol=None, origin=None, host=None, tls=None, timeout=PATIENCE):
        self.socket = connect(port, tls, timeout)
        self.buffer = b""
        lines = [
            f"GET {path} HTTP/1.1",
            f"Host: {host or f'127.0.0.1:{port}'}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode(),
        ]
        if subprotocol:
            lines.append("Sec-WebSocket-Protocol: " + subprotocol)
        if origin:
            lines.append("Origin: " + origin)
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        head = b""
        while b"\r\n\r\n" not in head:
            more = self.socket.recv(65536)
            if not more:
                raise Refused(0)
            head += more
        head, self.buffer = head.split(b"\r\n\r\n", 1)
        self.head = head.decode()
        status = int(self.head.split()[1])
        if status != 101:
            self.socket.close()
            raise Refused(status)

    def send(self, message):
        data = message if isinstance(message, bytes) else (message if isinstance(message, str) else json.dumps(message)).encode()
        self.send_frame(2 if isinstance(message, bytes) else 1, data)

    def send_frame(self, opcode, data):
        mask = os.urandom(4)
        if len(data) < 126:
            head = struct.pack("!BB", 0x80 | opcode, 0x80 | len(data))
        elif len(data) < 65536:
            head = struct.pack("!BBH", 0x80 | opcode, 0x80 | 126, len(data))
        else:
            head = struct.pack("!BBQ", 0x80 | opcode, 0x80 | 127, len(data))
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def _take(self, size):
        while len(self.buffer) < size:
            more = self.socket.recv(1 << 16)
            if not more:
                raise ConnectionError("the server closed the connection")
            self.buffer += more
        taken, self.buffer = self.buffer[:size], self.buffer[size:]
        return taken

    def receive(self):
        """The next message. Pings are answered; the server's close is a ConnectionError."""
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                (size,) = struct.unpack("!H", self._take(2))
            elif size == 127:
                (size,) = struct.unpack("!Q", self._take(8))
            data = self._take(size)
            opcode = first & 15
            if opcode == 9:
                self.send_frame(10, data)
            elif opcode == 8:
                raise ConnectionError("closed by the server: " + data[2:].decode(errors="replace"))
            elif opcode in (1, 2):
                return opcode == 2, data if opcode == 2 else data.decode()

    def until(self, wanted):
        """The first message for which wanted(message) is true; texts are decoded from JSON first. Other messages come all the time."""
        deadline = time.monotonic() + PATIENCE
        while True:
            if time.monotonic() > deadline:
                raise AssertionError(f"waited {PATIENCE} s in vain for a message of hydro-scope")
            binary, data = self.receive()
            message = decode_bins(data) if binary else json.loads(data)
            if wanted(message):
                return message

    def close(self):
        self.socket.close()


def decode_bins(data):
    """A binary message of kind 1 (docs/developers/scope_protocol.md)."""
    kind, number, run, flags, t0, width, bins, channels = struct.unpack_from("<IIIIddII", data)
    values = struct.unpack_from(f"<{2 * bins * channels}d", data, 40)
    assert kind == 1 and len(data) == 40 + 16 * bins * channels
    pairs = [(values[2 * c * bins:(2 * c + 1) * bins], values[(2 * c + 1) * bins:(2 * c + 2) * bins]) for c in range(channels)]
    return {"op": "bins", "id": number, "run": run, "flags": flags, "t0": t0, "width": width, "bins": bins, "channels": pairs}
