"""Rows of docs/safety.md: HYDRO_STOP, from any program and from hydro-launch --stop."""

import os
import signal
import struct
import subprocess
import threading

import event_log
import fault_case
import lcm_peer
import outcome
import stack


class StopTest(fault_case.FaultCase):
    def check_stopped(self, source):
        for role in ("plant", "pressure_ctrl", "position_ctrl", "logger"):
            self.assertEqual(self.run_[role].wait(), 0, self.run_[role].report())
        log = event_log.Log(self.log_file)
        stop = log.stops[0]
        self.assertEqual(stop.source, source)
        # States that the plant sent after the stop had arrived at the logger. They have zero volts, or there
        # are none.
        first = next(n for n, (kind, _) in enumerate(log.items) if kind == "HYDRO_STOP")
        after = [m for kind, m in log.items[first:] if kind == "HYDRO_STATE"]
        print(f"{self.id().split('.')[-1]}: {len(after)} states after the stop", flush=True)
        self.assertLessEqual(len(after), fault_case.ZERO_WITHIN)
        last = log.motor_commands[-1]
        self.assertEqual((last.status, last.voltage), (event_log.STOPPED, 0))
        return log

    # Tests that any program's HYDRO_STOP ends the run in order.
    def test_any_program(self):
        self.start_stack()
        self.wait_for_voltage()
        self.peer().publish("HYDRO_STOP", source="somebody", reason="enough", session=99)
        self.check_stopped("somebody")

    # Tests that hydro-launch --stop ends a stack that was started by hand, and waits until it has ended.
    def test_stop_by_hand(self):
        self.start_stack()
        self.wait_for_voltage()
        stopper = self.run_program("hydro-launch", *self.run_.arguments, "--stop")
        self.assertRegex(stopper.stdout, "stopped: 4 processes have ended")
        self.check_stopped("launch")

    # Tests that it ends a stack under hydro-launch, which then ends with 0.
    def test_stop_launched(self):
        launch = self.launch(self.moving(), "--duration", "0", "--log", self.log_file)
        stack.LiveLog(self, self.log_file).wait_for_tick(200)
        stopper = self.run_program("hydro-launch", self.moving(), "--set", f"bus.url={self.url}", "--stop")
        self.assertRegex(stopper.stdout, "stopped: 4 processes have ended")
        self.assertEqual(launch.wait(), 0, launch.report())
        self.assertRegex(launch.stdout, "stopped by launch: hydro-launch --stop")

    # Tests that --stop ends a stack while packets arrive that liblcm's own receiver does not survive, and
    # that the launcher and the doctor survive them too.
    def test_stop_among_poisoned_packets(self):
        launch = self.launch(self.moving(), "--duration", "0", "--log", self.log_file)
        stack.LiveLog(self, self.log_file).wait_for_tick(50)
        channel = b"HYDRO_PROCESS_STATUS\0"
        first = struct.pack(">4sIIIHH", b"LC03", 1, 4096, 0, 0, 3) + channel + b"A" * 32
        second = struct.pack(">4sIIIHH", b"LC03", 1, 4096, 0xFFFFFF00, 1, 3) + b"B" * 512
        peer, stop = lcm_peer.Peer(self.url, {}), threading.Event()

        def poison():
            while not stop.wait(0.005):
                peer.publish_packet(first)
                peer.publish_packet(second)
        sender = threading.Thread(target=poison)
        sender.start()
        try:
            doctor = self.launch(self.moving(), "--doctor")
            self.assertIn(doctor.wait(), (0, 1), doctor.report())
            stopper = self.run_program("hydro-launch", self.moving(), "--set", f"bus.url={self.url}", "--stop")
            self.assertRegex(stopper.stdout, "stopped: 4 processes have ended")
            self.assertEqual(launch.wait(), 0, launch.report())
        finally:
            stop.set()
            sender.join()
            peer.close()

    # Tests that a logger that is killed takes its stack with it, unless the configuration says that it is not
    # required.
    def test_logger_is_killed(self):
        for required in ("true", "false"):
            with self.subTest(required):
                log_file = self.path(f"{required}.lcmlog")
                launch = self.launch(self.moving(), "--duration", "0", "--log", log_file, "--set", f"logger.required={required}",
                                     url=self.new_url())
                stack.LiveLog(self, log_file).wait_for_tick(100)
                children = subprocess.run(["pgrep", "-P", str(launch.child.pid), "-a"], capture_output=True, text=True, check=True)
                logger = next(line for line in children.stdout.splitlines() if "hydro-logger" in line)
                os.kill(int(logger.split()[0]), signal.SIGKILL)
                if required == "false":
                    launch.wait_for("the run goes on .logger.required = false.")
                    launch.send(signal.SIGINT)
                self.assertEqual(launch.wait(), 1, launch.report())
                self.assertEqual("stopped by SIGINT" in launch.stdout, required == "false", launch.report())

    # Tests that a suspended launcher (Ctrl-Z at its terminal) leaves no motor running unwatched: zero volts
    # until it continues, and then a reference that starts from the arm's position.
    def test_launcher_is_suspended(self):
        launch = self.launch(self.moving(), "--duration", "0", "--log", self.log_file, "--set", "limits.stale_supervisor_s=0.5",
                             "--set", f"limits.stale_input_s={fault_case.STALE}")
        self.log = stack.LiveLog(self, self.log_file)
        self.wait_for_voltage()
        launch.send(signal.SIGSTOP)
        fault = self.wait_for_fault("supervisor_gone", source="plant")
        self.assertRegex(fault.text, "hydro-launch, which started this process, has not been heard .*Ctrl-Z")
        self.wait_for_states(200)
        launch.send(signal.SIGCONT)
        self.wait_for_fault("supervisor_gone", active=False)
        self.wait_for_voltage()
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(), 0, launch.report())
        log = event_log.Log(self.log_file)
        self.assert_zero_during(log, "supervisor_gone", "plant")
        held = [s.tick for s in log.states if fault.tick < s.tick and s.command_tick == -1]
        back = [r for r in log.arm_references if r.tick > held[-1]][0]
        arm = next(s.arm_angle for s in log.states if s.tick == back.tick)
        self.assertAlmostEqual(back.value, arm, delta=0.005)

    # Tests that it says so when there is no stack, with exit code 1, and that it cannot be combined with
    # --rearm.
    def test_nobody(self):
        arguments = (stack.config("demo.toml"), "--set", f"bus.url={self.url}")
        nobody = self.run_program("hydro-launch", *arguments, "--stop", expect=1)
        self.assertRegex(nobody.stderr, "no process of a stack is heard on udpm:")
        both = self.run_program("hydro-launch", *arguments, "--stop", "--rearm", expect=2)
        self.assertRegex(both.stderr, "--stop: found --rearm beside it")


if __name__ == "__main__":
    outcome.main()
