"""What public bug reports of plotting, logging and identification tools met, tried on ours: the inputs, commands and demands of
../shared/outside, beside the project. What a report of a whole diagnosis demands is tested elsewhere."""

import os
import re
import shutil
import subprocess
import unittest

import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OUTSIDE = os.environ.get("HYDRO_OUTSIDE", os.path.join(os.path.dirname(ROOT), "shared", "outside"))
CHECK = ["hydro-diagnose", "{0}.csv", "--model", "model.toml", "--check"]
FEW = r"found \d+ samples, allowed 100 or more"

# For each folder the tables, the command on each, and the requirements: exit code, what it must say, what it
# must not say.
TABLES = [
    ("05-two-samples-with-one-time", ["run"], 2, r"line 4, column t_ms: found 0\.001 s.* 1500 of 4000 rows .*every = 0\.000625", None),
    ("05-two-samples-with-one-time", ["last_twice"], 0, r"a row left out that repeats the one before.*line 1002", None),
    ("09-dates-and-times", ["iso"], 0, r"times counted from 2026-01-01T10:30:25\.000Z", None),
    ("09-dates-and-times", ["run"], 0, r"ok +samples +1000 in 4\.995 s, one each 5 ms", None),
    ("09-dates-and-times", ["summer_time"], 0, r"set by an hour \(line 502", None),
    ("11-counter-wraps", ["run"], 0, r"roll over \(line 402: 4294962296 to 0, a counter of 32 bits", None),
    ("11-counter-wraps", ["signed"], 0, r"roll over \(line 402: 2147478648 to -2147483648, a counter of 32 bits", None),
    ("11-counter-wraps", ["rebooted"], 2, r"line 502, column t: found 0 s, allowed a time above 2\.495 s", r"roll"),
    ("13-times-of-arrival-in-bursts", ["run"], 2,
     r"samples in bursts, 20 within 57 us each 100 ms.*times of arrival.*5 ms apart", None),
    ("13-times-of-arrival-in-bursts", ["reference"], 0, r"nothing wrong was found", r"burst"),
    ("columns-nobody-asked-for", ["idx", "unused", "text", "alarm", "hex", "note"], 2, FEW, r"column"),
    ("doubled-quotes", ["dq1", "dq2", "dq3"], 2, FEW, r"column"),
    ("latin1-names", ["latin1"], 2, r"line 1: found byte 0xb0, which is not UTF-8.*save the table as UTF-8", r"did you mean"),
    ("no-names-between-commas", ["nn1", "nn3", "nn4"], 2,
     r"line 1: found numbers without as many names in the line above, allowed a line of column names", None),
    ("third-header-line", ["h3", "h3a", "h3b", "h3c"], 2, FEW, r"line 3, column|line 4"),
    ("unsigned-command", ["unsigned"], 1, r"voltage jumps by 65536 counts.*a signed number read as unsigned", r"nothing wrong"),
    ("unsigned-command", ["uns12"], 1, r"voltage jumps by 4096 counts.*a signed number read as unsigned", r"nothing wrong"),
    ("unsigned-command", ["uns8"], 1, r"voltage jumps by 256 counts.*a signed number read as unsigned", r"nothing wrong"),
]


