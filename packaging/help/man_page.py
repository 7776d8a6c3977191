"""A man page from a program's help."""

import re


def escaped(text):
    """Text that roff prints as it is; a hyphen in it can be searched and copied."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text)


def bold(text):
    return f"\\fB{escaped(text)}\\fR"


def italic(text):
    return f"\\fI{escaped(text)}\\fR"


def usage(line):
    """The synopsis: the command bold, what the user puts in italic."""
    command, *words = line.split(" ")
    return " ".join([bold(command), *(italic(word) if re.search(r"[A-Z]", word) else bold(word) for word in words)])


def entries(of):
    lines = []
    for each in of:
        head = ", ".join(bold(name) if name.startswith("-") or name.islower() else italic(name) for name in each.names)
        if each.takes and each.names[0].startswith("-"):
            head += " " + italic(each.takes)
        if each.repeated:
            head += " ..."
        means = escaped(each.means) + (" (required)" if each.required and each.names[0].startswith("-") else "")
        lines += [".TP", head, means]
    return lines


def verb(help_):
    return [".SS " + bold(help_.command.split()[-1]), usage(help_.usage), ".PP", escaped(help_.says),
            *entries(help_.positionals), *entries(option for option in help_.options if "--help" not in option.names)]


def man_page(help_, version, names):
    """The page of section 1. `names`: all programs with a page, for SEE ALSO."""
    title = help_.says.split(":")[0].rstrip(".")
    title = title if title[1].isupper() else title[0].lower() + title[1:]
    lines = [f'.TH {help_.command.upper()} 1 "" "hydro {version}" "User Commands"', ".SH NAME",
             f"{escaped(help_.command)} \\- {escaped(title)}", ".SH SYNOPSIS", usage(help_.usage), ".SH DESCRIPTION", escaped(help_.says)]
    if help_.positionals:
        lines += [".SH ARGUMENTS", *entries(help_.positionals)]
    lines += [".SH OPTIONS", *entries(help_.options)]
    if help_.verbs:
        lines += [".SH COMMANDS", *(line for each in help_.verb_helps for line in verb(each))]
    lines += [".SH EXIT STATUS", ".TP", "0", "done", ".TP", "1", "the work failed: a fault tripped, logs differ", ".TP", "2",
              "bad usage or input, with one line that names the place"]
    if help_.examples:
        lines += [".SH EXAMPLES", ".nf", *(escaped(line) for line in help_.examples), ".fi"]
    others = ", ".join(f"{bold(name)}(1)" for name in names if name != help_.command)
    lines += [".SH SEE ALSO", others]
    if help_.more:
        lines += [".PP", italic(help_.more) + " in the folder of the documentation, " + italic("share/doc/hydro") + " below the prefix"]
    return "\n".join(lines) + "\n"
