"""In lockstep the result does not depend on the machine: run after run, under load, and in one process, bit by bit."""

import event_log
import outcome
import stack

# A longer run would only take more time.
PAPER = (stack.config("paper.toml"), "--set", "time.duration_s=1.2", "--set",
         "reference.steps=[[0.1,0.1],[0.7,-0.1]]")
DEMO = (stack.config("demo.toml"),)  # 6.5 s at 1 kHz, with sensor noise


class LockstepTest(stack.TestCase):
    def run_launch(self, name, arguments):
        log = self.path(name)
        launch = self.launch(*arguments, "--time", "lockstep", "--log", log)
        self.assertEqual(launch.wait(60), 0, launch.report())
        return log

    def run_sim(self, name, arguments):
        log = self.path(name)
        self.run_program("hydro-sim", *arguments, "-o", log, timeout=60)
        return log

    def compare_all_ways(self, *arguments):
        first = self.run_launch("first.lcmlog", arguments)
        again = self.run_launch("again.lcmlog", arguments)
        burners = self.burn(2)
        loaded = self.run_launch("loaded.lcmlog", arguments)
        self.assertTrue(all(burner.running for burner in burners))
        for burner in burners:
            burner.end()
        sim = self.run_sim("sim.lcmlog", arguments)
        self.assert_identical(first, again)
        self.assert_identical(first, loaded)
        self.assert_identical(first, sim)

        # This folder's own reader must agree with hydro-log compare.
        logs = [event_log.Log(path) for path in (first, loaded, sim)]
        for kind in event_log.NUMBERED + ("HYDRO_FAULT",):
            messages = [{m._replace(utime=0, session=0) for m in log.of(kind)} for log in logs]
            self.assertEqual(messages[0], messages[1], kind)
            self.assertEqual(messages[0], messages[2], kind)
        self.assertGreater(max(s.arm_angle for s in logs[0].states), 0.05)  # something happened

    # Tests that the paper's stack at 5 kHz gives the same bits each time, under load, and in hydro-sim.
    def test_paper(self):
        self.compare_all_ways(*PAPER)

    # Tests the same for the demo's stack, whose sensors are noisy.
    def test_demo_with_noise(self):
        self.compare_all_ways(*DEMO)

    # Tests the same for a loop without delay, where each motor command acts from the tick from which it was
    # computed.
    def test_without_command_delay(self):
        for name, arguments in (("paper", PAPER), ("demo", DEMO)):
            with self.subTest(name):
                arguments = (*arguments, "--set", "plant.command_delay_ticks=0")
                launch = self.run_launch(f"{name}.lcmlog", arguments)
                sim = self.run_sim(f"{name}-sim.lcmlog", arguments)
                self.assert_identical(launch, sim)
                for state in event_log.Log(launch).states[1:]:
                    self.assertEqual(state.command_tick, state.tick - 1)  # over the interval that ends here

    # Tests that compare notices differences: another seed of the noise, another gain, a shorter run.
    def test_compare_finds_differences(self):
        base = self.run_sim("base.lcmlog", (*DEMO, "--duration", "0.5"))
        for number, change in enumerate((("--seed", "2"), ("--set", "position.c2=1201"), ("--duration", "0.499"))):
            with self.subTest(change):
                other = self.run_sim(f"other{number}.lcmlog", (*DEMO, "--set", "time.duration_s=0.5", *change))
                compare = self.run_program("hydro-log", "compare", base, other, expect=1)
                self.assertRegex(compare.stdout, r"\Adiffer at tick \d+: .*\n\Z")


if __name__ == "__main__":
    outcome.main()
