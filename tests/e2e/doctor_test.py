"""hydro-launch --doctor on machines of its own making: network namespaces with and without a multicast route, with a stack
on the port, without the right to real-time priorities. What it prescribes is done, and then all must be well. Needs root;
skipped, saying so, where namespaces cannot be made."""

import os
import re
import shutil
import subprocess

import outcome
import stack

URL = "udpm://239.255.76.67:7667?ttl=0"


class DoctorTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        if shutil.which("ip") is None:
            self.skipTest("needs ip (package iproute2)")
        self.space = f"hydoc{os.getpid()}"
        made = subprocess.run(["ip", "netns", "add", self.space], capture_output=True, text=True)
        if made.returncode != 0:
            self.skipTest(f"network namespaces cannot be made here: {made.stderr.strip()}")
        self.addCleanup(subprocess.run, ["ip", "netns", "del", self.space], capture_output=True)

    def inside(self, *argv):
        return ["ip", "netns", "exec", self.space, *argv]

    def ip(self, *arguments):
        subprocess.run(["ip", "-n", self.space, *arguments], check=True, capture_output=True)

    def doctor(self, *arguments, prefix=(), expect=None):
        argv = self.inside(*prefix, stack.program("hydro-launch"), *arguments, "--doctor")
        done = subprocess.run(argv, capture_output=True, text=True, timeout=stack.PATIENCE)
        if expect is not None:
            self.assertEqual(done.returncode, expect or int("wake-ups" in self.late(done)), done.stdout + done.stderr)
        return done

    def late(self, done):
        """How this machine wakes just now depends on what else it does: no test's business."""
        return {"wake-ups"} & {check for check, (ok, _, _) in self.findings(done.stdout).items() if not ok}

    def findings(self, text):
        """{check: (ok, what was found, cure or None)}"""
        found = {}
        for line, mend in re.findall(r"^((?:ok|problem) .*)\n(?: +fix: (.*)\n)?", text, re.MULTILINE):
            word, check, rest = re.fullmatch(r"(ok|problem) +(.{19}) (.*)", line).groups()
            found[check.strip()] = (word == "ok", rest, mend or None)
            self.assertEqual(word == "ok", not mend, line)
        return found

    def problems(self, done):
        return {check for check, (ok, _, _) in self.findings(done.stdout).items() if not ok} - {"wake-ups"}

    def mend(self, done, check):
        cure = self.findings(done.stdout)[check][2]
        environment = {**os.environ, "PATH": stack.BIN + ":" + os.environ["PATH"]}
        subprocess.run(self.inside("sh", "-c", cure), check=True, capture_output=True, env=environment)

    # Tests a machine without a multicast route: the missing route and the failed delivery are both named, one
    # command fixes both, and the other checks are still made.
    def test_no_route(self):
        config = stack.config("demo.toml")
        done = self.doctor(config, expect=1)
        self.assertEqual(self.problems(done), {"multicast route", "loopback delivery"})
        self.assertEqual(set(self.findings(done.stdout)),
                         {"multicast route", "loopback delivery", "kernel buffers", "ttl and hosts", "IGMP snooping",
                          "other stacks", "real-time priority", "locked memory", "processors", "kernel", "CPU governor",
                          "swap", "clock", "wake-ups"})
        self.assertRegex(self.findings(done.stdout)["wake-ups"][1], r"^\d+ of 1000 ticks skipped at 1000 Hz, the latest [\d.]+ ms late")
        self.mend(done, "multicast route")
        done = self.doctor(config, expect=0)
        self.assertTrue(self.late(done) or done.stdout.endswith("all is well\n"), done.stdout)

    # Tests that a stack on several hosts requires a route that leaves the machine, and an interface that is
    # up.
    def test_way_out(self):
        self.ip("link", "set", "lo", "up")
        far_end = self.space + "f"
        subprocess.run(["ip", "netns", "add", far_end], check=True, capture_output=True)
        self.addCleanup(subprocess.run, ["ip", "netns", "del", far_end], capture_output=True)
        self.ip("link", "add", "veth0", "type", "veth", "peer", "name", "veth0", "netns", far_end)
        subprocess.run(["ip", "-n", far_end, "link", "set", "veth0", "up"], check=True, capture_output=True)
        self.ip("addr", "add", "10.99.0.1/24", "dev", "veth0")
        self.ip("route", "add", "224.0.0.0/4", "dev", "lo")
        far = (stack.config("demo.toml"), "--set", "bus.url=" + URL.replace("ttl=0", "ttl=1"))
        done = self.doctor(*far, expect=1)
        self.assertIn("multicast route", self.problems(done))
        self.mend(done, "multicast route")
        done = self.doctor(*far)
        self.assertNotIn("multicast route", self.problems(done), done.stdout)
        self.assertIn("veth", self.findings(done.stdout)["multicast route"][1])
        self.assertNotIn("loopback delivery", self.problems(done), done.stdout)

    # Tests that commands that may come from other hosts require a key, and hosts beyond the machine a ttl.
    def test_open_network(self):
        shutil.copytree(stack.CONFIG, self.path("config"))
        config = os.path.join(self.path("config"), "hosts.toml")
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read().split("[[process]]")[0]
        with open(config, "w", encoding="utf-8") as file:
            file.write(text + '[[process]]\nprogram = "hydro-plant"\nhost = "rig"\n'
                       '[[process]]\nprogram = "hydro-pressure-ctrl"\nhost = "desk"\n')
        for found in ("names several hosts, but with ttl=0", "ttl=1 and no bus.key_file"):
            done = self.doctor(config, expect=1)
            self.assertIn("ttl and hosts", self.problems(done), done.stdout)
            self.assertIn(found, self.findings(done.stdout)["ttl and hosts"][1])
            self.mend(done, "ttl and hosts")
        done = self.doctor(config)
        self.assertNotIn("ttl and hosts", self.problems(done), done.stdout)

    # Tests that a stack that runs on the port is heard and named, and that a stack with other channels is no
    # problem.
    def test_other_stack(self):
        self.ip("link", "set", "lo", "up")
        self.ip("route", "add", "224.0.0.0/4", "dev", "lo")
        config = stack.config("demo.toml")
        argv = self.inside(stack.program("hydro-launch"), config, "--duration", "0", "--set", "bus.url=" + URL)
        launch = stack.Process(argv, self.folder, "launch")
        self.processes.append(launch)
        launch.wait_for("all 3 processes ready")
        done = self.doctor(config, expect=1)
        self.assertEqual(self.problems(done), {"other stacks"}, done.stdout)
        self.assertRegex(self.findings(done.stdout)["other stacks"][1], "plant on .*position_ctrl on|position_ctrl on .*plant")
        self.assertNotIn("other stacks", self.problems(self.doctor(config, "--set", "bus.channel_suffix=_2")))
        # The command that the doctor recommends, with the program under test.
        cure = self.findings(done.stdout)["other stacks"][2]
        self.assertTrue(cure.startswith(f"hydro-launch {config} --stop"), cure)
        subprocess.run(self.inside(*[stack.program("hydro-launch"), config, "--stop"]), check=True, capture_output=True)
        self.assertEqual(launch.wait(), 0, launch.report())
        self.assertNotIn("other stacks", self.problems(self.doctor(config)))

    # Tests that a process that asks for a priority needs limits that allow it.
    def test_limits(self):
        if shutil.which("setpriv") is None:
            self.skipTest("needs setpriv (package util-linux)")
        self.ip("link", "set", "lo", "up")
        self.ip("route", "add", "224.0.0.0/4", "dev", "lo")
        config = self.path("priority.toml")
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read().replace("models/", os.path.join(stack.CONFIG, "models") + "/")
        with open(config, "w", encoding="utf-8") as file:
            file.write(text.replace('program = "hydro-plant"', 'program = "hydro-plant"\npriority = 80\ncpu = 1000'))
        weak = ("prlimit", "--rtprio=0", "--memlock=65536", "setpriv", "--bounding-set=-sys_nice,-ipc_lock",
                "--inh-caps=-sys_nice,-ipc_lock", "--ambient-caps=-all")
        done = self.doctor(config, prefix=weak, expect=1)
        self.assertLessEqual({"real-time priority", "locked memory", "processors"}, self.problems(done), done.stdout)
        self.assertIn("rtprio is 0, requested is 80", done.stdout)
        # The same limits do not matter to a process with the capabilities. (In some places, root cannot raise
        # the limits either.)
        problems = self.problems(self.doctor(config, prefix=weak[:3], expect=1))
        self.assertIn("processors", problems)
        self.assertFalse({"real-time priority", "locked memory"} & problems, problems)

    # Tests that a bad configuration is an error, as in every program, and that none is required.
    def test_configuration(self):
        done = self.doctor(self.path("none.toml"), expect=2)
        self.assertIn("none.toml", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        done = self.doctor(stack.config("demo.toml"), "--host", "moon", expect=2)
        self.assertIn("moon", done.stderr)
        self.ip("link", "set", "lo", "up")
        self.ip("route", "add", "224.0.0.0/4", "dev", "lo")
        done = self.doctor()
        self.assertIn(done.returncode, (0, 1))
        self.assertNotIn("multicast route", self.problems(done))
        plain = subprocess.run([stack.program("hydro-launch")], capture_output=True, text=True)
        self.assertEqual(plain.returncode, 2)
        self.assertEqual(plain.stderr.count("\n"), 1, plain.stderr)
        self.assertIn("CONFIG", plain.stderr)


if __name__ == "__main__":
    outcome.main()
