"""What the value of an option, or a positional, is completed with."""

import dataclasses
import re


@dataclasses.dataclass
class Values:
    kind: str  # "files", "folders", "words" or "" (nothing can be proposed)
    pattern: str = ""  # of files, e.g. "toml"; folders are always proposed
    words: tuple = ()


BY_NAME = {
    "CONFIG": Values("files", "toml"),
    "MODEL": Values("files", "toml"),
    "STUDY": Values("files", "toml"),
    "LOG": Values("files", "lcmlog"),
    "CONFIG|LOG": Values("files", "toml|lcmlog"),
    "A": Values("files", "lcmlog"),
    "B": Values("files", "lcmlog"),
    "FILE": Values("files"),
    "RUN": Values("files"),
    "TABLE": Values("files", "csv|mat"),
    "DIR": Values("folders"),
    "FOLDER": Values("folders"),
}
# "realtime or lockstep; as --set ..." and "pressure, position or both (default)" are all that is allowed.
ALTERNATIVES = re.compile(r"([a-z]+(?:, [a-z]+)*) or ([a-z]+)(?=$|[;.]| \()")


def values(entry):
    """The Values of an option that takes one, or of a positional."""
    is_option = entry.names[0].startswith("-")
    name, kind = (entry.takes, "") if is_option else (entry.names[0], entry.takes)
    alternatives = ALTERNATIVES.match(entry.means)
    if alternatives and name in ("MODE", "NAME"):
        return Values("words", words=(*alternatives[1].split(", "), alternatives[2]))
    if name in BY_NAME:
        return BY_NAME[name]
    if re.fullmatch(r"[A-Z]+\.[a-z]+", name):  # REPORT.json
        return Values("files", name.split(".")[1])
    if kind in ("FILE", "FOLDER"):
        return BY_NAME[kind]
    if "CONFIG" in name:  # hydro-set [CONFIG] KEY=VALUE...
        return BY_NAME["CONFIG"]
    return Values("")
