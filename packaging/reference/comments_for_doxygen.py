#!/usr/bin/env python3
"""comments_for_doxygen.py HEADER: the header as Doxygen wants it, on standard output. The comment before a declaration begins with
///, that behind one with ///<, and the first of the file is the file's. Comments are plain text: what Doxygen would take for a
command is escaped. Those in function bodies, and those before an empty line, stay as they are."""

import re
import sys

SPECIAL = re.compile(r"[\\@<>#%&\"$~]")
SCOPE = re.compile(r"\b(namespace|class|struct|enum|union|extern)\b")


def escaped(text):
    return SPECIAL.sub(lambda match: "\\" + match[0], text)


def without_strings(code):
    return re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])*\'', '""', code)


class Braces:
    """Whether a line is in a function's body, or an initialiser."""

    def __init__(self):
        self.open = []
        self.statement = ""

    def read(self, code):
        for character in without_strings(code):
            if character == "{":
                head = re.sub(r"template\s*<[^{]*>\s*(?=class|struct|[\w:]+ )", "", self.statement)
                self.open.append(bool(SCOPE.search(head)) and "(" not in head)
            elif character == "}" and self.open:
                self.open.pop()
            self.statement = "" if character in "{};" else self.statement + character
        self.statement += " "

    def declares(self):
        return all(self.open)


def split_comment(line):
    """(code, comment or None)"""
    match = re.match(r'((?:"(?:\\.|[^"\\])*"|[^"/]|/(?!/))*)//(?!/)(.*)', line)
    return (match[1], match[2]) if match else (line, None)


def converted(lines):
    braces = Braces()
    in_head = lines and lines[0].startswith("//")
    if in_head:
        yield "/// @file"
    behind = None  # the column of a comment behind a declaration, which may go on below
    for number, line in enumerate(lines):
        code, comment = split_comment(line)
        if comment is None:
            in_head, behind = False, None
            braces.read(code)
            yield line
            continue
        alone = not code.strip()
        if in_head:
            yield "///" + escaped(comment)
        elif not braces.declares() or (alone and not belongs(lines, number)):
            behind = None
            yield line if alone else code
        elif alone and behind is not None and len(code) == behind:
            yield f"{code}///<{escaped(comment)}"
        elif alone:
            behind = None
            yield f"{code}///{escaped(comment)}"
        else:
            behind = len(code)
            opens = code.rstrip().endswith("{") or code.lstrip().startswith("#")
            yield code if opens else f"{code}///<{escaped(comment)}"
        if not alone:
            braces.read(code)


def belongs(lines, number):
    """Whether a declaration follows this block of comments: neither an empty line nor the end of a scope."""
    while number < len(lines) and lines[number].lstrip().startswith("//"):
        number += 1
    return number < len(lines) and lines[number].strip() != "" and not lines[number].lstrip().startswith(("}", "#"))


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(converted(file.read().splitlines())))
