"""The firmware of front ends as it runs: on the board that is a process, over each kind of link, and on a Cortex-M4 in qemu-system-arm
(skipped, saying so, where that or Debian's gcc-arm-none-eabi is missing). The computer's side is written from docs/front_end.md."""

import os
import shutil
import signal
import struct
import time

import outcome
import stack
from front_end_wire import (ARMED, CONVERTER, FINGERPRINT, HELLO, IDENTITY, IDLE, PRESSURE, READY, SETTINGS, SETTINGS_HELD, TRIPPED, VOLTAGE,
                            WATCHDOG, ZERO, ARM, Both, Computer, Machine, Stream, Terminal, Udp, fingerprint, frame, sensor, settings)

SENSORS = [sensor(1, 0, scale=100), sensor(1, 1, scale=100)]


class BoardTest(stack.TestCase):
    def board(self, *arguments):
        self.process = self.start("hydro-front-end", *arguments)

    def port(self, kind, where):
        """A port of the computer or of the simulator, closed at the end of the test."""
        port = kind(where)
        self.addCleanup(port.close)
        return port

    def udp(self, *arguments, name="link"):
        if name == "link":
            self.board("udp:0", *arguments)
        return self.port(Udp, int(self.process.wait_for(rf"^{name} udp:127.0.0.1:(\d+)$")[1]))


