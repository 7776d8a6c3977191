"""Processes of one stack that were started with different configurations, models or modes of time."""

import shutil
import signal

import event_log
import fault_case
import outcome
import stack


class AgreementTest(fault_case.FaultCase):
    ROLES = ("logger", "position_ctrl", "pressure_ctrl", "plant")

    def start_with(self, role, *other):
        """The stack, in which one process has other options. It starts when the rest listen, so that each of them hears it."""
        run = self.run_ = self.stack(self.moving(), "--time", "realtime", "--duration", "0", "--set", f"limits.stale_input_s={fault_case.STALE}")
        own = {"logger": ("-o", self.log_file), "plant": ("--expect", "logger")}
        rest = [name for name in self.ROLES if name != role]
        for name in rest:
            run.start(name, *own.get(name, ()))
        if "logger" in rest:
            log = stack.LiveLog(self, self.log_file)
            for name in rest:
                log.wait_for("HYDRO_PROCESS_STATUS", lambda s, name=name: s.role == name, f"the {name} in the log")
        run.start(role, *own.get(role, ()), *other)
        return run

    def check_refused(self, role, expected, *other):
        run = self.start_with(role, *other)
        for name, process in run.processes.items():
            self.assertEqual(process.wait(), 1, process.report())
        self.assertRegex(run["plant"].stderr, f"{role} on .* \\(process \\d+\\) has another configuration: .*{expected}")
        log = event_log.Log(self.log_file)
        self.assertEqual([s for s in log.states if s.voltage != 0], [])

    # Tests that a stack does not start when its processes do not agree, and that the plant names process, key
    # and both values.
    def test_other_gain(self):
        self.check_refused("pressure_ctrl", "position.c1 is 60000 there, 6000 here", "--set", "position.c1=60000")

    def test_other_limit(self):
        self.check_refused("position_ctrl", "limits.pressure is inf there, 2000 here", "--set", "limits.pressure=inf")

    def test_other_time(self):
        self.check_refused("position_ctrl", "time.speed is 2 there, not given here", "--set", "time.speed=2")

    def test_other_model(self):
        model = self.path("other_model.toml")
        with open(stack.config("models/table1.toml"), encoding="utf-8") as file:
            text = file.read()
        changed = text.replace("\nk_1 = 4.0", "\nk_1 = 5.0")
        self.assertNotEqual(text, changed)
        with open(model, "w", encoding="utf-8") as file:
            file.write(changed)
        self.check_refused("pressure_ctrl", "model file: parameters.k_1 is 5 there, 4 here", "--set", f'model.file="{model}"')

    # Tests that the entries that may differ can differ: the noise, the integrator, and the place of the same
    # model.
    def test_may_differ(self):
        shutil.copy(stack.config("models/table1.toml"), self.path("copy.toml"))
        self.start_with("plant", "--set", "noise.p1=7", "--set", 'plant.integrator="fast"', "--set",
                        f'model.file="{self.path("copy.toml")}"')
        self.log = stack.LiveLog(self, self.log_file)
        self.wait_for_voltage()
        self.assertEqual(self.finish().of("HYDRO_FAULT"), [])

    # Tests that a process that joins later with another configuration is not obeyed and leaves, while the
    # others continue, and that a process with the right configuration takes over.
    def test_late_joiner(self):
        self.start_stack()
        self.wait_for_voltage()
        self.run_["pressure_ctrl"].send(signal.SIGKILL)
        self.run_["pressure_ctrl"].wait()
        self.wait_for_fault("stale_motor_command")
        joiner = self.start("hydro-pressure-ctrl", *self.run_.arguments, "--set", "position.c1=60000")
        self.assertEqual(joiner.wait(), 1, joiner.report())
        self.assertRegex(joiner.stderr, "plant on .* has another configuration: position.c1 is 6000 there, 60000 here")
        fault = self.wait_for_fault("other_configuration", source="plant")
        self.assertRegex(fault.text, "position.c1 is 60000 there, 6000 here")
        self.wait_for_fault("other_configuration", active=False, source="plant")
        zero = self.log.count("HYDRO_STATE")
        good = self.start("hydro-pressure-ctrl", *self.run_.arguments)
        self.wait_for_fault("stale_motor_command", active=False)
        self.wait_for_voltage()
        log = self.finish()
        self.assertEqual(good.wait(), 0, good.report())
        stale = next(n for n, s in enumerate(log.states) if n > 100 and s.command_tick == -1)
        self.assertEqual([s for s in log.states[stale:zero] if s.voltage != 0], [])


if __name__ == "__main__":
    outcome.main()
