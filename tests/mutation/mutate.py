#!/usr/bin/env python3
"""Shows that the tests notice wrong physics.

Changes one thing at a time in the model or a control law (a sign, a dropped leakage term, a valve's direction ...), builds
the tests and runs them: they must fail. Works on a private copy of the source tree; the checkout is not touched. A run of
the whole list takes more than half an hour on two free cores, so it is no part of ./check.

The tests of the folder that a mutation changes run first, up to the first that fails; those of experiments/ when none of
them does. First of all, everything must pass without a mutation.

--torture: the rules of docs/safety.md instead, one broken at a time, and hydro-torture, which must find each within
TORTURE_S seconds on fresh seeds; prints how long it took.

exit: 0 every mutation was caught; 1 one survived, no longer applies (its text does not stand exactly once in its file) or
does not build, or the tests fail without any; 2 bad usage.
"""

import argparse
import collections
import concurrent.futures
import filecmp
import fnmatch
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # the checkout stays as it is
from mutations import MUTATIONS, TORTURE_MUTATIONS  # noqa: E402

SOURCE = pathlib.Path(__file__).resolve().parents[2]
NOT_COPIED = {".git", "build", "out", "__pycache__"}
# Times what a test program takes otherwise: a wrong sign can make a simulation run for ever, which is noticed too.
LONGER = 10
FALLBACK = "experiments"
TORTURE_S = 600  # s, in which hydro-torture must find a broken rule


class Failed(Exception):
    pass


def programs(folder):
    """The test programs that tests/<folder>/CMakeLists.txt declares."""
    text = (SOURCE / "tests" / folder / "CMakeLists.txt").read_text()
    return re.findall(r"hydro_test\((\w+)", text)


