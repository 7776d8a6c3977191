"""hydro-experiment: its files, its exit codes, identical bytes each time, and the stack as separate processes."""

import json
import os
import re
import xml.etree.ElementTree as xml

import outcome
import stack

# All of them take well under 30 s on two free cores, but this machine may be shared.
LONG = 240

# The keys that contract and documentation promise; "a.b" is nested.
KEYS = {
    "fig2": ["table1.sticks", "stribeck.sticks", "stribeck.period_s", "stribeck.swing_psi"],
    "fig3": ["peak_p2_psi", "peak_dp_psi", "peak_time_s", "stick_time_s", "slip_time_s", "slip_dp_psi"],
    "fig4": ["rms_error_psi", "saturated_fraction", "steady_state_error_psi"],
    "fig5": ["rms_error_psi", "saturated_fraction", "steady_state_error_psi"],
    "fig6": ["bandwidth_hz", "natural_frequency_rad_s", "damping_ratio"],
    "fig7": ["bandwidth_hz", "natural_frequency_rad_s", "damping_ratio"],
    "fig8": ["critical_gain", "critical_frequency_rad_s", "poles_at_350"],
    "fig9": ["critical_gain", "critical_frequency_rad_s", "poles_at_350"],
    "fig10": [f"{model}.{key}" for model in ("linear", "nonlinear")
              for key in ("overshoot_percent", "settling_time_s", "steady_state_error_rad")],
    "fig10_uncertainty": ["machines", "settling_time_s.p95", "overshoot_percent.p50", "never_settles.share", "influences"],
    "friction": ["T_s", "b"],
    "leakage": ["c_E", "c_I"],
}


class ExperimentTest(stack.TestCase):
    def experiment(self, *arguments, expect=0, timeout=LONG):
        return self.run_program("hydro-experiment", *arguments, expect=expect, timeout=timeout)

    def names(self):
        lines = self.experiment("--list").stdout.splitlines()
        names = [line.split()[0] for line in lines]
        self.assertEqual(names[-1], "all")
        return names[:-1]

    def read(self, *parts):
        with open(self.path(os.path.join(*parts)), "rb") as file:
            return file.read()

    def test_one_figure(self):
        run = self.experiment("fig3", "--out", self.path("out"))
        files = os.listdir(self.path("out"))
        self.assertLessEqual({"fig3.json", "fig3.csv", "fig3.svg"}, set(files), files)
        self.assertFalse([name for name in files if not name.startswith("fig3")])
        self.assertAlmostEqual(json.loads(self.read("out", "fig3.json"))["peak_p2_psi"], 1512.6, delta=0.1)
        self.assertIn("peak of p_2", run.stdout)
        self.assertEqual(run.stderr, "")

    def test_si(self):
        run = self.experiment("fig3", "--si", "--out", self.path("out"))
        self.assertRegex(run.stdout, r"peak of p_2 .* 10\.42\d* +10\.42\d* +MPa")

    def test_wrong_usage(self):
        for arguments, named in [
            ([], "NAME"),
            (["fgi3"], r'fgi3.*did you mean "fig3"'),
            (["fig3", "--run", "x.csv"], r"--run.*fig3.*friction, leakage"),
            (["all", "--run", "x.csv"], r"--run.*all"),
            (["fig3", "--out", "/proc/none"], r"/proc/none"),
            (["fig3", "--jobs", "0"], r"--jobs"),
            (["fig3", "--seed", "x"], r"--seed"),
            (["fig3", "--machines", "50"], r"--machines.*fig3.*fig10_uncertainty, all"),
            (["fig4", "--seed", "-1"], r"--seed: found -1, allowed a whole number of at least 0"),
            (["fig10_uncertainty", "--machines", "3"], r"--machines.*3.*20 to 1000000"),
            (["friction", "--run", self.path("none.csv")], r"none\.csv"),
        ]:
            with self.subTest(arguments=arguments):
                out = [] if "--out" in arguments else ["--out", self.path("wrong")]
                run = self.experiment(*arguments, *out, expect=2)
                self.assertRegex(run.stderr, named)
                self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
                folder = self.path("wrong")
                self.assertFalse(os.path.isdir(folder) and os.listdir(folder))

    def test_all_twice(self):
        names = self.names()
        few = ("--machines", "300")  # the whole 10,000 take as long as all the rest
        self.experiment("all", *few, "--out", self.path("a"))
        self.experiment("all", *few, "--out", self.path("b"), "--jobs", "1")
        files = sorted(os.listdir(self.path("a")))
        self.assertEqual(files, sorted(os.listdir(self.path("b"))))
        for name in files:
            self.assertEqual(self.read("a", name), self.read("b", name), name)
        index = self.read("a", "index.html").decode()
        for name in names:
            for ending in (".json", ".csv", ".svg"):
                self.assertIn(name + ending, files)
            self.assertIn(f'<section id="{name}">', index)
            self.assertIn(f'href="#{name}"', index)
        self.assertNotIn("failed", re.sub(r"<style>.*?</style>", "", index, flags=re.S))
        # The page is self-contained, and every id occurs in it once.
        self.assertFalse(re.findall(r"<script|<link|\ssrc=|@import|url\((?!#)", index))
        ids = re.findall(r"""\sid=["']([^"']+)""", index)
        self.assertEqual(len(ids), len(set(ids)), sorted(i for i in set(ids) if ids.count(i) > 1)[:5])
        for name in files:
            if name.endswith(".svg"):
                xml.fromstring(self.read("a", name))
        findings = set()
        for name in names:
            report = json.loads(self.read("a", name + ".json"))
            findings |= {finding["number"] for finding in report["findings"]}
            for key in KEYS.get(name, []):
                value = report
                for part in key.split("."):
                    self.assertIn(part, value, f"{name}.json: {key}")
                    value = value[part]
        self.assertEqual(findings, set(range(1, 11)))

    def test_real_time(self):
        """Figure 5's stack as separate processes: its numbers are near those of simulated time."""
        self.experiment("fig5", "--out", self.path("lockstep"))
        run = self.start("hydro-experiment", "fig5", "--real-time", "--out", self.path("realtime"))
        if run.wait(LONG) == 1 and stack.TOO_LATE in run.stderr:  # the program's own verdict on the machine
            self.skipTest("the machine woke the plant too late for 5000 Hz: " + run.stderr.strip()[:200])
        self.assertEqual(run.wait(), 0, run.report())
        logs = [name for name in os.listdir(self.path("realtime/runs")) if name.endswith(".lcmlog")]
        self.assertTrue(logs)
        simulated, real = (json.loads(self.read(folder, "fig5.json")) for folder in ("lockstep", "realtime"))
        self.assertTrue(real["options"]["real_time"])
        # Late wake-ups on a shared machine disturb it, but it must still be recognisable as the same
        # experiment.
        self.assertLess(abs(real["rms_error_psi"] - simulated["rms_error_psi"]), 0.5 * simulated["rms_error_psi"] + 20)


if __name__ == "__main__":
    outcome.main()
