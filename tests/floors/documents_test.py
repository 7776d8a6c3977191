"""Tests that README.md and the pages of docs/ show the house as it is: its rooms, paths and headings that exist; and that docs/README.md
lists every page."""

import pathlib
import re
import sys
import tempfile
import unittest

from floors_test import load_rooms_script

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["README.md", "CONTRIBUTING.md", *sorted(p.relative_to(ROOT).as_posix() for p in (ROOT / "docs").rglob("*.md"))]
# What a page may name although it is not in the repository: what is built, written by a program or made by the reader.
MADE = re.compile(r"(build|out)/.*|config/mine\.toml")
# A path in a code span: folders of the repository's root, then names; braces and stars as in a shell.
PATH = re.compile(r"`((?:\./)?[\w@.+-]+(?:/[\w@.,*{}+-]+)+/?)`")
# Files that send a reader to a page.
SOURCES = {".cc", ".h", ".in", ".js", ".lcm", ".md", ".py", ".toml", ".txt", ""}
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)|<img src=\"([^\"]+)\"")


def expand(path):
    """The paths that a shell makes of braces: a/{b,c}.h is a/b.h and a/c.h."""
    braces = re.search(r"\{([^{}]*)\}", path)
    if not braces:
        return [path]
    start, end = path[: braces.start()], path[braces.end() :]
    return [full for part in braces.group(1).split(",") for full in expand(start + part + end)]


def is_there(path, root):
    return all(any(root.glob(each.removeprefix("./").rstrip("/"))) for each in expand(path))


def missing_paths(text, root):
    """(line number, path) of each path in a code span that starts with a folder of `root` and does not exist."""
    tops = {child.name for child in root.iterdir() if child.is_dir() and not child.name.startswith(".")}
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        for path in PATH.findall(line):
            named = path.removeprefix("./")
            if named.split("/")[0] not in tops or MADE.fullmatch(named):
                continue
            if not is_there(named, root):
                found.append((number, path))
    return found


