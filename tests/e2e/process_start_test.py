"""What every program does before anything else: no file or socket gets the number of a closed standard stream, and a file at its size
limit is an error like a full disk."""

import itertools
import os
import resource
import signal
import subprocess

import event_log
import front_end_wire
import outcome
import stack


# What hydro-tune reads and tries is of no interest here, so it tries as little as it can.
TUNE = ("hydro-tune", stack.config("demo.toml"), "--fixed-gains", "--goal", "step=0.1", "--samples", "0", "-o")


class ProcessStartCase(stack.TestCase):
    def run_prepared(self, prepare, *argv, **options):
        """Runs a program after `prepare` in its process; returns what subprocess.run does. A program that does not end fails here."""
        return subprocess.run([stack.program(argv[0]), *argv[1:]], cwd=self.folder, preexec_fn=prepare, timeout=stack.PATIENCE * 4,
                              check=False, stdin=subprocess.DEVNULL, text=True, errors="replace", **options)

    def start_prepared(self, prepare, *argv):
        """The same, for one that goes on until the end of the test."""
        process = subprocess.Popen([stack.program(argv[0]), *argv[1:]], cwd=self.folder, preexec_fn=prepare, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def record(self):
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "2", "-o", self.path("run.lcmlog"))
        self.run_program("hydro-log", "export", "run.lcmlog", "-o", self.path("run.csv"))


class ClosedStreamsTest(ProcessStartCase):
    def run_closed(self, closed, *argv):
        # Python closes its own copies only after this, so what is closed here stays closed for the program.
        return self.run_prepared(lambda: [os.close(number) for number in closed], *argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    # Tests that a launch ends, and that its log holds the run and no text, whichever streams are closed.
    def test_launch(self):
        for count in (1, 2, 3):
            for closed in itertools.combinations((0, 1, 2), count):
                with self.subTest(closed=closed):
                    log = self.path("".join(map(str, closed)) + ".lcmlog")
                    done = self.run_closed(closed, "hydro-launch", stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--time",
                                           "lockstep", "--duration", "0.5", "--log", log)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertEqual(len(event_log.Log(log).states), 501)
                    self.run_program("hydro-log", "info", log)

    # Tests that a program whose results cannot be printed says so with exit code 1, as on a full disk, and
    # that its files are the same as usual.
    def test_results(self):
        self.record()
        for argv in (("hydro-log", "info", "run.lcmlog"), ("hydro-log", "summary", "run.lcmlog"),
                     ("hydro-sim", stack.config("demo.toml"), "--duration", "2", "-o", "out.lcmlog"),
                     ("hydro-log", "export", "run.lcmlog", "-o", "-"), (*TUNE, "-"),
                     ("hydro-experiment", "--list"), ("hydro-diagnose", "run.lcmlog", "--model", stack.config("models/table1.toml"), "--check")):
            with self.subTest(" ".join(argv)):
                done = self.run_closed((1,), *argv)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"standard output cannot be written: Bad file descriptor\n\Z")
                self.assertEqual(self.run_closed((0, 1, 2), *argv, *(["--force"] if "-o" in argv else [])).returncode, 1)
        done = self.run_closed((2,), "hydro-log", "export", "run.lcmlog", "-o", "out.csv")
        self.assertEqual(done.returncode, 0)
        with open(self.path("out.csv"), "rb") as ours, open(self.path("run.csv"), "rb") as other:
            self.assertEqual(ours.read(), other.read())
        self.assert_identical(self.path("run.lcmlog"), self.path("out.lcmlog"))

    # Tests that no line about bad input is written into a file or a socket.
    def test_bad_input(self):
        for closed in ((2,), (0, 1, 2)):
            for name in ("hydro-sim", "hydro-plant", "hydro-pressure-ctrl", "hydro-position-ctrl", "hydro-launch", "hydro-scope", "hydro-set",
                         "hydro-tune", "hydro-limb"):
                with self.subTest(name, closed=closed):
                    self.assertEqual(self.run_closed(closed, name, "missing.toml").returncode, 2)

    # Tests that a front end which is a process puts frames and nothing else onto its link, whichever streams are closed.
    def test_front_end(self):
        for closed in ((1,), (2,), (0, 1), (1, 2), (0, 1, 2)):
            with self.subTest(closed=closed):
                path = self.path("".join(map(str, closed)) + ".socket")
                board = self.start_prepared(lambda numbers=closed: [os.close(number) for number in numbers], "hydro-front-end", f"unix:{path}")
                port = self.wait_until(lambda found=path: front_end_wire.Stream.opened(found), "a front end that listens")
                self.addCleanup(port.close)
                link = {int(name): os.readlink(f"/proc/{board.pid}/fd/{name}") for name in os.listdir(f"/proc/{board.pid}/fd")}
                self.assertEqual([number for number, target in link.items() if target.startswith("socket:") and number < 3], [], link)
                computer = front_end_wire.Computer(port)
                computer.connect(front_end_wire.settings(watchdog=200, sensors=[front_end_wire.sensor(1, 0), front_end_wire.sensor(1, 1)]))
                self.assertEqual(computer.sample()["p1"], 1)


