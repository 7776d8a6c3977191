"""Tests that what cmake --install gives is whole, that Debian's packages (packaging/debian/) share it out, and that man pages and completions say
what each program's own --help says.

HYDRO_BUILD is the folder of a finished build, HYDRO_SOURCE that of the sources.
"""

import fnmatch
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import typed_zsh

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "e2e"))
import outcome  # noqa: E402

BUILD = pathlib.Path(os.environ["HYDRO_BUILD"])
SOURCE = pathlib.Path(os.environ["HYDRO_SOURCE"])
PACKAGES = ("hydro", "libhydro-dev", "hydro-doc")
OPTIONAL = ("usr/share/doc/hydro-doc/html",)  # the reference, made by `ninja doc`
# Tools of ./check that a package's build does not run.
ONLY_TESTS = {"git", "python3-h5py", "python3-scipy", "python3-pandas", "octave", "iproute2", "librsvg2-bin", "libgtest-dev", "libgmock-dev", "libbenchmark-dev", "chromium", "nginx-light",
              "clang-format", "clang-tidy", "clang", "lld", "build-essential", "slurmctld", "slurmd", "slurm-client", "munge",
              "gcc-arm-none-eabi", "qemu-system-arm"}


def in_debian(path):
    """Where a package has what the prefix has at `path`: libraries in the architecture's folder."""
    return re.sub(r"^usr/lib/(?!systemd|sysusers|sysctl)", "usr/lib/x86_64-linux-gnu/", f"usr/{path}")


def claims(pattern, path):
    """Whether a line of an .install file takes a path: a file or a folder of that name, stars not crossing folders."""
    wanted, found = pattern.split("/"), path.split("/")
    return len(found) >= len(wanted) and all(map(fnmatch.fnmatchcase, found, wanted))


def completed(script, words):
    """What bash proposes for the last of these words."""
    return subprocess.run(
        ["bash", "--norc", "-c", 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
         '"$(complete -p "$1" | sed "s/.*-F \\([^ ]*\\) .*/\\1/")"; printf "%s\\n" "${COMPREPLY[@]}"', "bash", script, *words],
        check=True, capture_output=True, text=True, timeout=60).stdout.split()


class PackagingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls.folder.name) / "prefix"
        done = subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], capture_output=True, text=True, timeout=120)
        if done.returncode != 0:
            raise AssertionError(f"cmake --install: {done.stderr[-2000:]}")
        cls.programs = sorted(path.name for path in (cls.prefix / "bin").iterdir())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def help(self, *command):
        program = self.prefix / "bin" / command[0]
        return subprocess.run([program, *command[1:], "--help"], check=True, capture_output=True, text=True, timeout=60).stdout

    def verbs(self, program):
        """[()] for a program without verbs, and one of each verb."""
        listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", self.help(program), re.MULTILINE)
        return [()] + [(line.split()[0],) for line in (listed[1].splitlines() if listed else [])]

    def options(self, *command):
        return set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", self.help(*command), re.MULTILINE))

    def files(self):
        return sorted(path.relative_to(self.prefix).as_posix() for path in self.prefix.rglob("*") if path.is_symlink() or path.is_file())

    def test_every_file_has_one_package(self):
        """Tests that each installed file is in exactly one package, and that no line of a package's list is without files."""
        lists = {name: [line.split()[0] for line in (SOURCE / f"packaging/debian/{name}.install").read_text().splitlines()] for name in PACKAGES}
        files = [in_debian(path) for path in self.files()]
        self.assertGreater(len(files), 200)
        for path in files:
            takers = [name for name, patterns in lists.items() if any(claims(pattern, path) for pattern in patterns)]
            self.assertEqual(len(takers), 1, f"{path} is in the packages {takers}, allowed is one: packaging/debian/*.install")
        unused = [f"packaging/debian/{name}.install: {pattern}" for name, patterns in lists.items() for pattern in patterns
                  if pattern not in OPTIONAL and not any(claims(pattern, path) for path in files)]
        self.assertEqual(unused, [])

    def test_a_manual_for_each_program(self):
        """Tests that each program has a man page that shows its version, every option and every verb's options, as its --help has
        them now."""
        self.assertGreaterEqual(len(self.programs), 16)
        for program in self.programs:
            page = (self.prefix / f"share/man/man1/{program}.1").read_text().replace("\\-", "-")
            self.assertIn(f'"hydro {project_version()}"', page)
            for verb in self.verbs(program):
                for option in self.options(program, *verb) - {"--help"}:
                    self.assertIn(f"\\fB{option}\\fR", page, f"{program} {verb}: build target hydro_help")
            if shutil.which("man"):
                done = subprocess.run(["man", "--warnings", "-l", "-Tutf8", self.prefix / f"share/man/man1/{program}.1"],
                                      capture_output=True, text=True, env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"})
                self.assertEqual((done.returncode, done.stderr), (0, ""), program)

    def test_bash_completes_every_option(self):
        """Tests in bash that it proposes exactly the options that --help has, of each program and each verb, and the verbs."""
        for program in self.programs:
            script = self.prefix / "share/bash-completion/completions" / program
            for verb in self.verbs(program):
                self.assertEqual(set(completed(script, [program, *verb, "--"])), self.options(program, *verb), f"{program} {verb}")
            verbs = {verb[0] for verb in self.verbs(program) if verb}
            if verbs:
                self.assertLessEqual(verbs, set(completed(script, [program, ""])))

    def test_bash_completes_values(self):
        """Tests in bash what follows an option: the words that it allows, files of its kind; and an --option=value."""
        scripts = self.prefix / "share/bash-completion/completions"
        self.assertEqual(completed(scripts / "hydro-sim", ["hydro-sim", "--time", ""]), ["realtime", "lockstep"])
        self.assertEqual(completed(scripts / "hydro-sim", ["hydro-sim", "--time", "=", "l"]), ["lockstep"])
        config = f"{SOURCE}/config/"
        self.assertIn(f"{config}demo.toml", completed(scripts / "hydro-sim", ["hydro-sim", config]))
        self.assertIn(f"{config}models", completed(scripts / "hydro-sim", ["hydro-sim", config]))
        self.assertEqual(completed(scripts / "hydro-log", ["hydro-log", "info", f"{config}demo"]), [])  # no log
        self.assertEqual(completed(scripts / "hydro-sim", ["hydro-sim", "--seed", ""]), [])
        self.assertEqual(completed(scripts / "hydro-launch", ["hydro-launch", "st"]), ["stop"])

    def test_zsh_completions_are_of_every_option(self):
        """Tests that zsh's completions parse, where there is a zsh, and name every option."""
        for program in self.programs:
            script = self.prefix / f"share/zsh/site-functions/_{program}"
            text = script.read_text()
            self.assertTrue(text.startswith(f"#compdef {program}\n"))
            for verb in self.verbs(program):
                for option in self.options(program, *verb):
                    self.assertRegex(text, rf"{option}[\[}}']", f"{program} {verb}")
            if shutil.which("zsh"):
                subprocess.run(["zsh", "-n", script], check=True)

    @unittest.skipUnless(shutil.which("zsh"), "needs zsh")
    def test_zsh_proposes(self):
        """Tests in an interactive zsh what TAB proposes: options, verbs, their options, words, files of a kind."""
        folder = pathlib.Path(self.folder.name) / "typed"
        folder.mkdir()
        for name in ("one.toml", "two.toml", "three.txt", "four.lcmlog"):
            (folder / name).touch()
        for line, proposed, others in (
                ("hydro-sim --", ("--duration", "--tuning"), ()), ("hydro-sim --time ", ("realtime", "lockstep"), ()),
                ("hydro-sim ", ("one.toml", "two.toml"), ("three.txt", "four.lcmlog")), ("hydro-log ", ("compare", "replay"), ()),
                ("hydro-log export --", ("--output", "--suffix"), ()), ("hydro-log info f", ("four.lcmlog",), ()),
                ("hydro-launch s", ("stop",), ()), ("hydro-launch stop ", ("one.toml", "two.toml"), ("three.txt",))):
            shell = typed_zsh.TypedZsh(self.prefix / "share/zsh/site-functions", self.prefix / "bin", folder)
            try:
                shell.type(line + "\t\t")
                for text in proposed:
                    shell.wait_for(text)
                for text in others:
                    self.assertNotIn(text, shell.said, line)
            finally:
                shell.close()

    def test_installed_pages_link_to_what_is_installed(self):
        """Tests that each relative link of an installed page leads to an installed file."""
        pages = sorted((self.prefix / "share/doc/hydro").rglob("*.md"))
        self.assertGreater(len(pages), 20)
        for page in pages:
            for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text()):
                if "://" not in target:
                    self.assertTrue((page.parent / target).exists(), f"{page.relative_to(self.prefix)}: {target} is not installed")

    def test_installed_pages_are_of_an_installation(self):
        """Tests that their commands are those that a shell finds, and that nothing of the markers or of a checkout's first steps is left."""
        pages = {page.name if page.parent.name in ("docs", "developers") else f"/{page.name}": page.read_text()
                 for page in (self.prefix / "share/doc/hydro").rglob("*.md") if page.parent.name in ("docs", "developers", "hydro")}
        for name, text in pages.items():
            for word in ("build/bin/", "scripts/plot-run", "<!-- sources", "<!-- /sources", "<!-- installed"):
                self.assertNotIn(word, text, name)
        for name in ("/README.md", "start.md"):
            self.assertNotIn("./demo", pages[name], name)
            self.assertNotIn("./scripts/build", pages[name], name)
        self.assertIn("\nhydro-launch config/demo.toml --set position.c2=600", pages["/README.md"])
        self.assertIn("A run of `config/demo.toml` ends with", pages["/README.md"])
        self.assertIn("\nhydro-experiment fig3", pages["experiments.md"])
        self.assertIn(f"`cp -r {self.prefix}/share/hydro/config .`", pages["start.md"])
        blocks = re.findall(r"^```[a-z]*\n(.*?)^```", pages["/README.md"], re.DOTALL | re.MULTILINE)
        self.assertEqual(pages["/README.md"].count("\n```") % 2, 0)
        self.assertGreater(len(blocks), 6)

    def test_metadata(self):
        """Tests that the package has the project's version, and that its build has the packages of install-dependencies."""
        changelog = (SOURCE / "packaging/debian/changelog").read_text()
        self.assertEqual(re.match(r"hydro \(([^)]*)\)", changelog)[1], project_version())
        self.assertIn(f"\nVersion: {project_version()}\n", (self.prefix / "lib/pkgconfig/hydro.pc").read_text())
        script = (SOURCE / "scripts/install-dependencies").read_text()
        lists = re.findall(r"packages\+?=\(\n(.*?)\n\s*\)", script, re.DOTALL)
        needed = {word for text in lists for line in text.splitlines() for word in line.split("#")[0].split()}
        self.assertGreater(len(needed), 20)
        control = (SOURCE / "packaging/debian/control").read_text().split("\n\n")[0]
        listed = set(re.findall(r"^ ([a-z0-9.+-]+)", control, re.MULTILINE))
        self.assertEqual(needed - ONLY_TESTS - listed, set(), "not in Build-Depends of packaging/debian/control, nor in ONLY_TESTS here")


def project_version():
    return re.search(r"project\(hydro VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]


if __name__ == "__main__":
    outcome.main()
