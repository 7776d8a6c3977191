"""hydro-diagnose: its files and exit codes on a run of hydro-sim, and on data that cannot be used."""

import json
import math
import os
import random
import re

import outcome
import stack

SIDECAR = """shaft = "clamped"
[columns]
time = "time_s"
voltage = "voltage_V"
motor_speed = "speed"
p1 = "p1"
p2 = "p2"
"""
COLUMNS = ["time_s", "voltage_V", "speed", "p1", "p2"]
TABLE1 = os.path.join(stack.CONFIG, "models", "table1.toml")
LONG = 240


class DiagnoseTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        noise = random.Random(1)
        self.rows = []
        for i in range(400):
            t = 0.001 * i
            rise = 300 * (1 - math.exp(-t / 0.05))
            self.rows.append([t, 2.0, 40 * math.exp(-t / 0.05) + noise.gauss(0, 0.3), 100 + noise.gauss(0, 1.5),
                              100 + rise + noise.gauss(0, 1.5)])

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def run_file(self, name="bench", rows=None, columns=COLUMNS, sidecar=SIDECAR):
        text = ",".join(columns) + "\n"
        for row in self.rows if rows is None else rows:
            text += ",".join("" if v is None else str(v) for v in row) + "\n"
        self.write(name + ".toml", sidecar)
        return self.write(name + ".csv", text)

    def changed(self, column, change):
        k = COLUMNS.index(column)
        return [row[:k] + [change(i, row[k])] + row[k + 1:] for i, row in enumerate(self.rows)]

    def assert_refused(self, pattern, *arguments):
        run = self.start("hydro-diagnose", *arguments)
        self.assertEqual(run.wait(), 2, run.report())
        self.assertEqual(len(run.stderr.splitlines()), 1, run.report())
        self.assertRegex(run.stderr, pattern, run.report())
        self.assertEqual(run.stdout, "", run.report())
        self.assertFalse(os.path.exists(self.path("out")), run.report())

    # Tests data from which nothing can be learnt: exit code 2 and one line with run, signal and row.
    def test_unusable_data(self):
        good = self.rows
        for what, run, pattern in [
            ("no time column", dict(columns=["t", *COLUMNS[1:]]), r"columns\.time: found \"time_s\""),
            ("few samples", dict(rows=good[:99]), r"bench\.csv: found 99 samples, allowed 100"),
            ("backwards", dict(rows=good[:200] + good[100:]), r"bench\.csv: line 202.*time_s.*found"),
            ("constant", dict(rows=self.changed("p1", lambda i, v: 100)), r"bench\.csv: line 2: p1: found 100 psi"),
            ("all missing", dict(rows=self.changed("p2", lambda i, v: None)), r"columns\.p2: found"),
            ("all nan", dict(rows=self.changed("p2", lambda i, v: "nan")), r"columns\.p2: found"),
            ("a speed in another unit", dict(rows=self.changed("speed", lambda i, v: 1e4 * v)),
             r"bench\.csv: line 2: motor_speed: found \d+.* rad/s"),
            ("Pa for psi", dict(rows=self.changed("p2", lambda i, v: 6895 * v)), r"bench\.csv: line 2: p2: found"),
        ]:
            with self.subTest(what):
                self.assert_refused(pattern, self.run_file(**run), "--model", TABLE1, "--out", self.path("out"))

    # Tests options that are missing, malformed or contradictory.
    def test_wrong_usage(self):
        run = self.run_file()
        given = [run, "--model", TABLE1, "--out", self.path("out")]
        unknown = self.write("effects.toml", 'effects = ["pump.magic"]\n')
        for pattern, arguments in [
            ("RUN", given[1:]),
            ("--model", [run, "--out", self.path("out")]),
            ("--out", given[:3]),
            (r"none\.csv", [self.path("none.csv"), *given[1:]]),
            (r"none\.toml", [run, "--model", self.path("none.toml"), "--out", self.path("out")]),
            (r"--hold-out: found .* given as RUN", [*given, "--hold-out", run]),
            (r"effects\.toml:1: effects: found the unknown effect \"pump\.magic\"", [*given, "--effects", unknown]),
            ("--free: found \"q\"", [*given, "--free", "b,q"]),
            ("--jobs: found 0", [*given, "--jobs", "0"]),
            ("--time-limit: found 0", [*given, "--time-limit", "0"]),
            (r"model\.toml", [run, "--model", self.write("model.toml", "name = 'x'\n"), "--out", self.path(".")]),
            ("--seed", [*given, "--seed", "-1"]),
            ("--seed", [*given, "--seed", "x"]),
            ("--sed", [*given, "--sed", "1"]),
        ]:
            with self.subTest(pattern):
                self.assert_refused(pattern, *arguments)
        self.assertIn("--hold-out", self.run_program("hydro-diagnose", "--help").stdout)
        self.assertRegex(self.run_program("hydro-diagnose", "--version").stdout, r"^hydro-diagnose \d")

    def bench_table(self, name, factors):
        """A table of a simulated run, its columns multiplied by these factors, with a sidecar."""
        log, table = self.path("bench.lcmlog"), self.path("bench-export.csv")
        if not os.path.exists(log):
            self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "1.5", "--set", "noise.p1=1.5", "--set",
                             "noise.p2=1.5", "--set", "noise.motor_speed=0.3", "-o", log)
            self.run_program("hydro-log", "export", log, "-o", table)
        with open(table, encoding="utf-8") as file:
            names, *rows = [line.split(",") for line in file.read().split()]
        columns = [names.index(n) for n in ("time_s", "voltage_V", "motor_speed_rad_s", "p1_psi", "p2_psi", "arm_angle_rad")]
        rows = [[float(row[k]) * factors.get(names[k], 1) for k in columns] for row in rows]
        sidecar = SIDECAR.replace("clamped", "free") + 'arm_angle = "arm"\n'
        return self.run_file(name, rows, [*COLUMNS, "arm"], sidecar)

    # Tests --check: exit codes 0 and 1, the line that mends the sidecar, and 2 for unusable input. Also tests
    # that a diagnosis of such a recording begins with the same text and names no effect, and that its report
    # stays unless --force is given.
    def test_check(self):
        def check(run):
            return self.start("hydro-diagnose", run, "--model", TABLE1, "--check")

        sound = check(self.bench_table("sound", {}))
        self.assertEqual(sound.wait(timeout=LONG), 0, sound.report())
        self.assertRegex(sound.stdout, "^checklist of run \"?sound")
        self.assertRegex(sound.stdout, "\nok      sign of the command +a positive command turns the motor forward")
        self.assertRegex(sound.stdout, "\nok      charge pressure ")
        self.assertRegex(sound.stdout, "\nabsent  motor_angle ")
        self.assertRegex(sound.stdout, "\n\nrun sound: the motor turns one way only: .*\nnothing wrong was found in the recordings, as far as the model .*\n$")
        bar = self.bench_table("bar", {"p1_psi": 1 / 14.5038, "p2_psi": 1 / 14.5038})
        checked = check(bar)
        self.assertEqual(checked.wait(timeout=LONG), 1, checked.report())
        self.assertEqual(checked.stderr, "")
        self.assertRegex(checked.stdout, "\nlook    charge pressure .*: p1 and p2 are in bar")
        self.assertIn('p1 = { column = "p1", unit = "bar" }; p2 = { column = "p2", unit = "bar" }', checked.stdout)
        strange = check(self.bench_table("strange", {"motor_speed_rad_s": 0.01}))
        self.assertEqual(strange.wait(timeout=LONG), 1, strange.report())
        self.assertNotIn("nothing wrong was found", strange.stdout)
        late = check(self.bench_table("late", {"time_s": 1000}))
        self.assertEqual(late.wait(timeout=LONG), 1, late.report())
        self.assertIn('time = { column = "time_s", unit = "ms" }', late.stdout)
        short = check(self.run_file("short", self.rows[:99]))
        self.assertEqual(short.wait(timeout=LONG), 2, short.report())
        self.assertRegex(short.stderr, "found 99 samples")

        diagnosis = ("hydro-diagnose", bar, "--model", TABLE1, "--out", self.path("out"))
        os.mkdir(self.path("out"))
        self.write("out/report.html", "of another diagnosis")
        refused = self.run_program(*diagnosis, expect=2)
        self.assertRegex(refused.stderr, r"^[^\n]*report\.html: found a file of this name[^\n]*--force[^\n]*\n$")
        self.run_program(*diagnosis, "--force", timeout=LONG)
        with open(self.path("out/report.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual(report["verdict"], "unexplained")
        self.assertEqual(report["effects"], [])
        self.assertTrue(report["sentence"].startswith("Mend the recording first: run bar: p1 and p2 are in bar"))
        self.assertIn(report["remarks"][0], checked.stdout)
        self.assertIsNone(report["gap"]["held_out"]["after"])
        with open(self.path("out/report.html"), encoding="utf-8") as file:
            self.assertIn("<html", file.read())

    # Tests that a simulated log is diagnosed, and that its reports are whole and the same a second time,
    # except for the time that it took.
    def test_reports(self):
        log = self.path("run.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "1.5", "--set",
                         "noise.p1=1.5", "--set", "noise.p2=1.5", "--set",
                         "noise.motor_speed=0.3", "--set", "noise.arm_angle=0.0002", "-o", log)
        reports = []
        for out, jobs in (("a", 1), ("b", 2)):
            run = self.run_program("hydro-diagnose", log, "--model", TABLE1, "--out", self.path(out), "--jobs",
                                   str(jobs), timeout=LONG)
            self.assertRegex(run.stderr, r"^reading the runs\n")
            self.assertNotIn("reading the runs", run.stdout)
            files = {}
            for name in sorted(os.listdir(self.path(out))):
                with open(self.path(os.path.join(out, name)), encoding="utf-8") as file:
                    files[name] = re.sub(r'"elapsed_s": .*', "", file.read())
            self.assertLessEqual({"report.html", "report.json", "model.toml"}, set(files))
            reports.append(files)
        self.assertEqual(reports[0], reports[1])
        with open(self.path("a/report.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual(report["verdict"], "nothing_missing", report["sentence"])
        self.assertLess(report["gap"]["held_out"]["after"], 1.15)
        self.assertGreater(report["elapsed_s"], 0)


if __name__ == "__main__":
    outcome.main()
