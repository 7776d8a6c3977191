"""The whole circle: a plant with an effect that its users do not know of, the gap finder on the log of the running
processes, and the stack started again with the model that it wrote."""

import csv
import json
import os

import outcome
import stack

LONG = 1100  # s; some 100 on a quiet machine, but it gives way to the tests beside it
NOISE = {"p1_psi": 1.5, "p2_psi": 1.5, "motor_speed_rad_s": 0.3, "arm_angle_rad": 0.0001}
# The pump's friction grows with the pressures, an effect that Table 1 leaves out.
HIDDEN = '\n[effects."pump.pressure_friction"]\nf = 0.0006\n'


class GapClosedTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        with open(os.path.join(stack.CONFIG, "models", "table1.toml"), encoding="utf-8") as file:
            self.table1 = file.read()
        self.write("given.toml", self.table1)
        self.write("hidden.toml", self.table1 + HIDDEN)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    # Runs four processes, whose plant has `model`, as fast as they can. Returns the log.
    def record(self, model, name, *options):
        log = self.path(name + ".lcmlog")
        noise = [word for key, value in NOISE.items() for word in ("--set", f"noise.{key}={value}")]
        run = self.launch(stack.config("demo.toml"), "--time", "lockstep", "--duration", "2.5", "--log", log, "--set",
                          f"model.file={self.path(model)}", *noise, *options)
        self.assertEqual(run.wait(LONG), 0, run.report())
        return log

    def diagnose(self, model, out, *logs):
        self.run_program("hydro-diagnose", *logs, "--model", self.path(model), "--out", self.path(out),
                         "--time-limit", str(LONG), timeout=LONG)
        with open(self.path(os.path.join(out, "report.json")), encoding="utf-8") as file:
            return json.load(file)

    def column(self, log, name):
        table = log + ".csv"
        self.run_program("hydro-log", "export", log, "-o", table, "--force")
        with open(table, encoding="utf-8") as file:
            return [float(row[name]) for row in csv.DictReader(file)]

    # Tests that the effect is named with its size, that the gap finder finds nothing wrong with the model
    # that it wrote, and that the stack with that model behaves like the other one.
    def test_circle(self):
        moves = [("a", "reference.steps=[[0.1, 0.2], [1.2, -0.1]]"), ("b", "reference.steps=[[0.2, -0.15], [1.4, 0.25]]"),
                 ("c", "reference.steps=[[0.15, 0.1], [0.9, 0.3], [1.7, 0.0]]")]
        logs = [self.record("hidden.toml", name, "--set", steps, "--seed", str(seed))
                for seed, (name, steps) in enumerate(moves)]

        report = self.diagnose("given.toml", "out", *logs)
        self.assertEqual(report["verdict"], "named", report["sentence"])
        self.assertEqual([effect["id"] for effect in report["effects"]], ["pump.pressure_friction"], report["sentence"])
        f = report["effects"][0]["parameters"]["f"]
        self.assertLess(f["ci95"][0], 0.0006)
        self.assertGreater(f["ci95"][1], 0.0006)
        self.assertAlmostEqual(f["value"], 0.0006, delta=0.00003)
        self.assertGreater(report["gap"]["held_out"]["before"], 2)
        self.assertLess(report["gap"]["held_out"]["after"], 1.1)

        again = self.diagnose("out/model.toml", "again", *logs)
        self.assertEqual(again["verdict"], "nothing_missing", again["sentence"])

        # The same move and noise with three plants: only the new model reproduces the hidden plant's angle.
        same = ("--set", moves[0][1], "--seed", "0")
        arm = {name: self.column(self.record(model, name, *same), "arm_angle_rad")
               for name, model in (("unknown", "hidden.toml"), ("before", "given.toml"), ("after", "out/model.toml"))}

        def off(name):
            return max(abs(a - b) for a, b in zip(arm[name], arm["unknown"], strict=True))

        self.assertGreater(off("before"), 5 * off("after"), arm.keys())


if __name__ == "__main__":
    outcome.main()
