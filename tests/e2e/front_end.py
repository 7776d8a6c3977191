"""A front end as tests have it: the firmware as a process, the machine behind its converters, and a relay that sees every frame.

HYDRO_TEST_TOOLS names the folder where the build has put simulated_converters.
"""

import contextlib
import os
import re
import select
import shutil
import signal
import socket
import threading
import time

import front_end_wire as wire
import stack

_TOOLS = os.environ.get("HYDRO_TEST_TOOLS", os.path.join(os.path.dirname(stack.BIN), "tests"))
CONVERTERS = os.path.join(_TOOLS, "simulated_converters")
EMULATED_RATE = 100  # ticks a second of the image for QEMU (firmware/CMakeLists.txt)
MODEL = os.path.join(stack.CONFIG, "models", "table1.toml")


class FrontEnd:
    """A board of its own for one test, with the actuator that moves behind it. `link`: pty, unix or udp."""

    def __init__(self, case, link="udp", rate=1000, model=MODEL):
        self.case, self.link, self.rate = case, link, rate
        self.address = {"pty": "pty:" + case.path("front_end"), "unix": "unix:" + case.path("front_end"), "udp": "udp:0"}[link]
        self.start()
        self.machine = case.start(CONVERTERS, "unix:" + self.converters, model, rate)
        self.machine.wait_for("^ready")
        # Real hardware is never late because other tests run, so these get priority. Where that is not
        # allowed, they may be late.
        threads = [int(thread) for process in (self.board, self.machine) for thread in os.listdir(f"/proc/{process.pid}/task")]
        with contextlib.suppress(PermissionError, ProcessLookupError):
            for thread in threads:
                os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(10))

    def start(self):
        self.converters = self.case.path("converters-" + self.link)
        self.board = self.case.start("hydro-front-end", self.address, "--converters", "unix:" + self.converters, "--rate", self.rate)
        found = self.board.wait_for("^link (.*)").group(1)
        if self.link == "udp":
            self.port = int(found.rsplit(":", 1)[1])
            self.address = f"udp:{self.port}"  # where it is found again after a restart
            self.url = f"udp://127.0.0.1:{self.port}"
        else:
            self.url = ("serial:" if self.link == "pty" else "unix:") + self.case.path("front_end")

    def reset(self):
        self.board.send(signal.SIGUSR1)

    def relay(self):
        return Relay(self.case, self.port)

    def shown(self):
        """The machine's own words, once a second: tick, volts, p1, p2, motor speed, arm angle."""
        lines = re.findall(r"^\d+ \S+ \S+ \S+ \S+ \S+$", self.machine.stdout, re.MULTILINE)
        return [[float(word) for word in line.split()] for line in lines]

    def wait_until_arrived(self, arm, delta, seconds):
        """Until the arm has been there for two seconds."""
        try:
            wait(lambda: len(near := [line[5] for line in self.shown()[-3:] if abs(line[5] - arm) < delta]) == 3 and near,
                 f"an arm at {arm} rad", seconds, period=0.2)
        except AssertionError:
            self.skip_if_ticks_are_missed()
            raise

    def skip_if_ticks_are_missed(self):
        """Skips the test where this computer is so busy that the board, which is a process here, misses its ticks: of loops that hear of the
        machine that late nothing is promised, and the driver calls such a clock a fault."""
        lines = self.shown()
        made = (lines[-1][0] - lines[0][0]) / max(len(lines) - 1, 1)
        if made < 0.9 * self.rate:
            self.case.skipTest(f"this computer is too busy: the board made {made:.0f} of {self.rate} ticks a second")

    def changes(self):
        """(what, tick) of each tick in which the voltage became zero, or ceased to be."""
        return [(what, int(tick)) for what, tick in re.findall(r"^(zero|drives) (\d+)$", self.machine.stdout, re.MULTILINE)]

    def drives(self):
        changes = self.changes()
        return bool(changes) and changes[-1][0] == "drives"

    def wait_until_driven(self):
        self.case.wait_until(self.drives, "a voltage")

    def wait_until_zero(self):
        self.case.wait_until(lambda: not self.drives(), "zero volts")


class EmulatedFrontEnd(FrontEnd):
    """The firmware on a Cortex-M4 in qemu-system-arm. Skips the test where the emulator or the image is not there."""

    def __init__(self, case, model):
        self.image = stack.program("front_end_mps2_an386.elf")
        if not shutil.which("qemu-system-arm"):
            case.skipTest("needs qemu-system-arm (package qemu-system-arm)")
        if not os.path.exists(self.image):
            case.skipTest("needs front_end_mps2_an386.elf, which is built where arm-none-eabi-gcc is (package gcc-arm-none-eabi)")
        super().__init__(case, "unix", EMULATED_RATE, model)

    def start(self):
        self.converters = self.case.path("converters")
        self.url = "unix:" + self.case.path("front_end")
        lines = [argument for name in ("front_end", "converters")
                 for argument in ("-serial", f"unix:{self.case.path(name)},server=on,wait=off")]
        lines += ["-monitor", f"unix:{self.case.path('monitor')},server=on,wait=off"]
        self.board = self.case.start(shutil.which("qemu-system-arm"), "-M", "mps2-an386", "-kernel", self.image, "-display", "none",
                                     "-icount", "shift=3", *lines, label="qemu")
        self.case.wait_until(lambda: os.path.exists(self.converters) and os.path.exists(self.case.path("monitor")), "qemu")

    def reset(self):
        monitor = wire.Stream(self.case.path("monitor"))
        self.case.addCleanup(monitor.close)
        monitor.send(b"system_reset\n")

    def relay(self):
        return StreamRelay(self.case, self.url.removeprefix("unix:"))


