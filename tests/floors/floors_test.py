"""Tests that arrows point down only: every include, and every library that CMake links, is held against the floors of cmake/rooms.txt."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'\s*(?:#|%:)\s*(?:include|include_next|import)\b\s*(.*)')
COMMENT = re.compile(r"/\*.*?\*/")
NAME = re.compile(r'([<"])([^">]+)[">]')
SOURCES = {".h", ".cc", ".hpp", ".cpp", ".cxx", ".hxx", ".c", ".inc", ".ipp", ".in"}
# hydro_library(NAME ...) or hydro_program(NAME ...), and target_link_libraries(NAME ...).
TARGET = re.compile(r"\b(hydro_library|hydro_program|target_link_libraries)\(\s*([\w-]+)([^)]*)\)")

# Control laws and the model never read a clock, a socket or a file: what they may use of the house, and the system's headers that
# they may not.
PURE = {
    "model": {"base", "trajectory", "model"},
    "pressure_ctrl/law": {"model", "pressure_ctrl"},
    "position_ctrl/law": {"model", "position_ctrl"},
}
IMPURE_HEADERS = re.compile(
    r"chrono|ctime|time\.h|random|fstream|filesystem|iostream|ostream|istream|print|cstdio|stdio\.h|thread|future|mutex|"
    r"condition_variable|semaphore|csignal|signal\.h|poll\.h|(sys|net|netinet|arpa|linux)/.*|unistd\.h|fcntl\.h|.*lcm.*|spdlog/.*|"
    r"base/(text_file|new_file|mapped_file|terminal_line)\.h")
# What a launch decides runs over any clock, bus and children: it asks the system nothing. <signal.h> names signals.
NO_SYSTEM = ("launch/logic",)
SYSTEM_HEADERS = re.compile(
    r"ctime|time\.h|random|fstream|filesystem|thread|future|mutex|condition_variable|poll\.h|(sys|net|netinet|arpa|linux)/.*|"
    r"unistd\.h|fcntl\.h|bus/udpm/.*|base/(host_name|text_file|new_file|mapped_file|terminal_line)\.h")
SYSTEM_CALL = re.compile(r"WallClock|_clock::now|\b(?:getpid|fork|kill|raise|getenv|HostName|RandomSession)\s*\(")
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

    systemless = room in NO_SYSTEM
    for number, line in enumerate(text.splitlines(), 1):
        if systemless and SYSTEM_CALL.search(line.split("//")[0]):
            problem(number, line.strip(), "what a launch decides asks the system nothing")
        include = INCLUDE.match(COMMENT.sub(" ", line))
        if not include:
            continue
        named = NAME.match(include.group(1))
        if not named:
            problem(number, f"{room} -> {include.group(1)}", "write the header's name, so that this check can read it")
            continue
        bracket, name = named.groups()
        other = room_of(name, floors)
        if ".." in name.split("/") or (bracket == '"' and "/" not in name):
            problem(number, f"{room} -> {name}", "write the header's path from the root")
            continue
        if pure and IMPURE_HEADERS.fullmatch(name):
            problem(number, f"{room} -> <{name}>", "the model and the laws read no clock, socket or file")
        if systemless and SYSTEM_HEADERS.fullmatch(name):
            problem(number, f"{room} -> <{name}>", "what a launch decides asks the system nothing")
        if other is None:
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


def libraries_in(room, text, floors):
    """[(line number, target, rooms of its sources, words)] of the text of a room's CMakeLists.txt; words: all that follows the name."""
    text = re.sub(r"#.*", "", text)
    found, rooms_of = [], {}
    for call in TARGET.finditer(text):
        target, words = call.group(2), call.group(3).split()
        sources = [word for word in words if word.endswith(".cc") and not word.startswith("$")]
        rooms = {room_of(f"{room}/{source}", floors) for source in sources} or rooms_of.get(target, {room})
        rooms_of.setdefault(target, rooms)
        found.append((text[: call.start()].count("\n") + 1, target, rooms, words))
    return found


def link_problems(lists, floors):
    """A line for each link that goes up; `lists`: from each top room to the text of its CMakeLists.txt. A library of several rooms
    may use what any of them may: their includes are held to account one by one."""
    calls = {room: libraries_in(room, text, floors) for room, text in lists.items()}
    home = {}
    for room in calls:
        for _, target, rooms, _ in calls[room]:
            home.setdefault(target, rooms)
    found = []
    for room, targets in calls.items():
        for number, target, rooms, words in targets:
            for other in words:
                if other == target or other not in home or home[other] & rooms:
                    continue
                if min(floors[each] for each in home[other]) >= max(floors[each] for each in rooms):
                    found.append(f"{room}/CMakeLists.txt:{number}: {target} -> {other}: not on a lower floor")
    return found