class LinksTest(BoardTest):
    """The board that is a process, in real time."""

    def hello_to_zero(self, port):
        """Connects, arms, drives, falls silent, re-arms, asks for zero; returns the computer."""
        computer = Computer(port)
        body = settings(watchdog=200, sensors=SENSORS)
        identity, held = computer.connect(body)
        self.assertEqual(identity["board"].rstrip(b"\0"), b"posix")
        self.assertEqual((held["refused"], held["settings"], held["fingerprint"]), (0, body, fingerprint(body)))
        computer.arm(send=lambda: computer.voltage(0))
        driven = computer.sample(lambda s: s["voltage"] == 2.5, send=lambda: computer.voltage(2.5, tick=77))
        self.assertEqual((driven["state"], driven["host_tick"], driven["p1"]), (ARMED, 77, 100))
        tripped = computer.sample(lambda s: s["state"] == TRIPPED)
        self.assertEqual((tripped["voltage"], tripped["faults_latched"], tripped["trips"]), (0, WATCHDOG, 1))
        computer.voltage(2.5)
        self.assertEqual(computer.sample()["voltage"], 0)
        computer.arm(send=lambda: computer.voltage(0))
        computer.sample(lambda s: s["voltage"] == -1, send=lambda: computer.voltage(-1))
        computer.send(ZERO)
        self.assertEqual(computer.sample(lambda s: s["state"] == READY)["voltage"], 0)
        return computer

    # Tests the whole way from the hello to zero volts and back over UDP, and that the process ends cleanly.
    def test_udp(self):
        self.hello_to_zero(self.udp())
        self.process.send(signal.SIGTERM)
        self.assertEqual(self.process.wait(), 0)

    # Tests the same over a terminal, whose name is removed at the end.
    def test_terminal(self):
        self.board(f"pty:{self.path('tty')}")
        self.process.wait_for("^link")
        self.hello_to_zero(self.port(Terminal, self.path("tty")))
        self.process.send(signal.SIGINT)
        self.assertEqual(self.process.wait(), 0)
        self.assertFalse(os.path.lexists(self.path("tty")))

    # Tests that a board takes no path that is another board's or the user's, and removes none that is not its own, but one that a
    # killed board has left.
    def test_paths_of_others(self):
        precious, link = self.path("precious"), self.path("link")
        with open(precious, "w", encoding="utf-8") as file:
            file.write("kept")
        os.symlink(precious, link)
        self.run_program("hydro-front-end", f"pty:{link}", expect=2)
        self.assertEqual(os.readlink(link), precious)
        for kind, there in (("pty", "tty"), ("unix", "socket")):
            first = self.start("hydro-front-end", f"{kind}:{self.path(there)}")
            first.wait_for("^link")
            self.run_program("hydro-front-end", f"{kind}:{self.path(there)}", expect=2)
            self.assertTrue(os.path.lexists(self.path(there)))
            first.send(signal.SIGKILL)
            first.wait()
            second = self.start("hydro-front-end", f"{kind}:{self.path(there)}")
            second.wait_for("^link")

    # Tests the same over a Unix socket. A cable that is out for longer than the watchdog trips the device; a
    # cable that is in again gives samples at once, and volts only after a re-arm.
    def test_cable(self):
        self.board(f"unix:{self.path('link')}")
        self.process.wait_for("^link")
        port = Stream(self.path("link"))
        computer = self.hello_to_zero(port)
        computer.arm(send=lambda: computer.voltage(0))
        port.close()
        time.sleep(0.5)
        computer.port = self.port(Stream, self.path("link"))
        self.assertEqual(computer.sample(send=lambda: computer.voltage(3))["state"], TRIPPED)
        for _ in range(20):
            self.assertEqual(computer.sample(send=lambda: computer.voltage(3))["voltage"], 0)
        computer.arm(send=lambda: computer.voltage(3))
        computer.sample(lambda s: s["voltage"] == 3, send=lambda: computer.voltage(3))

    # Tests that a device that is reset while it drives is at zero, ignores what is still sent, and is
    # recognised as rebooted.
    def test_reset(self):
        computer = Computer(self.udp())
        body = settings(watchdog=500, sensors=SENSORS)
        before, _ = computer.connect(body)
        computer.arm(send=lambda: computer.voltage(1))
        self.process.send(signal.SIGUSR1)
        identity = None
        while not identity:
            computer.voltage(1)
            identity = computer.ask(HELLO, b"", IDENTITY)
            identity = identity if identity["boot"] != before["boot"] else None
        self.assertEqual((identity["state"], identity["fingerprint"]), (IDLE, 0))
        self.assertEqual(computer.ask(SETTINGS, body, SETTINGS_HELD)["refused"], 0)
        self.assertEqual(computer.sample(send=lambda: computer.voltage(1))["state"], READY)

    # Tests that a second computer is told which computer is in command, and disturbs nothing.
    def test_second_computer(self):
        port = self.udp()
        computer = Computer(port)
        computer.connect(settings(watchdog=900, sensors=SENSORS))
        computer.arm(send=lambda: computer.voltage(1))
        other = Computer(self.port(Udp, port.socket.getpeername()[1]), session=5)
        identity = other.ask(HELLO, b"", IDENTITY)
        self.assertEqual((identity["session_in_charge"], identity["state"]), (computer.session, ARMED))
        self.assertEqual(computer.sample(lambda s: s["voltage"] == 1, send=lambda: computer.voltage(1))["state"], ARMED)
        self.assertEqual(other.samples, [])

    # Tests that the converters' silence is a fault.
    def test_silent_simulator(self):
        port = self.udp("--converters", "udp:0")
        machine = Machine(self.udp(name="converters"))
        computer = Computer(Both(port, machine))
        computer.connect(settings(watchdog=1000, sensors=SENSORS))
        computer.arm(send=lambda: computer.voltage(1))
        machine.answers = False
        tripped = computer.sample(lambda s: s["state"] == TRIPPED, send=lambda: computer.voltage(1))
        self.assertEqual((tripped["faults_latched"], tripped["voltage"]), (CONVERTER, 0))

    # Tests that each wrong argument is one line and exit code 2.
    def test_bad_arguments(self):
        taken = self.udp().socket.getpeername()[1]
        for arguments, words in (([], "LINK: found nothing"), (["tcp:1"], "udp:PORT"), (["udp:x"], "65535"), (["udp:70000"], "65535"), (["udp:nowhere:1"], "IPv4"),
                                 ([f"udp:{taken}"], "in use"), (["unix:/no/such/folder/x"], "No such file"), (["unix:"], "107"),
                                 (["pty:/no/such/folder/x"], "No such file"), (["pty", "--rate", "0"], "20000"), (["pty", "--rate", "1e3"], "20000"),
                                 (["pty", "--rate"], "--rate: found no number"), (["pty", "pty"], "one LINK"), (["--fast", "pty"], "--fast"),
                                 (["pty", "--tick-by-converters"], "--converters"), (["pty", "--converters", "x"], "pty:PATH")):
            with self.subTest(arguments):
                process = self.run_program("hydro-front-end", *arguments, expect=2)
                self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
                self.assertIn(words, process.stderr)
        for option in "--help", "--version":
            self.assertIn("hydro-front-end", self.run_program("hydro-front-end", option).stdout)