class FullDiskTest(ProcessStartCase):
    def run_full(self, *argv):
        with open("/dev/full", "w", encoding="utf-8") as full:
            return self.run_prepared(None, *argv, stdout=full, stderr=subprocess.PIPE)

    # Tests that every program ends with 1 and one line when the output of --help or --version cannot be
    # written.
    def test_help(self):
        programs = sorted(name for name in os.listdir(stack.BIN) if name.startswith("hydro-") and os.access(stack.program(name), os.X_OK))
        self.assertGreater(len(programs), 0)
        for name in programs:
            for option in ("--help", "--version"):
                with self.subTest(name, option=option):
                    done = self.run_full(name, option)
                    self.assertEqual((done.returncode, done.stderr),
                                     (1, f"{name}: the standard output cannot be written: No space left on device\n"))

    # Tests the same for results, and for a launch, whose stack still comes to its end.
    def test_results(self):
        self.record()
        for argv in (("hydro-log", "info", "run.lcmlog"), ("hydro-sim", stack.config("demo.toml"), "--duration", "2")):
            with self.subTest(" ".join(argv)):
                done = self.run_full(*argv)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, r"\A[^\n]*the standard output cannot be written: No space left on device\n\Z")
        done = self.run_full("hydro-launch", stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--time", "lockstep",
                             "--duration", "0.5", "--log", self.path("launch.lcmlog"))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r"\[launch\] +the standard output cannot be written: No space left on device\n\Z")
        self.assertEqual(len(event_log.Log(self.path("launch.lcmlog")).states), 501)


class OneLineTest(ProcessStartCase):
    # Tests that a fault that ends the run is reported once, by the process that found it.
    def test_fault(self):
        done = self.run_prepared(None, "hydro-launch", stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--time", "lockstep",
                                 "--duration", "0.5", "--set", "limits.pressure=120", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1, done.stderr)
        own = [line for line in done.stderr.splitlines() if line.startswith("[pressure_ctrl]")]
        self.assertEqual(len(own), 1, done.stderr)
        self.assertRegex(own[0], r"fault pressure_limit: tick \d+: p2 is 1\d\d")

    # Tests that a program says nothing else about an input that it refuses: neither what it left out of a log
    # nor that a model is fast.
    def test_refusals(self):
        with open(self.path("fast.toml"), "w", encoding="utf-8") as file, \
                open(stack.config("models/table1.toml"), encoding="utf-8") as given:
            file.write(given.read().replace("D = 0.00796 ", "D = 1e9 "))
        self.record()
        with open(self.path("run.lcmlog"), "rb") as log, open(self.path("cut.lcmlog"), "wb") as cut:
            cut.write(log.read()[:-100])
        for argv in (("hydro-sim", stack.config("demo.toml"), "--set", f"model.file={self.path('fast.toml')}"),
                     ("hydro-log", "export", "cut.lcmlog", "-o", "a.csv", "--from", "100"),
                     ("hydro-diagnose", "cut.lcmlog", "missing.csv", "--model", stack.config("models/table1.toml"), "--check")):
            with self.subTest(" ".join(argv)):
                done = self.run_prepared(None, *argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), done.stderr)


