"""Starts the programs under test on a network of their own, watches them and always ends them.

The programs come from HYDRO_BIN and the configurations from HYDRO_CONFIG, so that an installed tree can be tested:
    HYDRO_BIN=/usr/bin HYDRO_CONFIG=/usr/share/hydro/config python3 -B tests/e2e/demo_test.py
Without them those of the source tree and its build folder are taken. Nothing is written but in temporary folders.
"""

import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import event_log

_ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BIN = os.environ.get("HYDRO_BIN", os.path.join(_ROOT, "build", "bin"))
CONFIG = os.environ.get("HYDRO_CONFIG", os.path.join(_ROOT, "config"))

# s to wait for what should come soon. No test passes because of it, so it may be long, because the machine is
# shared.
PATIENCE = 60
# s, added to a limit on wall time that the programs promise. Wake-ups here are late by up to 150 ms each, and
# a process on two cores that others keep busy may get its turn a few hundred milliseconds late.
MACHINE_MARGIN = 2.5

# What the programs say where the machine leaves a loop in real time no time for its ticks.
TOO_LATE = "because this machine woke the process too late"

PROGRAMS = {
    "plant": "hydro-plant",
    "driver": "hydro-driver",
    "pressure_ctrl": "hydro-pressure-ctrl",
    "position_ctrl": "hydro-position-ctrl",
    "logger": "hydro-logger",
}


def program(name):
    return os.path.join(BIN, name)


def config(name):
    return os.path.join(CONFIG, name)


IP_MULTICAST_ALL = 49  # of linux/in.h; the module socket has no name for it


