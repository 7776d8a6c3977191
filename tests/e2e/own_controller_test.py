"""A controller of one's own: examples/own_controller/pid.py in the place of hydro-position-ctrl, and the module that it stands on."""

import importlib
import os
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
# The module and the types that lcm-gen made: of the sources and their build folder, or installed.
PYTHON = os.environ.get("HYDRO_PYTHON", os.pathsep.join([os.path.join(ROOT, "python"), os.path.join(os.path.dirname(stack.BIN), "generated", "python")]))
EXAMPLE = os.path.join(os.environ.get("HYDRO_EXAMPLES", os.path.join(ROOT, "examples")), "own_controller")
PID, CONFIG = os.path.join(EXAMPLE, "pid.py"), os.path.join(EXAMPLE, "own.toml")
TARGET = 0.3  # rad, of pid.py


class OwnControllerTest(fault_case.FaultCase):
    def setUp(self):
        super().setUp()
        os.environ["PYTHONPATH"] = PYTHON

    def start_own(self):
        return self.start(sys.executable, "-B", PID, self.url, label="pid.py")

    # Tests that it moves the arm to its target in real time, without a fault of the loops, and ends with the run.
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

    # Tests that it is killed without harm: what it asked for last goes to zero, and the voltage with it.
    def test_killed(self):
        own = self.start_own()
        self.start_stack(config=CONFIG, roles=("logger", "pressure_ctrl"))
        self.run_.start("plant", "--expect", "logger")
        self.wait_for_voltage()
        own.kill()
        self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        self.log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.SAFE and c.voltage == 0, "zero volts")
        self.finish()

    def lockstep(self, name, disturb=None):
        launch = self.launch(CONFIG, "--time", "lockstep", "--duration", "1.2", "--log", self.path(name))
        own = self.start_own()
        if disturb:
            disturb(own)
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertEqual(own.wait(), 0, own.report())
        return self.path(name)

    # Tests that in lockstep its runs are identical, also when it stands still meanwhile and the plant asks again.
    def test_lockstep(self):
        def hang(own):
            self.log = stack.LiveLog(self, self.path("b.lcmlog"))
            self.log.wait_for_tick(50)
            own.send(signal.SIGSTOP)
            self.log.update()
            before = self.log.count("HYDRO_STATE")
            self.wait_until(lambda: (self.log.update(), self.log.count("HYDRO_STATE") >= before + 3)[1], "the plant asks again")
            own.send(signal.SIGCONT)

        a = self.lockstep("a.lcmlog")
        b = self.lockstep("b.lcmlog", hang)
        self.assert_identical(a, b)
        self.assertLess(abs(event_log.Log(a).states[-1].arm_angle - TARGET), 0.02)

    # Tests wrong usage of the module.
    def test_wrong_url(self):
        own = self.start(sys.executable, "-B", PID, "udp://1.2.3.4:5")
        self.assertEqual(own.wait(), 1)
        self.assertIn('found url "udp://1.2.3.4:5", allowed is e.g. "udpm://', own.stderr)

    # Tests that LCM's own programs understand it, and it them, in messages of one packet and of many.
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
