"""The systemd units as cmake --install leaves them: systemd itself finds nothing wrong with them, and they keep the promises
of docs/systemd.md. The build folder is that of HYDRO_BIN; skipped for an installed tree."""

import configparser
import os
import shutil
import subprocess

import outcome
import stack

BUILD = os.path.dirname(stack.BIN)


class SystemdTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        if shutil.which("cmake") is None or not os.path.exists(os.path.join(BUILD, "cmake_install.cmake")):
            self.skipTest("needs cmake and a build folder")
        self.prefix = self.path("prefix")
        subprocess.run(["cmake", "--install", BUILD, "--component", "systemd", "--prefix", self.prefix], check=True,
                       capture_output=True)
        # Other files to which the units refer.
        os.mkdir(os.path.join(self.prefix, "bin"))
        os.symlink(stack.program("hydro-launch"), os.path.join(self.prefix, "bin", "hydro-launch"))
        self.units = os.path.join(self.prefix, "lib", "systemd", "system")

    def unit(self, name):
        parser = configparser.RawConfigParser(strict=False, interpolation=None)
        parser.optionxform = str
        parser.read(os.path.join(self.units, name))
        return parser

    def verify(self, template, instance):
        """What systemd-analyze has to say about a unit of that template; empty: nothing."""
        path = os.path.join(self.units, instance)
        if not os.path.exists(path):
            shutil.copy(os.path.join(self.units, template), path)
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", path], capture_output=True, text=True)
        return "" if done.returncode == 0 and not done.stderr else f"exit {done.returncode}: {done.stderr}"

    # Tests that systemd reads what cmake --install leaves without a complaint, and that the check would
    # notice one.
    def test_verify(self):
        if shutil.which("systemd-analyze") is None:
            self.skipTest("needs systemd-analyze")
        self.assertEqual(self.verify("hydro@.service", "hydro@demo.service"), "")
        self.assertEqual(self.verify("hydro-multicast-route@.service", "hydro-multicast-route@lo.service"), "")
        os.remove(os.path.join(self.prefix, "bin", "hydro-launch"))
        self.assertIn("hydro-launch", self.verify("hydro@.service", "hydro@demo.service"))

    # Tests what the documentation promises: nothing is ever restarted, real-time limits, an ordered end.
    def test_promises(self):
        service = self.unit("hydro@.service")["Service"]
        self.assertEqual(service["Restart"], "no")
        self.assertGreaterEqual(int(service["LimitRTPRIO"]), 80)
        self.assertEqual(service["LimitMEMLOCK"], "infinity")
        self.assertEqual(service["KillMode"], "mixed")
        self.assertGreaterEqual(int(service["TimeoutStopSec"]), 15)
        self.assertIn(os.path.join(self.prefix, "bin", "hydro-launch") + " /etc/hydro/%i.toml", service["ExecStart"])
        self.assertTrue(service["ExecStartPre"].startswith("-"), "what the doctor says does not keep the stack from starting")
        for name in ("lib/sysusers.d/hydro.conf", "lib/sysctl.d/60-hydro.conf"):
            self.assertTrue(os.path.getsize(os.path.join(self.prefix, name)))

    # Tests the user's file and the buffers with the programs that read them.
    def test_users_and_buffers(self):
        with open(os.path.join(self.prefix, "lib/sysctl.d/60-hydro.conf"), encoding="utf-8") as file:
            self.assertIn("net.core.rmem_max = 4194304\n", file.read())
        if shutil.which("systemd-sysusers") is None:
            self.skipTest("needs systemd-sysusers")
        done = subprocess.run(["systemd-sysusers", "--dry-run", os.path.join(self.prefix, "lib/sysusers.d/hydro.conf")],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    outcome.main()
