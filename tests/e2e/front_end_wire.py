"""The frames of docs/front_end.md, written from that page and not from firmware/frames.c: what both agree on is what the page says."""

import math
import os
import select
import socket
import struct
import termios
import time
import tty
import zlib

HELLO, SETTINGS, ARM, VOLTAGE, PRESSURE, ZERO = 1, 2, 3, 4, 5, 6
IDENTITY, SETTINGS_HELD, SAMPLE = 0x81, 0x82, 0x83
OUTPUT, CONVERTERS = 0x40, 0x41
IDLE, READY, ARMED, TRIPPED = range(4)
WATCHDOG, COMMAND, FINGERPRINT, OVER_PRESSURE = 1, 2, 4, 8
SENSOR, CONVERTER, INTERLOCK = 64, 256, 1024

HEADER = struct.Struct("<BBHII")
BODIES = {
    HELLO: ("", ()),
    SETTINGS: ("192s", ("settings",)),
    ZERO: ("", ()),
    ARM: ("II", ("fingerprint", "trips")),
    VOLTAGE: ("Iqf", ("fingerprint", "host_tick", "voltage")),
    PRESSURE: ("Iqfffff", ("fingerprint", "host_tick", "pressure_ref", "k_p", "k_v", "reference_feedforward", "arm_speed_ratio")),
    IDENTITY: ("BBHHHIIQIIBBHff16s", ("state", "modes", "major", "minor", "patch", "boot", "tick_rate_hz", "tick", "session_in_charge",
                                      "fingerprint", "analog_inputs", "counters", "zero", "output_min_V", "output_max_V", "board")),
    SETTINGS_HELD: ("BBHI192s", ("refused", "refused_part", "zero", "fingerprint", "settings")),
    SAMPLE: ("QBBBBHHIIqIffffffiiffffHH",
             ("tick", "state", "source", "saturated", "sensor_faults", "faults_present", "faults_latched", "trips", "command_sequence",
              "host_tick", "command_age", "p1", "p2", "motor_angle", "motor_speed", "arm_angle", "arm_speed", "motor_count", "arm_count",
              "voltage", "read_back", "pressure_ref", "transfer", "frames_bad", "frames_refused")),
    OUTPUT: ("Qf", ("tick", "volts")),
    CONVERTERS: ("Q8f2IfB3x", ("tick", *(f"analog{i}" for i in range(8)), "counter0", "counter1", "read_back_V", "interlock")),
}
SENSOR_ROW = struct.Struct("<BBBxfffff")


def stuff(frame):
    out, code_at = bytearray([0, 0]), 1
    for byte in frame:
        if byte == 0:
            out[code_at], code_at = len(out) - code_at, len(out)
        out.append(byte)
    out[code_at] = len(out) - code_at
    return bytes(out) + b"\0"


def unstuff(piece):
    """The frame, or None where the distances do not lead to the end."""
    out, code_at = bytearray(piece), 0
    while code_at < len(out):
        step, out[code_at] = out[code_at], 0
        code_at += step
    return bytes(out[1:]) if code_at == len(out) else None


def frame(kind, session, sequence, body=b"", protocol=1):
    head = HEADER.pack(protocol, kind, 0, session, sequence) + body
    return stuff(head + struct.pack("<I", zlib.crc32(head)))


def encode(kind, session, sequence, fields):
    """The frame with these fields, as Receiver gives them."""
    form, names = BODIES[kind]
    return frame(kind, session, sequence, struct.pack("<" + form, *(fields[name] for name in names)))


def sensor(kind=0, channel=0, bits=0, scale=1.0, offset=0.0, share=1.0, low=-math.inf, high=math.inf):
    return SENSOR_ROW.pack(kind, channel, bits, scale, offset, share, low, high)


def settings(mode=1, interval=1, watchdog=50, transfer=0, voltage=10.0, pressure=math.inf, speed=math.inf, angle=math.inf, reference=2000.0,
             output_scale=1.0, output_offset=0.0, tolerance=0.0, sensors=()):
    rows = list(sensors) + [sensor()] * (6 - len(sensors))
    return struct.pack("<BxHII8fI", mode, interval, watchdog, transfer, voltage, pressure, speed, angle, reference, output_scale, output_offset,
                       tolerance, 0) + b"".join(rows)


def fingerprint(body):
    return zlib.crc32(b"\x01" + body) or 1


class Receiver:
    """Collects bytes; gives (kind, session, sequence, {field: value}) of each whole frame."""

    def __init__(self):
        self.piece, self.bad = bytearray(), 0

    def take(self, data):
        for byte in data:
            if byte:
                self.piece.append(byte)
                continue
            if self.piece:
                found = self.read(bytes(self.piece))
                self.bad += found is None
                if found:
                    yield found
            self.piece.clear()

    @staticmethod
    def read(piece):
        content = unstuff(piece)
        if content is None or len(content) < 16 or zlib.crc32(content[:-4]) != struct.unpack("<I", content[-4:])[0]:
            return None
        _, kind, _, session, sequence = HEADER.unpack(content[:12])
        if kind not in BODIES:
            return None
        form, names = BODIES[kind]
        return kind, session, sequence, dict(zip(names, struct.unpack("<" + form, content[12:-4])))


