"""Tests that the installed libraries are complete: somebody else's project finds them, builds, and runs.

HYDRO_BUILD is the folder of a finished build, HYDRO_SOURCE that of the sources.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["HYDRO_BUILD"])
SOURCE = pathlib.Path(os.environ["HYDRO_SOURCE"])


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls.folder.name) / "prefix"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix, "--component", "development")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_project_builds_and_runs(self):
        """Tests that find_package(hydro) is enough to build on the model, the laws, the bus and the log."""
        project = pathlib.Path(self.folder.name) / "project"
        run("cmake", "-S", SOURCE / "tests/install/project", "-B", project, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", project)
        said = run(project / "moves_an_arm", SOURCE / "config/models/table1.toml", project / "run.lcmlog")
        match = re.fullmatch(r"(\d+) states, arm at ([\d.]+) rad, (\d+) effects in the catalogue\n", said)
        self.assertTrue(match, said)
        self.assertEqual(int(match[1]), 10_000)
        self.assertAlmostEqual(float(match[2]), 0.3, delta=0.01)
        effects = len(list((SOURCE / "model/effects").glob("*_*.cc")))  # a file is GROUP_NAME.cc
        self.assertEqual(int(match[3]), effects)

    def test_headers_name_installed_headers(self):
        """Tests that no installed header includes one of the project's that is not installed, and none of the upper floors is."""
        include = self.prefix / "include/hydro"
        headers = sorted(path.relative_to(include).as_posix() for path in include.rglob("*.h*"))
        self.assertGreater(len(headers), 80)
        for header in headers:
            for name in re.findall(r'#include "([^"]+)"', (include / header).read_text()):
                self.assertTrue((include / name).is_file(), f"{header} includes {name}")
        self.assertEqual([name for name in headers if re.match("tests|diagnose|experiments|launch|plant", name)], [])

    def test_headers_have_their_libraries(self):
        """Tests that what an installed header declares is in an installed library."""
        include = self.prefix / "include/hydro"
        objects = {name for library in self.prefix.rglob("*.a") for name in run("ar", "t", library).split()}
        self.assertGreater(len(objects), 50)
        objects.add("catalogue.cc.o")  # joined with the other effects
        without = [path.relative_to(include).as_posix() for path in include.rglob("*.h")
                   if (SOURCE / path.relative_to(include)).with_suffix(".cc").is_file() and f"{path.stem}.cc.o" not in objects]
        self.assertEqual(without, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
