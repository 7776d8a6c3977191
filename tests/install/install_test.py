"""Tests that the installed libraries are complete: somebody else's project finds them, builds, and runs.

HYDRO_BUILD is the folder of a finished build, HYDRO_SOURCE that of the sources.
"""

import json
import os
import pathlib
import re
import socket
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


def compiled_in_batches(target):
    """What the objects of this target's sources would be called if they were not compiled together (HYDRO_UNITY)."""
    commands = json.loads((BUILD / "compile_commands.json").read_text())
    batches = [pathlib.Path(command["file"]) for command in commands if f"/{target}.dir/Unity/" in command["file"]]
    return [f"{pathlib.Path(name).name}.o" for batch in batches for name in re.findall(r'#include "([^"]+)"', batch.read_text())]


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
        """Tests that find_package(hydro) is enough to build on the model, the laws, the bus and the log, optimised too."""
        project = pathlib.Path(self.folder.name) / "project"
        run("cmake", "-S", SOURCE / "examples/own_project", "-B", project, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
            "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", project)
        self.moves_an_arm(project / "moves_an_arm", project)
        # What pkg-config says links, too.
        env = {**os.environ, "PKG_CONFIG_PATH": str(self.prefix / "lib/pkgconfig")}
        flags = {which: subprocess.run(["pkg-config", which, "hydro"], env=env, check=True, capture_output=True, text=True).stdout.split()
                 for which in ("--cflags", "--libs")}
        folders = [pathlib.Path(flag.removeprefix("-I")) for flag in flags["--cflags"] if flag.startswith("-I")]
        self.assertTrue(any((folder / "bus/bus.h").is_file() for folder in folders), folders)
        run("c++", "-O2", *flags["--cflags"], SOURCE / "examples/own_project/moves_an_arm.cc", "-o", project / "by_pkg_config", *flags["--libs"])
        self.moves_an_arm(project / "by_pkg_config", project)

    def moves_an_arm(self, program, project):
        log = project / "run.lcmlog"
        log.unlink(missing_ok=True)  # no log is written over another
        said = run(program, SOURCE / "config/models/table1.toml", log)
        match = re.fullmatch(r"(\d+) states, arm at ([\d.]+) rad, (\d+) effects in the catalogue\n", said)
        self.assertTrue(match, said)
        self.assertEqual(int(match[1]), 10_000)
        self.assertAlmostEqual(float(match[2]), 0.3, delta=0.01)
        effects = len(list((SOURCE / "model/effects").glob("*/*_*.cc")))  # a file is ROOM/GROUP_NAME.cc
        self.assertEqual(int(match[3]), effects)
        wrong = subprocess.run([program, "none.toml", project / "none.lcmlog"], capture_output=True, text=True, check=False)
        self.assertEqual((wrong.returncode, wrong.stderr.count("\n")), (2, 1), wrong.stderr)
        self.assertIn("10000 states over 2.000 s", run(BUILD / "bin/hydro-log", "summary", log))

    def test_a_controller_builds(self):
        """Tests that the example of a controller in C++ builds on what is installed; tests/e2e/own_controller_test.py runs it."""
        built = pathlib.Path(self.folder.name) / "controller"
        run("cmake", "-S", SOURCE / "examples/own_controller/cpp", "-B", built, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", built)
        done = subprocess.run([built / "pd"], capture_output=True, text=True, timeout=60, env={**os.environ, "HYDRO_CONFIG": ""})
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertRegex(done.stderr, "^position_ctrl: HYDRO_CONFIG: found nothing, allowed the path")

    def test_a_driver_builds_and_runs(self):
        """Tests that what `hydro-launch new-driver` writes builds on what is installed, and runs at once; and that the other examples build."""
        folder = pathlib.Path(self.folder.name) / "drivers"
        folder.mkdir()
        subprocess.run([BUILD / "bin/hydro-launch", "new-driver", "mine"], cwd=folder, check=True, capture_output=True, timeout=60)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        for source, program in ((folder / "mine", "mine"), (SOURCE / "examples/own_driver/cia402", "cia402"),
                                (SOURCE / "examples/own_driver/serial_board", "serial_board")):
            built = folder / program / "build"
            run("cmake", "-S", source, "-B", built, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}")
            run("cmake", "--build", built)
            self.assertIn("--check-sensors", run(built / program, "--help"))
        said = subprocess.run([BUILD / "bin/hydro-launch", folder / "mine/mine.toml", "--duration", "0.5", "--set", "limits.stale_input_s=1",
                               "--set", f"bus.url=udpm://239.255.76.67:{port}?ttl=0"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)

    def test_a_driver_builds_on_a_build(self):
        """Tests that what `hydro-launch new-driver` prints in a build that is not installed builds the driver."""
        folder = pathlib.Path(self.folder.name) / "uninstalled"
        folder.mkdir()
        made = subprocess.run([BUILD / "bin/hydro-launch", "new-driver", "mine"], cwd=folder, check=True, capture_output=True, text=True,
                              timeout=60).stdout
        command = re.search(r"^  (cmake -S mine .*-Dhydro_DIR=.*)$", made, re.MULTILINE)
        self.assertTrue(command, made)
        subprocess.run(["sh", "-c", command[1]], cwd=folder, check=True, capture_output=True)
        self.assertIn("--check-sensors", run(folder / "mine/build/mine", "--help"))

    def test_headers_name_installed_headers(self):
        """Tests that no installed header includes one of the project's that is not installed, and none of the upper floors is."""
        include = self.prefix / "include/hydro"
        headers = sorted(path.relative_to(include).as_posix() for path in include.rglob("*.h*"))
        self.assertGreater(len(headers), 80)
        for header in headers:
            for name in re.findall(r'#include "([^"]+)"', (include / header).read_text()):
                self.assertTrue((include / name).is_file(), f"{header} includes {name}")
        self.assertEqual([name for name in headers if re.match("tests|diagnose|experiments|launch", name)], [])
        self.assertEqual([name for name in headers if name.startswith("plant")],
                         ["plant/driver/device.h", "plant/driver/driver_main.h", "plant/driver/simulated_device.h", "plant/rig.h"])

    def test_headers_have_their_libraries(self):
        """Tests that what an installed header declares is in an installed library."""
        include = self.prefix / "include/hydro"
        libraries = sorted(self.prefix.rglob("*.a"))
        objects = {name for library in libraries for name in run("ar", "t", library).split()}
        objects.update(name for library in libraries for name in compiled_in_batches(library.stem.removeprefix("lib")))
        self.assertGreater(len(objects), 50)
        objects.update(("catalogue.cc.o", "formulas.cc.o"))  # joined with the other effects
        without = [path.relative_to(include).as_posix() for path in include.rglob("*.h")
                   if (SOURCE / path.relative_to(include)).with_suffix(".cc").is_file() and f"{path.stem}.cc.o" not in objects]
        self.assertEqual(without, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
