"""Runs the command lines in the code blocks of README.md and docs/, page by page and in their order, in a folder that looks like a checkout.

A page's table says what its lines need and what a line that is not run as it stands becomes: another line, or the reason why it cannot be run here,
with the test that runs it where there is one. Every line of a table must still be on its page. docs/start.md, docs/your_tools.md and
docs/own_controller.md have tests of their own; page_commands_test.py looks at the names and options of all lines and of commands in prose."""

import dataclasses
import os
import pathlib
import re
import shutil

import outcome
import stack

ROOT = pathlib.Path(__file__).resolve().parents[2]
OWN_TESTS = {"start.md": "start_page_test.py", "your_tools.md": "your_tools_test.py", "own_controller.md": "own_controller_test.py",
             "own_driver.md": "own_driver_test.py", "front_end.md": "front_end_test.py"}
# What begins a command. A program's output, a diagram or a file in a page does not begin like this.
COMMAND = re.compile(r"(?:\$ |\w+\$ +)?((?:build/(?:bin|tests)/|\./|scripts/)[\w./-]+|hydro-[a-z-]+(?![\w:-])|for|mkdir|cp|cd|cmake|export|fpath=|apt|javac|openssl|nginx|"
                     r"npm|node|systemd-sysusers|systemctl|journalctl)(?=[\s=(]|$)")


@dataclasses.dataclass
class As:
    """Another line in place of one, with a reason; `code`: how it ends; `prints`: what its output has."""

    line: str
    why: str = ""
    code: int = 0
    prints: str = ""


@dataclasses.dataclass
class Prints:
    """The line as it stands."""

    prints: str
    code: int = 0


@dataclasses.dataclass
class Not:
    """Not run here. `test`: the test that runs it, or a part of its name."""

    why: str
    test: str = ""


RUN = "hydro-sim config/demo.toml -o run.lcmlog\n"
RIG = "hydro-sim config/demo.toml --duration 2 --set model.file=models/table1_stribeck.toml -o rig.lcmlog && hydro-log export rig.lcmlog -o rig.csv\n"
BUILDS = "the tests run in a build already"
HERE = "changes this machine"
BOARD = "needs a board"
SHORT = "shorter"

