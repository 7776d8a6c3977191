"""hydro-batch: a real study of hydro-sim is the same to the byte whatever runs it, how often it is killed, and on however small a disk."""

import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import outcome
import stack

STUDY = """
name = "Steps of uncertain actuators"
seed = 3
config = "{config}"
set = ["time.mode=lockstep", "time.duration_s=0.4", "reference.steps=[[0.05, 0.1]]"]
draws = 2
[[grid]]
key = "position.c2"
values = [600.0, 1200.0, 2400.0]
[[grid]]
key = "model:b"
from = 0.01
to = 0.02
steps = 2
[[draw]]
key = "model:*"
distribution = "uncertainty"
[[draw]]
key = "noise.seed"
distribution = "uniform"
min = 1
max = 1000
whole = true
[collect]
rms_error_rad = {{ from = "summary.json:/tracking/rms_error_rad", unit = "rad" }}
final_error_rad = "summary.json:/tracking/final_error_rad"
"""
STUDY = STUDY.replace('"model:b"\n', '"position.c1"\n').replace("0.01", "3000").replace("0.02", "6000")
CASES = 12

# Runs SHELL in a small file system of its own at small/, where that is allowed.
SMALL_DISK = """
mount -t tmpfs -o size={size} tmpfs {folder}/small || exit 77
{shell}
"""


def results(folder):
    """Every file that must not depend on how the study was run: name -> bytes."""
    found = {}
    for name in ("table.csv", "table.json"):
        with open(os.path.join(folder, name), "rb") as file:
            found[name] = file.read()
    for path, _, files in os.walk(os.path.join(folder, "cases")):
        for name in files:
            with open(os.path.join(path, name), "rb") as file:
                found[os.path.relpath(os.path.join(path, name), folder)] = file.read()
    return found


def whole_cases(folder):
    """Which cases are there: path -> which file it is, so that one that was written again is seen."""
    found = {}
    for path, _, files in os.walk(os.path.join(folder, "cases")):
        if "result.json" in files:
            status = os.stat(os.path.join(path, "result.json"))
            found[path] = (status.st_ino, status.st_mtime_ns)
    return found