class Relay:
    """Between a driver and a device, both on UDP: passes frames on, keeps those of the device, and can do worse."""

    def __init__(self, case, device_port):
        self.driver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.driver.bind(("127.0.0.1", 0))
        self.device = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.device.connect(("127.0.0.1", device_port))
        self.begin(case, "udp://127.0.0.1:%d" % self.driver.getsockname()[1])

    def begin(self, case, url):
        self.url = url
        self.peer = None
        self.cut = False
        self.lie = None  # changes the fields of each sample on its way to the driver
        self.kept = []
        self.newest_command = b""
        self.ended = False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()
        case.addCleanup(self.end)

    def end(self):
        self.ended = True
        self.thread.join(5)
        self.driver.close()
        self.device.close()

    def run(self):
        while not self.ended:
            for ready in select.select([self.driver, self.device], [], [], 0.05)[0]:
                try:
                    self.pass_on(ready)
                except ConnectionRefusedError:
                    pass  # nobody is there at the moment

    def pass_on(self, ready):
        if ready is self.driver:
            data, self.peer = self.driver.recvfrom(4096)
            if not self.cut:
                self.newest_command = data
                self.device.send(data)
            return
        data = self.device.recv(4096)
        self.kept.append(data)
        if self.peer and not self.cut:
            lie = self.lie  # the test may end it meanwhile
            self.driver.sendto(self.lied(data, lie) if lie else data, self.peer)

    @staticmethod
    def lied(data, lie):
        told = b""
        for kind, session, sequence, fields in wire.Receiver().take(data):
            if kind == wire.SAMPLE:
                lie(fields)
            told += wire.encode(kind, session, sequence, fields)
        return told

    def to_driver(self, data):
        self.driver.sendto(data, self.peer)

    def frames(self):
        """(kind, session, sequence, fields) of what the device has sent so far."""
        receiver = wire.Receiver()
        return [frame for data in list(self.kept) for frame in receiver.take(data)]

    def samples(self):
        return [fields for kind, _, _, fields in self.frames() if kind == wire.SAMPLE]

    def newest(self):
        """The newest sample, and the session; None before there is one."""
        for data in reversed(self.kept[-50:]):
            for kind, session, sequence, fields in wire.Receiver().take(data):
                if kind == wire.SAMPLE:
                    return session, sequence, fields
        return None

    def command(self):
        """The newest command of the driver: (kind, session, sequence, fields)."""
        return next(iter(wire.Receiver().take(self.newest_command)), None)


class StreamRelay(Relay):
    """The same between two Unix sockets, whole frame by whole frame: an emulator's serial line passes single bytes."""

    def __init__(self, case, device_path):
        self.path = case.path("relay")
        self.listener = socket.socket(socket.AF_UNIX)
        self.listener.bind(self.path)
        self.listener.listen(1)
        self.device = socket.socket(socket.AF_UNIX)
        self.device.connect(device_path)
        self.driver = self.listener  # until somebody has connected
        self.parts = {}
        case.addCleanup(self.listener.close)
        self.begin(case, "unix:" + self.path)

    def pass_on(self, ready):
        if ready is self.listener:
            self.driver, _ = self.listener.accept()
            self.peer = self.driver
            return
        data = b""
        with contextlib.suppress(ConnectionResetError):  # of a driver that was killed
            data = ready.recv(4096)
        if not data and ready is self.driver:
            self.driver.close()
            self.driver, self.peer = self.listener, None
        *pieces, self.parts[ready] = (self.parts.get(ready, b"") + data).split(b"\0")
        for frame in (b"\0" + piece + b"\0" for piece in pieces if piece):
            if ready is self.device:
                self.kept.append(frame)
            elif not self.cut:
                self.newest_command = frame
            if not self.cut:
                self.device.sendall(frame) if ready is not self.device else self.peer and self.to_driver(frame)

    def to_driver(self, data):
        with contextlib.suppress(BrokenPipeError, ConnectionResetError):
            self.peer.sendall(data)


def age_at_trip(samples):
    """In ticks of the device, from the newest command that it took to its trip: of the last trip in these samples."""
    trip = max(i for i in range(1, len(samples)) if samples[i - 1]["state"] == wire.ARMED and samples[i]["state"] != wire.ARMED)
    before, after = samples[trip - 1], samples[trip]
    return before["command_age"] + after["tick"] - before["tick"], after


def wait(condition, what, seconds=stack.PATIENCE, period=0.002):
    end = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s in vain: {what}")
        time.sleep(period)
    return value
