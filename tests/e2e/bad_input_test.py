"""Bad input to the real programs: exit code 2, one line on stderr that names the place, and no output file."""

import json
import math
import os
import random
import resource
import shutil
import subprocess
import tomllib

import event_log
import outcome
import stack

# Programs that take a CONFIG, with options that make each of them work. FILE stands for an output file.
CONFIG_PROGRAMS = {
    "hydro-plant": ["--log", "FILE"],
    "hydro-driver": ["--log", "FILE"],
    "hydro-pressure-ctrl": ["--log", "FILE"],
    "hydro-position-ctrl": ["--log", "FILE"],
    "hydro-logger": ["-o", "FILE"],
    "hydro-sim": ["-o", "FILE"],
    "hydro-launch": ["--log", "FILE"],
}
LOG_VERBS = {
    "info": ["LOG"],
    "export": ["LOG", "-o", "FILE"],
    "compare": ["LOG", "GOOD"],
    "replay": ["LOG"],
    "summary": ["LOG", "--json", "FILE"],
}

# Changes to demo.toml (text to replace, replacement), and what the message must name in addition to the file.
CONFIGS = [
    ("unknown key", "rate_hz = 1000 ", "rate_hz = 1000\nrate = 1 ", r'plant: "rate"'),
    ("unknown section", "[plant]", "[pump]\nx = 1\n[plant]", r"pump"),
    ("not TOML", "[plant]", "[plant", r":\d+"),
    ("a string for a number", "rate_hz = 1000 ", 'rate_hz = "fast" ', r"plant\.rate_hz"),
    ("negative rate", "rate_hz = 1000 ", "rate_hz = -5 ", r"plant\.rate_hz"),
    ("interval not whole ticks", "sample_interval_s = 0.005", "sample_interval_s = 0.0053", r"sample_interval_s"),
    ("no gains", "natural_frequency_rad_s = 150.0", "", r"pressure"),
    ("unknown mode", 'mode = "realtime"', 'mode = "fast"', r"time\.mode"),
    ("missing model", "models/table1.toml", "models/none.toml", r"none\.toml"),
    ("arm beyond its range", "[2.2, -0.2]", "[2.2, -20.0]", r"reference"),
    ("steps out of order", "[4.4, 0.1]", "[1.0, 0.1]", r"reference"),
    ("bad url", "udpm://239.255.76.67:7667", "udpm://10.0.0.1:7667", r"url"),
    ("url of another kind", "udpm://239.255.76.67:7667?ttl=0", "http://x", r"url"),
]
OVERRIDES = [
    ("unknown key", ["--set", "plant.rat_hz=1"], r"plant\.rat_hz"),
    ("no value", ["--set", "plant.rate_hz"], r"plant\.rate_hz"),
    ("not a number", ["--set", "plant.rate_hz=fast"], r"plant\.rate_hz"),
    ("not finite", ["--set", "position.c1=nan"], r"position\.c1"),
    ("unknown mode", ["--time", "warp"], r"--time"),
    ("bad duration", ["--duration", "long"], r"--duration"),
    ("negative duration", ["--duration", "-1"], r"--duration"),
    ("duration not whole ticks", ["--duration", "0.0005"], r"duration"),
    ("bad seed", ["--seed", "1.5"], r"--seed"),
    ("unknown option", ["--sed", "1"], r"--sed"),
    ("an argument too many", ["more.toml"], r"more\.toml"),
]


class BadInputTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.out = self.path("out.csv")
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            self.demo = file.read().replace("models/table1.toml",
                                            os.path.join(stack.CONFIG, "models", "table1.toml"))

    def write(self, name, content):
        path = self.path(name)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return path

    def assert_refused(self, name, arguments, pattern):
        process = self.start(name, *[self.out if a == "FILE" else a for a in arguments])
        code = process.wait()
        said = process.stderr
        self.assertEqual(code, 2, process.report())
        # hydro-launch labels what a program prints and how it ended. It refuses bad input that it reads
        # itself.
        self.assertEqual(len(said.splitlines()), 1, process.report())
        self.assertRegex(said, pattern, process.report())
        self.assertEqual(process.stdout, "", process.report())
        left = [f for f in os.listdir(self.folder) if f.startswith(os.path.basename(self.out))]
        self.assertEqual(left, [], process.report())

    def all_programs(self, arguments, pattern):
        for name, output in CONFIG_PROGRAMS.items():
            with self.subTest(program=name):
                self.assert_refused(name, [*arguments, *output], pattern)

    # Tests that no program overwrites the configuration or the model that it reads with its log.
    def test_log_over_what_is_read(self):
        model = self.write("model.toml", open(os.path.join(stack.CONFIG, "models", "table1.toml"), "rb").read())
        config = self.write("mine.toml", self.demo.replace(os.path.join(stack.CONFIG, "models", "table1.toml"), model))
        for name, (option, _) in CONFIG_PROGRAMS.items():
            for file in (config, model):
                with self.subTest(program=name, file=file), open(file, "rb") as before:
                    text = before.read()
                    arguments = [config, option, file, "--duration", "0.1", "--set", f"bus.url={self.url}"]
                    self.assert_refused(name, arguments, f"{file}: found the name of a file that is read")
                    with open(file, "rb") as after:
                        self.assertEqual(after.read(), text)

    # Tests that a launch notices a log that cannot be written before it starts anything, because a failed
    # start would also stop other processes on the port.
    def test_log_that_cannot_be_written(self):
        nowhere = self.path(os.path.join("none", "run.lcmlog"))
        self.assert_refused("hydro-launch", [self.write("mine.toml", self.demo), "--log", nowhere],
                            f"{nowhere}: cannot be created")

    # Tests a table of malformed configurations on every program that takes one.
    def test_configurations(self):
        for what, old, new, pattern in CONFIGS:
            self.assertIn(old, self.demo, what)
            config = self.write("bad.toml", self.demo.replace(old, new))
            with self.subTest(what):
                self.all_programs([config], pattern)

    # Tests a missing configuration, a folder, an empty file, and one that is not text.
    def test_configuration_files(self):
        self.all_programs([self.path("none.toml")], r"none\.toml")
        self.all_programs([self.folder], os.path.basename(self.folder))
        self.all_programs([self.write("empty.toml", "")], r"empty\.toml")
        self.all_programs([self.write("binary.toml", bytes(range(256)))], r"binary\.toml")

    # Tests malformed models: the key or line is named.
    def test_models(self):
        with open(os.path.join(stack.CONFIG, "models", "table1.toml"), encoding="utf-8") as file:
            good = file.read()
        self.assertRegex(good, r"(?m)^J = ")
        models = [
            ("missing parameter", "\nJ = ", "\n# J = ", r"model\.toml.*\bJ\b"),
            ("unknown parameter", "\nJ = ", "\nJJ = 1.0\nJ = ", r"model\.toml.*JJ"),
            ("negative inertia", "\nJ = ", "\nJ = -", r"model\.toml.*\bJ\b"),
            ("unknown effect", "\n[parameters]", '\n[effects."pump.magic"]\nx = 1\n[parameters]', r"pump\.magic"),
        ]
        config = self.write("uses.toml", self.demo.replace(
            os.path.join(stack.CONFIG, "models", "table1.toml"), "model.toml"))
        for what, old, new, pattern in models:
            with self.subTest(what):
                self.assertIn(old, good)
                self.write("model.toml", good.replace(old, new, 1))
                self.all_programs([config], pattern)

    # Tests malformed options.
    def test_options(self):
        for what, options, pattern in OVERRIDES:
            with self.subTest(what):
                self.all_programs([stack.config("demo.toml"), *options], pattern)
        for name in CONFIG_PROGRAMS:
            with self.subTest(program=name):
                self.assert_refused(name, [], "CONFIG")
        self.assert_refused("hydro-logger", [stack.config("demo.toml")], "-o")
        self.assert_refused("hydro-logger", [stack.config("demo.toml"), "-o", "FILE", "--rotate-mb", "-1"],
                            "rotate-mb")
        self.assert_refused("hydro-sim", [stack.config("demo.toml"), "--duration", "0", "-o", "FILE"], "duration")
        for name in "hydro-sim", "hydro-logger":
            self.assert_refused(name, [stack.config("demo.toml"), "-o", "FILE", "--log", "other"], "beside -o")
        for word, verb in (("stopp", "stop"), ("re-arm", "rearm"), ("docter", "doctor"), ("make_key", "make-key"),
                           ("newcontroller", "new-controller")):
            self.assert_refused("hydro-launch", [word, stack.config("demo.toml")], f'found "{word}", did you mean "{verb}"?')
        self.assert_refused("hydro-launch", ["--stopp", stack.config("demo.toml")], 'found the unexpected argument "--stopp".*did you mean "--stop"')
        table = self.write("run.csv", b"time_s,arm_angle_rad,arm_ref_rad,p1_psi,p2_psi,pressure_ref_psi,motor_speed_rad_s,voltage_V\n0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0\n")
        self.assert_refused("hydro-plot", [table, table + "/pictures"], r'DIR: found ".*run\.csv/pictures", a folder that cannot be written \(Not a directory\)')
        self.assert_refused("hydro-torture", ["--runs", "0"], "--runs: found 0, allowed 1 and more")
        self.assert_refused("hydro-torture", ["--seed", "-1", "--runs", "1"], "--seed: found -1, allowed 0 and more")
        self.run_program("hydro-torture", "--runs", "1", "--seed", "1", "--out", self.path("torture"))
        self.assertFalse(os.path.exists(self.path("torture")), "a folder without a schedule")
        self.assert_refused("hydro-launch", [stack.config("demo.toml"), "--host", "nobody", "--log", "FILE"],
                            "nobody")

    # Tests outputs that cannot be written.
    def test_outputs(self):
        missing = self.path("none/run.lcmlog")
        demo = stack.config("demo.toml")
        for name, option in (("hydro-logger", "-o"), ("hydro-sim", "-o"), ("hydro-plant", "--log")):
            with self.subTest(program=name):
                self.assert_refused(name, [demo, "--set", f"bus.url={self.url}", option, missing],
                                    r"none/run\.lcmlog")

    # Tests damaged logs on every verb that reads one.
    def test_logs(self):
        good = self.path("good.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.05", "-o", good)
        with open(good, "rb") as file:
            data = file.read()
        event_log.write_plain(self.path("plain.lcmlog"), event_log.read_events(good))
        with open(self.path("plain.lcmlog"), "rb") as file:
            plain = file.read()
        # Where the tenth event begins.
        place = event_log.read_all_events(good)[9][0]
        logs = {
            "missing.lcmlog": None,
            "random.lcmlog": bytes((i * 7919 + 13) % 251 for i in range(5000)),
            "torn.lcmlog": plain[:-3],
            "flipped.lcmlog": data[:-500] + bytes([data[-500] ^ 16]) + data[-499:],
            "beheaded.lcmlog": data[1:],
            "damaged.lcmlog": data[:place] + b"\xff" * 40 + data[place + 40:],
            "empty.lcmlog": b"",
        }
        for name, content in logs.items():
            log = self.path(name) if content is None else self.write(name, content)
            for verb, arguments in LOG_VERBS.items():
                # The whole part of a damaged log is still useful, so info may count its messages instead of
                # refusing.
                if verb == "info" and content is not None:
                    continue
                with self.subTest(log=name, verb=verb):
                    if name == "empty.lcmlog" and verb == "compare":
                        continue  # two runs of which one is empty can be compared: they differ
                    self.assert_refused("hydro-log", [verb, *({"LOG": log, "GOOD": good}.get(a, a) for a in arguments)],
                                        name.replace(".", r"\."))

    # Tests that a log that was cut is read by every verb, which says so.
    def test_cut_log(self):
        good = self.path("good.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.5", "-o", good)
        with open(good, "rb") as file:
            data = file.read()
        for size in (len(data) // 2, event_log.read_all_events(good)[-1][0]):
            cut = self.write("cut.lcmlog", data[:size])
            for verb, arguments in LOG_VERBS.items():
                with self.subTest(verb=verb, size=size):
                    arguments = [{"LOG": cut, "GOOD": cut, "FILE": self.path(f"{verb}{size}.csv")}.get(a, a) for a in arguments]
                    done = self.run_program("hydro-log", verb, *arguments)
                    said = done.stdout if verb in ("info", "summary") else done.stderr
                    self.assertIn("incomplete: no mark of the end", said)

    # Tests malformed tables for import, and unknown verbs.
    def test_hydro_log_usage(self):
        tables = [
            ("no time", "voltage_V\n1\n", r"time_s"),
            ("unknown column", "time_s,volts\n0,1\n", r"volts"),
            ("a word", "time_s,voltage_V\n0,1\n1,high\n", r"3|high"),
            ("a short row", "time_s,voltage_V\n0,1\n1\n", r"3"),
            ("empty", "", r"bad\.csv"),
        ]
        for what, text, pattern in tables:
            with self.subTest(what):
                self.assert_refused("hydro-log", ["import", self.write("bad.csv", text), "-o", "FILE"], pattern)
        self.assert_refused("hydro-log", ["play", "x"], "play")
        self.assert_refused("hydro-log", [], "verb")
        self.assert_refused("hydro-log", ["export", self.path("x.lcmlog")], "-o|--output")

    # Tests that --help and --version succeed, and print on stdout only.
    def test_help_and_version(self):
        for name in [*CONFIG_PROGRAMS, "hydro-log"]:
            for option in ("--help", "--version"):
                with self.subTest(program=name, option=option):
                    process = self.run_program(name, option)
                    self.assertEqual(process.stderr, "")
                    self.assertIn(name, process.stdout)

    # Tests that ./check explains itself rather than building for minutes, and refuses what it does not know.
    def test_check_says_what_it_takes(self):
        check = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "check")
        for option, code in ("--help", 0), ("-j2", 2):
            with self.subTest(option=option):
                process = subprocess.run([check, option], capture_output=True, text=True, timeout=20, check=False)
                self.assertEqual(process.returncode, code, process.stderr)
                self.assertIn("--full", process.stderr if code else process.stdout)
                self.assertEqual(process.stderr.count("\n"), code // 2)



class DiagnoseInputTest(stack.TestCase):
    """hydro-diagnose: options and recordings that it cannot use, or cannot judge."""

    SIDECAR = 'shaft = "clamped"\n{}[columns]\ntime = {{ column = "t", unit = "{}" }}\nvoltage = "v"\nmotor_speed = "w"\n'
    PRESSURES = 'p1 = "p1"\np2 = "p2"\n'
    MODEL = ("--model", os.path.join(stack.CONFIG, "models", "table1.toml"))

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def table(self, name="bench", first="", unit="s", pressures=PRESSURES, moves=True, voltage=2.0):
        """A clamped motor that turns against its oil, or rests, with noise."""
        noise = random.Random(1)
        rows = ["t,v,w,p1,p2"]
        for i in range(400):
            fades = math.exp(-0.02 * i)
            speed, rise = (40 * fades, 300 * (1 - fades)) if moves else (0, 0)
            rows.append(f"{0.001 * i:.3f},{voltage if i == 200 else 2.0},{speed + noise.gauss(0, 0.3)},"
                        f"{100 + noise.gauss(0, 1.5)},{100 + rise + noise.gauss(0, 1.5)}")
        self.write(name + ".toml", self.SIDECAR.format(first, unit) + pressures)
        return self.write(name + ".csv", "\n".join(rows) + "\n")

    def motor_alone(self):
        """A bare motor that follows the model, eq. (4)."""
        with open(self.MODEL[1], "rb") as file:
            p = tomllib.load(file)["parameters"]
        noise, speed, rows = random.Random(2), 0, ["t,v,w"]
        for i in range(1500):
            volts = 4.0 if i % 500 < 250 else -3.0
            rows.append(f"{0.001 * i:.3f},{volts},{speed + noise.gauss(0, 0.3)}")
            speed += 0.001 / p["J"] * (p["k_1"] * volts - p["b"] * speed - math.copysign(p["T_s"], speed or volts))
        self.write("bare.toml", self.SIDECAR.format("bypass = true\n", "s"))
        return self.write("bare.csv", "\n".join(rows) + "\n")

    def refused(self, pattern, *arguments):
        run = self.run_program("hydro-diagnose", *arguments, expect=2)
        self.assertRegex(run.stderr, pattern)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertFalse(os.path.exists(self.path("out")))

    # Tests that an own effect cannot have an id of the program's own, in a file or in a model.
    def test_ids_of_closures(self):
        effect = 'summary = "a drag"\nequation = "load += drag * theta\'"\n[parameters.drag]\nunit = "in-lbf s"\nmeaning = "torque per speed"\n'
        own = self.write("own.toml", 'id = "closure.foo"\n' + effect)
        allowed = r'id: found "closure\.foo", allowed an id that does not begin with closure\.'
        for mode in (("--check",), ("--out", self.path("out"))):
            self.refused(r"own\.toml:1: " + allowed, self.table(), *self.MODEL, *mode, "--effect", own)
        with open(self.MODEL[1], encoding="utf-8") as file:
            model = self.write("model.toml", file.read() + '\n[effects."closure.foo"]\ndefinition = "own.toml"\ndrag = 0.1\n')
        self.refused(allowed, self.table(), "--model", model, "--check")

    # Tests that an own effect is looked for beside those of a list that does not name it.
    def test_own_effect_beside_a_list(self):
        own = self.write("own.toml", 'id = "pump.wind"\nsummary = "air drags"\nequation = "load += drag * theta\' * abs(theta\')"\n'
                         '[parameters.drag]\nunit = "in-lbf s^2"\nmeaning = "torque per square of speed"\nexample = 1e-4\n')
        few = self.write("few.toml", 'effects = ["pump.stribeck"]\n')
        self.run_program("hydro-diagnose", self.motor_alone(), *self.MODEL, "--effects", few, "--effect", own, "--out", self.path("out"), timeout=120)
        with open(self.path("out/report.json"), encoding="utf-8") as file:
            candidates = {one["id"].split()[0] for one in json.load(file)["candidates"]}
        self.assertLessEqual({"pump.wind", "pump.stribeck"}, candidates)
        self.assertNotIn("pump.quadratic_drag", candidates)

    # Tests that values by which torques are measured cannot be asked for by run.
    def test_values_that_belong_to_no_run(self):
        for name in "k_1", "k_2":
            self.refused(f'--per-run: found "{name}", .*allowed', self.table(), *self.MODEL, "--out", self.path("out"), "--per-run", f"T_s,{name}")

    # Tests that --check prints nothing before it refuses a value, and refuses an arm held where it cannot be.
    def test_refused_by_check(self):
        self.refused(r"bench\.csv: line 202: voltage: found 24000 V", self.table(voltage=24000), *self.MODEL, "--check")
        beyond = self.table(first="arm_angle_rad = 10\n")
        for mode in (("--check",), ("--out", self.path("out"))):
            self.refused(r"bench\.toml: .*arm_angle_rad: found 10 rad of a clamped shaft, allowed angles between", beyond, *self.MODEL, *mode)

    # Tests that times in another unit cost no work: the line that mends them, or a refusal.
    def test_times_in_another_unit(self):
        for unit in "us", "ns":
            run = self.start("hydro-diagnose", self.table(unit=unit), *self.MODEL, "--check")
            self.assertIn(run.wait(timeout=20), (1, 2), run.report())
            self.assertIn('unit = "s"', run.stdout + run.stderr)

    # Tests the exit code of runs that cannot be judged, and that a motor alone can be.
    def test_runs_that_cannot_be_judged(self):
        self.assertIn("nothing wrong", self.run_program("hydro-diagnose", self.motor_alone(), *self.MODEL, "--check").stdout)
        for name, run, why in (("rest", self.table("rest", moves=False), "the motor hardly turns"),
                               ("nop", self.table("nop", pressures=""), "p1 and p2 were not recorded")):
            with self.subTest(name):
                said = self.run_program("hydro-diagnose", run, *self.MODEL, "--check", expect=1).stdout
                self.assertRegex(said, f"\nrun {name}: signs, units and columns could not be checked, because {why}")
                self.assertNotIn("nothing wrong", said)


class FileLimitTest(stack.TestCase):
    # Tests that programs which open sockets, ports and pipes say in one line that their limit of open files is too small, or run.
    def test_too_few_open_files(self):
        demo = [stack.config("demo.toml"), "--set", f"bus.url={self.url}"]
        driver = [stack.config("front_end.toml"), "--set", f"bus.url={self.url}", "--set", "time.start_timeout_s=0.2", "--set"]
        cases = {"hydro-plant": [*demo, "--set", "time.start_timeout_s=0.2"],
                 "hydro-driver udp": [*driver, 'driver.url="udp://127.0.0.1:9"'],
                 "hydro-driver serial": [*driver, 'driver.url="serial:/dev/ptmx"'],
                 "hydro-scope": [*demo, "--port", "0"],
                 "hydro-launch": [*demo, "--duration", "0.1"]}
        for name, arguments in cases.items():
            met = 0
            for limit in range(4, 12):
                with self.subTest(name, limit=limit):
                    child = subprocess.Popen([stack.program(name.split()[0]), *arguments], cwd=self.folder, text=True, stdout=subprocess.DEVNULL,
                                             stderr=subprocess.PIPE,
                                             preexec_fn=lambda limit=limit: resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit)))
                    try:
                        _, said = child.communicate(timeout=5)
                    except subprocess.TimeoutExpired:  # it serves
                        child.terminate()
                        _, said = child.communicate(timeout=stack.PATIENCE)
                    if "error while loading shared libraries" in said or "open files" not in said:
                        continue
                    met += 1
                    self.assertIn(child.returncode, (1, 2), said)
                    self.assertEqual(said.count("\n"), 1, said)
                    self.assertRegex(said, "ulimit -n")
                    self.assertNotRegex(said, "ip route get|any free port|plugged in")
            self.assertGreater(met, 0, name)


