"""Tests that docs/troubleshooting.md quotes messages that the programs still print."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Where messages come from: the rooms, and what runs beside them. Tests and pages only repeat them.
NO_SOURCES = {"tests", "docs", "bench", "build", "out", "node_modules"}
TABLES = {"safety_table.toml"}  # compiled into the programs
ENDINGS = {".cc", ".h", ".py", ".js", ".lcm"}
SHORTEST = 8  # characters of a fixed part; a shorter one would be found anywhere


def printed_text():
    """All sources as one text, in which a string that is written in several pieces, or with escaped quotes, is in one."""
    texts = []
    for folder in sorted(ROOT.iterdir()):
        if folder.name in NO_SOURCES or folder.name.startswith("."):
            continue
        files = [folder] if folder.is_file() else (path for path in folder.rglob("*") if not NO_SOURCES & set(path.relative_to(ROOT).parts))
        texts += [path.read_text(errors="replace") for path in files
                  if path.is_file() and (path.suffix in ENDINGS or path.name in TABLES or path.parent.name in ("scripts", "java") or path.name == "CMakeLists.txt")]
    return joined("\n".join(texts))


def joined(text):
    return re.sub(r'(?<!\\)"\s*\n\s*"', "", text).replace('\\"', '"')


def quoted_messages(page):
    """(line number, message) of each code span in the first column of the tables."""
    found = []
    for number, line in enumerate(page.splitlines(), 1):
        if line.startswith("| ") and line.count(" | ") >= 2:
            found += [(number, span) for span in re.findall(r"`([^`]+)`", line.split(" | ")[0])]
    return found


def unknown_parts(message, text):
    """The parts of a message, between `...`, that are not in the text."""
    parts = [part.strip() for part in message.split("...")]
    return [part for part in parts if part and part not in text]


class TroubleshootingTest(unittest.TestCase):
    def test_messages_exist(self):
        """Tests that each quoted message, key and program is in the sources."""
        text = printed_text()
        messages = quoted_messages((ROOT / "docs/troubleshooting.md").read_text())
        self.assertGreater(len(messages), 60)
        found = [f"docs/troubleshooting.md:{number}: no source prints `{part}`"
                 for number, message in messages for part in unknown_parts(message, text)]
        self.assertEqual(found, [], "\n".join(found))

    def test_messages_can_be_searched_for(self):
        """Tests that each quoted message has a fixed part that is long enough to be told from others."""
        short = [message for _, message in quoted_messages((ROOT / "docs/troubleshooting.md").read_text())
                 if max(len(part.strip()) for part in message.split("...")) < SHORTEST]
        self.assertEqual(set(short) - {"missed", "damaged", "ttl=0", "lcm-spy", "./check"}, set())

    def test_what_is_wrong_is_found(self):
        """Tests the checks themselves: a message in two pieces of a string, one that is gone, a `...`."""
        text = joined('Fail("no route to "\n     "the \\"group\\"", 1); Say("{} volts");')
        self.assertEqual(unknown_parts('no route to the "group"', text), [])
        self.assertEqual(unknown_parts("no way to ... volts", text), ["no way to"])
        page = "| symptom | cause | cure |\n|---|---|---|\n| `a b`, fault `c` | `d` | `e` |\n"
        self.assertEqual(quoted_messages(page), [(3, "a b"), (3, "c")])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
