"""One stack on two hosts: two network namespaces joined by a veth pair, the plant and the logger in one, the controllers in
the other, the same configuration on each. Needs root; skipped, saying so, where namespaces cannot be made."""

import os
import shutil
import subprocess
import unittest

import event_log
import stack

RIG, DESK = f"hyr{os.getpid()}", f"hyd{os.getpid()}"
PROCESSES = """
[[process]]
program = "hydro-plant"
host = "rig"

[[process]]
program = "hydro-logger"
host = "rig"

[[process]]
program = "hydro-pressure-ctrl"
host = "desk"

[[process]]
program = "hydro-position-ctrl"
host = "desk"
"""
URL = "udpm://239.255.76.67:7667?ttl=1"  # nothing crosses with ttl=0; in namespaces of our own any port is free


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)


class HostsTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        if shutil.which("ip") is None:
            self.skipTest("needs ip (package iproute2)")
        for name in (RIG, DESK):
            try:
                ip("netns", "add", name)
            except subprocess.CalledProcessError as error:
                self.skipTest(f"network namespaces cannot be made here: {error.stderr.strip()}")
            self.addCleanup(subprocess.run, ["ip", "netns", "del", name], capture_output=True)
        ip("link", "add", "veth0", "netns", RIG, "type", "veth", "peer", "name", "veth0", "netns", DESK)
        for number, name in enumerate((RIG, DESK), start=1):
            ip("-n", name, "link", "set", "lo", "up")
            ip("-n", name, "addr", "add", f"10.99.0.{number}/24", "dev", "veth0")
            ip("-n", name, "link", "set", "veth0", "up")
            ip("-n", name, "route", "add", "224.0.0.0/4", "dev", "veth0")
        # A copy of the shipped configurations in which the processes have hosts.
        self.folder = self.path("config")
        shutil.copytree(os.path.dirname(stack.config("demo.toml")), self.folder)
        self.config = os.path.join(self.folder, "two_hosts.toml")
        with open(stack.config("demo.toml"), encoding="utf-8") as shipped, \
                open(self.config, "w", encoding="utf-8") as copy:
            copy.write(shipped.read().split("[[process]]")[0] + PROCESSES)

    def launch_on(self, namespace, host, *options):
        argv = ["ip", "netns", "exec", namespace, stack.program("hydro-launch"), self.config, "--host", host,
                "--set", "bus.url=" + URL, *options]
        process = stack.Process(argv, self.path("."), host)
        self.addCleanup(process.end)
        return process

    def run_both(self, *options):
        log_file = self.path("hosts.lcmlog")
        desk = self.launch_on(DESK, "desk", *options)
        rig = self.launch_on(RIG, "rig", "--log", log_file, *options)
        self.assertEqual(rig.wait(60), 0, rig.report())
        self.assertEqual(desk.wait(60), 0, desk.report())
        return log_file

    # Tests that a lockstep run over two hosts is that of hydro-sim, bit by bit.
    def test_lockstep(self):
        log_file = self.run_both("--time", "lockstep", "--duration", "1")
        simulated = self.path("sim.lcmlog")
        self.run_program("hydro-sim", self.config, "--duration", "1", "-o", simulated)
        self.assert_identical(log_file, simulated)

    # Tests that a real-time run over two hosts loses nothing and drives the motor.
    def test_realtime(self):
        log = event_log.Log(self.run_both("--time", "realtime", "--duration", "1"))
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        self.assertEqual(log.states[-1].tick, 1000)
        self.assertGreater(max(abs(s.voltage) for s in log.states), 1)


if __name__ == "__main__":
    unittest.main()
