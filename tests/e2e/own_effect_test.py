"""An effect of one's own, written as text: the simulation has it, its log says everything, and the gap finder finds it."""

import json
import os
import shutil

import outcome
import stack

TABLE1 = os.path.join(stack.CONFIG, "models", "table1.toml")
SPRING = os.path.join(stack.CONFIG, "..", "examples", "effects", "arm_spring.toml")
STIFFNESS, REST = 2500, 0.02
STEPS = ["[[0.1, 0.1], [0.7, -0.1]]", "[[0.1, -0.15], [0.6, 0.05]]", "[[0.1, 0.2], [0.9, 0.0]]"]


class OwnEffectTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        shutil.copy(SPRING, self.path("arm_spring.toml"))
        with open(TABLE1, encoding="utf-8") as file:
            text = file.read()
        with open(self.path("sprung.toml"), "w", encoding="utf-8") as file:
            file.write(f'{text}\n[effects."arm.spring"]\ndefinition = "arm_spring.toml"\nstiffness = {STIFFNESS}\nrest = {REST}\n')

    def simulate(self, name, steps, model, seed):
        self.run_program("hydro-sim", stack.config("demo.toml"), "--set", f"model.file={model}", "--set", f"noise.seed={seed}",
                         "--set", f"reference.steps={steps}", "--duration", "1.3", "-o", self.path(name))
        return self.path(name)

    # Tests that runs of a rig with the spring lead the gap finder to the spring, with its values, and that
    # neither the model that it writes nor a log needs another file.
    def test_is_found(self):
        runs = [self.simulate(f"{i}.lcmlog", steps, self.path("sprung.toml"), i) for i, steps in enumerate(STEPS)]
        os.remove(self.path("sprung.toml"))
        found = self.run_program("hydro-diagnose", *runs, "--model", TABLE1, "--effect", self.path("arm_spring.toml"), "--out",
                                 self.path("out"))
        self.assertRegex(found.stdout, r"named: Missing: a spring pulls the arm to its rest \[arm\.spring\]")
        with open(self.path("out/report.json"), encoding="utf-8") as file:
            effect = json.load(file)["effects"][0]
        values = {name: one["value"] for name, one in effect["parameters"].items()}
        self.assertAlmostEqual(values["stiffness"], STIFFNESS, delta=0.02 * STIFFNESS)
        self.assertAlmostEqual(values["rest"], REST, delta=0.002)
        os.remove(self.path("arm_spring.toml"))
        replay = self.run_program("hydro-log", "replay", runs[0])
        self.assertRegex(replay.stdout, "pressure: identical")
        again = self.simulate("again.lcmlog", STEPS[0], self.path("out/model.toml"), 9)
        same = self.run_program("hydro-diagnose", again, "--model", self.path("out/model.toml"), "--out", self.path("out2"))
        self.assertRegex(same.stdout, "^nothing")

    # Tests common mistakes: a misspelt name, the file of another effect, the same effect twice.
    def test_mistakes(self):
        def refused(pattern, *arguments):
            run = self.run_program(*arguments, expect=2)
            self.assertEqual(len(run.stderr.splitlines()), 1, run.stderr)
            self.assertRegex(run.stderr, pattern)
        sim = ("hydro-sim", stack.config("demo.toml"), "--set", f"model.file={self.path('sprung.toml')}", "-o", self.path("x.lcmlog"))
        spring = self.path("arm_spring.toml")
        with open(spring, encoding="utf-8") as file:
            text = file.read()
        with open(spring, "w", encoding="utf-8") as file:
            file.write(text.replace("-= stiffness", "-= stifness"))
        refused(r'arm_spring\.toml:\d+: effects\.arm\.spring\.definition\.equation: found the unknown name "stifness" at column 15', *sim)
        with open(spring, "w", encoding="utf-8") as file:
            file.write(text)
        os.rename(spring, self.path("other.toml"))
        refused(r"sprung\.toml:\d+: effects\.arm\.spring\.definition: .*arm_spring\.toml", *sim)
        diagnose = ("hydro-diagnose", "none.lcmlog", "--model", TABLE1, "--out", self.path("out"))
        refused("--effect: found .* allowed each effect once", *diagnose, "--effect", self.path("other.toml"), "--effect",
                self.path("other.toml"))
        refused("none.toml", *diagnose, "--effect", self.path("none.toml"))


if __name__ == "__main__":
    outcome.main()