# By page: (options of a stack that runs beside the commands, or none; lines to run first; {beginning of a
# line: what is done with it}).
PAGES = {
    "README.md": (None, "", {
        "./demo   ": Not("installs packages", "demo"),
        "./demo --scope": Not("runs until it is stopped", "demo"),
        "./check": Not("is what runs this"),
        "./scripts/build programs": Not(BUILDS),
        "build/bin/hydro-experiment all": Not("takes half a minute", "experiment"),
        "./demo --set": Not("installs packages", "demo"),
        "build/bin/hydro-log summary mine": Prints("3 steps|step at"),
        "build/bin/hydro-log compare": Prints("identical"),
        "build/bin/hydro-diagnose": Not("half a minute; as on docs/start.md", "start_page"),
    }),
    "configuration.md": (None, "", {
        "hydro-launch config/paper.toml": As("hydro-launch config/paper.toml --set pressure.damping_ratio=0.7 --set time.mode=realtime "
                                            "--set \"reference.steps=[[0, 0.1], [1, 0]]\" --duration 0.5", SHORT),
    }),
    "effects.md": (None, "", {
        "cmake --build": Not(BUILDS),
        "build/tests/effects_table": Not("writes into the sources", "effects_table"),
        "build/tests/model_effects_test": Not("is a test itself", "model_effects_test"),
    }),
    "experiments.md": (None, "", {
        "build/bin/hydro-experiment --list": Prints("fig3"),
        "build/bin/hydro-experiment all": Not("takes half a minute", "experiment"),
        "build/bin/hydro-experiment friction": Not("needs a measured run", "experiment"),
    }),
    "gap_finder.md": (None, "", {
        "hydro-diagnose RUN... --model MODEL.toml --out DIR": Not("a synopsis"),
        "hydro-diagnose RUN... --model MODEL.toml --check": Not("a synopsis"),
        "hydro-diagnose sine_moves": Not("needs measured data, and a minute", "real_data"),
    }),
    "hardware.md": (None, "C=config/mine.toml; cp config/demo.toml $C; hydro-sim $C -o sign.lcmlog\n", {
        "hydro-launch $C --duration 4 --set driver": Not(BOARD),
        "hydro-launch $C --duration 4 --log sign": Not(BOARD),
        "hydro-launch $C --duration 4 --log inner": Not(BOARD),
    }),
    "install.md": (None, "", {
        "scripts/package": Not("ten minutes", "packaging"),
        "apt install ./build": Not(HERE, "packaging"),
        "scripts/build programs": Not(BUILDS),
        "cmake --install": Not(BUILDS, "install"),
        "export PATH": Not("names a prefix", "install"),
        "fpath=": Not("zsh's", "packaging"),
        "apt install default-jre": Not(HERE),
        "hydro-spy": Not("opens a window", "java"),
        "javac": Not("needs a JDK", "java"),
    }),
    "launch.md": (None, "", {
        "mkdir -p out; hydro-launch": As("mkdir -p out; hydro-launch config/demo.toml --duration 1 --log out/run.lcmlog", SHORT),
        "rig$": Not("two hosts", "hosts"),
        "desk$": Not("two hosts", "hosts"),
    }),
    "limbs.md": (None, "", {
        "mkdir -p out; hydro-launch config/limb.toml --time realtime":
            As("mkdir -p out; hydro-launch config/limb.toml --time realtime --duration 1 --log out/limb.lcmlog", SHORT),
        "hydro-log summary out/limb": Prints("a limb with 2 joints"),
        "hydro-log compare b.lcmlog": Prints("identical"),
        "hydro-launch rearm config/limb.toml      ": As("hydro-launch rearm config/limb.toml", "none runs", 1),
        "hydro-launch rearm config/limb.toml --joint": As("hydro-launch rearm config/limb.toml --joint knee", "none runs", 1),
        "hydro-launch stop config/limb.toml": As("hydro-launch stop config/limb.toml", "none runs", 1),
        "hydro-tune config/limb.toml --joint knee --fixed-gains -o out/knee.toml":
            As("hydro-tune config/limb.toml --joint knee --fixed-gains --goal step=0.1 --samples 0 -o out/knee.toml", SHORT),
    }),
    "network.md": (None, "", {
        "hydro-launch CONFIG --doctor  ": As("hydro-launch config/demo.toml --doctor || test $? = 1", "a machine may have problems", 0, "multicast route"),
        "hydro-launch CONFIG --doctor --host": As("hydro-launch config/demo.toml --doctor --host rig", "no process of this name", 2, "rig"),
    }),
    "own_rig.md": (None, RIG, {
        "hydro-diagnose RUN.csv": As("hydro-diagnose rig.lcmlog --model config/models/table1.toml --check", "a recording of ours", 0, "sign of the command"),
        "$ hydro-diagnose sine_moves": Not("needs measured data", "real_data"),
    }),
    "safety.md": ((), "", {
        "hydro-launch CONFIG --rearm        # hydro-launch: re-armed": As("hydro-launch config/demo.toml --rearm", "nothing is latched", 1, "re-arm|rearm"),
        "hydro-launch CONFIG --rearm        # hydro-launch: refused": Not("the same line", "fault"),
    }),
    "safety_tests.md": (None, "", {
        "build/tests/safety_page": Not("writes into the sources", "safety_page"),
    }),
    "scope.md": (None, "", {
        "hydro-launch config/demo.toml --set time.duration_s=0 &": Not("runs until it is stopped", "scope"),
        "hydro-scope config/demo.toml": Not("serves until it is ended", "scope"),
        "openssl req": Prints(""),
        "hydro-scope config/mine.toml": Not("serves until it is ended", "tls"),
        "nginx": Not("serves until it is ended", "tls"),
        "cd scope/page": Not(HERE),
        "node --test tests/scope/unit": Not("is a test itself", "page"),
        "npm --prefix": Not("is a test itself", "page"),
        "node --test --test": Not("is a test itself", "page"),
        "node tests/scope/mock": Not("serves until it is ended"),
    }),
    "security.md": (None, "sed 's|^url = .*|&\\nkey_file = \"stack.key\"|' config/demo.toml > stack.toml; cp -r config/models .\n", {
        "hydro-launch stack.toml --make-key": Prints("stack.key"),
    }),
    "systemd.md": (None, "", {
        "cmake --install": Not(HERE, "install"),
        "systemd-sysusers": Not(HERE), "mkdir": Not(HERE), "cp ": Not(HERE), "systemctl enable --now": Not(HERE), "systemctl start": Not(HERE),
        "systemctl enable hydro@": Not(HERE), "journalctl": Not(HERE),
    }),
    "timing.md": (None, "", {
        "hydro-launch config/demo.toml": As("hydro-launch config/demo.toml --duration 1 --log run.lcmlog --timing timing.json", SHORT),
        "hydro-log timing": Prints("pressure_ctrl"),
    }),
    "torture.md": (None, "", {
        "build/bin/hydro-torture       ": As("build/bin/hydro-torture --runs 3", SHORT),
        "build/bin/hydro-torture --replay out/torture/seed_4711.torture\n": Not("there is one where a seed failed", "torture"),
        "build/bin/hydro-torture --replay out/torture/seed_4711.torture --tail": Not("there is one where a seed failed", "torture"),
        "build/bin/hydro-torture --list": Prints("launcher_crash"),
        "scripts/torture 8": Not("eight hours"),
        "scripts/torture --study 2000": Not("hours"),
        "scripts/torture --real": Not("minutes", "torture"),
        "hydro-torture 1": Not("the first line of a schedule"),
    }),
    "troubleshooting.md": (None, RUN, {
        "hydro-launch CONFIG --doctor": As("hydro-launch config/demo.toml --doctor || test $? = 1", "a machine may have problems", 0, "multicast route"),
        "hydro-log info": Prints("complete"),
    }),
    "tuning.md": (("--set", "position.c2=350"), "", {
        "hydro-set CONFIG position": As("hydro-set config/demo.toml position.c2=900 pressure.natural_frequency_rad_s=120", "", 0, "acts from tick"),
        "hydro-set CONFIG --undo": As("hydro-set config/demo.toml --undo", "", 0, "acts from tick"),
        "hydro-set CONFIG --list": As("hydro-set config/demo.toml --list", "", 0, "position.c2"),
        "hydro-set CONFIG --watch": Not("until Ctrl-C", "set"),
        "hydro-set CONFIG --save": As("hydro-set config/demo.toml --save saved.toml", "", 0),
        "$ hydro-set config/demo.toml position.c2=1200": Prints("gain margin"),
        "$ hydro-set config/demo.toml position.c2=9000": Prints("UNSTABLE", 1),
        "hydro-launch config/demo.toml --set position.c2=350": Not("25 s of a stack while one runs; its log is that of the summary below"),
    }),
    # With one draw in place of four: a quarter of the cases.
    "studies.md": (None, f"cp -r {ROOT}/examples .\nsed -i 's/^draws = 4$/draws = 1/' examples/studies/position_gains.toml\n", {
        "build/bin/hydro-batch examples/studies/position_gains.toml --out out/gains --slurm": Not("needs a Slurm cluster", "slurm"),
    }),
    # What a whole search finds is the subject of tune_program_test and e2e.tune.
    "tuning_gains.md": (None, "", {
        "build/bin/hydro-tune config/paper.toml      ": As("build/bin/hydro-tune config/paper.toml --goal step=0.1 --samples 0", SHORT),
        "mkdir -p out; build/bin/hydro-tune config/paper.toml -o": As("mkdir -p out; build/bin/hydro-tune config/paper.toml --goal step=0.1 "
                                                                   "--samples 0 -o out/tuned.toml --out out/tune", SHORT),
        "build/bin/hydro-tune config/paper.toml --goal": As("build/bin/hydro-tune config/paper.toml --goal overshoot_percent=1 --goal settling_s=0.6 "
                                                           "--goal step=0.1 --samples 0", SHORT),
        "build/bin/hydro-tune config/realtime.toml": As("build/bin/hydro-tune config/realtime.toml --interval 0.002 --noise --goal step=0.1 "
                                                        "--samples 0", SHORT),
    }),
}


