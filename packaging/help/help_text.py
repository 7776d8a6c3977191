"""What a program's own --help says, as data: from it come the man pages and the completions.

The form is that of settings/command_line.cc: a sentence, "Usage:", then "Positionals:", "Options:" and "Subcommands:" with a line
each (name, what it takes, in column 30 what it means), "Examples:" and "More:".
"""

import dataclasses
import re
import subprocess

SECTIONS = ("Positionals:", "Options:", "Subcommands:", "Examples:")
COLUMN = 30  # where meanings begin; a longer name pushes its meaning to the next line
# Kinds of values that CLI11 prints behind a name: "CONFIG FILE REQUIRED" is a file, "RUN ..." may be repeated.
KINDS = {"FILE", "FOLDER", "VALUE"}


@dataclasses.dataclass
class Entry:
    """An option, a positional or a verb."""

    names: list  # ["-o", "--out"], or ["CONFIG"]
    takes: str = ""  # what follows an option, e.g. "FILE"; the kind of a positional
    required: bool = False
    repeated: bool = False
    means: str = ""


@dataclasses.dataclass
class Help:
    command: str  # "hydro-log export"
    says: str = ""
    usage: str = ""
    positionals: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    verbs: list = dataclasses.field(default_factory=list)  # entries
    verb_helps: list = dataclasses.field(default_factory=list)  # a Help for each verb
    examples: list = dataclasses.field(default_factory=list)
    more: str = ""

    def verbs_as_words(self):
        """Verbs that are no subcommands, but a first word which the help shows: "hydro-launch stop CONFIG"."""
        text = "\n".join([option.means for option in self.options] + self.examples)
        words = re.findall(rf"(?:^|Also: ){re.escape(self.command)} ([a-z]+) ", text, re.MULTILINE)
        known = [name for verb in self.verbs for name in verb.names]
        return sorted(set(words) - set(known))


def entry(head, means):
    """An entry from "-o,--out FILE ... REQUIRED" and its meaning."""
    words = head.split()
    found = Entry(names=words.pop(0).split(","), means=means)
    if not found.names[0].startswith("-"):
        while words and words[0] not in KINDS | {"REQUIRED", "..."}:  # a name of several words
            found.names[0] += " " + words.pop(0)
    found.required = "REQUIRED" in words
    found.repeated = "..." in words
    found.takes = " ".join(word for word in words if word not in ("REQUIRED", "..."))
    return found


def parse(command, text):
    """The Help of `text`, which `command --help` printed. ValueError: it has another form."""
    found = Help(command)
    lists = {"Positionals:": found.positionals, "Options:": found.options, "Subcommands:": found.verbs}
    section = None
    says = []
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if line.startswith("Usage: "):
            found.usage = line.removeprefix("Usage: ")
        elif line.startswith("More: "):
            found.more = line.removeprefix("More: ")
        elif line in SECTIONS:
            section = line
        elif not line.strip():
            continue
        elif section is None:
            says.append(line)
        elif section == "Examples:":
            found.examples.append(line.strip())
        elif line.startswith(" " * COLUMN):  # goes on
            last = lists[section][-1]
            last.means = f"{last.means} {line.strip()}".strip()
        elif re.match(r"  \S", line):
            goes_on = number + 1 < len(lines) and lines[number + 1].startswith(" " * COLUMN)
            column = COLUMN if line[COLUMN - 1 : COLUMN] == " " and not goes_on else len(line)
            lists[section].append(entry(line[:column], line[column:]))
        else:
            raise ValueError(f"{command} --help: found '{line}', allowed two spaces, a name, its meaning in column {COLUMN}")
    found.says = " ".join(says)
    if not found.usage or not found.options:
        raise ValueError(f"{command} --help: found neither 'Usage:' nor 'Options:'")
    return found


def ask(program, *verb):
    """What a program at a path, or one of its verbs, prints on --help."""
    return subprocess.run([program, *verb, "--help"], check=True, capture_output=True, text=True, timeout=60).stdout


def read(program, name):
    """The Help of the program at that path, which is called `name`, with its verbs'."""
    found = parse(name, ask(program))
    for verb in found.verbs:
        found.verb_helps.append(parse(f"{name} {verb.names[0]}", ask(program, verb.names[0])))
    return found
