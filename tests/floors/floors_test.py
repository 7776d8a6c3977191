"""Tests that arrows point down only: every include, and every library that CMake links, is held against the floors of cmake/rooms.txt."""

import importlib.machinery
import importlib.util
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
    "model": {"base", "model"},
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


def load_rooms_script():
    """scripts/rooms, which reads the list."""
    path = str(ROOT / "scripts/rooms")
    loader = importlib.machinery.SourceFileLoader("rooms", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("rooms", loader))
    loader.exec_module(module)
    return module


def read_rooms(text):
    """From each room's path to what the list says of it."""
    return {room.path: room for room in load_rooms_script().read_rooms(text)}


def why_not(room, other):
    """Why the first room may not use the second, in words; None where it may."""
    if room.path == other.path:
        return None
    if room.top == other.top:
        return None if other.place < room.place else "a room that stands higher in its folder"
    if other.floor > room.floor:
        return "a room on a higher floor"
    if other.floor == room.floor:
        return "a room on the same floor"
    return None if other.open else "a room that only its own folder may use"


def room_of(path, rooms):
    """The innermost room that `path`, relative to the root, lies in; None outside the house."""
    parts = path.split("/")[:-1]
    while parts:
        if "/".join(parts) in rooms:
            return "/".join(parts)
        parts.pop()
    return None


def problems_in(path, text, rooms):
    """A line for each include of the file at `path` that the list does not allow."""
    room, found = room_of(path, rooms), []
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
        other = room_of(name, rooms)
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
        why = why_not(rooms[room], rooms[other])
        if why:
            problem(number, arrow, why)
        elif pure and other.split("/")[0] not in pure:
            problem(number, arrow, "the model and the laws use only " + ", ".join(sorted(pure)))
        elif room.split("/")[0] in NO_PROCESS and PROCESS.fullmatch(name):
            problem(number, arrow, "experiments and the gap finder know no process")
    return found


def libraries_in(room, text, rooms):
    """[(line number, target, rooms of its sources, words)] of the text of a room's CMakeLists.txt; words: all that follows the name."""
    text = re.sub(r"#.*", "", text)
    found, rooms_of = [], {}
    for call in TARGET.finditer(text):
        target, words = call.group(2), call.group(3).split()
        sources = [word for word in words if word.endswith(".cc") and not word.startswith("$")]
        homes = {room_of(f"{room}/{source}", rooms) for source in sources} or rooms_of.get(target, {room_of(f"{room}/x", rooms)})
        rooms_of.setdefault(target, homes)
        found.append((text[: call.start()].count("\n") + 1, target, homes, words))
    return found


def link_problems(lists, rooms):
    """A line for each link that is not allowed; `lists`: from each folder to the text of its CMakeLists.txt. A library of several rooms
    may use what any of them may: their includes are held to account one by one."""
    calls = {folder: libraries_in(folder, text, rooms) for folder, text in lists.items()}
    home = {}
    for folder in calls:
        for _, target, homes, _ in calls[folder]:
            home.setdefault(target, homes)
    found = []
    for folder, targets in calls.items():
        for number, target, homes, words in targets:
            for other in words:
                if other == target or other not in home or home[other] & homes:
                    continue
                reasons = [why_not(rooms[mine], rooms[its]) for mine in homes for its in home[other]]
                if None not in reasons:
                    found.append(f"{folder}/CMakeLists.txt:{number}: {target} -> {other}: {reasons[0]}")
    return found