class SlowModelTest(ProcessStartCase):
    # Tests that a signal stops a model that runs some seven times slower than real time within a tick, alone
    # and in a launch.
    def test_stop(self):
        with open(self.path("slow.toml"), "w", encoding="utf-8") as file, open(stack.config("models/table1.toml"), encoding="utf-8") as given:
            text = given.read()
            self.assertIn("J_a = 23.3 ", text)
            file.write(text.replace("J_a = 23.3 ", "J_a = 2e-7 "))
        arguments = [stack.config("demo.toml"), "--set", f"model.file={self.path('slow.toml')}", "--set", f"bus.url={self.url}",
                     "--time", "lockstep", "--duration", "1000"]
        alone = self.start("hydro-sim", *arguments)
        alone.wait_for("which may take very long to simulate")
        alone.send(signal.SIGTERM)
        self.assertEqual(alone.wait(), 0, alone.report())
        self.assertIn("hydro-sim: stopped by signal 15", alone.stderr)
        launch = self.start("hydro-launch", *arguments)
        launch.wait_for("all 3 processes ready")
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(), 0, launch.report())
        self.assertNotIn("did not end", launch.stdout + launch.stderr)


class FileSizeLimitTest(ProcessStartCase):
    def check(self, outputs, *argv, limits=(0, 500)):
        """With less room than its output needs, a program ends with 1 and a line that says why, and leaves nothing."""
        before = set(os.listdir(self.folder))
        for limit in limits:

            def limit_size(limit=limit):
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

            done = self.run_prepared(limit_size, *argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            said = f"{argv} with {limit} bytes: exit code {done.returncode}: {done.stderr[-1000:]}"
            self.assertEqual(done.returncode, 1, said)
            self.assertRegex(done.stderr, "File too large|no space|cannot be written", said)
            left = set(os.listdir(self.folder)) - before
            self.assertFalse([name for name in left for output in outputs if name.startswith(output) and os.path.isfile(self.path(name))],
                             said)

    def test_logs_and_tables(self):
        self.record()
        for name in ("out.csv", "out.mat", "out.h5", "out.mcap"):
            with self.subTest(name):
                self.check(["out"], "hydro-log", "export", "run.lcmlog", "-o", name)
        for argv in (("hydro-log", "import", "run.csv", "-o", "out.lcmlog"), ("hydro-log", "repair", "run.lcmlog", "-o", "out.lcmlog"),
                     ("hydro-sim", stack.config("demo.toml"), "--duration", "2", "-o", "out.lcmlog"),
                     ("hydro-log", "summary", "run.lcmlog", "--json", "out.json")):
            with self.subTest(" ".join(argv)):
                self.check(["out"], *argv)

    def test_pages_and_configurations(self):
        self.record()
        for argv in (("hydro-plot", "run.csv", "."), (*TUNE, "out.toml"),
                     ("hydro-experiment", "fig2", "--out", ".")):
            with self.subTest(" ".join(argv)):
                self.check(["out", "arm", "pressure", "fig2"], *argv, limits=(0,))

    # Tests that no part of a key or of a skeleton controller is left either, and that the message blames the
    # machine and not the user.
    def test_small_files(self):
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            config = file.read().replace("models/table1.toml", stack.config("models/table1.toml"))
        with open(self.path("keyed.toml"), "w", encoding="utf-8") as file:
            file.write(config.replace("[bus]", '[bus]\nkey_file = "out.key"'))

        def limit_size():
            resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))

        for argv in (("hydro-launch", "make-key", "keyed.toml"), ("hydro-launch", "new-controller", "out")):
            with self.subTest(" ".join(argv)):
                done = self.run_prepared(limit_size, *argv, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"\Ahydro-launch: [^\n]*cannot be written: File too large[^\n]*\n\Z")
                self.assertEqual(os.listdir(self.folder), ["keyed.toml"])

    # Tests that the logger of a launch notices the limit and says so, as on a full disk.
    def test_launch(self):
        def limit_size():
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        done = self.run_prepared(limit_size, "hydro-launch", stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--time",
                                 "lockstep", "--duration", "2", "--log", self.path("run.lcmlog"), stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("File too large", done.stderr + done.stdout)
        self.assertNotIn(signal.strsignal(signal.SIGXFSZ), done.stderr + done.stdout)
        self.assertLessEqual(os.path.getsize(self.path("run.lcmlog")), 20000)


if __name__ == "__main__":
    outcome.main()
