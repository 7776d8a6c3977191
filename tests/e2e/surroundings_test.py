"""What acts on a machine from outside and was recorded: a force on its arm, the oil's temperature. The recordings are of a simulation of the
paper's equations that is written here once more, in small fixed steps."""

import json
import math
import os
import random
import tomllib

import outcome
import stack

MODEL = stack.config("models/table1.toml")
STEP, STEPS, SAMPLES = 1e-5, 100, 2000  # s; a sample each ms
SIDECAR = """tables = "f*.csv"
shaft = "free"
[columns]
time = "t"
voltage = "v"
motor_speed = "w"
motor_angle = "theta"
p1 = "p1"
p2 = "p2"
arm_angle = "alpha"
"""


class Machine:
    """Table 1 with a force on the arm and oil that is thinner by `rate` a kelvin."""

    def __init__(self, rate):
        with open(MODEL, "rb") as file:
            self.p = tomllib.load(file)["parameters"]
        self.p["c"] = self.p["r"] ** 2 * self.p["d"] / 2
        self.rate = rate

    def rates(self, x, voltage, force, thinner):
        p = self.p
        _, w, p1, p2, alpha, speed = x
        torque = max(-p["T_pmax"], min(p["T_pmax"], p["k_1"] * voltage))
        dp = p2 - p1
        leak = thinner * p["c_I"] * dp
        q1 = p["D"] * w - leak + thinner * p["c_E"] * (p1 - p["p_3"])
        q2 = -p["D"] * w + leak + thinner * p["c_E"] * (p2 - p["p_3"])
        return (w, (torque - p["D"] * dp - p["b"] / thinner * w - p["T_s"] * math.tanh(w / 0.002)) / p["J"],
                -p["beta"] / (p["V_ms"] - p["c"] * alpha) * (q1 - p["c"] * speed),
                -p["beta"] / (p["V_ms"] + p["c"] * alpha) * (q2 + p["c"] * speed),
                speed, (p["k_2"] * dp + force) / p["J_a"])

    def record(self, path, seed, temperature, force):
        noise = random.Random(seed).gauss
        x = [0, 0, 300, 300, 0, 0]
        rows = ["t,v,w,theta,p1,p2,alpha,F,T"]
        for k in range(SAMPLES):
            t, warm = 1e-3 * k, temperature + 8e-3 * k
            volts = 2.6 * math.sin(2 * math.pi * (0.7 + 0.2 * seed) * t)
            volts += 1.2 if math.sin(2 * math.pi * (1.9 + 0.2 * seed) * t) > 0 else -1.2
            rows.append(",".join(f"{value:.7g}" for value in (
                t, volts, x[1] + noise(0, 0.05), x[0] + noise(0, 1e-4), x[2] + noise(0, 0.5), x[3] + noise(0, 0.5),
                x[4] + noise(0, 2e-5), force(t) + noise(0, 0.2), warm)))
            thinner = math.exp(self.rate * (warm - 40))
            for i in range(STEPS):  # the midpoint rule
                now = t + i * STEP
                half = self.rates(x, volts, force(now), thinner)
                half = self.rates([a + 0.5 * STEP * b for a, b in zip(x, half)], volts, force(now + 0.5 * STEP), thinner)
                x = [a + STEP * b for a, b in zip(x, half)]
                x[2], x[3] = max(x[2], self.p["p_3"]), max(x[3], self.p["p_3"])
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")


class SurroundingsTest(stack.TestCase):
    def record(self, rate, temperatures, force):
        for i, temperature in enumerate(temperatures):
            Machine(rate).record(self.path(f"f{i}.csv"), i, temperature, force)

    def diagnose(self, more, runs):
        with open(self.path("all.toml"), "w", encoding="utf-8") as file:
            file.write(SIDECAR + more)
        out = self.path("out")
        run = self.start("hydro-diagnose", *(self.path(f"f{i}.csv") for i in range(runs)), "--model", MODEL, "--out", out, "--force")
        self.assertEqual(run.wait(400), 0, run.report())
        with open(os.path.join(out, "report.json"), encoding="utf-8") as file:
            return json.load(file)

    # Tests that friction and leakage that follow the recorded temperature are named, with their rate.
    def test_temperature(self):
        self.record(0.03, (15, 35, 60), lambda t: 0.0)
        report = self.diagnose('temperature = { column = "T", unit = "degC" }\n', 3)
        self.assertEqual([effect["id"] for effect in report["effects"]], ["fluid.viscosity"], report["sentence"])
        low, high = report["effects"][0]["parameters"]["k"]["ci95"]
        self.assertLess(abs(0.5 * (low + high) - 0.03), 0.001)
        self.assertLess(high - low, 0.003)
        gap = next(one["typical"] for one in report["gap"]["horizons"] if abs(one["seconds"] - 0.4) < 1e-9)
        self.assertLess(gap["after"], 0.1 * gap["before"])

    # Tests that a recorded force moves the model's arm as it moved the machine's, which cannot be explained
    # without the force.
    def test_force_on_the_arm(self):
        self.record(0, (20, 20), lambda t: 60 * math.sin(7 * t) + 25 * math.sin(20 * t))

        def missed(more):
            return self.diagnose(more, 2)["gap"]["signals"]["arm_angle"]["held_out"]["before"]

        known = missed('arm_force = "F"\n')
        self.assertLess(known, 1.5e-4)
        self.assertGreater(missed(""), 10 * known)


if __name__ == "__main__":
    outcome.main()
