"""A driver of one's own: the examples of examples/own_driver with their simulated devices, and what hydro-driver-check finds."""

import fcntl
import json
import os
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys

import board
import event_log
import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLES = os.path.join(os.environ.get("HYDRO_EXAMPLES", os.path.join(ROOT, "examples")), "own_driver")
TOOLS = os.environ.get("HYDRO_TEST_TOOLS", os.path.join(os.path.dirname(stack.BIN), "tests"))  # where the examples are built

# A box that does not hear what a guardian sends, whose datagrams have the sequence number 0.
DEAF = """
import socket, struct, subprocess, sys, threading
device = subprocess.Popen(sys.argv[3:], stdin=sys.stdin)
box = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
box.connect(("127.0.0.1", int(sys.argv[2])))
here = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
here.bind(("127.0.0.1", int(sys.argv[1])))
driver = []
def back():
    while True:
        try:
            here.sendto(box.recv(1000), driver[-1])
        except ConnectionRefusedError:
            pass
started = False
while True:
    datagram, address = here.recvfrom(1000)
    if not driver:
        threading.Thread(target=back, daemon=True).start()
    driver.append(address)
    sequence = struct.unpack("<I", datagram[4:8])[0]
    started = started or sequence > 0
    if sequence > 0 or not started:
        box.send(datagram)
"""


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


