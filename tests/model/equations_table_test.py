"""Holds the table of equations in docs/model.md against the code: every equation of the paper has a row, each file that a
row names exists, and the symbol stands there next to the equation's number."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = "docs/model.md"
EQUATIONS = [n for n in range(1, 18) if n != 8]  # the paper has no (8)
NEAR = 3  # lines between a symbol and its equation's number, either way

ROW = re.compile(r"^\| \((\d+)\) \| [^|]+ \| `([^`]+)` \| `([^`]+)` \|$")


def stands_there(lines, number, symbol):
    """Whether the symbol, as a word, has the number in parentheses near it."""
    word = re.compile(rf"(?<!\w){re.escape(symbol)}(?!\w)")
    for i, line in enumerate(lines):
        if word.search(line) and any(f"({number})" in near for near in lines[max(0, i - NEAR):i + NEAR + 1]):
            return True
    return False


def faults(root):
    rows = []
    for number, line in enumerate((root / DOCUMENT).read_text(encoding="utf-8").splitlines(), 1):
        match = ROW.match(line)
        if match:
            rows.append((number, int(match[1]), match[2], match[3]))
    for equation in EQUATIONS:
        if equation not in {row[1] for row in rows}:
            yield f"{DOCUMENT}: equation ({equation}) has no row in the table of equations"
    for number, equation, name, symbol in rows:
        if equation not in EQUATIONS:
            yield f"{DOCUMENT}:{number}: found equation ({equation}), the paper has (1) to (17) without (8)"
        elif not (root / name).is_file():
            yield f"{DOCUMENT}:{number}: {name} does not exist: name the file that has equation ({equation}) now"
        elif not stands_there((root / name).read_text(encoding="utf-8").splitlines(), equation, symbol):
            yield (f"{DOCUMENT}:{number}: {name} has no `{symbol}` within {NEAR} lines of ({equation}): "
                   "correct the row, or write the number beside the equation in the code")


def test_the_test():
    """The check finds what it is for."""
    lines = ["x.q_1 = D * speed;  // (11)", "", "", "", "", "y = 1;"]
    assert stands_there(lines, 11, "q_1") and stands_there(lines, 11, "x.q_1")
    assert not stands_there(lines, 11, "q_") and not stands_there(lines, 1, "q_1") and not stands_there(lines, 11, "y")


test_the_test()
found = list(faults(ROOT))
print("\n".join(found))
sys.exit(1 if found else 0)