class Tree:
    """A private copy of the source tree with its build folder."""

    def __init__(self, folder, jobs):
        self.source = folder / "source"
        self.build = folder / "build"
        self.jobs = jobs
        self.passed = set()  # folders whose tests pass without a mutation
        self.usual_s = {}  # by program, what it took without a mutation
        self.caught = collections.Counter()  # by file and program: those that caught most so far are run first
        copy_what_differs(SOURCE, self.source)
        self._run(["cmake", "-S", str(self.source), "-B", str(self.build), "-G", "Ninja", "-DHYDRO_BUILD_BENCH=OFF",
                   "-DCMAKE_BUILD_TYPE=Mutation", "-DCMAKE_CXX_FLAGS_MUTATION=-O1 -Wno-maybe-uninitialized"], "cmake")

    def _run(self, command, what):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            raise Failed(f"{what} failed:\n{done.stdout[-3000:]}")

    def build_programs(self, *targets):
        self._run(["cmake", "--build", str(self.build), "-j", str(self.jobs), "--target", *targets], "build")

    def failing_test(self, folder, changed=None):
        """Builds and runs the tests of `folder` up to the first that fails: its name, or None."""
        def usefulness(program):
            return self.caught[changed, program], sum(n for (_, name), n in self.caught.items() if name == program)

        for name in sorted(programs(folder), key=usefulness, reverse=True):
            self.build_programs(name)
            timeout_s = LONGER * max(2, self.usual_s.get(name, 60))
            start = time.monotonic()
            try:
                done = subprocess.run([str(self.build / "tests" / name), "--gtest_fail_fast", "--gtest_brief=1"],
                                      cwd=self.build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                      errors="replace", timeout=timeout_s)
            except subprocess.TimeoutExpired:
                return f"{name} (still running after {timeout_s:.0f} s)"
            self.usual_s.setdefault(name, time.monotonic() - start)
            if done.returncode != 0:
                self.caught[changed, name] += 1
                found = re.search(r"\[  FAILED  \] ([\w./]+)", done.stdout)
                return f"{name}: {found.group(1) if found else 'ended with ' + str(done.returncode)}"
        return None

    def expect_pass(self, folder):
        """Without a mutation: all tests of `folder` must pass. Once."""
        if folder in self.passed:
            return
        self.build_programs(*programs(folder))
        failing = self.failing_test(folder)
        if failing is not None:
            raise Failed(f"without any mutation the tests fail: {failing}")
        self.passed.add(folder)

    def try_mutation(self, mutation, fallback):
        """What caught it, or None."""
        path = self.source / mutation.file
        text = path.read_text()
        try:
            path.write_text(mutated(text, mutation))
            caught = self.failing_test(mutation.file.split("/")[0], mutation.file)
            if caught is None and fallback:
                path.write_text(text)
                self.expect_pass(FALLBACK)
                path.write_text(mutated(text, mutation))
                caught = self.failing_test(FALLBACK, mutation.file)
            return caught
        finally:
            path.write_text(text)

    def torture(self, mutation):
        """What hydro-torture found, and after how many seconds of running; None when it found nothing."""
        path = self.source / mutation.file
        text = path.read_text()
        try:
            path.write_text(mutated(text, mutation))
            self.build_programs("hydro-torture")
            out = self.build / "torture"
            done = subprocess.run([str(self.build / "bin" / "hydro-torture"), "--first", "--seconds", str(TORTURE_S),
                                   "--jobs", str(self.jobs), "--out", str(out)],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
            found = re.search(r"^seed \d+ \(after ([\d.]+) s\): (.*)", done.stdout, re.MULTILINE)
            if done.returncode == 0:
                return None
            if not found:
                raise Failed(f"hydro-torture ended with {done.returncode}:\n{done.stdout[-500:]}")
            return f"after {found[1]} s: {found[2][:120]}"
        finally:
            path.write_text(text)


def copy_what_differs(source, target):
    """Makes `target` a copy of `source`. Files that are equal keep their time, so that an earlier build is of use; others
    become new, whatever their time in `source`: what was built of a mutation must not pass for what it was made from."""
    target.mkdir(parents=True, exist_ok=True)
    names = {path.name for path in source.iterdir()} - NOT_COPIED
    for path in target.iterdir():
        if path.name not in names:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    for name in sorted(names):
        if (source / name).is_dir():
            copy_what_differs(source / name, target / name)
        elif not (target / name).exists() or not filecmp.cmp(source / name, target / name, shallow=False):
            shutil.copyfile(source / name, target / name)
            shutil.copymode(source / name, target / name)


def mutated(text, mutation):
    count = text.count(mutation.old)
    if count != 1:
        raise Failed(f"stands {count} times in {mutation.file}, not once: {mutation.old!r}")
    return text.replace(mutation.old, mutation.new)


def check_all_apply(mutations):
    stale = 0
    for mutation in mutations:
        try:
            mutated((SOURCE / mutation.file).read_text(), mutation)
        except (Failed, OSError) as error:
            print(f"{mutation.name}: no longer applies: {error}", file=sys.stderr)
            stale += 1
    return stale


def run(mutations, work, jobs, fallback):
    folders = sorted({mutation.file.split("/")[0] for mutation in mutations})
    trees = queue.Queue()
    for i in range(jobs):
        tree = Tree(work / f"tree-{i}", max(1, 2 // jobs))
        for folder in folders:
            tree.expect_pass(folder)
        trees.put(tree)
    print(f"without any mutation: all tests pass\n{len(mutations)} mutations", flush=True)

    def one(mutation):
        tree = trees.get()
        start = time.monotonic()
        try:
            caught = tree.try_mutation(mutation, fallback)
            verdict, says = ("killed", caught) if caught else ("SURVIVED", "no test fails")
        except Failed as error:
            verdict, says = "ERROR", str(error)
        finally:
            trees.put(tree)
        print(f"{verdict:9}{mutation.name:32}{time.monotonic() - start:6.1f} s  {says}", flush=True)
        return verdict

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        verdicts = list(pool.map(one, mutations))
    killed = verdicts.count("killed")
    print(f"{killed} of {len(mutations)} killed, {verdicts.count('SURVIVED')} survived, {verdicts.count('ERROR')} errors")
    return killed == len(mutations)


def run_torture(mutations, work):
    tree = Tree(work / "torture", 2)
    missed = 0
    for mutation in mutations:
        try:
            found = tree.torture(mutation)
            verdict, says = ("found", found) if found else ("MISSED", f"nothing found in {TORTURE_S} s")
        except Failed as error:
            verdict, says = "ERROR", str(error)
        missed += verdict != "found"
        print(f"{verdict:9}{mutation.name:32}{says}", flush=True)
    print(f"{len(mutations) - missed} of {len(mutations)} found")
    return missed == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true", help="print the mutations and end")
    parser.add_argument("--dry-run", action="store_true", help="only check that each mutation still applies")
    parser.add_argument("--only", action="append", metavar="NAME", help="only these; NAME may hold * and ? (repeatable)")
    parser.add_argument("--jobs", type=int, default=1, metavar="N",
                        help="mutations at a time, each in a tree of its own (default 1, which builds on two cores)")
    parser.add_argument("--work", type=pathlib.Path, metavar="DIR",
                        help="where the trees go; kept, so that a next run builds less (default: a temporary folder)")
    parser.add_argument("--torture", action="store_true", help="the broken rules that hydro-torture must find, and no tests")
    parser.add_argument("--model-only", action="store_true", help="do not run the experiments' tests when no other fails")
    arguments = parser.parse_args()
    if arguments.jobs < 1:
        parser.error(f"--jobs: found {arguments.jobs}, must be at least 1")
    known = mutations = TORTURE_MUTATIONS if arguments.torture else MUTATIONS
    if arguments.only:
        for pattern in arguments.only:
            if not any(fnmatch.fnmatchcase(mutation.name, pattern) for mutation in known):
                parser.error(f"--only: no mutation is named {pattern}; --list prints them")
        mutations = [m for m in known if any(fnmatch.fnmatchcase(m.name, p) for p in arguments.only)]
    if arguments.list:
        for mutation in mutations:
            old, new = (" ".join(text.split()) for text in (mutation.old, mutation.new))
            print(f"{mutation.name:32}{mutation.file}: {old}  ->  {new}")
        return 0
    if check_all_apply(mutations + TORTURE_MUTATIONS if arguments.dry_run else mutations) > 0:
        return 1
    if arguments.dry_run:
        print(f"{len(mutations)} mutations, all apply; so do {len(TORTURE_MUTATIONS)} for hydro-torture")
        return 0

    def examine(work):
        if arguments.torture:
            return run_torture(mutations, work)
        return run(mutations, work, arguments.jobs, not arguments.model_only)

    try:
        if arguments.work:
            work = arguments.work.resolve()
            if work == SOURCE or SOURCE in work.parents:
                parser.error("--work: must lie outside of the checkout")
            work.mkdir(parents=True, exist_ok=True)
            return 0 if examine(work) else 1
        with tempfile.TemporaryDirectory(prefix="hydro-mutation-") as work:
            return 0 if examine(pathlib.Path(work)) else 1
    except Failed as error:
        print(f"mutate: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