class TickTest(BoardTest):
    """The board that is a process, ticked by the test: what happens in which tick is exact."""

    def setUp(self):
        super().setUp()
        self.board(f"unix:{self.path('link')}", "--converters", f"unix:{self.path('machine')}", "--tick-by-converters")
        self.process.wait_for("^converters")
        self.machine = Machine(self.port(Stream, self.path("machine")))
        self.machine.answers = False
        self.computer = Computer(self.port(Stream, self.path("link")))
        self.wait_until(lambda: self.machine.poll() or self.machine.outputs, "the first tick")

    def tick(self):
        """One tick of the device; the volts that it then holds."""
        before = len(self.machine.outputs)
        self.machine.give(self.machine.outputs[-1][0])
        self.wait_until(lambda: self.machine.poll() or len(self.machine.outputs) > before, "a tick")
        self.computer.poll()
        return self.machine.outputs[-1][1]

    def connect(self, **options):
        self.computer.send(HELLO)
        self.tick()
        self.computer.body = settings(**{"sensors": SENSORS, **options})
        self.computer.send(SETTINGS, self.computer.body)
        self.tick()
        self.wait_until(lambda: self.computer.poll() or self.computer.samples, "a sample")
        self.arm()

    def arm(self):
        trips = self.computer.samples[-1]["trips"]
        self.computer.send(ARM, struct.pack("<II", fingerprint(self.computer.body), trips))

    # Tests that the output is at zero N ticks after the last command, and not one tick earlier, and that a
    # re-arm ends that.
    def test_watchdog(self):
        for n in 1, 3, 50:
            with self.subTest(n):
                self.connect(watchdog=n)
                for _ in range(5):
                    self.computer.voltage(2)
                    self.assertEqual(self.tick(), 2)
                self.assertEqual([self.tick() for _ in range(n + 5)], [2] * (n - 1) + [0] * 6)
                self.wait_until(lambda: self.computer.poll() is not None and self.computer.samples[-1]["state"] == TRIPPED, "the trip")
                self.arm()
                self.computer.voltage(2)
                self.assertEqual(self.tick(), 2)
                self.computer.send(ZERO)
                self.assertEqual(self.tick(), 0)
                for _ in range(3):
                    self.tick()
                self.wait_until(lambda: self.computer.poll() is not None and self.computer.samples[-1]["state"] == READY, "zero")

    # Tests that forged frames, of another session or with another fingerprint, have no effect.
    def test_forged(self):
        self.connect(watchdog=50)
        self.computer.voltage(2)
        self.assertEqual(self.tick(), 2)
        command = struct.pack("<Iqf", fingerprint(self.computer.body), 0, 9)
        self.computer.send(VOLTAGE, command, session=self.computer.session ^ 1)
        self.computer.send(VOLTAGE, command, sequence=1)
        self.computer.port.send(frame(VOLTAGE, self.computer.session, 1000, command)[:-3] + b"\0\0\0")
        self.assertEqual(self.tick(), 2)
        self.computer.send(VOLTAGE, struct.pack("<Iqf", fingerprint(self.computer.body) ^ 1, 0, 9))
        self.assertEqual(self.tick(), 0)
        self.wait_until(lambda: self.computer.poll() is not None and self.computer.samples[-1]["state"] == TRIPPED, "the trip")
        self.assertEqual(self.computer.samples[-1]["faults_latched"], FINGERPRINT)

    # Tests the loop on the device: its voltage follows eq. (16) from one tick to the next, and a change of
    # gains causes no jump.
    def test_loop_on_the_device(self):
        self.connect(mode=2, watchdog=50, transfer=10, sensors=[*SENSORS, sensor(2, 0, 16), sensor(3)])
        for p2, expected in ((1.0, 2.0), (2.0, 1.0), (4.0, -1.0)):
            self.machine.analog[1] = p2
            self.command(200, 0.01)
            self.assertAlmostEqual(self.tick(), expected, 5)
        self.command(200, 0.02)
        self.assertAlmostEqual(self.tick(), -1.0, 5)
        steps = [self.tick() for _ in range(10)]
        for step, volts in enumerate(steps, 1):
            self.assertAlmostEqual(volts, -1.0 - 0.1 * step, 5)

    def command(self, reference, k_p):
        self.computer.send(PRESSURE, struct.pack("<Iqfffff", fingerprint(self.computer.body), 0, reference, k_p, 0, 0, 0))


