"""A wire between a driver and a front end that damages frames, can be cut, and knows what either end must count."""

import contextlib
import math
import os
import random
import select
import socket
import threading
import time
import tty

import front_end_wire as wire

CLEAN = {}
NEWER = 0x80000000  # sequences that differ by less, modulo 2^32, are newer


class Direction:
    """What is sent one way, and what of it arrives. `damage`: rates of each bit that flips, of each frame that is lost, doubled or late."""

    def __init__(self, seed, forgets):
        self.random, self.damage = random.Random(seed), CLEAN
        self.forgets = forgets  # a piece of a frame, at the end of a datagram
        self.bits_left, self.late, self.piece = None, None, b""
        self.count = {"frames": 0, "flipped bits": 0, "lost": 0, "doubled": 0, "late": 0, "damaged": 0}

    def set(self, damage):
        self.damage, self.bits_left = damage, None

    def happens(self, what):
        happens = self.random.random() < self.damage.get(what, 0)
        self.count[what] += happens
        return happens

    def flip(self, frame):
        rate = self.damage.get("bit", 0)
        if not rate:
            return frame
        frame = bytearray(frame)
        at = 0
        while True:
            if self.bits_left is None:
                self.bits_left = int(math.log(1 - self.random.random()) / math.log(1 - rate))
            if at + self.bits_left >= 8 * len(frame):
                self.bits_left -= 8 * len(frame) - at
                return bytes(frame)
            at += self.bits_left
            frame[at // 8] ^= 1 << (at % 8)
            self.count["flipped bits"] += 1
            at, self.bits_left = at + 1, None

    def pass_on(self, frame):
        """The frames that arrive instead of this one."""
        self.count["frames"] += 1
        frame = self.flip(frame)
        if self.late is None and self.happens("late"):
            self.late = frame
            return []
        arrive = [] if self.happens("lost") else [frame]
        if self.happens("doubled"):
            arrive.append(frame)
        if self.late is not None:
            arrive.append(self.late)
            self.late = None
        return arrive

    def arrived(self, data):
        """Whole frames in what has arrived; counts those that are none, as docs/front_end.md says."""
        *pieces, self.piece = (self.piece + data).split(b"\0")
        if self.forgets:
            self.piece = b""
        for piece in pieces:
            if piece:
                found = wire.Receiver.read(piece)
                self.count["damaged"] += found is None
                if found:
                    yield found


class Order:
    """The sequences of one sender as a receiver judges them."""

    def __init__(self):
        self.newest, self.lost, self.refused = None, 0, 0

    def take(self, sequence):
        ahead = 1 if self.newest is None else (sequence - self.newest) % 2**32
        if not 0 < ahead < NEWER:
            self.refused += 1
            return False
        self.lost += ahead - 1
        self.newest = sequence
        return True


class UdpEnds:
    forgets = True

    def __init__(self, case, front):
        self.driver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.driver.bind(("127.0.0.1", 0))
        self.device = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.device.connect(("127.0.0.1", front.port))
        for end in self.driver, self.device:
            end.setblocking(False)
            end.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
            case.addCleanup(end.close)
        self.url = "udp://127.0.0.1:%d" % self.driver.getsockname()[1]
        self.peer = None

    def heard(self):
        """The driver has the link open: what is sent to it arrives."""
        return self.peer is not None

    def unplug(self):
        pass

    plug = unplug

    def wait(self):
        select.select([self.driver, self.device], [], [], 0.02)

    def from_driver(self):
        with contextlib.suppress(BlockingIOError, ConnectionRefusedError):
            data, self.peer = self.driver.recvfrom(4096)
            return data
        return b""

    def from_device(self):
        with contextlib.suppress(BlockingIOError, ConnectionRefusedError):
            return self.device.recv(4096)
        return b""

    def to_driver(self, frame):
        if self.peer:
            with contextlib.suppress(BlockingIOError, ConnectionRefusedError):
                self.driver.sendto(frame, self.peer)

    def to_device(self, frame):
        with contextlib.suppress(BlockingIOError, ConnectionRefusedError):
            self.device.send(frame)


class TerminalEnds:
    """A pseudo terminal for the driver; that of the device is opened as the driver would. Pulled, the driver's hangs up and has no name."""

    forgets = False

    def __init__(self, case, front):
        self.name = case.path("wire")
        self.url = "serial:" + self.name
        self.device = wire.Terminal(front.url.removeprefix("serial:"))
        case.addCleanup(self.device.close)
        self.master = None
        self.plug()
        case.addCleanup(self.unplug)

    def plug(self):
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)  # held open here, so that the master stays readable while the driver is not there
        os.set_blocking(self.master, False)
        os.symlink(os.ttyname(self.slave), self.name)
        self.greeted = False

    def heard(self):
        return self.greeted  # before that, a driver throws away what it finds in a port that it opens

    def unplug(self):
        if self.master is not None:
            os.unlink(self.name)
            os.close(self.slave)
            os.close(self.master)
            self.master = None

    def wait(self):
        ends = [self.device.file] if self.master is None else [self.device.file, self.master]
        select.select(ends, [], [], 0.02)

    def from_driver(self):
        data = b""
        with contextlib.suppress(OSError):
            data = os.read(self.master, 65536) if self.master is not None else b""
        self.greeted = self.greeted or data != b""
        return data

    def from_device(self):
        return self.device.receive()

    def to_driver(self, frame):
        if self.master is not None:
            with contextlib.suppress(BlockingIOError):
                os.write(self.master, frame)

    def to_device(self, frame):
        self.device.send(frame)