def anchors(text):
    """What a link's #... may be: each heading as GitHub writes it (small letters, no punctuation, blanks as hyphens)."""
    headings = re.findall(r"^#+ (.*)", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def missing_anchors(page, text):
    """(line number, link) of each link of `page` (a path) to a heading that the page it leads to does not have."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        for target, anchor in re.findall(r"\]\(([^)#\s]*)#([^)\s]+)\)", line):
            there = page.parent / target if target else page
            if "://" not in target and there.suffix == ".md" and there.exists() and anchor not in anchors(there.read_text()):
                found.append((number, f"{target}#{anchor}"))
    return found


def inline_markers(text):
    """(line number, line) of each marker of the installed pages that does not stand alone: packaging/pages takes out what is between
    <!-- sources --> and <!-- /sources -->, and keeps what <!-- installed ... --> has, as whole lines with blank ones around them."""
    lines, found = ["", *text.splitlines(), ""], []
    for number, line in enumerate(lines):
        begins, ends = line == "<!-- sources -->" or line == "<!-- installed", line in ("<!-- /sources -->", "-->")
        marker = re.search(r"<!-- (/?sources|installed)\b", line) or line == "-->"
        before_ok = ends or lines[number - 1] in ("", "<!-- /sources -->")
        after_ok = begins or lines[min(number + 1, len(lines) - 1)] in ("", "<!-- installed")
        if marker and not ((begins or ends) and before_ok and after_ok):
            found.append((number, line))
    return found


class DocumentsTest(unittest.TestCase):
    def test_rooms_are_current(self):
        """Tests that README.md and docs/developers/architecture.md show the rooms of cmake/rooms.txt."""
        pages = load_rooms_script().outdated(ROOT)
        self.assertEqual(sorted(pages), [], "not current; this mends it: scripts/rooms --write")

    def test_paths_exist(self):
        """Tests that every path of the repository that a page names in a code span exists."""
        found = [f"{page}:{number}: {path} does not exist"
                 for page in PAGES for number, path in missing_paths((ROOT / page).read_text(), ROOT)]
        self.assertEqual(found, [], "\n".join(found))

    def test_links_lead_somewhere(self):
        """Tests that every relative link and picture of a page leads to a file."""
        found = []
        for page in PAGES:
            for number, line in enumerate((ROOT / page).read_text().splitlines(), 1):
                for target in map("".join, LINK.findall(line)):
                    if "://" not in target and not (ROOT / page).parent.joinpath(target).exists():
                        found.append(f"{page}:{number}: {target} does not exist")
        self.assertEqual(found, [], "\n".join(found))

    def test_links_lead_to_headings(self):
        """Tests that what a link names behind # is a heading of the page that it leads to."""
        found = [f"{page}:{number}: {link} does not exist"
                 for page in PAGES for number, link in missing_anchors(ROOT / page, (ROOT / page).read_text())]
        self.assertEqual(found, [], "\n".join(found))

    def test_markers_stand_alone(self):
        """Tests that what an installation's pages leave out or add are whole paragraphs, list items or blocks, never parts of a sentence."""
        found = [f"{page}:{number}: {line}" for page in PAGES for number, line in inline_markers((ROOT / page).read_text())]
        self.assertEqual(found, [], "a marker needs a line of its own, and a blank line outside it:\n" + "\n".join(found))
        self.assertIn("\n<!-- sources -->\n", (ROOT / "README.md").read_text())

    def test_index(self):
        """Tests that docs/README.md lists each page of docs/ once, with a line that says what it is for, and README.md leads there."""
        listed = re.findall(r"^\| \[([\w/]+\.md)\]\(([\w/]+\.md)\) \| (.{10,}) \|$", (ROOT / "docs/README.md").read_text(), re.MULTILINE)
        self.assertEqual([(name, target) for name, target, _ in listed if name != target], [])
        pages = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")} - {"README.md"}
        self.assertEqual(sorted(name for name, _, _ in listed), sorted(pages))
        self.assertIn("](docs/README.md)", (ROOT / "README.md").read_text())

    def test_pages_that_sources_name_exist(self):
        """Tests that each page that a message, a --help, a message type, a configuration or an example names exists."""
        found, count = [], 0
        for folder in sorted(ROOT.iterdir()):
            if folder.name.startswith(".") or folder.name in ("build", "docs", "out", "tests"):
                continue
            for path in [folder] if folder.is_file() else folder.rglob("*"):
                if "node_modules" in path.parts or path.suffix not in SOURCES or not path.is_file():
                    continue
                for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
                    for page in re.findall(r"\bdocs/[\w/]+\.md\b", line):
                        count += 1
                        if not (ROOT / page).exists():
                            found.append(f"{path.relative_to(ROOT)}:{number}: {page} does not exist")
        self.assertGreater(count, 40)
        self.assertEqual(found, [], "\n".join(found))

    def test_what_is_wrong_is_found(self):
        """Tests the checks themselves: a room that was added, a list without markers, paths that do not exist."""
        rooms = load_rooms_script()
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("cmake", "docs/developers", "base"):
                (root / name).mkdir(parents=True)
            (root / "base/text.h").touch()
            (root / "cmake/rooms.txt").write_text("# head\nbase  text\n")
            (root / "README.md").write_text("a\n<!-- rooms -->\n<!-- /rooms -->\nb\n")
            (root / "docs/developers/architecture.md").write_text("<!-- rooms -->\n<!-- /rooms -->\n")
            for name, text in rooms.outdated(root).items():
                (root / name).write_text(text)
            self.assertEqual(rooms.outdated(root), {})
            self.assertEqual((root / "README.md").read_text(),
                             "a\n<!-- rooms -->\n| floors, from the top | |\n|---|---|\n| `base/` | text |\n<!-- /rooms -->\nb\n")
            (root / "cmake/rooms.txt").write_text("base  text\n\nmodel  equations\n")
            self.assertEqual(sorted(rooms.outdated(root)), ["README.md", "docs/developers/architecture.md"])
            (root / "README.md").write_text("no markers\n")
            self.assertRaisesRegex(ValueError, "README.md: found no <!-- rooms -->", rooms.outdated, root)
            whole = "a\n\n<!-- sources -->\nb\n<!-- /sources -->\n<!-- installed\nc\n-->\n\nd\n"
            self.assertEqual(inline_markers(whole), [])
            self.assertEqual(inline_markers("a<!-- sources -->, b<!-- /sources -->.\n"), [(1, "a<!-- sources -->, b<!-- /sources -->.")])
            self.assertEqual(inline_markers("a\n<!-- sources -->\nb\n<!-- /sources -->c\n"), [(2, "<!-- sources -->"), (4, "<!-- /sources -->c")])
            self.assertEqual(inline_markers("<!-- installed a -->\n"), [(1, "<!-- installed a -->")])
            text = "`base/text.h`\n`base/old.h` and `other/x.h`\n`base/{text,gone}.h` `./base/*.h`"
            page = root / "docs/a.md"
            page.write_text("# A `b` (c): d\n```\n# no heading\n```\n[x](#a-b-c-d) [x](#no-heading)\n[x](a.md#gone) [x](https://y#z)\n")
            self.assertEqual(missing_anchors(page, page.read_text()), [(5, "#no-heading"), (6, "a.md#gone")])
            self.assertEqual(missing_paths(text, root), [(2, "base/old.h"), (3, "base/{text,gone}.h")])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
