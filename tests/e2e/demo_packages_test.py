"""What ./demo builds needs only the packages that it installs, and no room of the upper floors."""

import pathlib
import re
import subprocess
import tempfile
import unittest

import outcome

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Packages that `scripts/install-dependencies demo` leaves out: those that CMake finds by name.
LEFT_OUT = ("benchmark", "Boost", "Ceres", "GTest")


class DemoPackagesTest(unittest.TestCase):
    # Tests that the configuration of ./demo succeeds without the other packages.
    def test_configures_without_the_others(self):
        with tempfile.TemporaryDirectory(prefix="hydro-demo-") as build:
            command = ["cmake", "-S", str(ROOT), "-B", build, "-G", "Ninja", "-D", "HYDRO_ONLY_STACK=ON"]
            command += [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in LEFT_OUT]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("comedi", (pathlib.Path(build) / "CMakeCache.txt").read_text())
            steps = subprocess.run(["ninja", "-C", build, "-t", "commands", "demo_programs"], capture_output=True, text=True, check=True)
            sources = re.findall(rf"{re.escape(str(ROOT))}/((?:tune/)?\w+)/\S+\.cc\b", steps.stdout)
            self.assertIn("plant", sources)
            self.assertIn("tools", sources)
            self.assertEqual(set(sources) & {"bench", "diagnose", "experiments", "tests", "tune/search"}, set())

    # Tests that ./demo requests only these packages, and that the full build still needs the others.
    def test_the_rest_is_asked_for_by_the_rest(self):
        script = (ROOT / "scripts/install-dependencies").read_text()
        basic, rest = script.split("demo) ;;")
        for package in ("libceres-dev", "libboost-dev", "libcomedi-dev", "libgtest-dev", "libbenchmark-dev", "clang-tidy"):
            self.assertNotIn(package, basic)
            self.assertIn(package, rest)
        demo = (ROOT / "demo").read_text()
        self.assertIn("scripts/install-dependencies demo\n", demo)
        self.assertIn("scripts/build demo_programs\n", demo)


if __name__ == "__main__":
    outcome.main()
