"""Tests what firmware/ promises of itself, by its sources and by gcc's call graph: no heap, no recursion, no call through a pointer, no
loop without a bound but the program's own, no array of variable length, and no more stack than docs/front_end.md says."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/e2e"))
import outcome  # noqa: E402

CORE = sorted((ROOT / "firmware").glob("*.c")) + [ROOT / "firmware/boards/converter_link.c"]
# Board and start-up of the emulated board.
BOARD = sorted((ROOT / "firmware/boards/mps2_an386").glob("*.c"))
ARM = "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16".split()
FLAGS = "-std=c11 -O2 -ffreestanding -ffp-contract=off -fno-strict-aliasing".split()
ALLOWED_OUTSIDE = {"memcpy", "memset", "memmove"}  # GCC's own, for assignments of structs; and what a board provides:
BOARD_FUNCTION = re.compile(r"hydro_board_\w+")
LOOP = re.compile(r"\b(for|while|do|goto)\b")
FOR = re.compile(r"for \((?:size_t|uint8_t) (\w+) = \d+; \1 < (\w+); \+\+\1\)")
NODE = re.compile(r'^node: \{ title: "([^"]+)" label: "[^"]*?\\n(?:[^"]*?\\n)?(?:(\d+) bytes \(([^)]+)\))?[^"]*"( shape : ellipse)?')
EDGE = re.compile(r'^edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
PROGRAM_LOOP = "while (hydro_board_wait(&readings))"


def without_comments(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)


def body_after(text, at):
    """What a loop whose head ends at `at` repeats: a block, or a statement."""
    if not text[at:].lstrip().startswith("{"):
        return text[at : text.index(";", at)]
    depth, start = 0, text.index("{", at)
    for end in range(start, len(text)):
        depth += (text[end] == "{") - (text[end] == "}")
        if depth == 0:
            return text[start:end]
    raise ValueError("a brace is not closed")


def assigned(name, text):
    """Whether `text` changes the variable: by an assignment, a step, or through its address."""
    return re.search(rf"(?<![\w.>]){name}\s*(?:[-+*/%&|^]|<<|>>)?=(?!=)|(?:\+\+|--|&){name}\b|(?<![\w.>]){name}(?:\+\+|--)", text)


def loop_problems(name, text):
    """A line for each loop that might not end."""
    text, found = without_comments(text), []
    for loop in LOOP.finditer(text):
        where = f"{name}:{text[: loop.start()].count(chr(10)) + 1}"
        if text.startswith(PROGRAM_LOOP, loop.start()) and name == "main.c":
            continue
        head = FOR.match(text, loop.start())
        if not head:
            found.append(f"{where}: {text[loop.start() : loop.start() + 60].splitlines()[0]}: write for (size_t i = 0; i < BOUND; ++i)")
            continue
        variable, bound = head.groups()
        body = body_after(text, head.end())
        for changed in (variable, bound):
            if assigned(changed, body):
                found.append(f"{where}: {changed} changes within its loop")
    return found


def call_graph(compiler, flags, sources, folder):
    """From each function to (bytes of its own stack or None where it is outside, kind, functions that it calls)."""
    graph = {}
    for source in sources:
        out = pathlib.Path(folder) / (source.stem + ".o")
        subprocess.run([compiler, *FLAGS, *flags, f"-I{ROOT}", "-fcallgraph-info=su", "-c", source, "-o", out], check=True)
        for line in out.with_suffix(".ci").read_text().splitlines():
            if node := NODE.match(line):
                name, size, kind, outside = node.groups()
                if not outside:
                    calls = graph[name][2] if name in graph else set()
                    graph[name] = (int(size), kind, calls)
                else:
                    graph.setdefault(name, (None, None, set()))
            elif edge := EDGE.match(line):
                graph.setdefault(edge[1], (None, None, set()))[2].add(edge[2])
                graph.setdefault(edge[2], (None, None, set()))
    return graph


def graph_problems(graph):
    """A line for each call that is not allowed."""
    found = []
    for name, (size, kind, _) in sorted(graph.items()):
        if size is None and name not in ALLOWED_OUTSIDE and not BOARD_FUNCTION.fullmatch(name):
            found.append(f"calls {name}, which is not the firmware's")
        if kind and kind != "static":
            found.append(f"{name}: its stack is {kind}")

    def visit(name, path):
        if name in path:
            found.append("recursion: " + " -> ".join([*path[path.index(name) :], name]))
            return
        for other in sorted(graph[name][2]):
            visit(other, [*path, name])

    for name in sorted(graph):
        visit(name, [])
    return found


def stack_of(graph, name):
    """Bytes of stack from this function on; the graph has no circle."""
    size, _, calls = graph[name]
    return (size or 0) + max((stack_of(graph, other) for other in calls), default=0)


class StaticTest(unittest.TestCase):
    def graph(self, compiler, flags, sources):
        if not shutil.which(compiler):
            self.skipTest(f"needs {compiler}")
        with tempfile.TemporaryDirectory() as folder:
            return call_graph(compiler, flags, sources, folder)

    # Tests that every loop has a bound that its body does not move.
    def test_loops(self):
        found = [line for source in CORE for line in loop_problems(source.name, source.read_text())]
        headers = [line for header in (ROOT / "firmware").glob("*.h") for line in loop_problems(header.name, header.read_text())]
        self.assertEqual(found + headers, [])
        self.assertGreater(len(CORE), 6)

    # Tests that there is no recursion and nothing foreign in the program, and that its stack is what the page says.
    def test_calls_and_stack(self):
        page = (ROOT / "docs/front_end.md").read_text()
        said = re.search(r"at most ([\d,]+) bytes of stack", page)
        self.assertIsNotNone(said, "docs/front_end.md says how much stack")
        limit = int(said[1].replace(",", ""))
        self.assertEqual(graph_problems(self.graph("gcc", [], CORE)), [])
        graph = self.graph("arm-none-eabi-gcc", ARM, CORE)
        self.assertEqual(graph_problems(graph), [])
        stack = stack_of(graph, "main")
        self.assertLessEqual(stack, limit)
        self.assertGreater(stack, limit * 0.7, "the page says much more than it is")

    # Tests the same of the emulated board; its interrupts come on top, one at a time.
    def test_emulated_board(self):
        graph = self.graph("arm-none-eabi-gcc", ARM, CORE + BOARD)
        self.assertEqual(graph_problems(graph), [])

    # Tests that the skeleton for a microcontroller compiles, without a warning. More is not known of it.
    def test_skeleton_compiles(self):
        skeleton = ROOT / "firmware/boards/stm32_skeleton/board.c"
        self.assertIn("NOT TRIED", skeleton.read_text())
        graph = self.graph("arm-none-eabi-gcc", [*ARM, "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Werror"], [*CORE, skeleton])
        foreign = [line for line in graph_problems(graph) if "calls yours_" not in line]
        self.assertEqual(foreign, [])

    # Tests the checks themselves: each kind of what is forbidden is found.
    def test_what_is_wrong_is_found(self):
        for text in ("while (x) {}", "do { } while (0);", "for (;;) {}", "for (size_t i = 0; i != n; ++i) {}", "for (size_t i = 0; i < n; i += 0) {}",
                     "for (size_t i = 0; i < n; ++i) { i = 0; }", "for (size_t i = 0; i < n; ++i) { n += 1; }",
                     "for (size_t i = 0; i < n; ++i) move(&i);", "for (size_t i = 0; i < n; ++i) i--;", "goto again;",
                     "while (hydro_board_wait(&readings)) {}"):
            self.assertEqual(len(loop_problems("x.c", text)) > 0, True, text)
        self.assertEqual(loop_problems("x.c", "for (size_t i = 0; i < n; ++i) { a[i] = n; b.n = i; } /* while */"), [])
        if not shutil.which("gcc"):
            self.skipTest("needs gcc")
        head = "#include <stddef.h>\nvoid *malloc(size_t);int f(int);int g(int);int h(int n);int (*p)(int);\n"
        for text, words in (("int f(int n) { return n ? f(n - 1) * 3 + f(n - 2) : 0; }", "recursion: f -> f"),
                            ("__attribute__((noinline)) int g(int n) { return n + f(n - 1) * 2; }\n"
                             "__attribute__((noinline)) int f(int n) { return n ? 2 * g(n) + 1 : 0; }", "recursion"),
                            ("int f(int n) { return *(int *)malloc((size_t)n); }", "malloc"),
                            ("int f(int n) { return p(n) + 1; }", "__indirect_call"),
                            ("int f(int n) { char *a = __builtin_alloca((size_t)n); h((int)(long)a); return a[0]; } int h(int n) { return n; }", "dynamic")):
            with tempfile.TemporaryDirectory() as folder:
                source = pathlib.Path(folder) / "bad.c"
                source.write_text(head + text + "\n")
                self.assertIn(words, "\n".join(graph_problems(call_graph("gcc", [], [source], folder))), text)


if __name__ == "__main__":
    outcome.main()
