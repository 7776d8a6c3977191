"""hydro-diagnose on measurements of a real rig (examples/buoy_pto): what it finds on one record must hold on another."""

import json
import math
import os
import shutil
import unittest

import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLE = os.path.join(ROOT, "examples", "buoy_pto")
DATA = os.path.join(os.environ.get("HYDRO_DATA", ""), "buoy_pto")
SINE, FRICTION = "sine_moves_2021-07-26", "friction_moves_bias_current"
# The whole catalogue would take ten times as long, and would find the same effects.
EFFECTS = 'effects = ["valve.relief", "pump.pressure_friction"]\n'
LONG = 1700  # s; some 250 on a quiet machine, but it gives way to the tests beside it


@unittest.skipUnless(os.path.isdir(DATA), "the measured data are not here: examples/buoy_pto/README.md says where they are")
class RealDataTest(stack.TestCase):
    # Tests that the clocks, the relief valve and the friction of a real rig are found from one record, and
    # that the model then predicts another record, which was not fitted.
    def test_wave_energy_take_off(self):
        for name in (SINE, FRICTION):
            shutil.copy(os.path.join(DATA, name + ".csv"), self.path(name + ".csv"))
            shutil.copy(os.path.join(EXAMPLE, name + ".toml"), self.path(name + ".toml"))
        with open(self.path("effects.toml"), "w", encoding="utf-8") as file:
            file.write(EFFECTS)
        run = self.start("hydro-diagnose", self.path(SINE + ".csv"), "--hold-out", self.path(FRICTION + ".csv"),
                         "--model", os.path.join(EXAMPLE, "model.toml"), "--effects", self.path("effects.toml"),
                         "--free", "J,b,T_s,c_E", "--time-limit", str(LONG), "--out", self.path("out"))
        self.assertEqual(run.wait(LONG), 0, run.report())
        with open(os.path.join(self.path("out"), "report.json"), encoding="utf-8") as file:
            report = json.load(file)

        late = {(clock["run"], name): clock["late_s"] for clock in report["recording"] for name in clock["signals"]}
        for record in ("sine moves", "friction moves"):
            self.assertGreater(late[record, "motor_speed"], 0.2, late)
            self.assertLess(late[record, "motor_speed"], 0.4, late)
            self.assertGreater(late[record, "voltage"], 0.25, late)
        self.assertTrue(any("late by" in remark for remark in report["remarks"]), report["remarks"])

        found = {effect["id"]: effect["parameters"] for effect in report["effects"]}
        self.assertIn("valve.relief", found)
        # The valve regulates from 2850 psi on. One record shows `set` and the rest of its losses only
        # together, and the interval has to say so (measured: 2399 [0, 6739]; the balances alone give 2881,
        # and an earlier search gave 2950).
        low, high = found["valve.relief"]["set"]["ci95"]
        self.assertLess(low, 2850)
        self.assertGreater(high, 2850)

        signals = report["gap"]["signals"]
        p1, p2 = (signals[name]["held_out"]["after"] for name in ("p1", "p2"))
        rpm = signals["motor_speed"]["held_out"]["after"] * 30 / math.pi
        # The rig's published simulator is off by 529 rpm and 240 psi there. The error of the speed is 254 rpm, less than half of
        # that, with the clocks that the balances show (0.33 and 0.31 s, 0.27 and 0.26 s). It was 129 rpm with another 0.1 s of
        # delay in the command, which improved this prediction but worsened the torque balance.
        self.assertLess(rpm, 264, signals)
        # The error of p2 - p1 is 198 psi, more than half of 240. (It was 188 psi, and the speed's 289 rpm, while values that
        # --free names stayed where the balances do not show them.)
        self.assertLess(math.hypot(p1, p2), 205, signals)


if __name__ == "__main__":
    outcome.main()