class FloorsTest(unittest.TestCase):
    rooms = read_rooms((ROOT / "cmake/rooms.txt").read_text())

    def sources(self):
        for top in sorted({room.split("/")[0] for room in self.rooms}):
            for path in sorted((ROOT / top).rglob("*")):
                if path.suffix in SOURCES and path.is_file():
                    yield path.relative_to(ROOT).as_posix(), path.read_text()

    def test_arrows_point_down(self):
        """Tests that no source includes a header of a room above or beside its own."""
        found = [line for path, text in self.sources() for line in problems_in(path, text, self.rooms)]
        self.assertEqual(found, [], "arrows that are not allowed:\n" + "\n".join(found))

    def test_links_point_down(self):
        """Tests that no library or program links one of a room above or beside its own, with or without an include."""
        tops = sorted({room.split("/")[0] for room in self.rooms})
        lists = {path.parent.relative_to(ROOT).as_posix(): path.read_text() for top in tops for path in (ROOT / top).rglob("CMakeLists.txt")
                 if "node_modules" not in path.parts}
        names = {name for folder, text in lists.items() for _, name, _, _ in libraries_in(folder, text, self.rooms)}
        self.assertGreater(len(names), 30)
        found = link_problems(lists, self.rooms)
        self.assertEqual(found, [], "links that are not allowed:\n" + "\n".join(found))

    def test_json_is_written_at_one_place(self):
        """Tests that all JSON is written by JsonText (base/json_text.h), which no bytes from outside can make throw."""
        found = [f"{path}: write JSON with JsonText()" for path, text in self.sources()
                 if path != "base/json_text.cc" and re.search(r"[.>]dump\(", text)]
        self.assertEqual(found, [], "\n".join(found))

    def test_every_source_lies_in_a_room(self):
        """Tests that each folder with sources is in the list, and that each room of the list is there."""
        with_sources = {pathlib.PurePath(path).parent.as_posix() for path, _ in self.sources()}
        inside = {folder for folder in with_sources if room_of(folder + "/x", self.rooms) == folder}
        self.assertEqual(with_sources - inside, set())
        for room in self.rooms:
            self.assertTrue((ROOT / room).is_dir(), room)

    def test_what_is_not_allowed_is_found(self):
        """Tests the check itself: an arrow up, one sideways, a clock in the model, a process in a figure."""
        rooms = read_rooms("base  text\n\nmodel  text\nplant  text\n\nexperiments  text\n  runs  text\n  + open  text\n  .\n\nover  text\n")
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
        cases |= {
            ("experiments/runs/a.h", '#include "experiments/open/b.h"'):
                "experiments/runs/a.h:1: experiments/runs -> experiments/open (experiments/open/b.h): a room that stands higher in its folder",
            ("experiments/open/a.h", '#include "experiments/b.h"'):
                "experiments/open/a.h:1: experiments/open -> experiments (experiments/b.h): a room that stands higher in its folder",
            ("over/a.h", '#include "experiments/runs/b.h"'):
                "over/a.h:1: over -> experiments/runs (experiments/runs/b.h): a room that only its own folder may use",
        }
        for (path, text), line in cases.items():
            self.assertEqual(problems_in(path, text, rooms), [line])
        for path, header in (("experiments/a.h", "experiments/open/b.h"), ("over/a.h", "experiments/open/b.h"), ("over/a.h", "experiments/b.h")):
            self.assertEqual(problems_in(path, f'#include "{header}"', rooms), [])
        logic = read_rooms("launch/logic  text\n")
        nothing = "what a launch decides asks the system nothing"
        self.assertEqual(problems_in("launch/logic/a.cc", "#include <unistd.h>\nint id = getpid();  // HostName()\n// WallClock", logic), [
            f"launch/logic/a.cc:1: launch/logic -> <unistd.h>: {nothing}", f"launch/logic/a.cc:2: int id = getpid();  // HostName(): {nothing}"])
        self.assertEqual(problems_in("model/a.cc", '#include "base/b.h"\n#include <vector>', rooms), [])

    def test_links_that_are_not_allowed_are_found(self):
        """Tests the check of links: up, sideways, down, and from a room within a room."""
        rooms = read_rooms("base  text\n\nmodel  text\n\nplant  text\n  .\n  driver  text\n\nsim  text\n")
        lists = {
            "base": "hydro_library(hydro_base SOURCES a.cc)\ntarget_link_libraries(hydro_base PRIVATE hydro_model)",
            "model": "hydro_library(hydro_model\n  SOURCES a.cc\n  PUBLIC hydro_base hydro_plant)",
            "plant": "hydro_library(hydro_plant SOURCES a.cc PUBLIC hydro_base)\n"
                     "hydro_library(hydro_driver SOURCES driver/a.cc PUBLIC hydro_plant hydro_sim)\n",
            "sim": "hydro_library(hydro_sim SOURCES a.cc PUBLIC hydro_driver_lib hydro_model)",
        }
        self.assertEqual(link_problems(lists, rooms), [
            "base/CMakeLists.txt:2: hydro_base -> hydro_model: a room on a higher floor",
            "model/CMakeLists.txt:1: hydro_model -> hydro_plant: a room on a higher floor",
            "plant/CMakeLists.txt:2: hydro_driver -> hydro_sim: a room on a higher floor",
        ])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + ["-v"])
