"""The Monte Carlo of hydro-experiment fig10_uncertainty against two others: the real stack on the same machines (hydro-sim --machine, hydro-log
summary), and the paper's equations in plain Python (paper_step.py)."""

import csv
import json
import os

import outcome
import paper_step
import stack

MACHINES = 4000  # the first one that never settles is number 3995
STEP = 0.1  # rad
WATCHED = 2  # s
TICK = 1 / paper_step.RATE

TABLE_1 = {"k_1": 4.0, "T_pmax": 40.0, "D": 0.00796, "J": 0.03, "b": 0.01455, "T_s": 4.0, "f": 0.0, "beta": 247000.0, "V_ms": 3.16,
           "c": 1.83**2 * 2.20 / 2, "c_E": 6.5e-6, "c_I": 1.0e-6, "p_3": 100.0, "k_2": 3.68, "J_a": 23.3, "mgl": 0.0}


class UncertainMachinesTest(stack.TestCase):
    def draw(self):
        self.run_program("hydro-experiment", "fig10_uncertainty", "--machines", MACHINES, "--out", self.path("out"), timeout=240)
        with open(self.path("out/fig10_uncertainty.csv"), encoding="utf-8") as file:
            self.rows = list(csv.DictReader(file))
        with open(self.path("out/fig10_uncertainty.json"), encoding="utf-8") as file:
            self.numbers = json.load(file)
        self.assertEqual(len(self.rows), MACHINES)
        self.slowest, self.most_overshoot = ([row["machine"] for row in self.numbers[key]] for key in ("slowest", "most_overshoot"))
        self.assertEqual(self.rows[self.slowest[0]]["settling_time_s"], "")

    def expected(self, number):
        row = self.rows[number]
        settling = row["settling_time_s"]
        return float(settling) if settling else None, float(row["overshoot_percent"]), float(row["steady_state_error_rad"])

    def parameters(self, number):
        return {name: float(self.rows[number][name]) for name in TABLE_1}

    def on_the_stack(self, number):
        """The summary of a run of the real programs on that machine, under controllers that know Table 1."""
        model = self.path(f"machine{number}.toml")
        with open(model, "w", encoding="utf-8") as file:
            file.write("[parameters]\n" + "".join(f"{name} = {self.rows[number][name]}\n" for name in TABLE_1))
        log, summary = self.path(f"run{number}.lcmlog"), self.path(f"run{number}.json")
        self.run_program("hydro-sim", os.path.join(stack.CONFIG, "retuned.toml"), "--duration", 0.1 + WATCHED, "--machine", model, "-o", log, "--force")
        self.run_program("hydro-log", "summary", log, "--json", summary, "--force")
        with open(summary, encoding="utf-8") as file:
            return json.load(file)["tracking"]["steps"][0]

    def test_others_step_as_the_table_says(self):
        self.draw()
        self.check_the_stack()
        self.check_the_papers_equations()

    def check_the_stack(self):
        # The stack waits for 0.1 s before the step, so its integrator takes other steps. Its tolerance is
        # 1e-8.
        numbers = {*range(14), *self.slowest[:3], *self.most_overshoot[:3]}
        self.assertGreaterEqual(len(numbers), 17)
        for number in sorted(numbers):
            with self.subTest("stack", machine=number):
                settling, overshoot, error = self.expected(number)
                step = self.on_the_stack(number)
                self.assertEqual(step["settling_time_s"] is None, settling is None)
                if settling is not None:
                    self.assertAlmostEqual(step["settling_time_s"], settling, delta=1e-9)
                self.assertAlmostEqual(step["overshoot_percent"], overshoot, delta=1e-6)
                self.assertAlmostEqual(step["final_error_rad"], error, delta=5e-8)

    def check_the_papers_equations(self):
        for number in (0, self.slowest[0], self.most_overshoot[0]):
            with self.subTest("equations", machine=number):
                settling, overshoot, error = self.expected(number)
                angles = paper_step.step_response(TABLE_1, self.parameters(number), STEP, WATCHED, 4)
                seen, beyond = paper_step.measure(angles, STEP)
                self.assertEqual(seen is None, settling is None)
                if settling is not None:
                    self.assertAlmostEqual(seen, settling, delta=2.5 * TICK)
                self.assertAlmostEqual(beyond, overshoot, delta=1e-3)
                last = angles[-round(0.1 / TICK) - 1:]
                self.assertAlmostEqual(sum(last) / len(last) - STEP, error, delta=2e-5)

    def test_a_machine_in_other_units_is_refused(self):
        model = self.path("si.toml")
        with open(model, "w", encoding="utf-8") as file:
            file.write('units = "si"\n[parameters]\n' + "".join(f"{name} = {value!r}\n" for name, value in TABLE_1.items()))
        run = self.run_program("hydro-sim", os.path.join(stack.CONFIG, "retuned.toml"), "--machine", model, expect=2)
        self.assertRegex(run.stderr, r"^hydro-sim: .*si\.toml: units: found .*, allowed the same\n$")


if __name__ == "__main__":
    outcome.main()