@unittest.skipUnless(os.path.isdir(OUTSIDE), "the inputs are not here: they stand in ../shared/outside beside the project")
class OutsideTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        os.symlink(os.path.dirname(stack.config("demo.toml")), self.path("config"))

    # Runs a command in a copy of the folder. Returns its exit code and all of its output.
    def run_in(self, folder, *argv):
        copy = self.path(folder)
        if not os.path.isdir(copy):
            shutil.copytree(os.path.join(OUTSIDE, folder), copy)
            os.symlink(self.path("config"), os.path.join(copy, "config"))
        command = [stack.program(argv[0])] if argv[0].startswith("hydro-") else [argv[0]]
        done = subprocess.run(command + list(argv[1:]), cwd=copy, capture_output=True, text=True, errors="replace", timeout=120)
        return done.returncode, done.stdout + done.stderr

    # Runs a command that must succeed.
    def do_in(self, folder, *argv):
        code, said = self.run_in(folder, *argv)
        self.assertEqual(code, 0, said)
        return said

    # Tests that each table is read, or refused, as its case demands, with the line and a remedy.
    def test_tables(self):
        for folder, tables, code, says, never in TABLES:
            for table in tables:
                with self.subTest(folder=folder, table=table):
                    found, said = self.run_in(folder, *[part.format(table) for part in CHECK])
                    self.assertEqual(found, code, said)
                    self.assertRegex(said, says)
                    if never:
                        self.assertNotRegex(said, never)

    # Tests that a file that was cut off inside its last number is not imported with another number.
    def test_cut_in_a_number(self):
        said = self.do_in("cut-in-a-number", "hydro-log", "import", "cut.csv", "-o", "cut.lcmlog")
        self.assertRegex(said, r"the last line left out, 3, which has no end and is cut")
        table = self.do_in("cut-in-a-number", "hydro-log", "export", "cut.lcmlog", "-o", "-")
        self.assertEqual(len([line for line in table.splitlines() if re.match(r"\d", line)]), 1, table)

    # Tests that the advice for a file with another kind of name can be followed.
    def test_lvm(self):
        for argv in (["hydro-diagnose", "run.lvm", "--model", "model.toml", "--check"],
                     ["hydro-log", "import", "run.lvm", "-o", "RUN.lcmlog"]):
            code, said = self.run_in("lvm-dead-end", *argv)
            self.assertEqual(code, 2, said)
            self.assertRegex(said, r"named? .*\.csv.*rename it|names that end in \.csv.*rename it")
        self.assertFalse(os.path.exists(os.path.join(self.path("lvm-dead-end"), "RUN.lcmlog")))

    # Tests that a silence and a clock that was set are named, and that rates leave them out.
    def test_gap_and_clock(self):
        folder = "gap-and-clock-in-info"
        self.do_in(folder, "hydro-sim", "config/demo.toml", "--duration", "1", "-o", "a.lcmlog")
        for verb, says in (("gap", r"clock: 600 s without a message at 0\.5 s of plant time"),
                           ("stepback", r"clock: set back by 3 s at 0\.5 s of plant time")):
            self.do_in(folder, "python3", "mutate.py", verb, "a.lcmlog", verb + ".lcmlog")
            info = self.do_in(folder, "hydro-log", "info", verb + ".lcmlog")
            self.assertRegex(info, says)
            self.assertRegex(info, r"HYDRO_STATE +1001 +\d{3,4}\.\d\d ")
            self.assertRegex(info, r"\A\S+: \d+ messages, \d+ bytes, 1(\.0\d*)? s\n")

    # Tests that a log without messages is not mended into an empty run.
    def test_repair_of_nothing(self):
        folder = "repair-of-nothing"
        self.do_in(folder, "hydro-sim", "config/demo.toml", "--duration", "0.5", "-o", "a.lcmlog")
        here = self.path(folder)
        with open(os.path.join(here, "a.lcmlog"), "rb") as whole, open(os.path.join(here, "cut400.lcmlog"), "wb") as cut:
            cut.write(whole.read(400))
        with open(os.path.join(here, "empty.lcmlog"), "wb"):
            pass
        for name in ("cut400", "empty"):
            code, said = self.run_in(folder, "hydro-log", "repair", name + ".lcmlog", "-o", name + ".mended.lcmlog")
            self.assertEqual(code, 2, said)
            self.assertEqual(said.count("\n"), 1, said)
            self.assertFalse(os.path.exists(os.path.join(here, name + ".mended.lcmlog")))

    # Tests that two runs in one log are told apart, or refused, by every verb.
    def test_two_runs(self):
        folder = "summary-of-two-runs"
        for run, seed, target in (("r1", "1", "0.3"), ("r2", "2", "-0.3")):
            self.do_in(folder, "hydro-sim", "config/demo.toml", "--duration", "0.6", "--seed", seed, "--set",
                       f"reference.steps=[[0.1,{target}]]", "-o", run + ".lcmlog")
            self.assertIn("final error", self.do_in(folder, "hydro-log", "summary", run + ".lcmlog"))
        self.do_in(folder, "python3", "mutate.py", "cat", "r1.lcmlog", "r2.lcmlog", "cat.lcmlog")
        self.do_in(folder, "python3", "mutate.py", "merge", "r1.lcmlog", "r2.lcmlog", "merge.lcmlog")
        here = self.path(folder)
        with open(os.path.join(here, "joined.lcmlog"), "wb") as joined:
            for run in ("r1", "r2"):
                with open(os.path.join(here, run + ".lcmlog"), "rb") as part:
                    joined.write(part.read())
        for log in ("cat.lcmlog", "merge.lcmlog", "joined.lcmlog"):
            for verb in (["summary", log], ["replay", log], ["export", log, "-o", "-"], ["compare", log, log]):
                code, said = self.run_in(folder, "hydro-log", *verb)
                self.assertEqual(code, 2, said)
                self.assertRegex(said, r"found states from 2 senders on HYDRO_STATE, 2 runs")
            info = self.do_in(folder, "hydro-log", "info", log)
            self.assertEqual(len(re.findall(r"^run \d of 2, by sender 0x(?!0{16})", info, re.M)), 2, info)
            ranges = re.findall(r"^arm_ref \(rad\) +(\S+) +(\S+)", info, re.M)
            self.assertEqual(ranges, [("0", "0.3"), ("-0.3", "0")], info)

    # Tests that a whole number may be written with a decimal point.
    def test_whole_number_with_a_point(self):
        self.do_in("whole-number-with-a-point", "hydro-sim", "config/demo.toml", "--set", "noise.seed=1.0", "--duration", "0.1",
                   "-o", "x.lcmlog")
        self.do_in("whole-number-with-a-point", "hydro-sim", "config/demo.toml", "--set", "noise.seed=1", "--duration", "0.1",
                   "-o", "y.lcmlog")
        self.assertIn("identical", self.do_in("whole-number-with-a-point", "hydro-log", "compare", "x.lcmlog", "y.lcmlog"))
        code, said = self.run_in("whole-number-with-a-point", "hydro-sim", "config/demo.toml", "--set", "noise.seed=1.5",
                                 "--duration", "0.1", "-o", "z.lcmlog")
        self.assertEqual(code, 2, said)
        self.assertIn("found 1.5, allowed a whole number", said)

    # Tests that missing values can be written so that no reader takes them for 0.
    def test_missing_values(self):
        folder = "21-empty-cells-in-octave"
        self.do_in(folder, "hydro-sim", "config/demo.toml", "--duration", "0.5", "--set", "reference.signal=voltage", "--set",
                   "reference.steps=[[0.1, 2.0]]", "-o", "r.lcmlog")
        self.do_in(folder, "hydro-log", "export", "r.lcmlog", "-o", "t.csv")
        self.do_in(folder, "hydro-log", "export", "r.lcmlog", "--missing", "nan", "-o", "n.csv")
        with open(os.path.join(self.path(folder), "t.csv"), encoding="utf-8") as file:
            plain = file.read()
        with open(os.path.join(self.path(folder), "n.csv"), encoding="utf-8") as file:
            named = file.read()
        self.assertIn(",,", plain)
        self.assertNotIn(",,", named)
        self.assertEqual(re.sub(r"\bnan\b", "", named), plain)

    # Tests that a program recognises a file of another program, and says which program reads it.
    def test_files_of_other_programs(self):
        folder = "gap-and-clock-in-info"
        self.do_in(folder, "hydro-sim", "config/demo.toml", "--duration", "0.2", "-o", "a.lcmlog")
        self.do_in(folder, "hydro-log", "export", "a.lcmlog", "-o", "a.csv")
        self.do_in(folder, "hydro-log", "export", "a.lcmlog", "-o", "a.h5")
        self.do_in(folder, "hydro-log", "export", "a.lcmlog", "-o", "a.mat")
        model = os.path.join("config", "models", "table1.toml")
        for argv, says in (
                (["hydro-plot", "a.lcmlog", "out"], "an LCM event log, allowed a table .*hydro-log export a.lcmlog"),
                (["hydro-sim", "a.lcmlog", "-o", "o.lcmlog"], "an LCM event log, allowed a TOML file; hydro-log info a.lcmlog"),
                (["hydro-sim", "a.csv", "-o", "o.lcmlog"], "found a table, allowed a TOML file"),
                (["hydro-sim", "a.mat", "-o", "o.lcmlog"], "found a MAT file, allowed a TOML file"),
                (["hydro-log", "import", "a.lcmlog", "-o", "o.lcmlog"], "an LCM event log, allowed a table"),
                (["hydro-log", "info", "a.h5"], "an HDF5 file, allowed an LCM event log"),
                (["hydro-log", "info", "a.mat"], "a MAT file, allowed an LCM event log"),
                (["hydro-log", "summary", "config/demo.toml"], "the configuration of a stack, allowed an LCM event log"),
                (["hydro-diagnose", "a.lcmlog", "--model", "config/demo.toml", "--check"],
                 "the configuration of a stack, allowed a model"),
                (["hydro-diagnose", "a.lcmlog", "--model", "a.lcmlog", "--check"], "an LCM event log, allowed a model"),
                (["hydro-diagnose", model, "--model", model, "--check"], r"a model \(\[parameters\]\), allowed the run itself"),
                (["hydro-sim", model, "-o", "o.lcmlog"], "found a model"),
        ):
            with self.subTest(argv=argv):
                code, said = self.run_in(folder, *argv)
                self.assertEqual(code, 2, said)
                self.assertRegex(said, says)
                self.assertNotRegex(said, r"\\x|repair")
                self.assertEqual(said.count("\n"), 1, said)
        self.assertFalse(os.path.exists(os.path.join(self.path(folder), "o.lcmlog")))


if __name__ == "__main__":
    outcome.main()