class Computer:
    """The computer's side of a connection, over `port`: an object with send(bytes) and receive() -> bytes, which does not wait."""

    def __init__(self, port, session=0x1234ABCD):
        self.port, self.session, self.sequence = port, session, 0
        self.receiver, self.samples, self.body = Receiver(), [], b""

    def send(self, kind, body=b"", session=None, sequence=None):
        self.sequence += 1
        number = self.sequence if sequence is None else sequence
        self.port.send(frame(kind, self.session if session is None else session, number, body))

    def poll(self):
        found = list(self.receiver.take(self.port.receive()))
        self.samples += [fields for kind, _, _, fields in found if kind == SAMPLE]
        return found

    def ask(self, kind, body, answer, seconds=10):
        """Sends, again every 50 ms, until a frame of kind `answer` arrives: its fields."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.send(kind, body)
            again = time.monotonic() + 0.05
            while time.monotonic() < again:
                for found_kind, _, _, fields in self.poll():
                    if found_kind == answer:
                        return fields
                self.port.wait(0.01)
        raise AssertionError(f"no frame of kind {answer:#x} within {seconds} s")

    def connect(self, body):
        """Hello and settings; returns the identity and what is held."""
        identity = self.ask(HELLO, b"", IDENTITY)
        self.body = body
        return identity, self.ask(SETTINGS, body, SETTINGS_HELD)

    def sample(self, wanted=lambda _: True, seconds=30, send=lambda: None):
        """The next sample for which `wanted` holds; `send` is called every 5 ms."""
        end = time.monotonic() + seconds
        again = 0
        while (now := time.monotonic()) < end:
            if now >= again:
                send()
                again = now + 0.005
            for kind, _, _, fields in self.poll():
                if kind == SAMPLE and wanted(fields):
                    return fields
            self.port.wait(0.001)
        last = self.samples[-1] if self.samples else None
        raise AssertionError(f"no such sample within {seconds} s; the last one is {last}")

    def arm(self, send=lambda: None):
        """Asks for it, again with each newer sample, until a sample says so."""
        def ask():
            send()
            if self.samples and time.monotonic() > again[0]:
                self.send(ARM, struct.pack("<II", fingerprint(self.body), self.samples[-1]["trips"]))
                again[0] = time.monotonic() + 0.05
        again = [0]
        return self.sample(lambda s: s["state"] == ARMED, send=ask)

    def voltage(self, volts, tick=0):
        self.send(VOLTAGE, struct.pack("<Iqf", fingerprint(self.body), tick, volts))


class Udp:
    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.socket.setblocking(False)

    def send(self, data):
        try:
            self.socket.send(data)
        except (BlockingIOError, ConnectionRefusedError):
            pass

    def receive(self):
        data = b""
        while True:
            try:
                data += self.socket.recv(4096)
            except (BlockingIOError, ConnectionRefusedError):
                return data

    def wait(self, seconds):
        select.select([self.socket], [], [], seconds)

    def close(self):
        self.socket.close()


class Stream:
    """A Unix socket."""

    @classmethod
    def opened(cls, path):
        """None as long as nobody listens: the path is there a moment before its maker listens."""
        try:
            return cls(path)
        except (FileNotFoundError, ConnectionRefusedError):
            return None

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        try:
            self.socket.connect(path)
        except OSError:
            self.socket.close()
            raise
        self.socket.setblocking(False)

    def send(self, data):
        try:
            self.socket.send(data)
        except (BlockingIOError, BrokenPipeError, ConnectionResetError):
            pass

    def receive(self):
        data = b""
        while True:
            try:
                piece = self.socket.recv(4096)
            except (BlockingIOError, ConnectionResetError):
                return data
            if not piece:
                return data
            data += piece

    wait, close = Udp.wait, Udp.close


class Terminal:
    def __init__(self, path):
        self.file = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.file)
        termios.tcflush(self.file, termios.TCIOFLUSH)

    def send(self, data):
        try:
            os.write(self.file, data)
        except BlockingIOError:
            pass

    def receive(self):
        try:
            return os.read(self.file, 65536)
        except BlockingIOError:
            return b""

    def wait(self, seconds):
        select.select([self.file], [], [], seconds)

    def close(self):
        os.close(self.file)


class Machine:
    """A simulator's end of the converter link: inputs that hold, and every output that was written."""

    def __init__(self, port):
        self.port, self.receiver, self.sequence = port, Receiver(), 0
        self.analog, self.counters, self.interlock = [1.0] * 8, [0, 0], 1
        self.outputs, self.held = [], math.nan
        self.answers, self.kick_s, self.heard = True, None, time.monotonic()
        self.give(0)

    def give(self, tick):
        self.sequence += 1
        self.port.send(frame(CONVERTERS, 0, self.sequence, struct.pack("<Q8f2IfB3x", tick, *self.analog, *self.counters, self.held,
                                                                       self.interlock)))

    def poll(self):
        for kind, _, _, fields in self.receiver.take(self.port.receive()):
            if kind == OUTPUT:
                self.outputs.append((fields["tick"], fields["volts"]))
                self.held, self.heard = fields["volts"], time.monotonic()
                if self.answers:
                    self.give(fields["tick"])
        # An emulator may sleep until something arrives, so this sends the same values again, in case it has
        # missed its own clock.
        if self.kick_s and self.outputs and time.monotonic() > self.heard + self.kick_s:
            self.heard = time.monotonic()
            self.give(self.outputs[-1][0])


class Both:
    """The computer's port, beside which a Machine answers."""

    def __init__(self, port, machine):
        self.port, self.machine, self.send = port, machine, port.send

    def receive(self):
        self.machine.poll()
        return self.port.receive()

    def wait(self, seconds):
        self.machine.port.wait(min(seconds, 0.001))
