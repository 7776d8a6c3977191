"""Programs that may have little memory: each does its work whole, or ends with exit code 1, one line that says so and no output."""

import glob
import os
import resource
import signal
import subprocess

import outcome
import stack

# bytes, from far below what the programs need, mostly not even enough for their libraries, to more than
# enough.
LEAST, MOST, STEPS = 30 << 20, 240 << 20, 24
# How a program ends when its libraries, or what is set up before its main(), do not fit. No better message is
# possible there.
BEFORE_MAIN = (127, -signal.SIGABRT, -signal.SIGSEGV)


class MemoryLimitsTest(stack.TestCase):
    def limited(self, limit, *argv):
        def limit_memory():
            resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        return subprocess.run([stack.program(argv[0]), *argv[1:]], cwd=self.folder, capture_output=True, text=True, errors="replace",
                              preexec_fn=limit_memory, timeout=stack.PATIENCE * 4, check=False)

    # Checks that a program with more memory than one that began its work does not end like one that could
    # not.
    def assert_end(self, code, begun, said):
        self.assertIn(code, (0, 1) if begun else (0, 1, *BEFORE_MAIN), said)

    def outputs(self):
        return sorted(os.path.basename(name) for name in glob.glob(self.path("out*")))

    # Tries a program with less and more memory. Its output must be that of a run without a limit, or nothing.
    def check(self, output, *argv):
        expected = None
        if output:
            self.run_program(*argv)
            with open(self.path(output), "rb") as file:
                expected = file.read()
            os.remove(self.path(output))
        ends = set()
        for step in range(STEPS):
            limit = int(LEAST * (MOST / LEAST) ** (step / (STEPS - 1)))
            done = self.limited(limit, *argv)
            said = f"{argv} with {limit} bytes: exit code {done.returncode}: {done.stderr[-1000:]}"
            self.assert_end(done.returncode, bool(ends & {0, 1}), said)
            ends.add(done.returncode)
            if done.returncode == 0:
                self.assertEqual(self.outputs(), [output] if output else [], said)
            else:
                self.assertEqual(self.outputs(), [], said)
            if done.returncode == 0 and output:
                with open(self.path(output), "rb") as file:
                    self.assertEqual(file.read(), expected, said)
                os.remove(self.path(output))
            if done.returncode == 1:
                self.assertRegex(done.stderr, r"\A" + argv[0] + r": [^\n]*out of memory: [^\n]*\n\Z", said)
        self.assertLessEqual({0, 1}, ends, f"{argv}: of all limits none was too small for it, or all were")

    # Tests the programs that read logs and tables, with data as large as that of a minute.
    def test_logs(self):
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "40", "-o", self.path("run.lcmlog"))
        self.run_program("hydro-log", "export", self.path("run.lcmlog"), "-o", self.path("run.csv"))
        for output, argv in (("out.csv", ("export", "run.lcmlog", "-o", "out.csv")),
                             ("out.mat", ("export", "run.lcmlog", "-o", "out.mat")),
                             ("out.json", ("summary", "run.lcmlog", "--json", "out.json")),
                             ("", ("replay", "run.lcmlog")),
                             ("", ("compare", "run.lcmlog", "run.lcmlog"))):
            with self.subTest(" ".join(argv)):
                self.check(output, "hydro-log", *argv)

    # Tests that a simulation records all of its run, or nothing, because what it writes does not depend on a
    # clock.
    def test_simulation(self):
        def export(name):
            self.run_program("hydro-log", "export", self.path(name), "-o", self.path("table.csv"))
            with open(self.path("table.csv"), "rb") as file:
                table = file.read()
            os.remove(self.path("table.csv"))
            return table

        argv = ("hydro-sim", stack.config("demo.toml"), "--duration", "2", "-o", "out.lcmlog")
        self.run_program(*argv)
        expected = export("out.lcmlog")
        os.remove(self.path("out.lcmlog"))
        done, ends = 0, set()
        for megabytes in range(30, 60):
            ended = self.limited(megabytes << 20, *argv)
            said = f"{megabytes} MiB: exit code {ended.returncode}: {ended.stderr[-1000:]}"
            self.assert_end(ended.returncode, bool(ends & {0, 1}), said)
            ends.add(ended.returncode)
            if ended.returncode == 0:
                done += 1
                self.assertEqual(export("out.lcmlog"), expected)
                os.remove(self.path("out.lcmlog"))
            elif ended.returncode == 1:
                self.assertRegex(ended.stderr, r"\Ahydro-sim: [^\n]*out of memory: [^\n]*\n\Z", said)
            self.assertEqual(self.outputs(), [], said)
        self.assertGreater(done, 0)


if __name__ == "__main__":
    outcome.main()
