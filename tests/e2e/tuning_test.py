"""hydro-set against a running stack: one tick for all, refusals, undo, files, a controller that starts again, a stack with a key."""

import re
import signal
import subprocess

import fault_case
import outcome
import stack


class TuningTest(fault_case.FaultCase):
    def set(self, *arguments, expect=0):
        """Runs hydro-set on the stack of this test."""
        return self.run_program("hydro-set", self.config_file, "--set", f"bus.url={self.url}", *arguments, expect=expect)

    def start_moving(self):
        self.config_file = self.moving()
        self.start_stack(config=self.config_file)
        self.wait_for_voltage()

    def replay(self):
        done = self.run_program("hydro-log", "replay", self.log_file, timeout=120)
        self.assertIn("pressure: identical", done.stdout)
        self.assertIn("position: identical", done.stdout)

    # Tests that a change acts on the named tick in both loops, that the replay of its log follows it, and
    # that the summary reports it.
    def test_change_and_undo(self):
        self.start_moving()
        done = self.set("position.c2=900", "pressure.natural_frequency_rad_s=140")
        self.assertRegex(done.stdout, r"version 1: position.c2 = 900, pressure.natural_frequency_rad_s = 140; pressure loop: gain margin")
        tick = re.search(r"acts from tick (\d+) on .*: position_ctrl since tick (\d+), pressure_ctrl since tick (\d+)", done.stdout)
        self.assertIsNotNone(tick, done.stdout)
        self.assertRegex(self.set("--list").stdout, r"(?m)^position\.c2 +900 +psi s/rad +>= 0 +position_ctrl ")
        self.set("--undo")
        self.assertRegex(self.set("--list").stdout, r"(?m)^position\.c2 +1200 ")
        log = self.finish()
        # Each loop acts from its first tick at or after the named one, which a late plant may have skipped.
        for since, every in ((tick[3], 1), (tick[2], 5)):
            self.assertEqual(int(since), min(s.tick for s in log.states if s.tick >= int(tick[1]) and s.tick % every == 0))
        self.assertEqual([f for f in log.faults if f.code not in ("late_plant", "stale_state", "stale_motor_command")], [])
        self.replay()
        summary = self.run_program("hydro-log", "summary", self.log_file).stdout
        self.assertIn(f"tuned: version 1 from tick {tick[1]} on: position.c2 = 900, pressure.natural_frequency_rad_s = 140 (hydro-set)", summary)
        self.assertRegex(summary, r"(?m)^tuned: version 2 from tick \d+ on: position\.c2 as configured, pressure\.natural_frequency_rad_s as configured \(hydro-set\)$")

    # Tests that a refusal is reported with its reason and exit code 1, and changes nothing; that --watch says
    # when the stack ends.
    def test_refused(self):
        self.start_moving()
        for changes, says in (
                (("position.c2=9000",), "refused: would be unstable: .*position loop: UNSTABLE"),
                (("limits.pressure=9000", "position.c2=900"), "refused: limits.pressure: found 9000 psi, allowed up to 2000 psi"),
                (("--undo",), "refused: nothing to undo")):
            done = self.set(*changes, expect=1)
            self.assertRegex(done.stderr, says)
            self.assertEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)
        # Requests that can never succeed are refused without asking the stack.
        for changes, says in ((("plant.rate_hz=500",), "plant.rate_hz: cannot be changed while the stack runs"),
                              (("position.c3=5",), 'position.c3: no such value, did you mean "position.c1"'),
                              (("c2=900",), "c2: no such value, did you mean position.c2?")):
            self.assertIn(says, self.set(*changes, expect=2).stderr)
        self.assertIn("in force: version 0: as configured", self.set("--list").stdout)
        watcher = self.start("hydro-set", self.config_file, "--set", f"bus.url={self.url}", "--watch")
        watcher.wait_for("in force: version 0")
        self.finish()
        watcher.wait_for(r"the stack ends \(.*\); Ctrl-C ends this, too")
        watcher.send(signal.SIGINT)
        self.assertEqual(watcher.wait(), 0, watcher.report())

    # Tests wrong usage, and the case that no stack is there.
    def test_bad_usage(self):
        self.config_file = stack.config("demo.toml")
        for arguments, says in (((), "found nothing to do"), (("position.c2=1", "--undo"), "--undo: found"),
                                (("a.toml", "position.c2=1"), "found a second CONFIG"), (("position.c2",), "found a second CONFIG"),
                                (("--save", stack.config("demo.toml")), "which is CONFIG"),
                                (("position.c2=1", "position.c2=2"), "found twice")):
            done = self.set(*arguments, expect=2)
            self.assertRegex(done.stderr, says)
            self.assertEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)
        lonely = self.path("lonely.toml")
        with open(lonely, "w", encoding="utf-8") as file:
            file.write(f'[model]\nfile = "{stack.CONFIG}/models/table1.toml"\n[bus]\nurl = "{self.url}"\n[pressure]\nk_p = 0.1\nk_v = 8\n')
        self.config_file = lonely
        self.assertIn("no running stack is heard on " + self.url, self.set("position.c2=1", expect=1).stderr)

    # Tests that the saved file is the configuration with only the changed lines changed, and that a stack
    # starts with it.
    def test_save(self):
        self.start_moving()
        saved = self.path("saved.toml")
        self.set("position.c2=900", "--save", saved)
        # On standard output the file stands alone; all other text goes to standard error.
        printed = self.set("--list", "--save", "-")
        self.assertRegex(printed.stdout, r"^#")
        self.assertRegex(printed.stdout, r"(?m)^c2 = 900 +# psi s/rad")
        self.assertNotIn("in force", printed.stdout)
        self.assertIn("value in force", printed.stderr)
        self.finish()
        done = subprocess.run(["diff", self.config_file, saved], capture_output=True, text=True, check=False)
        self.assertRegex(done.stdout, r"^(\d+)c\1\n< c2 = 1200\.0 +# psi s/rad.*\n---\n> c2 = 900 +# psi s/rad.*\n$")
        self.run_program("hydro-sim", saved, "--duration", "0.2", "-o", self.path("saved.lcmlog"))
        # Changes that a simulation would not make are said.
        unchanged = self.run_program("hydro-sim", saved, "--duration", "0.05", "--tuning", self.path("saved.lcmlog"))
        self.assertIn("saved.lcmlog: found no change of values", unchanged.stderr)
        short = self.run_program("hydro-sim", saved, "--duration", "0.05", "--tuning", self.log_file)
        self.assertIn("1 of 1 changes act after tick 50, the last of this run", short.stderr)

    # Tests that in a stack with a key only a holder of the key can change anything.
    def test_sealed(self):
        key = self.path("stack.key")
        self.config_file = self.moving()
        self.run_program("hydro-launch", "make-key", self.config_file, "--set", f"bus.key_file={key}")
        self.start_stack("--set", f"bus.key_file={key}", config=self.config_file)
        self.wait_for_voltage()
        stranger = self.set("position.c2=700", expect=1)
        self.assertIn("does not answer", stranger.stderr)
        self.wait_for_fault("unauthenticated_command", source="plant")
        self.assertIn("version 1: position.c2 = 900", self.set("--set", f"bus.key_file={key}", "position.c2=900").stdout)
        log = self.finish()
        self.assertEqual({s.version for s in log.of("HYDRO_SETTINGS")}, {0, 1})

    # Tests that a controller that is killed and started again uses the values in force from its first command
    # on.
    def test_controller_restarted(self):
        self.start_moving()
        self.set("position.c2=900")
        old = self.run_["position_ctrl"]
        session = self.log.wait_for("HYDRO_PRESSURE_COMMAND", lambda c: True, "a pressure command").session
        old.send(signal.SIGKILL)
        old.wait()
        self.wait_for_fault("stale_pressure_command")
        again = self.start("hydro-position-ctrl", *self.run_.arguments)
        self.wait_for_fault("stale_pressure_command", active=False)
        mine = lambda s: s.session != session and s.role == "position_ctrl" and s.in_force == 1
        self.log.wait_for("HYDRO_TUNING_STATUS", mine, "the restarted position loop at version 1")
        log = self.finish()
        self.assertEqual(again.wait(), 0, again.report())
        first = min(c.tick for c in log.of("HYDRO_PRESSURE_COMMAND") if c.session != session)
        since = [s.since for s in log.of("HYDRO_TUNING_STATUS") if mine(s)]
        self.assertLessEqual(since[0], first)


if __name__ == "__main__":
    outcome.main()
