#!/usr/bin/env python3
"""write_from_help.py OUT VERSION PROGRAM...: man pages and completions of the programs at these paths, from their --help:
OUT/man/NAME.1, OUT/bash/NAME, OUT/zsh/_NAME."""

import pathlib
import sys

import bash_completion
import help_text
import man_page
import zsh_completion


def main(out, version, *programs):
    names = sorted(pathlib.Path(program).name for program in programs)
    out = pathlib.Path(out)
    for folder in ("man", "bash", "zsh"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    for program in programs:
        name = pathlib.Path(program).name
        help_ = help_text.read(program, name)
        (out / "man" / f"{name}.1").write_text(man_page.man_page(help_, version, names))
        (out / "bash" / name).write_text(bash_completion.bash_completion(help_))
        (out / "zsh" / f"_{name}").write_text(zsh_completion.zsh_completion(help_))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (ValueError, OSError) as error:
        sys.exit(f"write_from_help: {error}")