class FloorsTest(unittest.TestCase):
    floors = read_floors((ROOT / "cmake/rooms.txt").read_text())

    def sources(self):
        for top in sorted({room.split("/")[0] for room in self.floors}):
            for path in sorted((ROOT / top).rglob("*")):
                if path.suffix in SOURCES and path.is_file():
                    yield path.relative_to(ROOT).as_posix(), path.read_text()

    def test_arrows_point_down(self):
        """Tests that no source includes a header of a room above or beside its own."""
        found = [line for path, text in self.sources() for line in problems_in(path, text, self.floors)]
        self.assertEqual(found, [], "arrows that are not allowed:\n" + "\n".join(found))

    def test_links_point_down(self):
        """Tests that no library or program links one of a room above or beside its own, with or without an include."""
        tops = sorted({room.split("/")[0] for room in self.floors})
        lists = {top: (ROOT / top / "CMakeLists.txt").read_text() for top in tops}
        names = {name for top in tops for _, name, _, _ in libraries_in(top, lists[top], self.floors)}
        self.assertGreater(len(names), 30)
        found = link_problems(lists, self.floors)
        self.assertEqual(found, [], "links that are not allowed:\n" + "\n".join(found))

    def test_json_is_written_at_one_place(self):
        """Tests that all JSON is written by JsonText (base/json_text.h), which no bytes from outside can make throw."""
        found = [f"{path}: write JSON with JsonText()" for path, text in self.sources()
                 if path != "base/json_text.cc" and re.search(r"[.>]dump\(", text)]
        self.assertEqual(found, [], "\n".join(found))

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
        up = "base -> model (model/b.h): a room on a higher floor"
        root = "write the header's path from the root"
        cases |= {
            ("base/a.h", '#include"model/b.h"'): f"base/a.h:1: {up}",
            ("base/a.h", "#include <model/b.h>"): f"base/a.h:1: {up}",
            ("base/a.h", " # include_next <model/b.h>"): f"base/a.h:1: {up}",
            ("base/a.h", '#include "../model/b.h"'): f"base/a.h:1: base -> ../model/b.h: {root}",
            ("base/a.h", '#include "b.h"'): f"base/a.h:1: base -> b.h: {root}",
            ("base/a.h", '/* */ #include "model/b.h"'): f"base/a.h:1: {up}",
            ("model/a.h", '#include "base/text_file.h"'):
                "model/a.h:1: model -> <base/text_file.h>: the model and the laws read no clock, socket or file",
            ("base/a.h", "#include HEADER"): "base/a.h:1: base -> HEADER: write the header's name, so that this check can read it",
        }
        for (path, text), line in cases.items():
            self.assertEqual(problems_in(path, text, floors), [line])
        logic = read_floors("launch/logic  text\n")
        nothing = "what a launch decides asks the system nothing"
        self.assertEqual(problems_in("launch/logic/a.cc", "#include <unistd.h>\nint id = getpid();  // HostName()\n// WallClock", logic), [
            f"launch/logic/a.cc:1: launch/logic -> <unistd.h>: {nothing}", f"launch/logic/a.cc:2: int id = getpid();  // HostName(): {nothing}"])
        self.assertEqual(problems_in("model/a.cc", '#include "base/b.h"\n#include <vector>', floors), [])

    def test_links_that_are_not_allowed_are_found(self):
        """Tests the check of links: up, sideways, down, and from a room within a room."""
        floors = read_floors("base  text\n\nmodel\nplant\n\nplant/driver\nsim\n")
        lists = {
            "base": "hydro_library(hydro_base SOURCES a.cc)\ntarget_link_libraries(hydro_base PRIVATE hydro_model)",
            "model": "hydro_library(hydro_model\n  SOURCES a.cc\n  PUBLIC hydro_base hydro_plant)",
            "plant": "hydro_library(hydro_plant SOURCES a.cc PUBLIC hydro_base)\n"
                     "hydro_library(hydro_driver SOURCES driver/a.cc PUBLIC hydro_plant hydro_sim)\n",
            "sim": "hydro_library(hydro_sim SOURCES a.cc PUBLIC hydro_driver_lib hydro_model)",
        }
        self.assertEqual(link_problems(lists, floors), [
            "base/CMakeLists.txt:2: hydro_base -> hydro_model: not on a lower floor",
            "model/CMakeLists.txt:1: hydro_model -> hydro_plant: not on a lower floor",
            "plant/CMakeLists.txt:2: hydro_driver -> hydro_sim: not on a lower floor",
        ])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