def lines_of(page):
    """The command lines of a page's code blocks as they stand, without prompts and with the lines that they go on on; loops are one line."""
    found, in_block, shown, joined = [], False, False, ""
    for line in page.splitlines():
        bare = line.strip()
        if bare.startswith("```"):
            in_block, shown, joined = not in_block, bare not in ("```", "```sh"), ""
        elif in_block and not shown and (joined or COMMAND.match(bare) and not re.search(r"\s\||-> |\^", bare)):
            joined += ("\n" if joined else "") + bare
            if not bare.endswith("\\") and (not joined.startswith("for ") or bare == "done"):  # loops end with done
                found.append(joined)
                joined = ""
    return found


class PageLinesTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        shutil.copytree(stack.CONFIG, self.path("config"))
        os.makedirs(self.path("build"))
        os.symlink(stack.BIN, self.path("build/bin"))
        os.symlink(ROOT / "scripts", self.path("scripts"))
        for config in pathlib.Path(self.path("config")).glob("*.toml"):
            config.write_text(re.sub(r'(?m)^url = "[^"]*"', f'url = "{self.url}"', config.read_text()))

    def bash(self, text, code, prints):
        process = self.start("/bin/bash", "-euc", f"PATH='{stack.BIN}':$PATH\n{text}", label=text)
        self.assertEqual(process.wait(120), code, process.report())
        if prints:
            self.assertRegex(process.stdout + process.stderr, prints, text)

    def run_page(self, name):
        running, before, table = PAGES[name]
        variables = "".join(re.findall(r"^C=[^;]*;", before))
        if before:
            self.bash(before, 0, "")
        if running is not None:
            self.launch("config/demo.toml", "--set", "time.duration_s=0", *running).wait_for("processes ready")
        page = (ROOT / name if name == "README.md" else next((ROOT / "docs").rglob(name))).read_text(encoding="utf-8")
        used, ran = set(), 0
        for line in lines_of(page):
            beginnings = [one for one in table if (line + "\n").startswith(one)]
            self.assertLessEqual(len(beginnings), 1, f"{name}: {line}: {beginnings}")
            used.update(beginnings)
            what = table[beginnings[0]] if beginnings else Prints("")
            if isinstance(what, Not):
                continue
            text = what.line if isinstance(what, As) else re.sub(r"^\w*\$ +", "", line)
            self.bash(variables + text, what.code, what.prints)
            ran += 1
        self.assertEqual(sorted(set(table) - used), [], f"{name}: these lines are no longer there")
        return ran

    # Tests that every page with command lines has its table here, or a test of its own.
    def test_all_pages(self):
        pages = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
        with_lines = {page.name for page in pages if page.parent == ROOT or page.name != "README.md" if lines_of(page.read_text(encoding="utf-8"))}
        self.assertEqual(with_lines, set(PAGES) | set(OWN_TESTS))
        for test in OWN_TESTS.values():
            self.assertTrue(list((ROOT / "tests").rglob(test)), test)

    # Tests that every test that is named as running something exists.
    def test_other_tests(self):
        names = " ".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("CMakeLists.txt"))
        for _, _, table in PAGES.values():
            for what in table.values():
                if isinstance(what, Not):
                    self.assertIn(what.test, names)


def add_pages():
    for name in PAGES:
        def test(self, name=name):
            self.run_page(name)
        setattr(PageLinesTest, "test_" + name.removesuffix(".md").lower(), test)


add_pages()

if __name__ == "__main__":
    outcome.main()
