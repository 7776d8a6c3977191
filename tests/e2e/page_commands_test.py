"""Tests that each command line of ours in README.md and docs/ names a program that exists, its verbs and options that --help knows."""

import functools
import os
import pathlib
import re
import shlex
import subprocess
import unittest

import outcome

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = os.environ.get("HYDRO_BIN", str(ROOT / "build/bin"))
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
SCRIPTS = {"hydro-spy": ROOT / "packaging/java/hydro-spy"}  # programs that are not compiled
# A command: at the beginning of the line, after a prompt or after something that joins commands.
COMMAND = re.compile(r"(?:^|[;&|(]|\bdo|[\w-]*\$)\s*(?:\S*/)?(hydro-[a-z-]+)(?=\s|$)(.*)")


@functools.lru_cache(maxsize=None)
def known(program, verb=""):
    """(options, verbs) that --help of a program or of its verb shows."""
    path = SCRIPTS.get(program, pathlib.Path(BIN) / program)
    done = subprocess.run([path, *([verb] if verb else []), "--help"], capture_output=True, text=True, timeout=60, check=True)
    options = set(re.findall(r"^\s+(-\w|--[\w-]+)", done.stdout, re.MULTILINE)) | set(re.findall(r"^\s+-\w,(--[\w-]+)", done.stdout, re.MULTILINE))
    listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", done.stdout, re.MULTILINE)
    verbs = {line.split()[0] for line in listed[1].splitlines()} if listed else set(re.findall(rf"Also: {program} ([a-z-]+)", done.stdout))
    if program == "hydro-experiment":
        listed = subprocess.run([path, "--list"], capture_output=True, text=True, timeout=60, check=True).stdout
        verbs = {"all", *(line.split()[0] for line in listed.splitlines() if line.strip())}
    return options, verbs


def commands(page):
    """(line number, program, its words) of the command lines in code blocks and of code spans."""
    found, in_block, block_line, joined = [], False, 0, ""
    for number, line in enumerate(page.splitlines(), 1):
        if line.lstrip().startswith("```"):
            in_block = not in_block
        elif in_block:
            block_line = block_line if joined else number
            joined += line.lstrip() if joined else line
            if joined.endswith("\\"):
                joined = joined[:-1]
                continue
            # The lines of a diagram or of a program's own output look different: "hydro-launch: re-armed",
            # boxes.
            found += [(block_line, *each) for each in split(joined)]
            joined = ""
        else:
            for span in re.findall(r"`([^`]+)`", line):
                if re.match(r"(?:\S*/)?hydro-[a-z-]+ \S", span):
                    found += [(number, *each) for each in split(span)]
    return found


def split(text):
    """(program, words) of each command in a line; a comment, or a column of words behind two blanks, ends it."""
    text = re.split(r"\s#|\s{3,}", text.strip())[0]
    found = []
    for part in re.split(r"\s&&?\s|;\s|\s\|\s", text + " "):
        match = COMMAND.search(part)
        if match:
            try:
                words = shlex.split(match[2])
            except ValueError:  # an apostrophe of prose
                words = match[2].split()
            found.append((match[1], words))
    return found


def problems(program, words):
    """What a command line asks for that the program does not know."""
    try:
        options, verbs = known(program)
    except FileNotFoundError:
        return [f"no program {program}"]
    words = [word.strip("[].,") for word in words]
    if verbs and words and re.fullmatch(r"[a-z][a-z0-9-]*", words[0]):
        if words[0] not in verbs:
            return [f"{program} has no verb {words[0]}"]
        if program == "hydro-log":
            options = known(program, words[0])[0]
    asked = [re.match(r"-\w$|--[\w-]+", word) for word in words]
    return [f"{program} has no option {match[0]}" for match in asked if match and match[0] not in options]


class PageCommandsTest(unittest.TestCase):
    # Tests that no page shows a program, a verb or an option that no longer exists.
    def test_pages(self):
        found, count = [], 0
        for page in PAGES:
            for number, program, words in commands(page.read_text(encoding="utf-8")):
                count += 1
                found += [f"{page.relative_to(ROOT)}:{number}: {problem}" for problem in problems(program, words)]
        self.assertGreater(count, 150)
        self.assertEqual(found, [], "\n".join(found))

    # Tests the check itself: continued lines, comments, prompts, spans, and mistakes.
    def test_what_is_wrong_is_found(self):
        page = ("`hydro-sim a.toml --seed 1` and `hydro-sim`\n```sh\nx=1; build/bin/hydro-sim b.toml \\\n  --sed 2   # --no\nrig$ hydro-log sumary x.lcmlog & hydro-launch halt x.toml\n"
                "hydro-log info -x && hydro-gone\n```\n")
        found = [(number, problem) for number, program, words in commands(page) for problem in problems(program, words)]
        self.assertEqual(found, [(3, "hydro-sim has no option --sed"), (5, "hydro-log has no verb sumary"), (5, "hydro-launch has no verb halt"),
                                 (6, "hydro-log has no option -x"), (6, "no program hydro-gone")])


if __name__ == "__main__":
    outcome.main()
