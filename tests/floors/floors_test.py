"""Tests that arrows point down only: every include is held against the floors of cmake/rooms.txt."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'\s*#\s*include\s+([<"])([^">]+)[">]')

# Control laws and the model never read a clock, a socket or a file: what they may use of the house, and the system's headers that
# they may not.
PURE = {
    "model": {"base", "trajectory", "model"},
    "pressure_ctrl/pressure_law": {"model", "pressure_ctrl"},
    "position_ctrl/position_law": {"model", "position_ctrl"},
}
IMPURE_HEADERS = re.compile(r"chrono|ctime|fstream|filesystem|iostream|cstdio|thread|mutex|sys/.*|unistd\.h|fcntl\.h|.*lcm.*|spdlog/.*")
# Experiments and the gap finder know the laws, and never a process.
NO_PROCESS = ("experiments", "diagnose")
PROCESS = re.compile(r"process/.*|logger/.*|plant/.*|(pressure|position)_ctrl/\w*_app\.h")


def read_floors(text):
    """From each room to its floor, counted from the bottom."""
    floors, floor, empty = {}, 0, True
    for line in text.splitlines():
        if line.startswith("#"):
            continue
        if not line.strip():
            floor, empty = floor if empty else floor + 1, True
            continue
        floors[line.split()[0]], empty = floor, False
    return floors


def room_of(path, floors):
    """The innermost room that `path`, relative to the root, lies in; None outside the house."""
    parts = path.split("/")[:-1]
    while parts:
        if "/".join(parts) in floors:
            return "/".join(parts)
        parts.pop()
    return None


def problems_in(path, text, floors):
    """A line for each include of the file at `path` that the floors do not allow."""
    room, found = room_of(path, floors), []
    pure = next((allowed for start, allowed in PURE.items() if path.startswith(start)), None)

    def problem(number, arrow, why):
        found.append(f"{path}:{number}: {arrow}: {why}")

    for number, line in enumerate(text.splitlines(), 1):
        include = INCLUDE.match(line)
        if not include:
            continue
        bracket, name = include.groups()
        other = room_of(name, floors)
        if bracket == "<" or other is None:
            if pure and IMPURE_HEADERS.fullmatch(name):
                problem(number, f"{room} -> <{name}>", "the model and the laws read no clock, socket or file")
            continue
        arrow = f"{room} -> {other} ({name})"
        if other != room and floors[other] > floors[room]:
            problem(number, arrow, "a room on a higher floor")
        elif other != room and floors[other] == floors[room]:
            problem(number, arrow, "a room on the same floor")
        elif pure and other.split("/")[0] not in pure:
            problem(number, arrow, "the model and the laws use only " + ", ".join(sorted(pure)))
        elif room.split("/")[0] in NO_PROCESS and PROCESS.fullmatch(name):
            problem(number, arrow, "experiments and the gap finder know no process")
    return found


class FloorsTest(unittest.TestCase):
    floors = read_floors((ROOT / "cmake/rooms.txt").read_text())

    def sources(self):
        for top in sorted({room.split("/")[0] for room in self.floors}):
            for path in sorted((ROOT / top).rglob("*")):
                if path.suffix in (".h", ".cc", ".in") and path.is_file():
                    yield path.relative_to(ROOT).as_posix(), path.read_text()

    def test_arrows_point_down(self):
        """Tests that no source includes a header of a room above or beside its own."""
        found = [line for path, text in self.sources() for line in problems_in(path, text, self.floors)]
        self.assertEqual(found, [], "arrows that are not allowed:\n" + "\n".join(found))

    def test_every_source_lies_in_a_room(self):
        """Tests that each folder with sources is in the list, and that each room of the list is there."""
        with_sources = {pathlib.PurePath(path).parent.as_posix() for path, _ in self.sources()}
        inside = {folder for folder in with_sources if room_of(folder + "/x", self.floors) == folder or folder.startswith("model/")}
        self.assertEqual(with_sources - inside, set())
        for room in self.floors:
            self.assertTrue((ROOT / room).is_dir(), room)

    def test_what_is_not_allowed_is_found(self):
        """Tests the check itself: an arrow up, one sideways, a clock in the model, a process in a figure."""
        floors = read_floors("base  text\n\nmodel\nplant\n\nexperiments\n")
        cases = {
            ("base/a.h", '#include "model/b.h"'): "base/a.h:1: base -> model (model/b.h): a room on a higher floor",
            ("model/a.h", '\n#include "plant/b.h"'): "model/a.h:2: model -> plant (plant/b.h): a room on the same floor",
            ("model/a.cc", "#include <chrono>"): "model/a.cc:1: model -> <chrono>: the model and the laws read no clock, socket or file",
            ("experiments/a.cc", '#include "plant/plant_app.h"'):
                "experiments/a.cc:1: experiments -> plant (plant/plant_app.h): experiments and the gap finder know no process",
        }
        for (path, text), line in cases.items():
            self.assertEqual(problems_in(path, text, floors), [line])
        self.assertEqual(problems_in("model/a.cc", '#include "base/b.h"\n#include <vector>', floors), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
