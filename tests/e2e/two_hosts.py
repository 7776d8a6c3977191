"""Two hosts on one machine: network namespaces, joined by a cable (a veth pair) or by a bad network (relay.py in a third
namespace). The tests make and remove them themselves. Needs root; skipped, saying so, where namespaces cannot be made."""

import json
import os
import shutil
import signal
import subprocess
import sys

import stack

GROUP, PORT = "239.255.76.67", 7667  # in namespaces of our own any port is free
URL = f"udpm://{GROUP}:{PORT}?ttl=1"  # nothing crosses with ttl=0
HOSTS = ("rig", "desk")


# Small steps from a standing start and back, so that a machine that is late for many ticks does not take the
# arm to its limit.
GENTLE = ("--set", "reference.steps=[[0.2, 0.1], [2.2, 0.0], [4.4, 0.1]]")
# Even on such a machine, nothing is late by that much.
PATIENT = ("--set", "limits.stale_input_s=5")


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)


def sections(hosts):
    """[[process]] sections that put the programs on hosts: {program: host}."""
    return "".join(f'\n[[process]]\nprogram = "{program}"\nhost = "{host}"\n' for program, host in hosts.items())


class TestCase(stack.TestCase):
    # The hosts on which the programs run. Without a section for it, a logger runs on each host whose launch
    # is given --log.
    layout = {"hydro-plant": "rig", "hydro-pressure-ctrl": "rig", "hydro-position-ctrl": "desk", "hydro-logger": "desk"}
    # Options of relay.py. None: a cable.
    relay_options = None

    def setUp(self):
        super().setUp()
        if shutil.which("ip") is None:
            self.skipTest("needs ip (package iproute2)")
        self.spaces = {name: f"hy{name[0]}{os.getpid()}" for name in (*HOSTS, "between")}
        try:
            self.make_spaces()
        except subprocess.CalledProcessError as error:
            self.skipTest(f"network namespaces cannot be made here: {error.stderr.strip()}")
        # A copy of the shipped configurations in which the processes have hosts.
        shutil.copytree(os.path.dirname(stack.config("demo.toml")), self.path("config"))
        self.config = self.configure("two_hosts.toml", self.layout)
        self.relay = None
        if self.relay_options is not None:
            self.start_relay(*self.relay_options)

    def make_spaces(self):
        for space in self.spaces.values():
            ip("netns", "add", space)
            self.addCleanup(subprocess.run, ["ip", "netns", "del", space], capture_output=True)
            ip("-n", space, "link", "set", "lo", "up")
        if self.relay_options is None:
            ip("link", "add", "veth0", "netns", self.spaces["rig"], "type", "veth", "peer", "name", "veth0", "netns",
               self.spaces["desk"])
        for number, host in enumerate(HOSTS, start=1):
            subnet = 0
            if self.relay_options is not None:
                subnet = number
                ip("link", "add", "veth0", "netns", self.spaces[host], "type", "veth", "peer", "name", host, "netns",
                   self.spaces["between"])
                ip("-n", self.spaces["between"], "addr", "add", f"10.99.{subnet}.254/24", "dev", host)
                ip("-n", self.spaces["between"], "link", "set", host, "up")
            ip("-n", self.spaces[host], "addr", "add", f"10.99.{subnet}.{number}/24", "dev", "veth0")
            ip("-n", self.spaces[host], "link", "set", "veth0", "up")
            ip("-n", self.spaces[host], "route", "add", "224.0.0.0/4", "dev", "veth0")

    def configure(self, name, layout, source="demo.toml"):
        """The shipped configuration `source` with its processes on these hosts; returns the file."""
        with open(stack.config(source), encoding="utf-8") as file:
            text = file.read().split("[[process]]")[0]
        path = os.path.join(self.path("config"), name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + sections(layout))
        return path

    def start_in(self, host, argv, label=None, environment=None):
        """Starts a program on a host."""
        shifted = ["env", *(f"{name}={value}" for name, value in (environment or {}).items())]
        process = stack.Process(["ip", "netns", "exec", self.spaces[host], *shifted, *argv], self.folder, label or host)
        self.processes.append(process)
        return process

    def start_relay(self, *options):
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "relay.py")
        self.relay = self.start_in("between", [sys.executable, "-B", script, "--a", "rig", "--b", "desk", "--group", GROUP,
                                               "--port", str(PORT), "--record", self.path("relay.json"),
                                               *map(str, options)], "relay")
        self.relay.wait_for("^relaying")

    def relay_record(self):
        """Ends the relay and returns what it did."""
        self.relay.send(signal.SIGTERM)
        self.assertEqual(self.relay.wait(), 0, self.relay.report())
        with open(self.path("relay.json"), encoding="utf-8") as file:
            return json.load(file)

    def launch_on(self, host, *options, environment=None, config=None):
        return self.start_in(host, [stack.program("hydro-launch"), config or self.config, "--host", host, "--set",
                                    "bus.url=" + URL, *map(str, options)], host, environment)

    def log_of(self, host):
        return self.path(f"{host}.lcmlog")

    def start_both(self, *options, logs=("desk",), environments=None):
        """Both launches, each with --log for the hosts of `logs` (and for the rig's, which then waits for a logger)."""
        launches = {}
        for host in reversed(HOSTS):
            log = ["--log", self.log_of(host)] if host in logs or host == "rig" else []
            launches[host] = self.launch_on(host, *log, *options, environment=(environments or {}).get(host))
        return launches

    def run_both(self, *options, expect=0, timeout=90, **more):
        launches = self.start_both(*options, **more)
        for host, launch in launches.items():
            self.assertEqual(launch.wait(timeout), expect, launch.report())
        return launches

    def lost_by_info(self, log):
        """{channel: messages missing}, as hydro-log info counts them."""
        info = json.loads(self.run_program("hydro-log", "info", log, "--json").stdout)
        return {name: channel["missing"] for name, channel in info["channels"].items() if "missing" in channel}


def final_error(log):
    """rad, how far the arm is from the reference at the end of a log."""
    return log.arm_references[-1].value - log.states[-1].arm_angle
