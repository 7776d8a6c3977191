"""A controller of one's own: examples/own_controller/pid.py in the place of hydro-position-ctrl, and the module that it stands on."""

import importlib
import os
import re
import shutil
import signal
import sys
import threading
import time

import event_log
import fault_case
import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# The module and the types that lcm-gen made, either from the sources and their build folder or installed.
PYTHON = os.environ.get("HYDRO_PYTHON", os.pathsep.join([os.path.join(ROOT, "bus", "python"), os.path.join(os.path.dirname(stack.BIN), "generated", "python")]))
EXAMPLE = os.path.join(os.environ.get("HYDRO_EXAMPLES", os.path.join(ROOT, "examples")), "own_controller")
PID, CONFIG = os.path.join(EXAMPLE, "pid.py"), os.path.join(EXAMPLE, "own.toml")
TOOLS = os.environ.get("HYDRO_TEST_TOOLS", os.path.join(os.path.dirname(stack.BIN), "tests"))  # where the example in C++ is built
TARGET = 0.3  # rad, of pid.py
# Slower than real time, because no loop brings the arm to its target on a busy machine that skips many ticks.
PACE = ("--set", "time.speed=0.25")


class OwnControllerTest(fault_case.FaultCase):
    def setUp(self):
        super().setUp()
        os.environ["PYTHONPATH"] = PYTHON

    def start_own(self):
        return self.start(sys.executable, "-B", PID, self.url, label="pid.py")

    # Tests that it moves the arm to its target in real time, without a fault of the loops, and ends with the
    # run.
    def test_realtime(self):
        own = self.start_own()
        self.start_stack(config=CONFIG, roles=("logger", "pressure_ctrl"))
        self.run_.start("plant", "--expect", "logger")
        self.log.wait_for("HYDRO_STATE", lambda s: s.time > 1 and abs(s.arm_angle - TARGET) < 0.005, "the arm at its target")
        log = self.finish()
        self.assertEqual(own.wait(), 0, own.report())
        self.assertEqual([f for f in log.faults if f.code.startswith(("second_", "undecodable", "excessive", "nonfinite", "future"))], [])
        statuses = [s.state for s in log.of("HYDRO_PROCESS_STATUS") if s.role == "position_ctrl"]
        self.assertEqual(sorted(set(statuses), key=statuses.index), [event_log.READY, event_log.RUNNING, event_log.DONE])

    # Tests that killing it does no harm: its last reference goes to zero, and the voltage with it.
    def test_killed(self):
        own = self.start_own()
        self.start_stack(config=CONFIG, roles=("logger", "pressure_ctrl"))
        self.run_.start("plant", "--expect", "logger")
        self.wait_for_voltage()
        own.kill()
        self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.SAFE and c.voltage == 0, "zero volts")
        self.finish()

    def config_of(self, command, name="own.toml", more=""):
        """own.toml with another command, a TOML value, here."""
        with open(CONFIG, encoding="utf-8") as file:
            text = file.read()
        text = text.replace("../../config", stack.CONFIG)
        changed, count = re.subn(r'(?m)^command = .*$', lambda _: f"command = {command}\n{more}", text)
        self.assertEqual(count, 1)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(changed)
        return self.path(name)

    def script(self, name, text, mode=0o755):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path(name), mode)
        return self.path(name)

    def variant(self, name, old, new):
        """pid.py with a change, here."""
        with open(PID, encoding="utf-8") as file:
            text = file.read()
        self.assertIn(old, text)
        return self.script(name, text.replace(old, new))

    def lockstep(self, config, name, disturb=None):
        launch = self.launch(config, "--time", "lockstep", "--duration", "1.2", "--log", self.path(name))
        if disturb:
            self.log = stack.LiveLog(self, self.path(name))
            disturb()
        self.assertEqual(launch.wait(60), 0, launch.report())
        return self.path(name)

    def pid_of_own(self):
        return self.log.wait_for("HYDRO_PROCESS_STATUS", lambda s: s.role == "position_ctrl", "the loop").pid

    # Tests that hydro-launch starts it, that its runs in lockstep are identical, even when it stands still
    # for a while and the plant asks again, and that a replay through it gives what was recorded.
    def test_launched_in_lockstep(self):
        def hang():
            self.log.wait_for_tick(50)
            pid = self.pid_of_own()
            os.kill(pid, signal.SIGSTOP)
            before = self.log.count("HYDRO_STATE")
            self.wait_until(lambda: self.log.count("HYDRO_STATE") >= before + 3, "the plant asks again")
            os.kill(pid, signal.SIGCONT)

        a = self.lockstep(CONFIG, "a.lcmlog")
        b = self.lockstep(CONFIG, "b.lcmlog", hang)
        self.assert_identical(a, b)
        self.assertLess(abs(event_log.Log(a).states[-1].arm_angle - TARGET), 0.02)
        summary = self.run_program("hydro-log", "summary", a).stdout
        self.assertRegex(summary, r"(?i)step.*0\.3")
        self.assertIn('command = ["./pid.py"]', event_log.Log(a).of("HYDRO_RUN")[0].config_text)

        replay = self.run_program("hydro-log", "replay", "--controller", PID, a)
        self.assertEqual(replay.stdout, f"{PID}: identical, 241 pressure commands from 1201 states\n")
        ours = self.run_program("hydro-log", "replay", a)
        self.assertRegex(ours.stdout, r"pressure: identical, .*\nposition: not replayed: the run had \./pid\.py \(position_ctrl\)")
        other = self.variant("other.py", "6000.0", "6001.0")
        self.assertRegex(self.run_program("hydro-log", "replay", "--controller", other, a, expect=1).stdout,
                         r"other\.py: differ at tick \d+: HYDRO_PRESSURE_COMMAND\.pressure_ref: ")
        dies = self.variant("dies.py", "    asked =", "    if state.tick == 100: sys.exit(3)\n    asked =")
        self.assertRegex(self.run_program("hydro-log", "replay", "--controller", "./dies.py", a, expect=1).stderr,
                         r"hydro-log: \./dies\.py ended with exit code 3 before it could answer tick 100\n")
        self.assertEqual(dies, self.path("dies.py"))
        self.variant("hangs.py", "    asked =", "    while state.tick == 100: pass\n    asked =")
        self.assertEqual(self.run_program("hydro-log", "replay", "--controller", "./hangs.py", "--timeout", "0.5", a, expect=1).stderr,
                         "hydro-log: ./hangs.py did not answer tick 100 within 0.5 s\n")
        wrong = self.run_program("hydro-log", "replay", "--controller", PID, "--role", "pressure_ctrl", a, expect=1)
        self.assertIn("takes part as position_ctrl, and pressure_ctrl is replayed", wrong.stderr)
        self.assertIn('--controller: found "./no.py", and there is no program',
                      self.run_program("hydro-log", "replay", "--controller", "./no.py", a, expect=2).stderr)

    # Tests that in real time it moves the arm, that its lines carry its role, and that the run replays.
    def test_launched_in_real_time(self):
        says = self.variant("says.py", "bus = ", 'print("hello", flush=True)\nbus = ')
        launch = self.launch(self.config_of('["./says.py"]'), *PACE, "--duration", "1.5", "--log", self.path("run.lcmlog"))
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertRegex(launch.stdout, r"(?m)^\[position_ctrl\] hello$")
        self.assertRegex(launch.stdout, "all 4 processes ready")
        self.assertLess(abs(event_log.Log(self.path("run.lcmlog")).states[-1].arm_angle - TARGET), 0.02)
        replay = self.run_program("hydro-log", "replay", "--controller", says, self.path("run.lcmlog"))
        answers = sum(not c.open_loop for c in event_log.Log(self.path("run.lcmlog")).pressure_commands)  # fewer where ticks were skipped
        self.assertGreater(answers, 100)
        self.assertIn(f": identical, {answers} pressure commands from ", replay.stdout)

    # Tests that our loop's values can be changed as soon as the stack is ready, and that changes of the
    # foreign loop's values are refused with the reason.
    def test_tuning(self):
        config = self.config_of(f'["{sys.executable}", "-B", "{PID}"]')
        launch = self.launch(config, "--duration", "0", "--log", self.path("run.lcmlog"))
        launch.wait_for("processes ready")
        ours = self.start("hydro-set", config, "--set", f"bus.url={self.url}", "pressure.natural_frequency_rad_s=90")
        self.assertEqual(ours.wait(), 0, ours.report())
        own = self.start("hydro-set", config, "--set", f"bus.url={self.url}", "position.c2=400")
        self.assertEqual(own.wait(), 1, own.report())
        self.assertIn("position_ctrl does not take part in tuning", own.stderr)
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(), 0, launch.report())

    # Tests that the run ends at zero volts, with 1 and a reason, when it is killed, fails, or leaves, and
    # that the processes that it has started end with it.
    def test_launched_dies(self):
        fails = self.variant("fails.py", "    asked =", "    if state.tick >= 200: 1 / 0\n    asked =")
        leaves = self.variant("leaves.py", "    asked =", "    if state.tick >= 200: os._exit(0)\n    asked =")
        with open(leaves, encoding="utf-8") as file:
            text = file.read()
        self.script("leaves.py", text.replace("import sys", "import os\nimport sys"))
        self.script("child.py", "#!/bin/sh\n" + f"{sys.executable} -B {PID} &\nwait\nexit 0\n")
        cases = (("./killed.py", r"killed\.py \(position_ctrl\) was killed by signal 9 \(SIGKILL\)"),
                 ("./fails.py", r"fails\.py \(position_ctrl\) ended with exit code 1: ZeroDivisionError: division by zero"),
                 ("./leaves.py", r"leaves\.py \(position_ctrl\) ended though nobody"))
        self.variant("killed.py", "    asked =", "    if state.tick >= 200: os.kill(os.getpid(), 9)\n    asked =")
        with open(self.path("killed.py"), encoding="utf-8") as file:
            text = file.read()
        self.script("killed.py", text.replace("import sys", "import os\nimport sys"))
        self.assertTrue(fails)
        for number, (command, said) in enumerate(cases):
            log = self.path(f"{number}.lcmlog")
            launch = self.launch(self.config_of(f'["{command}"]'), "--log", log)
            self.assertEqual(launch.wait(60), 1, launch.report())
            self.assertRegex(launch.stderr, said)
            self.assertRegex(launch.stdout, "the output reads back 0 V")
            self.assertEqual(event_log.Log(log).of("HYDRO_MOTOR_COMMAND")[-1].voltage, 0)

    # Tests that a script that starts the loop is watched as the loop itself is, and that no process of it is
    # left when it is killed.
    def test_launched_by_a_script(self):
        self.script("start.sh", f'#!/bin/sh\n{sys.executable} -B "{PID}"\nexit $?\n')
        config = self.config_of('["./start.sh"]')
        launch = self.launch(config, "--duration", "0", "--log", self.path("run.lcmlog"))
        launch.wait_for("all 4 processes ready")
        self.log = stack.LiveLog(self, self.path("run.lcmlog"))
        loop = self.pid_of_own()
        with open(f"/proc/{loop}/stat", encoding="utf-8") as file:
            script = int(file.read().rsplit(") ", 1)[1].split()[1])
        self.log.wait_for_tick(100)
        os.kill(script, signal.SIGKILL)
        self.assertEqual(launch.wait(60), 1, launch.report())
        self.assertIn("./start.sh (position_ctrl) was killed by signal 9", launch.stderr)
        self.wait_until(lambda: not os.path.exists(f"/proc/{loop}"), "the loop has ended")

    # Tests that a controller that is never ready is named, and that one that does not end is killed.
    def test_launched_hangs(self):
        launch = self.launch(self.config_of('["sleep", "60"]'), "--set", "time.start_timeout_s=3.5")  # for the others, on a busy computer
        self.assertEqual(launch.wait(60), 1, launch.report())
        self.assertRegex(launch.stderr, r"not ready (within|after) 3\.\d+ s \(time\.start_timeout_s\): (sleep 60 \()?position_ctrl")
        text = "sys.exit(hydro_bus.Loop("
        self.variant("deaf.py", text, "import signal, threading\nhydro_bus.Loop._on_signal = lambda *_: None\n"
                                     "hydro_bus.Loop._on_stop = lambda *_: None\n" + text)
        launch = self.launch(self.config_of('["./deaf.py"]'), "--duration", "0.2", "--log", self.path("run.lcmlog"))
        self.assertEqual(launch.wait(60), 1, launch.report())
        self.assertIn("./deaf.py (position_ctrl) did not end on SIGTERM and was killed", launch.stderr)

    # Tests that anything that cannot be started is refused before any process starts.
    def test_launched_wrongly(self):
        self.script("plain.py", "", 0o644)
        for command, more, said in (
                ('["./none.py"]', "", r'own\.toml:\d+: process\.command: found "\./none\.py", and there is no program .*/none\.py, allowed'),
                ('["none"]', "", r'found "none", which is not on PATH, allowed'),
                ('["plain.py"]', "", r'found "plain\.py", which is not on PATH, allowed "\./plain\.py"'),
                ('["./plain.py"]', "", r'found "\./plain\.py", which may not be executed, allowed .* `chmod \+x '),
                ('"./plain.py"', "", r'process\.command: found "\./plain\.py", allowed the program and its arguments as a list'),
                ('[]', "", r"process\.command: found no program"),
                ('["./plain.py"]', 'program = "hydro-plant"', r"process\.command: found it beside program"),
                ('["./plain.py"]', "lock_memory = true", r"process\.lock_memory: found it beside command")):
            launch = self.launch(self.config_of(command, more=more), "--log", self.path("none.lcmlog"))
            self.assertEqual(launch.wait(), 2, launch.report())
            self.assertRegex(launch.stderr, said)
            self.assertEqual(launch.stderr.count("\n"), 1)
            self.assertFalse(os.path.exists(self.path("none.lcmlog")))
        self.script("noline.py", "print()\n")
        launch = self.launch(self.config_of('["./noline.py"]'))
        self.assertEqual(launch.wait(), 2, launch.report())
        self.assertRegex(launch.stderr, "noline.py: cannot be started: Exec format error; a script needs a first line such as #!")

    # Tests that a simulation without processes says that it runs our loop, and its log says so too.
    def test_simulated(self):
        sim = self.run_program("hydro-sim", CONFIG, "--duration", "0.1", "-o", self.path("sim.lcmlog"))
        self.assertRegex(sim.stderr, r"warning: .*own\.toml:\d+: \./pid\.py \(position_ctrl\) is a program of your own; the simulation runs our")
        self.assertNotIn("pid.py", event_log.Log(self.path("sim.lcmlog")).of("HYDRO_RUN")[0].config_text)
        replay = self.run_program("hydro-log", "replay", self.path("sim.lcmlog"))
        self.assertRegex(replay.stdout, r"position: identical, 21 ")

    # Tests that the skeleton runs at once, and never overwrites existing work.
    def test_new_controller(self):
        made = self.run_program("hydro-launch", "new-controller", "mine")
        self.assertIn("hydro-launch mine.toml --duration 3 --log mine.lcmlog", made.stdout)
        log = self.lockstep(self.path("mine.toml"), "mine.lcmlog")
        self.assertLess(abs(event_log.Log(log).states[-1].arm_angle - TARGET), 0.02)
        replay = self.run_program("hydro-log", "replay", "--controller", "./mine.py", log)
        self.assertIn("./mine.py: identical, 241 ", replay.stdout)
        os.remove(self.path("mine.py"))
        again = self.run_program("hydro-launch", "--new-controller", "mine", expect=2)
        self.assertEqual(again.stderr, "hydro-launch: mine.toml: is there already and is not overwritten; give another name, or move it away\n")
        self.assertFalse(os.path.exists(self.path("mine.py")))
        self.assertIn('found "a/b", allowed a name of at most 64 letters', self.run_program("hydro-launch", "new-controller", "a/b", expect=2).stderr)

    # Tests a pressure loop of the user's own: two lockstep runs are identical, and the replay uses what it
    # had heard.
    def test_pressure_loop(self):
        self.script("pressure.py", """#!/usr/bin/env python3
import sys
import hydro_bus
from hydro import motor_command_t

def answer(state, command):
    asked = command.pressure_ref - (state.p2 - state.p1)
    command.voltage = max(-5.0, min(5.0, 0.05 * asked - 0.02 * state.motor_speed))
    if loop.asked and loop.asked.tick >= state.tick:
        raise ValueError(f"a command of tick {loop.asked.tick} at tick {state.tick}")

loop = hydro_bus.Loop(hydro_bus.Bus(), "pressure_ctrl", "HYDRO_MOTOR_COMMAND", motor_command_t, answer)
sys.exit(loop.run())
""")
        config = self.config_of('["./pressure.py"]')
        with open(config, encoding="utf-8") as file:
            text = file.read()
        with open(config, "w", encoding="utf-8") as file:
            file.write(text.replace("position_ctrl", "pressure_ctrl").replace("hydro-pressure-ctrl", "hydro-position-ctrl"))
        a, b = self.lockstep(config, "a.lcmlog"), self.lockstep(config, "b.lcmlog")
        self.assert_identical(a, b)
        commands = event_log.Log(a).of("HYDRO_MOTOR_COMMAND")
        self.assertEqual([c.pressure_command_tick for c in commands[:8]], [-1, 0, 0, 0, 0, 0, 5, 5])
        self.assertEqual((commands[-1].voltage, commands[-1].status), (0, 3))
        replay = self.run_program("hydro-log", "replay", "--controller", "./pressure.py", a)
        self.assertEqual(replay.stdout, "./pressure.py: identical, 1201 motor commands from 1201 states\n")
        self.check_pressure_loop_in_cpp(config, a)

    def check_pressure_loop_in_cpp(self, config, log):
        """The example in C++, of the same law, commands what the one in Python did, replays it, and runs in real time."""
        built = os.path.join(TOOLS, "own_pressure")
        self.assertTrue(os.path.exists(built), f"{built}: cmake --build build --target own_pressure")
        with open(config, encoding="utf-8") as file:
            text = file.read()
        self.assertIn('["./pressure.py"]', text)
        with open(config, "w", encoding="utf-8") as file:
            file.write(text.replace('["./pressure.py"]', f'["{built}"]'))
        commands, theirs = ([(c.tick, c.voltage, c.status, c.pressure_ref, c.pressure_command_tick) for c in event_log.Log(name).of("HYDRO_MOTOR_COMMAND")]
                            for name in (self.lockstep(config, "cpp.lcmlog"), log))
        self.assertEqual(commands[:-1], theirs[:-1])  # the last one, of zero volts, names no reference
        self.assertEqual(commands[-1][1:3], (0, 3))
        replay = self.run_program("hydro-log", "replay", "--controller", built, log)
        self.assertIn("identical, 1201 motor commands from ", replay.stdout)
        launch = self.launch(config, *PACE, "--duration", "1.5", "--log", self.path("run.lcmlog"))
        self.assertEqual(launch.wait(60), 0, launch.report())
        angle = event_log.Log(self.path("run.lcmlog")).states[-1].arm_angle
        self.assertLess(abs(angle - event_log.Log(log).states[-1].arm_angle), 0.05)

    def loop_on(self, role, channel, type_name, answer, **more):
        """A Loop of hydro_bus on a bus that is a list of what was published, and what hands it a message."""
        sys.path[:0] = PYTHON.split(os.pathsep)
        self.addCleanup(lambda: [sys.path.remove(folder) for folder in PYTHON.split(os.pathsep)])
        hydro_bus, hydro = importlib.import_module("hydro_bus"), importlib.import_module("hydro")
        published, handlers = [], {}

        class ListedBus:
            def subscribe(self, channel, _type, handler):
                handlers[channel] = handler

            def publish(self, channel, message):
                published.append((channel, message))

        loop = hydro_bus.Loop(ListedBus(), role, channel, getattr(hydro, type_name), answer, **more)

        def hear(channel, type_name, **fields):
            message = getattr(hydro, type_name)()
            for name, value in fields.items():
                setattr(message, name, value)
            handlers[channel](message)
            return [m for c, m in published if c != "HYDRO_PROCESS_STATUS"]

        return loop, hear

    # Tests that while an open-loop command is in force a pressure loop passes its voltage on, and calls
    # answer() again after it.
    def test_open_loop(self):
        asked = []

        def answer(state, command):
            asked.append(state.tick)
            command.voltage = 1.0

        _, hear = self.loop_on("pressure_ctrl", "HYDRO_MOTOR_COMMAND", "motor_command_t", answer)
        hear("HYDRO_STATE", "state_t", session=7, tick=0)
        hear("HYDRO_PRESSURE_COMMAND", "pressure_command_t", tick=0, open_loop=True, voltage=-2.5)
        hear("HYDRO_STATE", "state_t", session=7, tick=1)
        hear("HYDRO_PRESSURE_COMMAND", "pressure_command_t", tick=1, pressure_ref=3.0)
        sent = hear("HYDRO_STATE", "state_t", session=7, tick=2)
        self.assertEqual([(c.voltage, c.status, c.pressure_command_tick) for c in sent], [(1.0, 0, -1), (-2.5, 1, 0), (1.0, 0, 1)])
        self.assertEqual(asked, [0, 2])

    # Tests that a stale pressure command gives zero volts, and then a fault that ends with the next good
    # command.
    def test_stale_command(self):
        os.environ["HYDRO_STALE_TICKS"] = "3"
        self.addCleanup(lambda: os.environ.pop("HYDRO_STALE_TICKS"))

        def answer(state, command):
            command.voltage = 1.0

        _, hear = self.loop_on("pressure_ctrl", "HYDRO_MOTOR_COMMAND", "motor_command_t", answer)
        hear("HYDRO_PRESSURE_COMMAND", "pressure_command_t", tick=0, open_loop=True, voltage=2.0)
        for tick in range(6):
            hear("HYDRO_STATE", "state_t", session=7, tick=tick)
        hear("HYDRO_PRESSURE_COMMAND", "pressure_command_t", tick=5)
        sent = hear("HYDRO_STATE", "state_t", session=7, tick=6)
        commands = [(c.voltage, c.status) for c in sent if hasattr(c, "voltage")]
        self.assertEqual(commands, [(1.0, 0), (2.0, 1), (2.0, 1), (2.0, 1), (0.0, 2), (0.0, 2), (1.0, 0)])
        faults = [(number, m.tick, m.code, m.active, m.value, m.limit) for number, m in enumerate(sent) if hasattr(m, "latched")]
        self.assertEqual(faults, [(5, 4, "stale_pressure_command", True, 4.0, 3.0), (8, 6, "stale_pressure_command", False, 1.0, 3.0)])

    # Tests that in lockstep a state that overtook the command it needs is answered when the command comes, as
    # if it had come in time.
    def test_overtaken_command(self):
        os.environ.update(HYDRO_TIME="lockstep", HYDRO_POSITION_EVERY="2", HYDRO_COMMAND_DELAY="1")
        self.addCleanup(lambda: [os.environ.pop(name) for name in ("HYDRO_TIME", "HYDRO_POSITION_EVERY", "HYDRO_COMMAND_DELAY")])
        _, hear = self.loop_on("pressure_ctrl", "HYDRO_MOTOR_COMMAND", "motor_command_t", lambda state, command: None)
        self.assertEqual(len(hear("HYDRO_STATE", "state_t", session=7, tick=0)), 1)
        self.assertEqual(len(hear("HYDRO_STATE", "state_t", session=7, tick=1)), 1)
        self.assertEqual(len(hear("HYDRO_STATE", "state_t", session=7, tick=1)), 1)  # asked again
        sent = hear("HYDRO_PRESSURE_COMMAND", "pressure_command_t", tick=0, pressure_ref=4.0)
        self.assertEqual([(c.tick, c.pressure_ref) for c in sent], [(0, 0.0), (1, 4.0)])
        self.assertEqual(len(hear("HYDRO_STATE", "state_t", session=7, tick=2)), 3)  # the command of tick 0 is in force still
        self.assertEqual(len(hear("HYDRO_STATE", "state_t", session=7, tick=3)), 3)

    # Tests that a reference is published before its answer, and that the author of an answer() that returns
    # its command is told what to do.
    def test_reference_and_returned_value(self):
        _, hear = self.loop_on("position_ctrl", "HYDRO_PRESSURE_COMMAND", "pressure_command_t", lambda state, command: None, every=2,
                               reference=lambda state: state.tick / 10)
        for tick in range(3):
            sent = hear("HYDRO_STATE", "state_t", session=7, tick=tick)
        self.assertEqual([type(m).__name__ for m in sent], ["arm_reference_t", "pressure_command_t"] * 2)
        self.assertEqual((sent[2].tick, sent[2].sequence, sent[2].value), (2, 1, 0.2))
        _, hear = self.loop_on("position_ctrl", "HYDRO_PRESSURE_COMMAND", "pressure_command_t", lambda state, command: 4.0)
        with self.assertRaisesRegex(TypeError, r"returned a value.*fills in the command"):
            hear("HYDRO_STATE", "state_t", session=7, tick=0)

    def check_example(self, command):
        """In lockstep twice identical and with pid.py's answers, and in real time."""
        config = self.config_of(command)
        a, b = self.lockstep(config, "a.lcmlog"), self.lockstep(config, "b.lcmlog")
        self.assert_identical(a, b)
        self.run_program("hydro-log", "replay", "--controller", PID, a)
        launch = self.launch(config, *PACE, "--duration", "1.5", "--log", self.path("run.lcmlog"))
        self.assertEqual(launch.wait(60), 0, launch.report())
        log = event_log.Log(self.path("run.lcmlog"))
        self.assertLess(abs(log.states[-1].arm_angle - TARGET), 0.02)
        self.assertEqual([f for f in log.faults if f.code.startswith(("second_", "undecodable", "excessive", "nonfinite", "future"))], [])
        return a

    # Tests the example in C++. A replay through it also gives what was recorded.
    def test_cpp(self):
        built = os.path.join(TOOLS, "own_pd")
        if not os.path.exists(built):
            self.skipTest(f"needs {built}: cmake --build build --target own_pd")
        log = self.check_example(f'["{built}"]')
        self.assertIn("identical, 241 ", self.run_program("hydro-log", "replay", "--controller", built, log).stdout)

    # Tests the examples in Octave: in the loop, and on a recorded run by exchange of files.
    def test_octave(self):
        if not shutil.which("octave-cli"):
            self.skipTest("needs octave-cli: apt-get install octave")
        octave = os.path.join(EXAMPLE, "octave")
        log = self.check_example(f'["{octave}/octave_loop.py", "pd_law"]')
        for name in (log, self.path("run.lcmlog")):
            table = name.replace(".lcmlog", ".csv")
            self.run_program("hydro-log", "export", name, "-o", table)
            check = self.start(shutil.which("octave-cli"), "--quiet", "--no-init-file", os.path.join(octave, "check_law.m"), table)
            code = check.wait(60)
            if name == log:
                self.assertEqual((code, check.stdout), (0, "identical: 240 commands\n"), check.report())
            else:  # in real time a command may come after the next one is due
                self.assertRegex(check.stdout, r"^(identical: \d+|\d+ of \d+) commands")

    # Tests wrong usage of the module.
    def test_wrong_url(self):
        own = self.start(sys.executable, "-B", PID, "udp://1.2.3.4:5")
        self.assertEqual(own.wait(), 1)
        self.assertIn('found url "udp://1.2.3.4:5", allowed is e.g. "udpm://', own.stderr)

    # Tests that it and LCM's own programs understand each other, in messages of one packet and of many.
    def test_lcms_own_programs(self):
        logger, player = shutil.which("lcm-logger"), shutil.which("lcm-logplayer")
        if not logger or not player:
            self.skipTest("needs lcm-logger and lcm-logplayer: apt-get install liblcm-bin")
        sys.path[:0] = PYTHON.split(os.pathsep)
        self.addCleanup(lambda: [sys.path.remove(folder) for folder in PYTHON.split(os.pathsep)])
        hydro_bus, hydro = importlib.import_module("hydro_bus"), importlib.import_module("hydro")
        bus = hydro_bus.Bus(self.url)
        self.addCleanup(bus.close)
        sent = []
        for length in (10, 65_000, 65_600, 300_000):
            message = hydro.run_description_t()
            message.config_text = "".join(chr(97 + k % 26) for k in range(length))
            sent.append(message)
        recorder = self.start(logger, "--lcm-url=" + self.url, "--flush-interval=50", self.path("lcm.log"))

        def recorded():
            if not os.path.exists(self.path("lcm.log")):
                return set()
            return {e.data for e in event_log.read_events(self.path("lcm.log"), torn_tail=True) if e.channel == "OWN"}

        def all_arrive():  # once the recorder has subscribed
            for message in sent:
                bus.publish("OWN", message)
            time.sleep(0.1)  # of sending alone nothing would come
            return {m.encode() for m in sent} <= recorded()

        self.wait_until(all_arrive, "lcm-logger has written all four messages")
        recorder.send(signal.SIGINT)
        recorder.wait()

        received = []
        bus.subscribe("OWN", hydro.run_description_t, lambda m: received.append(m.config_text))
        play = threading.Thread(target=lambda: self.start(player, "--lcm-url=" + self.url, self.path("lcm.log")).wait())
        while bus.handle(0):  # its own, from before
            pass
        received.clear()
        play.start()
        self.wait_until(lambda: (bus.handle(0.05), {len(text) for text in received} >= {10, 65_000, 65_600, 300_000})[1], "lcm-logplayer's messages")
        play.join()
        self.assertLessEqual(set(received), {m.config_text for m in sent})


if __name__ == "__main__":
    outcome.main()