class Port:
    """A UDP port that no socket of this machine uses. It stays reserved as long as this object lives: others who ask
    get others, while LCM, which shares its ports, can use it."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("", 0))  # not to one address: a port on which any group is heard is not free
        self.socket.setsockopt(socket.IPPROTO_IP, IP_MULTICAST_ALL, 0)  # it hears nothing itself
        # This comes after the choice, so that the choice avoids every port in use.
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.url = f"udpm://239.255.76.67:{self.socket.getsockname()[1]}?ttl=0"

    def close(self):
        self.socket.close()


class Process:
    """A started program, with its output read continuously."""

    def __init__(self, argv, cwd, label):
        self.argv = argv
        self.label = label
        self.started = time.monotonic()
        self.child = subprocess.Popen(argv, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE)
        self._news = threading.Condition()
        self._lines = {"stdout": [], "stderr": []}
        self._readers = [threading.Thread(target=self._read, args=(name,), daemon=True) for name in self._lines]
        for reader in self._readers:
            reader.start()

    def _read(self, name):
        for line in getattr(self.child, name):
            with self._news:
                self._lines[name].append(line.decode(errors="replace"))
                self._news.notify_all()

    @property
    def pid(self):
        return self.child.pid

    @property
    def running(self):
        return self.child.poll() is None

    @property
    def stdout(self):
        return "".join(self._lines["stdout"])

    @property
    def stderr(self):
        return "".join(self._lines["stderr"])

    def report(self):
        code = self.child.poll()
        end = "running" if code is None else f"exit code {code}"
        return f"--- {self.label} ({end}): {' '.join(self.argv)}\n{self.stdout}{self.stderr}"

    def wait_for(self, pattern, timeout=PATIENCE):
        """Waits for a line of either stream that matches; returns the match."""
        deadline = time.monotonic() + timeout
        with self._news:
            while True:
                for lines in self._lines.values():
                    for line in lines:
                        if found := re.search(pattern, line):
                            return found
                left = deadline - time.monotonic()
                if left <= 0:
                    raise AssertionError(f"no line like {pattern!r} within {timeout} s\n" + self.report())
                self._news.wait(left)

    def wait(self, timeout=PATIENCE):
        """Waits for its end and returns the exit code (negative: the signal that ended it)."""
        try:
            code = self.child.wait(timeout)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running after {timeout} s\n" + self.report()) from None
        for reader in self._readers:
            reader.join(PATIENCE)
        return code

    def send(self, number):
        self.child.send_signal(number)

    def kill(self):
        self.send(signal.SIGKILL)

    def end(self):
        """Kills it, whatever its state."""
        if self.running:
            self.send(signal.SIGKILL)
        self.child.wait()
        for reader in self._readers:
            reader.join(PATIENCE)
        self.child.stdout.close()
        self.child.stderr.close()


class TestCase(unittest.TestCase):
    """A test with a folder and a network of its own; ends what it started. Shows all output when it fails."""

    longMessage = True

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="hydro-e2e-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.url = self.new_url()
        self.processes = []
        self.addCleanup(self._end_all)

    def _end_all(self):
        for process in reversed(self.processes):
            process.end()

    def run(self, result=None):
        result = result or self.defaultTestResult()
        troubles = len(result.failures) + len(result.errors)
        super().run(result)
        if len(result.failures) + len(result.errors) > troubles:
            for process in self.processes:
                print(process.report()[-6000:], file=sys.stderr)
        return result

    def new_url(self):
        port = Port()
        self.addCleanup(port.close)
        return port.url

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, name, *arguments, label=None):
        """Starts one of the programs under test, by its name, or any program, by its path."""
        argv = [name if os.path.isabs(name) else program(name), *map(str, arguments)]
        process = Process(argv, self.folder, label or os.path.basename(name))
        self.processes.append(process)
        return process

    def run_program(self, name, *arguments, expect=0, timeout=PATIENCE):
        """Runs it to its end, checks its exit code and returns the process."""
        process = self.start(name, *arguments)
        code = process.wait(timeout)
        self.assertEqual(code, expect, process.report())
        return process

    def launch(self, config_file, *options, url=None):
        return self.start("hydro-launch", config_file, "--set", f"bus.url={url or self.url}", *options)

    def stack(self, config_file, *options, url=None):
        return Stack(self, config_file, options, url or self.url)

    def burn(self, cores):
        """Starts other processes that load that many cores fully."""
        return [self.start(sys.executable, "-c", "while True: pass", label="burner") for _ in range(cores)]

    def assert_identical(self, a, b, *options):
        compare = self.run_program("hydro-log", "compare", a, b, *options)
        self.assertEqual(compare.stdout, "identical\n", compare.report())

    def wait_until(self, condition, what, timeout=PATIENCE):
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            if time.monotonic() > deadline:
                self.fail(f"waited {timeout} s in vain: {what}")
            time.sleep(0.005)
        return value


class Stack:
    """The four programs of a stack, started by hand, that is, without hydro-launch."""

    def __init__(self, case, config_file, options, url):
        self.case = case
        self.arguments = [config_file, "--set", f"bus.url={url}", *options]
        self.processes = {}

    def start(self, role, *more, label=None):
        process = self.case.start(PROGRAMS[role], *self.arguments, *more, label=label or role)
        self.processes[role] = process
        return process

    def start_all(self, log=None):
        """Starts all of them, or all but the logger. Returns a view of the log as it grows."""
        if log:
            self.start("logger", "-o", log)
        self.start("position_ctrl")
        self.start("pressure_ctrl")
        self.start("plant", *(["--expect", "logger"] if log else []))
        return LiveLog(self.case, log) if log else None

    def __getitem__(self, role):
        return self.processes[role]

    def others(self, *roles):
        return {role: process for role, process in self.processes.items() if role not in roles}


class LiveLog:
    """The messages of a log that is being written, for tests that act when something has happened."""

    def __init__(self, case, path):
        self.case = case
        self.follower = event_log.Follower(path)
        self.messages = {kind: [] for kind in event_log.TYPES}

    def update(self):
        for event in self.follower.new_events():
            kind = event_log.kind_of(event.channel)
            if not kind:
                continue
            try:
                self.messages[kind].append(event_log.TYPES[kind].decode(event.data))
            except (event_log.LogError, struct.error):
                pass  # a test has sent what no program would; event_log.Log judges the whole log

    def wait_for(self, kind, condition, what, timeout=PATIENCE, start=0):
        """Waits for a message of that kind, the `start`-th or a later one, for which `condition` holds; returns it."""
        position = start

        def look():
            nonlocal position
            self.update()
            messages = self.messages[kind]
            while position < len(messages):
                position += 1
                if condition(messages[position - 1]):
                    return messages[position - 1]
            return None

        return self.case.wait_until(look, what, timeout)

    def wait_for_tick(self, tick):
        return self.wait_for("HYDRO_STATE", lambda s: s.tick >= tick, f"state of tick {tick}")

    def pids(self):
        """The process ids of all that take part, by role: of the launch itself none, which asks who is there where a start takes long."""
        return {status.role: status.pid for status in self.messages["HYDRO_PROCESS_STATUS"] if status.role != "launch"}

    def count(self, kind):
        self.update()
        return len(self.messages[kind])


def still_running(pids):
    """Those of the process ids that belong to a living process (a zombie is none). A process id that was given to
    another program in the meantime does not count either."""
    alive = []
    for pid in pids:
        try:
            with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as file:
                name, rest = file.read().split("(", 1)[1].rsplit(") ", 1)
        except (FileNotFoundError, ProcessLookupError):
            continue
        if name.startswith("hydro-") and rest[0] not in "ZX":
            alive.append(pid)
    return alive
