"""Row of docs/safety.md: the network cable between two hosts comes out and goes in again.

Two network namespaces are the hosts, a third the switch between them: plant, pressure loop and a logger on one, position
loop and another logger on the other. Needs root; skipped, saying so, where namespaces or bridges cannot be made.
"""

import os
import shutil
import signal
import subprocess

import event_log
import fault_case
import outcome
import stack
from fault_case import RATE, STALE

RIG, DESK, SWITCH = (f"hyf{letter}{os.getpid()}" for letter in "rds")
URL = "udpm://239.255.76.67:7667?ttl=1"  # in namespaces of our own any port is free
RAMP = 200  # ticks, the default of limits.pressure_ramp_s


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)


class NetworkTest(fault_case.FaultCase):
    def setUp(self):
        super().setUp()
        if shutil.which("ip") is None:
            self.skipTest("needs ip (package iproute2)")
        try:
            self.make_network()
        except subprocess.CalledProcessError as error:
            self.skipTest(f"network namespaces cannot be made here: {error.stderr.strip()}")

    def make_network(self):
        for name in (RIG, DESK, SWITCH):
            ip("netns", "add", name)
            self.addCleanup(subprocess.run, ["ip", "netns", "del", name], capture_output=True)
        ip("-n", SWITCH, "link", "add", "br0", "type", "bridge", "mcast_snooping", "0")
        ip("-n", SWITCH, "link", "set", "br0", "up")
        for number, (name, port) in enumerate(((RIG, "rig"), (DESK, "desk")), start=1):
            ip("link", "add", "veth0", "netns", name, "type", "veth", "peer", "name", port, "netns", SWITCH)
            ip("-n", SWITCH, "link", "set", port, "master", "br0", "up")
            ip("-n", name, "link", "set", "lo", "up")
            ip("-n", name, "addr", "add", f"10.98.0.{number}/24", "dev", "veth0")
            ip("-n", name, "link", "set", "veth0", "up")
            ip("-n", name, "route", "add", "224.0.0.0/4", "dev", "veth0")

    def start_on(self, namespace, role, *more):
        argv = ["ip", "netns", "exec", namespace, stack.program(stack.PROGRAMS[role]), *self.arguments, *more]
        process = stack.Process(argv, self.folder, f"{role} in {namespace}")
        self.processes.append(process)
        return process

    def start_hosts(self):
        # A logger that has heard nothing new sends nothing, and counts as gone when it has been silent for a
        # while.
        self.arguments = [self.moving(), "--set", f"bus.url={URL}", "--time", "realtime", "--duration", "0", "--set",
                          f"limits.stale_input_s={STALE}", "--set", "limits.stale_logger_s=0.5"]
        self.rig = [self.start_on(RIG, "logger", "-o", self.log_file), self.start_on(RIG, "pressure_ctrl")]
        self.desk = [self.start_on(DESK, "position_ctrl"),
                     self.start_on(DESK, "logger", "-o", self.path("desk.lcmlog"))]
        for process in self.desk:
            self.wait_until(lambda p=process: p.running, "a process")
        desk_log = stack.LiveLog(self, self.path("desk.lcmlog"))
        # Both loggers are there before the plant starts.
        desk_log.wait_for("HYDRO_PROCESS_STATUS", lambda s: s.role == "logger" and s.state == event_log.READY, "a logger")
        self.plant = self.start_on(RIG, "plant", "--expect", "logger")
        self.log = stack.LiveLog(self, self.log_file)
        self.log.wait_for_tick(500)
        self.wait_for_voltage()

    def cable_out_and_in(self, out, back):
        self.start_hosts()
        out()
        fault = self.wait_for_fault("stale_pressure_command", source="pressure_ctrl")
        gone = self.wait_for_fault("logger_gone", source="plant")
        self.log.wait_for_tick(fault.tick + RAMP)
        self.wait_for_states(100)
        back()
        self.wait_for_fault("stale_pressure_command", active=False)
        self.wait_for_fault("logger_gone", active=False)
        self.wait_for_voltage()
        self.plant.send(signal.SIGTERM)
        for process in (self.plant, *self.rig, *self.desk):
            self.assertEqual(process.wait(), 0, process.report())
        log = event_log.Log(self.log_file)
        self.assertIn("logger on", gone.text)
        # The rig's own processes continued: each state was answered, in the end with zero volts.
        safe = [c for c in log.motor_commands if c.status == event_log.SAFE]
        self.assertGreater(len(safe), 50)
        self.assertEqual([c for c in safe if c.voltage != 0], [])
        newest = [m for kind, m in self.before_fault(log, fault.code) if kind == "HYDRO_PRESSURE_COMMAND"][-1]
        self.assertGreaterEqual(safe[0].tick - newest.tick, 6 + STALE * RATE + RAMP)
        after = [s for s in log.states if s.command_tick in {c.tick for c in safe}]
        self.assertEqual([s for s in after if s.voltage != 0], [])
        # The desk's log says which messages it has not heard.
        desk = event_log.Log(self.path("desk.lcmlog"))
        missing = event_log.missing_numbers(desk.states)
        lost = sum(len(numbers) for numbers in missing.values())
        print(f"{self.id().split('.')[-1]}: the desk missed {lost} of {len(log.states)} states", flush=True)
        self.assertGreater(lost, 100)
        reported = [s.lost_messages for s in desk.statistics if s.role == "position_ctrl" and s.whole_run]
        self.assertEqual(len(reported), 1)
        self.assertGreater(reported[0], 100)
        return log, desk

    # Tests a cable that is pulled at the switch, so that both hosts keep their interfaces.
    def test_cable(self):
        self.cable_out_and_in(lambda: ip("-n", SWITCH, "link", "set", "desk", "down"),
                              lambda: ip("-n", SWITCH, "link", "set", "desk", "up"))

    # Tests an interface that is taken down and up: what cannot be sent is lost and reported, and no process
    # ends because of it.
    def test_interface(self):
        def back():
            # With no states to answer, the loop only sends its report once a second.
            self.desk[0].wait_for("fault unsent_message")
            ip("-n", DESK, "link", "set", "veth0", "up")
            ip("-n", DESK, "route", "add", "224.0.0.0/4", "dev", "veth0")  # it went with the interface
        self.cable_out_and_in(lambda: ip("-n", DESK, "link", "set", "veth0", "down"), back)
        self.assertRegex(self.desk[0].stderr, "fault unsent_message: [0-9]+ messages could not be sent")

    # Tests that --stop ends a stack whose network is gone, within the time that the plant needs to look,
    # although no process would have stopped by itself.
    def test_stop_without_network(self):
        self.arguments = [self.config_with('signal = "voltage"\nkind = "steps"\nsteps = [[0.0, 1.0]]'), "--set", f"bus.url={URL}",
                          "--time", "realtime", "--duration", "0", "--set", "limits.stale_input_s=60", "--set",
                          "model.bypass=true"]
        processes = [self.start_on(RIG, "logger", "-o", self.log_file), self.start_on(RIG, "pressure_ctrl"),
                     self.start_on(RIG, "position_ctrl"), self.start_on(RIG, "plant", "--expect", "logger")]
        self.log = stack.LiveLog(self, self.log_file)
        self.log.wait_for_tick(300)
        self.wait_for_voltage()
        ip("-n", RIG, "link", "set", "veth0", "down")
        argv = ["ip", "netns", "exec", RIG, stack.program("hydro-launch"), *self.arguments, "--stop"]
        stopper = stack.Process(argv, self.folder, "stopper")
        self.processes.append(stopper)
        self.assertEqual(stopper.wait(), 0, stopper.report())
        self.assertRegex(stopper.stdout, "stopped: 4 processes have ended .over their local sockets")
        for process in processes:
            self.assertEqual(process.wait(), 0, process.report())


if __name__ == "__main__":
    outcome.main()