class DamagedWire:
    """Passes frames on in a thread of its own. `commanded(kind, sequence, fields)` and `sampled(fields)` see each frame of either side as it was
    sent, before any damage."""

    def __init__(self, case, ends, seed, commanded, sampled):
        self.ends, self.commanded, self.sampled = ends, commanded, sampled
        self.towards_device, self.towards_driver = Direction(seed, ends.forgets), Direction(seed + 1, False)
        self.cut, self.done, self.ended = False, False, False
        self.order, self.device_order, self.boot = Order(), Order(), None
        self.parts = {"driver": b"", "device": b""}
        self.stalls, self.error = [], None  # when this thread woke up late: (time, seconds)
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()
        case.addCleanup(self.end)

    def end(self):
        self.ended = True
        self.thread.join(5)

    def set(self, **damage):
        self.towards_device.set(damage)
        self.towards_driver.set(damage)

    def unplug(self):
        self.cut = True

    def plug(self):
        self.cut = False

    def run(self):
        with contextlib.suppress(PermissionError):  # a wire is never late because other programs run
            os.sched_setscheduler(threading.get_native_id(), os.SCHED_FIFO, os.sched_param(10))
        out, looked = False, time.monotonic()
        try:
            while not self.ended:
                if self.cut != out:
                    self.ends.unplug() if self.cut else self.ends.plug()
                    out = self.cut
                self.ends.wait()
                self.turn(out)
                now = time.monotonic()
                if now - looked > 0.1:
                    self.stalls.append((now, now - looked))
                looked = now
        except Exception as error:  # told by the test, which would otherwise wait in vain
            self.error = error
            raise

    def turn(self, out):
        while data := self.ends.from_driver():
            for frame in self.whole("driver", data):
                kind, _, sequence, fields = wire.Receiver.read(frame[1:-1])
                self.commanded(kind, sequence, fields)
                for arrives in self.towards_device.pass_on(frame) if not out else []:
                    self.ends.to_device(arrives)
                    for found in self.towards_device.arrived(arrives):
                        self.device_order.take(found[2])
        while data := self.ends.from_device():
            for frame in self.whole("device", data):
                kind, _, _, fields = wire.Receiver.read(frame[1:-1])
                if kind == wire.SAMPLE:
                    self.sampled(fields)
                for arrives in self.towards_driver.pass_on(frame) if not out and self.ends.heard() else []:
                    self.ends.to_driver(arrives)
                    for found in self.towards_driver.arrived(arrives):
                        self.judge(*found)

    def whole(self, side, data):
        """The frames in what one side has sent, each with its two zeros."""
        *pieces, self.parts[side] = (self.parts[side] + data).split(b"\0")
        return [b"\0" + piece + b"\0" for piece in pieces if piece]

    def judge(self, kind, session, sequence, fields):
        """As a driver must: a device that has reset itself counts from the beginning."""
        if kind == wire.IDENTITY and fields["boot"] != self.boot:
            self.boot, self.order.newest = fields["boot"], None
        if kind in (wire.IDENTITY, wire.SETTINGS_HELD, wire.SAMPLE):
            self.order.take(sequence)