class ResultsStayTest(stack.TestCase):
    """No program replaces a log or a result that is there already, unless it is told to."""

    def setUp(self):
        super().setUp()
        self.log = self.path("run.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.05", "-o", self.log)
        self.run_program("hydro-log", "export", self.log, "-o", self.path("run.csv"))

    def refused_and_forced(self, output, program, *arguments, code=0):
        """Refused in one line that names the file and the cure, and done with --force; an empty file is no result."""
        with open(output, "w", encoding="utf-8") as file:
            file.write("yesterday\n")
        before = sorted(os.listdir(self.folder))
        refused = self.run_program(program, *arguments, expect=2)
        self.assertRegex(refused.stderr, f"^hydro-[^\n]*{os.path.basename(output)}: found a file of this name[^\n]*--force[^\n]*\n$")
        self.assertEqual(refused.stdout, "")
        with open(output, encoding="utf-8") as file:
            self.assertEqual(file.read(), "yesterday\n")
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        self.run_program(program, *arguments, "--force", expect=code, timeout=60)
        with open(output, "rb") as file:
            self.assertNotEqual(file.read(), b"yesterday\n")

    # Tests the programs that record a run, each alone, and the launcher, which passes the option on to its
    # logger.
    def test_logs(self):
        old = self.path("old.lcmlog")
        demo = [stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--duration", "0.05"]
        alone = [*demo, "--set", "time.start_timeout_s=0.2"]  # nobody joins: the plant gives up
        self.refused_and_forced(old, "hydro-sim", *demo, "-o", old)
        self.refused_and_forced(old, "hydro-sim", *demo, "--log", old)
        self.refused_and_forced(old, "hydro-plant", *alone, "--log", old, code=1)
        self.refused_and_forced(old, "hydro-launch", *demo, "--time", "lockstep", "--log", old)
        self.assertEqual(len(event_log.Log(old).states), 51)
        report = self.path("timing.json")
        self.refused_and_forced(report, "hydro-launch", *demo, "--time", "lockstep", "--timing", report)
        for program, option in (("hydro-logger", "-o"), ("hydro-pressure-ctrl", "--log"), ("hydro-position-ctrl", "--log")):
            with self.subTest(program):
                refused = self.run_program(program, *demo, option, self.log, expect=2)
                self.assertRegex(refused.stderr, r"^[^\n]*run\.lcmlog: found a file of this name[^\n]*--force[^\n]*\n$")

    # Tests that a recording in parts looks for all existing parts before it begins.
    def test_parts_of_a_recording(self):
        with open(self.path("new-001.lcmlog"), "wb") as file:
            file.write(b"yesterday")
        refused = self.run_program("hydro-logger", stack.config("demo.toml"), "--set", f"bus.url={self.url}", "-o",
                                   self.path("new.lcmlog"), "--rotate-mb", "1", expect=2)
        self.assertIn("new-001.lcmlog: found a file of this name", refused.stderr)
        self.assertFalse(os.path.exists(self.path("new.lcmlog")))

    # Tests the files that are made from logs.
    def test_results(self):
        for name, arguments in (("x.csv", ["export", self.log, "-o"]), ("x.mat", ["export", self.log, "-o"]),
                                ("x.h5", ["export", self.log, "-o"]), ("x.mcap", ["export", self.log, "-o"]),
                                ("back.lcmlog", ["import", self.path("run.csv"), "-o"]),
                                ("whole.lcmlog", ["repair", self.log, "-o"]), ("summary.json", ["summary", self.log, "--json"])):
            with self.subTest(name):
                self.refused_and_forced(self.path(name), "hydro-log", *arguments, self.path(name))
        self.run_program("hydro-log", "export", self.log, "-o", "/dev/null", "--format", "csv")  # keeps nothing


class InputsStayTest(stack.TestCase):
    """No program writes over what it reads, by whatever path it is named."""

    def test_inputs_stay(self):
        folder = self.path("inputs")
        shutil.copytree(os.path.dirname(stack.config("demo.toml")), folder)
        with open(os.path.join(folder, "reference.csv"), "w", encoding="utf-8") as file:
            file.write("time_s,arm_ref_rad\n0,0\n1,0.1\n")
        config = os.path.join(folder, "demo.toml")
        with open(config, encoding="utf-8") as file:
            text = file.read()
        begin, end = text.index("[reference]"), text.index("[limits]")
        reference = '[reference]\nsignal = "arm_angle"\nkind = "csv"\nfile = "reference.csv"\ncolumn = "arm_ref_rad"\n\n'
        with open(config, "w", encoding="utf-8") as file:
            file.write(text[:begin] + reference + text[end:])
        os.symlink(config, os.path.join(folder, "link.toml"))
        os.link(os.path.join(folder, "models", "table1.toml"), os.path.join(folder, "hard.toml"))
        before = self.contents(folder)
        for name in ("demo.toml", "link.toml", "reference.csv", "models/table1.toml", "hard.toml"):
            target = os.path.join(folder, name)
            for program, options in CONFIG_PROGRAMS.items():
                if program == "hydro-driver":
                    continue  # it wants a board first
                arguments = [target if option == "FILE" else option for option in options]
                refused = self.run_program(program, config, "--set", f"bus.url={self.url}", *arguments, expect=2)
                self.assertRegex(refused.stderr, "found the name of a file that is read", refused.report())
        self.assertEqual(self.contents(folder), before)

    @staticmethod
    def contents(folder):
        found = {}
        for place, _, names in os.walk(folder):
            for name in names:
                with open(os.path.join(place, name), "rb") as file:
                    found[os.path.join(place, name)] = file.read()
        return found


if __name__ == "__main__":
    outcome.main()