class BatchTest(stack.TestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.made = tempfile.mkdtemp(prefix="hydro-e2e-")
        cls.addClassCleanup(shutil.rmtree, cls.made, ignore_errors=True)

    def study(self, text=STUDY, name="study.toml"):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text.format(config=stack.config("demo.toml")) if text is STUDY else text)
        return self.path(name)

    def batch(self, *arguments, expect=0, timeout=120):
        return self.run_program("hydro-batch", *arguments, expect=expect, timeout=timeout)

    def one_line(self, done):
        self.assertEqual(len(done.stderr.splitlines()), 1, done.report())
        return done.stderr

    def reference(self):
        """The study's results as one worker makes them, never interrupted: made once, and a copy for each test."""
        study, made = self.study(), os.path.join(self.made, "reference")
        if not os.path.exists(made):
            self.batch(study, "--out", made, "--jobs", 1)
        shutil.copytree(made, self.path("reference"))
        return results(self.path("reference"))

    def without_cases(self, name):
        """A folder as a driver has prepared it, without a case; after reference()."""
        shutil.copytree(self.path("reference"), self.path(name), ignore=shutil.ignore_patterns("cases", *self.report_files()))

    # Tests that one worker, three workers, and overlapping ranges of cases in another order give the same
    # bytes, and that the numbers are those of hydro-sim and hydro-log by themselves.
    def test_same_whatever_runs_it(self):
        study, reference = self.study(), self.reference()
        self.assertEqual(len(reference), CASES + 2)
        self.batch(study, "--out", self.path("three"), "--jobs", 3)
        self.assertEqual(results(self.path("three")), reference)

        self.without_cases("ranges")
        workers = [self.start("hydro-batch", "--worker", self.path("ranges"), "--cases", cases, "--jobs", 2)
                   for cases in ("8:12", "3:10", "0:5")]
        for worker in workers:
            self.assertEqual(worker.wait(120), 0, worker.report())
        self.batch("--finish", self.path("ranges"))
        self.assertEqual(results(self.path("ranges")), reference)

        with open(self.path("reference/table.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([int(row["case"]) for row in rows], list(range(CASES)))
        self.assertEqual({row["status"] for row in rows}, {"done"})
        self.assertEqual(len({row["rms_error_rad"] for row in rows}), CASES)
        with open(self.path("reference/table.json"), encoding="utf-8") as file:
            table = json.load(file)
        self.assertEqual(len(table["rows"]), CASES)
        self.check_by_hand(table["rows"][7])

    def check_by_hand(self, row):
        """The case's number, from programs run by hand on the study's files with the row's values."""
        with open(self.path("reference/model.toml"), encoding="utf-8") as file:
            model = file.read()
        for key, value in row["values"].items():
            if key.startswith("model:"):
                name = key.split(":")[1]
                model = re.sub(rf"(?m)^(r|d) *=.*\n", "", model) if name == "c" else model
                model, count = re.subn(rf"(?m)^{name} *=.*$", f"{name} = {value}", model)
                if count == 0:
                    model = model.replace("[parameters]\n", f"[parameters]\n{name} = {value}\n")
        with open(self.path("model.toml"), "w", encoding="utf-8") as file:
            file.write(model)
        changes = [f"{key}={value}" for key, value in row["values"].items() if not key.startswith("model:")]
        options = [word for change in [*changes, f"model.file={self.path('model.toml')}"] for word in ("--set", change)]
        self.run_program("hydro-sim", self.path("reference/config.toml"), *options, "-o", self.path("hand.lcmlog"))
        self.run_program("hydro-log", "summary", self.path("hand.lcmlog"), "--json", self.path("hand.json"))
        with open(self.path("hand.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["tracking"]["rms_error_rad"], row["numbers"]["rms_error_rad"])

    # Tests that the shipped torture study runs hydro-torture from seeds that the study draws, and has its
    # numbers.
    def test_torture_is_a_study(self):
        with open(os.path.join(os.path.dirname(stack.CONFIG), "examples", "studies", "torture.toml"), encoding="utf-8") as file:
            shipped = file.read()
        study = shipped.replace("draws = 20", "draws = 2").replace('"--runs", "50"', '"--runs", "3"')
        self.assertEqual(len(study), len(shipped) - 2)
        self.batch(self.study(study), "--out", self.path("torture"))
        with open(self.path("torture/table.json"), encoding="utf-8") as file:
            rows = json.load(file)["rows"]
        self.assertEqual(len({row["values"]["first_seed"] for row in rows}), 2)
        for row in rows:
            self.assertEqual((row["numbers"]["failed_runs"], row["numbers"]["findings"]), (0, 0))
            self.assertGreater(row["numbers"]["faults_injected"], 0)
            self.assertGreater(row["numbers"]["ticks"], 1000)

    # Tests that a driver killed at any point leaves whole cases, that the next driver continues without
    # repeating any, and that the results are those of a study that was never killed.
    def test_killed_driver_goes_on(self):
        study, reference = self.study(), self.reference()
        dice, kept, kills = random.Random(5), {}, 0
        while len(kept) < CASES:
            driver = self.start("hydro-batch", study, "--out", self.path("out"), "--jobs", 2)
            # Every other kill may come before a case is whole. Those between wait for cases, so that this ends on any machine.
            patience, more = dice.uniform(0, 0.25) if kills % 2 else stack.PATIENCE, dice.randrange(1, 4)
            deadline = time.monotonic() + patience
            self.wait_until(lambda: not driver.running or time.monotonic() > deadline or
                            len(whole_cases(self.path("out"))) >= len(kept) + more, "a moment to kill")
            driver.kill()
            driver.wait()
            kills += 1
            now = whole_cases(self.path("out"))
            self.assertEqual({path: now.get(path) for path in kept}, kept)
            for path in now:
                with open(os.path.join(path, "result.json"), "rb") as file:
                    self.assertEqual(file.read(), reference[os.path.relpath(os.path.join(path, "result.json"), self.path("out"))])
            kept = now
        print(f"killed {kills} times", flush=True)
        # The files that a kill in the middle of the report leaves. The notes belong to the user.
        for name in ("table.csv.part", "table.json.part1", "worst.svg.part", "notes.part"):
            with open(self.path(f"out/{name}"), "w", encoding="utf-8") as file:
                file.write("half")
        self.batch(study, "--out", self.path("out"))
        self.assertEqual(whole_cases(self.path("out")), kept | whole_cases(self.path("out")))
        self.assertEqual(results(self.path("out")), reference)
        self.assertEqual(os.listdir(self.path("out/staging")), [])
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         sorted(["cases", "config.toml", "inputs", "model.toml", "notes.part", "staging", "study.toml", "times",
                                 *self.report_files()]))

    # Tests that cases torn by a power cut run again in the same run, which says so, and have the same results
    # as before.
    def test_torn_cases_run_again(self):
        reference = self.reference()
        for number, text in ((3, b""), (7, b"\0" * 134)):
            with open(self.path(f"reference/cases/000/000/{number:03}/result.json"), "wb") as file:
                file.write(text)
        done = self.batch(self.study(), "--out", self.path("reference"))
        self.assertIn("2 stored results are not whole; their cases run again", done.stderr)
        self.assertEqual(results(self.path("reference")), reference)

    # Tests that --again runs failed cases once, even where other cases run again because their results are
    # torn.
    def test_again_beside_a_torn_case(self):
        ran = self.path("ran")
        study = self.study('[[grid]]\nkey = "a"\nvalues = [1, 2]\n[[step]]\nrun = ["sh", "-c", '
                           f'"echo {{value:a}} >> {ran}; exit $(({{value:a}} - 1))"]\n')
        self.batch(study, "--out", self.path("out"), expect=1)
        with open(self.path("out/cases/000/000/000/result.json"), "w", encoding="utf-8"):
            pass
        done = self.batch(study, "--out", self.path("out"), "--again", expect=1)
        self.assertIn("1 stored results are not whole", done.stderr)
        with open(ran, encoding="utf-8") as file:
            self.assertEqual(sorted(file.read().split()), ["1", "1", "2", "2"])

    # Tests that the studies in docs/studies.md can be run, and that all their cases succeed.
    def test_the_pages_studies(self):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        with open(os.path.join(root, "docs", "studies.md"), encoding="utf-8") as file:
            blocks = re.findall(r"```toml\n(.*?)```", file.read(), re.DOTALL)
        whole = [block for block in blocks if "../../config/" in block]
        self.assertEqual(len(whole), 2)
        for number, block in enumerate(whole):
            study = self.study(block.replace("../../config/", os.path.dirname(stack.config("demo.toml")) + "/"), f"page{number}.toml")
            done = self.batch(study, "--out", self.path(f"page{number}"))
            self.assertRegex(done.stdout, "cases: [1-9][0-9]* done, 0 failed, 0 missing")

    def report_files(self):
        return [name for name in os.listdir(self.path("reference")) if name.startswith("table.") or name.endswith((".svg", ".html"))]

    # Tests that after a driver was killed while it prepared the folder, the next one continues and leaves
    # nothing half-written.
    def test_killed_in_preparation(self):
        os.makedirs(self.path("out/inputs"))
        for name in ("config.toml.part", "study.toml.part1"):
            with open(self.path(f"out/{name}"), "w", encoding="utf-8") as file:
                file.write("half")
        self.batch(self.study(), "--out", self.path("out"))
        self.assertEqual(results(self.path("out")), self.reference())
        self.assertEqual([name for name in os.listdir(self.path("out")) if ".part" in name], [])

    # Tests that a worker killed in the middle of its range loses nothing: another one runs the remaining
    # cases, and repeats no whole case.
    def test_killed_worker(self):
        reference = self.reference()
        self.without_cases("out")
        worker = self.start("hydro-batch", "--worker", self.path("out"), "--cases", f"0:{CASES}", "--jobs", 1)
        self.wait_until(lambda: len(whole_cases(self.path("out"))) >= 3, "three cases")
        worker.kill()
        worker.wait()
        kept = whole_cases(self.path("out"))
        self.assertLess(len(kept), CASES)
        self.batch("--worker", self.path("out"), "--cases", f"0:{CASES}", "--jobs", 2)
        now = whole_cases(self.path("out"))
        self.assertEqual({path: now[path] for path in kept}, kept)
        self.batch("--finish", self.path("out"))
        self.assertEqual(results(self.path("out")), reference)

    # Tests that SIGINT and SIGTERM end a study cleanly: one line, exit code 1, no process left, and the
    # remaining cases can be run afterwards.
    def test_stop_signals(self):
        study = self.study('draws = 6\n[[step]]\nrun = ["sh", "-c", "echo $$ > pid; exec sleep 0.3", "{case}"]\n')
        for number in (signal.SIGINT, signal.SIGTERM):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            driver = self.start("hydro-batch", study, "--out", self.path("out"), "--jobs", 2)
            self.wait_until(lambda: len(whole_cases(self.path("out"))) >= 2, "two cases")
            with open(f"/proc/{driver.pid}/task/{driver.pid}/children", encoding="utf-8") as file:
                self.assertEqual(file.read(), "")  # its threads have them
            driver.send(number)
            self.assertEqual(driver.wait(), 1)
            self.assertRegex(self.one_line(driver), "^hydro-batch: stopped; the same command goes on")
            self.assertFalse(os.path.exists(self.path("out/lock")))
            self.assertRegex(self.batch("--status", self.path("out")).stdout, r"6 cases: [2-5] done, 0 failed, [1-4] missing")
            self.batch(study, "--out", self.path("out"))

    # Tests that a second driver is refused with the first one's name, that --status reports the first one
    # meanwhile, and that the folder is free after its end, however sudden.
    def test_one_driver_at_a_time(self):
        study = self.study('[[grid]]\nkey = "a"\nvalues = [1, 2]\n[[step]]\nrun = ["sleep", "60"]\n')
        driver = self.start("hydro-batch", study, "--out", self.path("out"))
        self.wait_until(lambda: os.path.exists(self.path("out/lock")), "the lock")
        self.wait_until(lambda: "driven by" in self.batch("--status", self.path("out")).stdout, "a driver in the status")
        second = self.batch(study, "--out", self.path("out"), expect=2)
        self.assertRegex(self.one_line(second), rf"found it in use by hydro-batch, process {driver.pid} on ")
        driver.kill()
        driver.wait()
        self.assertRegex(self.batch("--status", self.path("out")).stdout, "nobody runs it")
        third = self.start("hydro-batch", study, "--out", self.path("out"))
        self.wait_until(lambda: str(third.pid) in self.batch("--status", self.path("out")).stdout, "the third")

    # Tests that failed cases are retried, named with their reason, shown in the table and the exit code, kept
    # when the study continues, and run again on request.
    def test_failed_cases(self):
        study = self.study(f"""retries = 2
[[grid]]
key = "k"
values = [1, 2, 3]
[[step]]
run = ["sh", "-c", "echo {{case}} >> {self.folder}/ran; [ {{value:k}} != 2 ] || [ -e {self.folder}/mended ] || {{ echo no twos >&2; exit 9; }}"]
""".replace("{{", "{").replace("}}", "}"))
        done = self.batch(study, "--out", self.path("out"), "--jobs", 1, expect=1)
        self.assertEqual(self.one_line(done), "hydro-batch: 1 case failed, the first: case 1: step 1: sh ended with exit code 9: no twos\n")
        self.batch(study, "--out", self.path("out"), expect=1)
        with open(self.path("ran"), encoding="utf-8") as file:
            self.assertEqual(file.read().split(), ["0", "1", "1", "1", "2"])
        with open(self.path("out/table.csv"), encoding="utf-8") as file:
            self.assertIn("\n1,failed,3,2,step 1: sh ended with exit code 9: no twos\n", file.read())
        with open(self.path("mended"), "w", encoding="utf-8"):
            pass
        self.batch(study, "--out", self.path("out"), "--again")
        with open(self.path("out/table.csv"), encoding="utf-8") as file:
            self.assertIn("\n1,done,1,2,\n", file.read())

    def on_small_disk(self, size, shell):
        """Its exit code and output."""
        os.makedirs(self.path("small"), exist_ok=True)
        done = subprocess.run(["unshare", "--mount", "sh", "-c", SMALL_DISK.format(size=size, folder=self.folder, shell=shell)],
                              cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)
        if done.returncode in (77, 1) and ("unshare" in done.stderr or "mount" in done.stderr):
            raise unittest.SkipTest("a small file system cannot be mounted here: " + done.stderr.strip())
        return done

    # Tests that a full disk below the study ends it with one line and with every case whole or absent, and
    # that it continues when there is room again.
    def test_full_disk(self):
        reference = self.reference()
        batch = stack.program("hydro-batch")
        done = self.on_small_disk("60k", f"""
{batch} study.toml --out small/out --jobs 2 2> first.err; echo first $?
find small/out -name result.json | wc -l
find small/out -name result.json -size 0 | wc -l
mount -o remount,size=50m {self.folder}/small
find small/out -name result.json -printf '%p %i %T@\\n' | sort > before
{batch} study.toml --out small/out --jobs 2; echo second $?
find small/out -name result.json -printf '%p %i %T@\\n' | sort > after
cp -r small/out out
""")
        self.assertRegex(done.stdout, r"(?s)^first 1\n(\d+)\n0\n.*second 0\n$", done.stderr)
        self.assertLess(int(done.stdout.split()[2]), CASES)
        with open(self.path("first.err"), encoding="utf-8") as file:
            self.assertRegex(file.read(), r"\Ahydro-batch: .*: cannot be written: No space left on device\n\Z")
        with open(self.path("before"), encoding="utf-8") as before, open(self.path("after"), encoding="utf-8") as after:
            self.assertLessEqual(set(before), set(after))
        self.assertEqual(results(self.path("out")), reference)

    # Tests that a full disk where cases run also ends the study, and that no case counts as failed when one of
    # two cases finds the disk full, whatever it is writing, and that the reason is given. None fits on the first
    # of these disks, one case fits on some, and two fit on the last.
    def test_scratch_of_any_size(self):
        reference, batch = self.reference(), stack.program("hydro-batch")
        sizes = (100, 145, 150, 155, 180, 220, 260, 290, 320)
        done = self.on_small_disk("100k", f"""
for size in {" ".join(map(str, sizes))}; do
  mount -o remount,size=${{size}}k {self.folder}/small || exit 77
  rm -rf out
  TMPDIR={self.folder}/small {batch} study.toml --out out --jobs 2 > /dev/null 2> err.$size
  echo $size $? $(find out/cases -name '*.failed' 2> /dev/null | wc -l)
done
{batch} study.toml --out out --jobs 2
""")
        for size in sizes:
            said = re.search(rf"(?m)^{size} ([01]) 0$", done.stdout)
            self.assertIsNotNone(said, done.stdout + done.stderr)
            with open(self.path(f"err.{size}"), encoding="utf-8") as file:
                self.assertRegex(file.read(), r"\Ahydro-batch: [^\n]*: No space left on device\n\Z" if said[1] == "1" else r"\A\Z")
        self.assertIn("\n100 1 0\n", "\n" + done.stdout)
        self.assertEqual(results(self.path("out")), reference)

    # Tests that wrong input ends with exit code 2 and one line that says what is wrong, and that nothing is
    # created.
    def test_wrong_input(self):
        study = self.study()
        self.batch(study, "--out", self.path("out"), "--jobs", 2)
        other = self.study(STUDY.format(config=stack.config("demo.toml")).replace("2400.0", "2500.0"), "other.toml")
        config = stack.config("demo.toml")
        bad = {
            'config = "none.toml"\n': "none.toml",
            f'config = "{config}"\nsed = 1\n': 'bad.toml:2: "sed": found an unknown key',
            f'config = "{config}"\n[[grid]]\nkey = "position.c3"\nvalues = [1]\n': 'bad.toml:3: position.c3 = 1: position: "c3": found an unknown key',
            '[[step]]\nrun = ["hydro-nonsense"]\n': 'step.run: found "hydro-nonsense"',
            '[[step]]\nrun = ["echo", "{valeu:k}"]\n': "step.run: found {valeu:k}",
        }
        for text, says in bad.items():
            done = self.batch(self.study(text, "bad.toml"), "--out", self.path("none"), expect=2)
            self.assertIn(says, self.one_line(done))
            self.assertFalse(os.path.exists(self.path("none")))
        for arguments, says in (((other, "--out", self.path("out")), "study.toml: grid[0].values[2]: was 2400, is 2500"),
                                ((study, "--out", stack.CONFIG), "found "),
                                (("--status", stack.CONFIG), "found no study.toml in it"),
                                (("--worker", self.path("out"), "--cases", "5"), '--cases: found "5"'),
                                ((study, "--jobs", "-1"), "--jobs: found -1"),
                                ((), "STUDY: found nothing")):
            self.assertIn(says, self.one_line(self.batch(*arguments, expect=2)))


if __name__ == "__main__":
    outcome.main()
