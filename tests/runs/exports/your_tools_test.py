"""Runs what docs/your_tools.md tells its readers to type, section by section, on a log of the demo.

The lines of shell come first, then those of Python, MATLAB or Octave (both run by Octave), in the order of the page."""

import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "e2e"))
import outcome  # noqa: E402

PAGE = pathlib.Path(__file__).resolve().parents[3] / "docs/your_tools.md"
BIN = os.environ["HYDRO_BIN"]
RUNNERS = {"sh": ["bash", "-euc"], "python": [sys.executable, "-c"], "matlab": ["octave-cli", "--norc", "--no-history", "--eval"]}
RUNNERS["octave"] = RUNNERS["matlab"]


def sections():
    """Each heading with its blocks: (language, text)."""
    for section in PAGE.read_text(encoding="utf-8").split("\n## ")[1:]:
        yield section.split("\n", 1)[0], re.findall(r"```(\w+)\n(.*?)```", section, re.DOTALL)


class YourToolsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        config = os.path.join(os.environ["HYDRO_CONFIG"], "demo.toml")
        self.run_in("sh", f"hydro-sim '{config}' --duration 0.4 -o run.lcmlog")

    def run_in(self, language, text):
        done = subprocess.run([*RUNNERS[language], text], cwd=self.folder, capture_output=True, text=True, timeout=120, check=False,
                              env=dict(os.environ, PATH=BIN + ":" + os.environ["PATH"]))
        self.assertEqual(done.returncode, 0, f"{language}:\n{text}\n{done.stdout[-1000:]}{done.stderr[-2000:]}")
        return done.stdout

    # Tests that the page has a section for each tool and lines of each language in it.
    def test_page(self):
        found = {name: [language for language, _ in blocks] for name, blocks in sections()}
        self.assertEqual(found, {"pandas": ["sh", "python"], "Jupyter": ["sh", "python"], "MATLAB": ["sh", "matlab"],
                                 "Octave": ["sh", "octave", "sh", "octave"], "PlotJuggler": ["sh"], "Foxglove": ["sh"]})

    # Tests that the lines run, and print what a reader expects of this log.
    def test_lines(self):
        expected = {"pandas": ["largest error 0", "p1_psi"], "Jupyter": ["HYDRO_STATE", " psi pressure of side 1", "hydro-sim"],
                    "MATLAB": ["401 states, pressures in psi", "1000 ticks a second", "0.4 s"],
                    "Octave": ["30 rows from 0.01 s", "complete", "30 ", "missing: 0 with empty cells, 1 with nan"], "PlotJuggler": [], "Foxglove": []}
        for name, blocks in sections():
            with self.subTest(name):
                modules = [module for _, text in blocks for module in re.findall(r"^import (\w+)", text, re.MULTILINE)]
                missing = [module for module in modules if not importlib.util.find_spec(module)]
                missing += ["octave"] if {"matlab", "octave"} & {language for language, _ in blocks} and not shutil.which("octave-cli") else []
                if missing:
                    self.skipTest(f"{name}: {missing} not installed")
                printed = "".join(self.run_in(language, text) for language, text in blocks)
                for text in expected[name]:
                    self.assertIn(text, printed)


if __name__ == "__main__":
    outcome.main()