class Device:
    """A simulated device that a test starts itself, and so can ask when its driver has gone."""

    def __init__(self, case, *argv):
        self.child = subprocess.Popen(argv, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        case.addCleanup(self.end)
        case.assertEqual(self.child.stdout.readline(), "ready\n")

    def end(self):
        self.child.kill()
        self.child.communicate()

    def ask(self, word):
        self.child.stdin.write(word + "\n")
        return self.child.stdout.readline().strip()

    def output(self):
        return float(self.ask("output").split()[1])


class OwnDriverCase(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.port = free_port()

    def config(self, example="udp_box", *changes, name=None):
        """An example's configuration here, with its programs as they are built."""
        with open(os.path.join(EXAMPLES, example, example + ".toml"), encoding="utf-8") as file:
            text = file.read()
        built = {f"build/{example}": os.path.join(TOOLS, example), "build/simulated_device": os.path.join(TOOLS, example + "_device"),
                 "../../../config": stack.CONFIG, "5005": str(self.port), "build/can.sock": "can.sock", "build/board": "board"}
        for old, new in (*built.items(), *changes):
            self.assertIn(old, text) if (old, new) in changes else None
            text = text.replace(old, new)
        # Real-time priorities where allowed, because the test machine may be busy with other work. The device
        # inherits its driver's priority.
        text = re.sub(r'(?m)^((role = "driver")|(program = "hydro-p.*"))$', r"\1\npriority = 10", text)
        path = self.path((name or example) + ".toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def device(self):
        return Device(self, os.path.join(TOOLS, "udp_box_device"), str(self.port), os.path.join(stack.CONFIG, "models", "table1.toml"))

    def check(self, *arguments, expect=0):
        return self.run_program("hydro-driver-check", *arguments, expect=expect, timeout=150)

    def arrives(self, example):
        """hydro-launch runs the example with its simulated device: the arm ends at its target, and the log shows the driver's run."""
        log_file = self.path(example + ".lcmlog")
        launch = self.launch(self.config(example), "--set", "limits.stale_input_s=0.3", "--log", log_file)
        code = launch.wait(60)
        skipped = re.search(r"\d+ of \d+ ticks \(.*\) were skipped", launch.stderr)
        if skipped and code != 0 and re.search("device_silent|motor_speed_limit", launch.stderr):
            # A terminal's bytes wait for the kernel, whatever the priority of who reads them; a voltage that is held for that long
            # turns the motor too fast.
            self.skipTest(f"this computer is too busy for a device: {skipped[0]}")
        self.assertEqual(code, 0, launch.report())
        self.assertRegex(launch.stderr + launch.stdout, "stands for the device.*nothing real moves")
        log = event_log.Log(log_file)
        self.run_program("hydro-log", "summary", log_file, "--json", self.path("summary.json"), "--force")
        with open(self.path("summary.json"), encoding="utf-8") as file:
            tracking = json.load(file)["tracking"]
        if skipped and not tracking["at_target"]:
            self.skipTest(f"this computer is too busy for a loop: {skipped[0]}")
        self.assertTrue(tracking["at_target"], tracking)
        self.assertEqual(log.descriptions[0].program, example)
        self.assertEqual([(s.source, s.exit_code) for s in log.stops], [("driver", 0)])
        self.assertEqual([f.text for f in log.faults if f.code.startswith(("sensor", "device", "output"))], [])
        (left,) = log.outputs_left
        self.assertEqual((left.role, bool(left.accepted)), ("driver", True))
        self.assertLess(abs(left.voltage), 0.01)
        self.assertIn("driver", {s.role for s in log.statistics})
        self.assertIn('role = "driver"', log.descriptions[0].config_text)

    def keeps_its_promises(self, example):
        table = self.check(self.config(example)).stdout
        self.assertRegex(table, r"(?m)^18 kept, 0 broken, 0 not tried$")
        self.assertRegex(table, r"(?m)^device silent .* kept .*device_silent")
        self.assertRegex(table, r"(?m)^device gives NaN .* kept .*sensor_p1")
        self.assertRegex(table, r"(?m)^read-back lies .* kept .*output_differs")


class OwnDriverTest(OwnDriverCase):
    # Tests that hydro-launch runs each example with its simulated device. The arm ends at its target, as hydro-log summary judges it, through
    # scales, inputs and outputs of the example, and the log shows the driver's run. (own_driver_terminal_test.py runs serial_board.)
    def test_arm_reaches_its_target(self):
        for example in ("udp_box", "cia402"):
            with self.subTest(example):
                self.arrives(example)

    # Tests that each of them, and hydro-driver on the simulated board, keeps what docs/safety.md promises.
    def test_promises(self):
        for example in ("udp_box", "cia402"):
            with self.subTest(example):
                self.keeps_its_promises(example)

    def test_promises_of_ours(self):
        os.environ["LD_PRELOAD"] = board.LIBRARY
        self.addCleanup(os.environ.pop, "LD_PRELOAD")
        file = self.path("board")
        device = [board.ACTUATOR, file, os.path.join(stack.CONFIG, "models", "table1.toml")]
        table = self.check(stack.config("driver.toml"), "--set", f"driver.device={file}", "--set", f"driver.simulated_device={device}",
                           "--set", "limits.stale_input_s=0.3").stdout
        self.assertRegex(table, r"(?m)^18 kept, 0 broken, 0 not tried$")
        self.assertRegex(table, r"(?m)^device silent .* kept .*board_error, exit code 1")
        self.assertRegex(table, r"(?m)^read-back lies .* kept .*said at the end: ")

    # Tests that a broken promise is found: the device does not hear the zero of a guardian.
    def test_broken_promise(self):
        with open(self.path("deaf.py"), "w", encoding="utf-8") as file:
            file.write(DEAF)
        behind = free_port()
        device = [sys.executable, "deaf.py", str(self.port), str(behind), os.path.join(TOOLS, "udp_box_device"), str(behind),
                  os.path.join(stack.CONFIG, "models", "table1.toml")]
        config = self.config("udp_box")
        table = self.check(config, "--set", f"driver.simulated_device={device}", "--only", "SIGKILL", "--only", "dead loops", expect=1).stdout
        self.assertRegex(table, r"(?m)^SIGKILL .* BROKEN +the machine has -?\d")
        self.assertRegex(table, r"(?m)^dead loops .* kept ")
        self.assertRegex(table, r"(?m)^1 kept, 1 broken, 0 not tried$")

    # Tests a driver that is killed under hydro-launch, which then kills everything that is left of its group.
    # Its guardian still leaves zero volts, before the box's own watchdog does, and the launch names the
    # driver and ends with 1.
    def test_killed_under_hydro_launch(self):
        device = self.device()
        launch = self.launch(self.config(), "--duration", "0", "--set", "driver.simulated_device=[]",
                             "--set", 'reference={ signal = "arm_angle", kind = "sine", amplitude = 0.2, frequency_hz = 1.0 }',
                             "--log", self.path("run.lcmlog"))
        self.wait_until(lambda: abs(device.output()) > 0.3, "a voltage")
        log = stack.LiveLog(self, self.path("run.lcmlog"))
        pid = log.wait_for("HYDRO_PROCESS_STATUS", lambda s: s.role == "driver", "the driver").pid
        os.kill(pid, signal.SIGKILL)
        self.assertEqual(launch.wait(30), 1, launch.report())
        self.assertRegex(launch.stderr, r"udp_box \(driver\) was killed by signal 9")
        self.assertRegex(launch.stderr, "make sure that the output is at zero")
        self.wait_until(lambda: device.output() == 0, "zero volts")

    # Tests that a driver of the user's own notices a launcher that hangs, as ours does: zero volts.
    def test_launcher_hangs(self):
        device = self.device()
        launch = self.launch(self.config(), "--duration", "0", "--set", "driver.simulated_device=[]", "--set", 'limits.rearm="restart"',
                             "--set", 'reference={ signal = "arm_angle", kind = "sine", amplitude = 0.2, frequency_hz = 1.0 }',
                             "--log", self.path("run.lcmlog"))
        self.wait_until(lambda: abs(device.output()) > 0.3, "a voltage")
        log = stack.LiveLog(self, self.path("run.lcmlog"))
        launch.send(signal.SIGSTOP)
        log.wait_for("HYDRO_FAULT", lambda f: f.code == "supervisor_gone" and f.active, "supervisor_gone")
        self.wait_until(lambda: device.output() == 0, "zero volts")
        launch.send(signal.SIGCONT)
        self.wait_until(lambda: abs(device.output()) > 0.3, "a voltage again")
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(30), 0, launch.report())

    # Tests --check-sensors of a driver of the user's own, started by hand.
    def test_check_sensors(self):
        config = self.config()
        good = subprocess.run([os.path.join(TOOLS, "udp_box"), config, "--check-sensors", "--duration", "0.3"], capture_output=True,
                              text=True, timeout=30, check=False)
        self.assertEqual(good.returncode, 0, good.stderr)
        self.assertRegex(good.stdout, r"p1 +analog ai0 +0[.]7000 V +100 psi\n")
        self.assertRegex(good.stdout, r"motor_angle +counter encoder +0 +0 rad\n")
        self.assertRegex(good.stdout, r"arm_speed +rate of the angle")


class OwnDriverInputTest(OwnDriverCase):
    def refused(self, *changes, example="udp_box", program="hydro-launch", more=()):
        process = self.run_program(program, self.config(example, *changes), "--set", f"bus.url={self.url}", *more, expect=2)
        self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
        return process.stderr

    # Tests what the configuration may not say about a driver. Each case is refused in one line, before any
    # process is started.
    def test_configuration(self):
        cases = [
            ((('kind = "own"', 'kind = "comedi"'),), 'driver: "own": found an unknown key'),
            ((('kind = "own"\n', ""),), 'driver: "own": found an unknown key'),
            ((('device = "udp', '# "'),), "driver.device: "),
            ((('role = "driver"', 'role = "plant"'),), r'process.role: found "plant", allowed "position_ctrl", "pressure_ctrl" or "driver"; '
             "the plant is always hydro-plant; a machine of your own is a driver"),
            ((('input = "ai0"', 'input = 0'),), "driver.p1.input: found 0, allowed"),
            ((('minimum = 0.4', 'minimum_V = 0.4'),), 'driver.p1: "minimum_V": found an unknown key'),
            ((('minimum = 0.4', 'minimum = 5'),), "driver.p1.minimum: found 5, allowed below maximum = 4.6"),
            ((('simulated_device = ["', 'simulated_device = [5, "'),), "driver.simulated_device: found 5 in it, allowed the program"),
            ((('[driver.own]', 'own = 3\n[driver.owned]'),), "driver.own"),
        ]
        for changes, says in cases:
            self.assertRegex(self.refused(*changes), says)
        self.assertRegex(self.refused(more=("--time", "lockstep")), r'time.mode: found "lockstep", allowed "realtime" with \S*udp_box \(driver\)')
        two = ('[[process]]\nprogram = "hydro-pressure-ctrl"', '[[process]]\nprogram = "hydro-plant"\n[[process]]\nprogram = "hydro-pressure-ctrl"')
        self.assertRegex(self.refused(two), r"udp_box \(driver\)")

    # Tests that hydro-driver refuses a configuration for a driver of the user's own, and says what to write.
    def test_hydro_driver_refuses(self):
        self.assertRegex(self.refused(program="hydro-driver"), r'driver.kind: found "own", allowed "comedi".* with hydro-driver; a driver of your own '
                         r'is started by \[\[process\]\] with command = \[\.\.\.\] and role = "driver"')

    # Tests errors that only the driver can detect: exit code 2 and one line, which names the input, the
    # driver's own key, or the device's address.
    def test_driver(self):
        for changes, says in (
                ((('input = "ai3"', 'input = "ai9"'),), r'driver.arm_angle.input: found "ai9", allowed "ai0", "ai1", "ai2" or "ai3", which udp://\S+ has'),
                ((('input = "encoder"', 'input = "ai1"'),), 'driver.motor_angle.input: found "ai1", allowed "encoder"'),
                ((('answer_ms = 1000', 'answer_ms = 0'),), "driver.own.answer_ms: found 0, allowed"),
                ((('answer_ms = 1000', 'anser_ms = 1000'),), 'driver.own: "anser_ms": found an unknown key, allowed "answer_ms"'),
                ((('device = "udp://127.0.0.1:', 'device = "udp:/127.0.0.1:'),), "driver.device: found .*allowed udp://HOST:PORT"),
                *(((("device = \"udp://127.0.0.1:%d" % self.port, f'device = "udp://127.0.0.1:{port}'),),
                   rf'driver.device: found "udp://127.0.0.1:{re.escape(port)}", allowed udp://HOST:PORT.*, with PORT from 1 to 65535$')
                  for port in ("70000", "0", "-1", "65536", "x", "", "5005x", "99999999999"))):
            process = subprocess.run([os.path.join(TOOLS, "udp_box"), self.config("udp_box", *changes), "--set", f"bus.url={self.url}"],
                                     capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(process.returncode, 2, process.stderr)
            self.assertRegex(process.stderr.splitlines()[-1], says)
        env = {name: value for name, value in os.environ.items() if name != "HYDRO_CONFIG"}  # these tests' own folder has that name
        nobody = subprocess.run([os.path.join(TOOLS, "udp_box")], capture_output=True, text=True, timeout=30, check=False, env=env)
        self.assertEqual((nobody.returncode, nobody.stderr.count("\n")), (2, 1), nobody.stderr)
        self.assertIn("found no CONFIG", nobody.stderr)

    # Tests the same for a board on a serial port: a rate that does not exist, and names that are not ports,
    # are missing or belong to another program.
    def test_serial_board(self):
        taken, end = os.openpty()
        self.addCleanup(os.close, taken)
        self.addCleanup(os.close, end)
        fcntl.flock(end, fcntl.LOCK_EX)
        for changes, says in (
                ((("baud = 2000000", "baud = 123456"),), "driver.own.baud: found 123456, allowed 115200, 230400, "),
                ((("baud = 2000000", "# baud"),), "driver.own.baud: found nothing, allowed bits per second, as the sketch has them"),
                ((('device = "board"', 'device = "/dev/ttyNone0"'),), r'driver.device: found "/dev/ttyNone0" \(No such file or directory\), allowed a serial port: is'),
                ((('device = "board"', 'device = "/dev/null"'),), r'driver.device: found "/dev/null" \(Inappropriate ioctl for device\), allowed a serial port$'),
                ((('device = "board"', f'device = "{os.ttyname(end)}"'),), r"driver.device: .* allowed a port that no other program has open: fuser -v names it")):
            process = subprocess.run([os.path.join(TOOLS, "serial_board"), self.config("serial_board", *changes), "--set", f"bus.url={self.url}",
                                      "--set", "driver.simulated_device=[]"], capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual((process.returncode, process.stderr.count("\n")), (2, 1), process.stderr)
            self.assertRegex(process.stderr.strip(), says)

    # Tests that a device that does not answer ends the program with 1 and its address.
    def test_nobody_answers(self):
        config = self.config("udp_box", ("answer_ms = 1000", "answer_ms = 50"))
        process = subprocess.run([os.path.join(TOOLS, "udp_box"), config, "--set", f"bus.url={self.url}", "--set", "driver.simulated_device=[]"],
                                 capture_output=True, text=True, timeout=30, check=False)
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertRegex(process.stderr, rf"udp://127.0.0.1:{self.port} has not answered within 50 ms")

    # Tests what hydro-driver-check refuses.
    def test_check(self):
        config = self.config()
        for arguments, says in (
                ((config, "--only", "SIGFOO"), '--only: found "SIGFOO", allowed "start", '),
                ((config, "--set", "driver.simulated_device=[]"), "driver.simulated_device: found nothing, allowed a program"),
                ((config, "--set", 'driver.simulated_device=["./nothing"]'), "driver.simulated_device: found \"./nothing\", and there is no program"),
                ((stack.config("demo.toml"),), "process: found no driver")):
            process = self.check(*arguments, expect=2)
            self.assertEqual(process.stdout, "", "no table of nothing")
            self.assertEqual(process.stderr.count("\n"), 1, process.stderr)
            self.assertIn(says, process.stderr)

    # Tests limits of files, memory and processes: what is said names the limit, or has what the driver itself said of it.
    def test_limits(self):
        config = self.config()
        limits = [(resource.RLIMIT_NOFILE, count) for count in (5, 6, 8, 9, 10, 11, 12)]
        limits += [(resource.RLIMIT_AS, size << 20) for size in (36, 48)]
        limits += [(resource.RLIMIT_NPROC, 1)] if os.geteuid() else []
        met = set()
        for which, limit in limits:
            with self.subTest(which=which, limit=limit):
                done = subprocess.run([stack.program("hydro-driver-check"), config, "--only", "start"], capture_output=True, text=True, timeout=60,
                                      check=False, preexec_fn=lambda which=which, limit=limit: resource.setrlimit(which, (limit, limit)))
                said = done.stderr + done.stdout
                if done.returncode == 0 or "error while loading shared libraries" in said:
                    continue
                met.add(which)
                self.assertIn(done.returncode, (1, 2))
                self.assertRegex(said, "`?ulimit -[nuv]")
        self.assertIn(resource.RLIMIT_NOFILE, met)

    # Tests that what a simulated device says is neither kept nor waited for without an end, by the check and by the driver.
    def test_device_that_talks(self):
        config = self.config()
        for says, instead in (("'x' * 10_000_000", "says a line of more than 4096 bytes"), ("'not ready'", "ended before")):
            device = ["--set", f"driver.simulated_device={[sys.executable, '-c', f'print({says})']}"]
            check = self.check(config, *device, expect=2)
            self.assertEqual(check.stderr.count("\n"), 1, check.stderr)
            self.assertRegex(check.stderr, rf'driver.simulated_device: found \S+, which {instead}, allowed a program that says "ready" within 10 s')
            driver = subprocess.run([os.path.join(TOOLS, "udp_box"), config, "--set", f"bus.url={self.url}", *device], capture_output=True,
                                    text=True, timeout=30, check=False)
            self.assertEqual(driver.returncode, 2, driver.stderr)
            self.assertRegex(driver.stderr, rf'driver.simulated_device: found \S+, which {instead}, allowed a program that says "ready" within 5 s: start it')

    # Tests what new-driver writes, that it overwrites nothing, and bad names.
    def test_new_driver(self):
        made = self.run_program("hydro-launch", "new-driver", "mine")
        self.assertIn("wrote mine/: mine.cc", made.stdout)
        self.assertRegex(made.stdout, "(?m)^  cmake -S mine -B mine/build( -D(hydro_DIR|CMAKE_PREFIX_PATH)=/.*)? && cmake --build mine/build$")
        self.assertEqual(sorted(os.listdir(self.path("mine"))),
                         ["CMakeLists.txt", "frames.h", "mine.cc", "mine.toml", "simulated_device.cc"])
        with open(self.path("mine/mine.toml"), encoding="utf-8") as file:
            text = file.read()
        self.assertNotIn("udp_box", text)
        self.assertIn('command = ["build/mine"]', text)
        again = self.run_program("hydro-launch", "--new-driver", "mine", expect=2)
        self.assertRegex(again.stderr, "mine: is there already and is not overwritten")
        for name in ("a/b", "1st", "", "simulated_device"):
            self.assertRegex(self.run_program("hydro-launch", "--new-driver", name, expect=2).stderr, "--new-driver.*allowed|new-driver")
        self.assertFalse(os.path.exists(self.path("simulated_device")))
        self.assertIn("found no NAME, allowed letters", self.run_program("hydro-launch", "new-driver", "", expect=2).stderr)
        self.assertIn("allowed a name of at most 64 letters", self.run_program("hydro-launch", "new-driver", "n" * 65, expect=2).stderr)
        self.assertIn("new-driver NAME", self.run_program("hydro-launch", "new-driver", "--help").stdout)
        # CMake has a target or a file of these names; and each name that is missing is asked for, with an example.
        for name in ("test", "all", "install", "clean", "package", "help", "edit_cache", "rebuild_cache", "depend", "Makefile", "CMakeFiles"):
            self.assertEqual(self.run_program("hydro-launch", "new-driver", name, expect=2).stderr,
                             f'hydro-launch: --new-driver: found "{name}", allowed another name, e.g. my_{name}: CMake has a target or file of this name\n')
            self.assertFalse(os.path.exists(self.path(name)))
        for arguments in (("new-driver",), ("new-driver", "--quiet"), ("--new-driver",), ("new-controller",)):
            self.assertEqual(self.run_program("hydro-launch", *arguments, expect=2).stderr,
                             "hydro-launch: VERB: found no NAME, allowed letters, digits and underscores, e.g. hydro-launch VERB crane\n".replace(
                                 "VERB", arguments[0].removeprefix("--")))
        for name in ("hydro", "hydro_bus", "socket", "signal"):
            self.assertRegex(self.run_program("hydro-launch", "new-controller", name, expect=2).stderr,
                             f'new-controller: found "{name}", allowed another name, e.g. my_{name}: the controller imports a Python module')
        # It also runs where it is built, because the configuration names the place where CMake puts it.
        os.mkdir(self.path("mine/build"))
        shutil.copy(os.path.join(TOOLS, "udp_box"), self.path("mine/build/mine"))
        shutil.copy(os.path.join(TOOLS, "udp_box_device"), self.path("mine/build/simulated_device"))
        with open(self.path("mine/mine.toml"), "w", encoding="utf-8") as file:
            file.write(text.replace("5005", str(self.port)))
        launch = self.launch(self.path("mine/mine.toml"), "--duration", "0.5", "--set", "limits.stale_input_s=0.3")
        self.assertEqual(launch.wait(60), 0, launch.report())


if __name__ == "__main__":
    outcome.main()
