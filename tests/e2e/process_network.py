"""Where the processes of a run are: on one machine's loopback interface, or on hosts of their own behind a switch that can cut off
each (network namespaces and a bridge: needs root)."""

import ctypes
import os
import shutil
import subprocess
import unittest

import bad_link

CLONE_NEWNET = 0x40000000


class Loopback:
    url_options = "ttl=0"

    def command(self, _, argv):
        """What starts a program at a place: the name of a role, or "operator"."""
        return argv

    def opened_there(self, make):
        """What `make` returns, which opens sockets."""
        return make()


class Switch:
    url_options = "ttl=1"  # nothing crosses with ttl=0

    def __init__(self, case, places):
        if not all(shutil.which(tool) for tool in ("ip", "bridge")):
            case.skipTest("needs ip and bridge (package iproute2)")
        self.middle = f"hyswitch{os.getpid()}"
        try:
            self._make(case, places)
        except subprocess.CalledProcessError as error:
            raise unittest.SkipTest(f"network namespaces or bridges cannot be made here: {error.stderr.strip()}") from None

    @staticmethod
    def _ip(*arguments):
        subprocess.run(["ip", *arguments], check=True, capture_output=True, text=True)

    def _space(self, case, name, number):
        """A host with an address in the network, through the interface that `_make` has given it."""
        self._ip("-n", name, "link", "set", "lo", "up")
        self._ip("-n", name, "addr", "add", f"10.98.0.{number}/24", "dev", "net")
        self._ip("-n", name, "link", "set", "net", "up")
        self._ip("-n", name, "route", "add", "224.0.0.0/4", "dev", "net")

    def _make(self, case, places):
        self.spaces = {place: f"hyhost{number}-{os.getpid()}" for number, place in enumerate(places)}
        for space in (self.middle, *self.spaces.values()):
            self._ip("netns", "add", space)
            case.addCleanup(subprocess.run, ["ip", "netns", "del", space], capture_output=True)
        # Without snooping, each multicast packet goes to every port.
        self._ip("-n", self.middle, "link", "add", "net", "type", "bridge", "mcast_snooping", "0", "stp_state", "0", "forward_delay", "0")
        self._space(case, self.middle, 250)
        for number, space in enumerate(self.spaces.values()):
            port = f"port{number}"
            self._ip("link", "add", "net", "netns", space, "type", "veth", "peer", "name", port, "netns", self.middle)
            self._ip("-n", self.middle, "link", "set", port, "master", "net", "up")
            self._space(case, space, number + 1)

    def command(self, place, argv):
        return [shutil.which("ip"), "netns", "exec", self.spaces.get(place, self.middle), *argv]

    def opened_there(self, make):
        """Sockets stay where they were opened."""
        libc = ctypes.CDLL(None, use_errno=True)
        with open("/proc/self/ns/net", encoding="ascii") as here, open(f"/run/netns/{self.middle}", encoding="ascii") as there:
            if libc.setns(there.fileno(), CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), "setns")
            try:
                return make()
            finally:
                libc.setns(here.fileno(), CLONE_NEWNET)

    def _port(self, place):
        return f"port{list(self.spaces).index(place)}"

    def connect(self, place, connected):
        """The switch forwards what comes from and goes to a place, or nothing of it; the cable stays plugged in."""
        state = "3" if connected else "0"  # forwarding, disabled
        subprocess.run(self.command(None, ["bridge", "link", "set", "dev", self._port(place), "state", state]), check=True)

    def make_bad(self, place, delay):
        """From now on what a place sends is late by `delay` s, or lost if that is None."""
        self._ip("-n", self.middle, "link", "set", self._port(place), "nomaster")
        return self.opened_there(lambda: bad_link.BadLink(self._port(place), "net", delay))

    def make_good(self, place):
        """When its bad link has ended."""
        self._ip("-n", self.middle, "link", "set", self._port(place), "master", "net")
