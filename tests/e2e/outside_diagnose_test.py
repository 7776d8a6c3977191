"""hydro-diagnose on recordings that outsiders' public complaints led to: what is right is known for each."""

import json
import os
import unittest

import outcome
import stack

OUTSIDE = os.environ.get("HYDRO_OUTSIDE", "")
FRICTION = {"b": 3e-4, "T_s": 0.015}  # of the recorded motor, where 2e-4 and 0.01 are given


@unittest.skipUnless(os.path.isdir(OUTSIDE), "the recordings from outside are not here")
class OutsideDiagnoseTest(stack.TestCase):
    def diagnose(self, folder, runs, *options, model="model.toml"):
        """The report on these runs of a folder."""
        base = os.path.join(OUTSIDE, folder)
        out = self.path("-".join([folder, *runs, model]))
        self.run_program("hydro-diagnose", *[os.path.join(base, name + ".csv") for name in runs], "--model",
                               os.path.join(base, model), *options, "--out", out, timeout=600)
        with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
            return json.load(file)

    def assert_only_values(self, report, values):
        """Other values suffice: these, and no effect is named."""
        self.assertEqual(report["verdict"], "parameters", report["sentence"])
        self.assertEqual(report["effects"], [])
        found = {one["name"]: one for one in report["parameters"]}
        self.assertEqual(sorted(found), sorted(values))
        for name, value in values.items():
            low, high = found[name]["ci95"]
            self.assertTrue(low <= value <= high, found[name])
        gaps = report["gap"]["held_out"]
        self.assertLess(gaps["after"], 1.2)
        self.assertLessEqual(gaps["after"], gaps["refit_only"] * 1.001)

    # Tests that a signal in every second row, or in rows of its own, has the noise of its own samples, and
    # that this leads to no finding.
    def test_a_signal_in_every_second_row(self):
        for name in ("topics11", "topics12", "each2"):
            report = self.diagnose("noise-of-a-signal-in-every-second-row", [name], "--free", "b,T_s")
            self.assert_only_values(report, FRICTION)
            self.assertAlmostEqual(report["gap"]["signals"]["motor_speed"]["noise"], 0.1, delta=0.01)
            self.assertFalse([remark for remark in report["remarks"] if "spike" in remark])

    # Tests that the diagnosis names a value when a value explains the gap as well as an effect does.
    def test_a_parameter_and_its_double(self):
        folder = "parameter-and-its-double"
        self.assert_only_values(self.diagnose(folder, ["only_Ts"], "--free", "b,T_s"), {"T_s": 0.015})
        for name in ("b_and_Ts", "reference"):
            self.assert_only_values(self.diagnose(folder, [name], "--free", "b,T_s"), FRICTION)

    # Tests with runs of a fifth of a second that no reported result predicts worse than the refit.
    def test_a_refit_is_not_dropped(self):
        for name in ("fast2k", "fast5k", "fast"):
            self.assert_only_values(self.diagnose("refit-dropped-for-windows", [name], "--free", "b,T_s"), FRICTION)

    # Tests that models that predict the same get the same verdict, whatever part of their numbers the runs
    # cannot show.
    def test_a_refit_is_not_lost(self):
        folder, runs = "refit-lost-in-nan", ["run", "run2"]
        self.assert_only_values(self.diagnose(folder, runs, "--free", "k_1,J,b,T_s,c_E,c_I,mgl"), FRICTION)
        for name in ("twice", "3", "10"):
            report = self.diagnose(folder, runs, model="model_%s.toml" % name)
            self.assertEqual(report["verdict"], "parameters", report["sentence"])
            self.assertLess(report["gap"]["held_out"]["after"], 1.2)

    # Tests that signed numbers of a recorder that appear in a table without their sign are found before
    # anything else.
    def test_an_unsigned_command(self):
        base = os.path.join(OUTSIDE, "unsigned-command")
        for name, counts in (("unsigned", 65536), ("uns12", 4096), ("uns8", 256)):
            run = self.run_program("hydro-diagnose", os.path.join(base, name + ".csv"), "--model",
                                   os.path.join(base, "model.toml"), "--check", expect=1)
            self.assertIn("voltage jumps by %d counts" % counts, run.stdout + run.stderr)


if __name__ == "__main__":
    outcome.main()