class QemuTest(BoardTest):
    """The firmware on a Cortex-M4 with FPU; time is that of the instructions, so that a slow test machine makes no tick late."""

    def setUp(self):
        super().setUp()
        image = stack.program("front_end_mps2_an386.elf")
        if not shutil.which("qemu-system-arm"):
            self.skipTest("needs qemu-system-arm (package qemu-system-arm)")
        if not os.path.exists(image):
            self.skipTest("needs front_end_mps2_an386.elf, which is built where arm-none-eabi-gcc is (package gcc-arm-none-eabi)")
        lines = [f"unix:{self.path(name)},server=on,wait=off" for name in ("link", "machine", "monitor")]
        self.start(shutil.which("qemu-system-arm"), "-M", "mps2-an386", "-kernel", image, "-display", "none", "-icount", "shift=3",
                   "-serial", lines[0], "-serial", lines[1], "-monitor", lines[2], label="qemu")
        self.wait_until(lambda: os.path.exists(self.path("monitor")), "qemu")
        self.machine = Machine(self.stream("machine"))
        self.machine.kick_s = 0.5
        self.computer = Computer(Both(self.stream("link"), self.machine))

    def stream(self, name):
        stream = self.wait_until(lambda: Stream.opened(self.path(name)), name)
        self.addCleanup(stream.close)
        return stream

    # Tests that the device boots, says what it is, takes settings, arms and drives, that it is at zero N of
    # its own ticks after the last command, and that a reset leaves it at zero with another boot number.
    def test_boots_drives_and_goes_to_zero(self):
        n = 60
        body = settings(watchdog=n, sensors=SENSORS)
        identity, held = self.computer.connect(body)
        self.assertEqual((identity["board"].rstrip(b"\0"), identity["tick_rate_hz"]), (b"mps2-an386", 100))
        self.assertEqual((held["refused"], held["settings"], held["fingerprint"]), (0, body, fingerprint(body)))
        self.computer.arm(send=lambda: self.computer.voltage(0))
        driven = self.computer.sample(lambda s: s["voltage"] == 2.5, send=lambda: self.computer.voltage(2.5), seconds=30)
        self.assertEqual((driven["p1"], driven["state"]), (100, ARMED))
        begin = len(self.computer.samples)
        tripped = self.computer.sample(lambda s: s["state"] == TRIPPED, seconds=30)
        self.assertEqual((tripped["voltage"], tripped["faults_latched"]), (0, WATCHDOG))
        # There is a sample for every tick, and the last armed one says when its command was taken.
        last = [s for s in self.computer.samples[begin - 1:] if s["state"] == ARMED][-1]
        self.assertEqual(last["voltage"], 2.5)
        self.assertEqual(tripped["tick"] - (last["tick"] - last["command_age"]), n)
        self.wait_until(lambda: self.computer.poll() is not None and self.machine.outputs[-1][1] == 0, "zero at the terminal")

        self.computer.arm(send=lambda: self.computer.voltage(1))
        self.computer.sample(lambda s: s["voltage"] == 1, send=lambda: self.computer.voltage(1), seconds=30)
        self.stream("monitor").send(b"system_reset\n")
        again = None
        while again is None or again["boot"] == identity["boot"]:
            again = self.computer.ask(HELLO, b"", IDENTITY)
        self.assertEqual((again["state"], again["fingerprint"]), (IDLE, 0))
        self.wait_until(lambda: self.computer.poll() is not None and self.machine.outputs[-1][1] == 0, "zero at the terminal")


if __name__ == "__main__":
    outcome.main()
