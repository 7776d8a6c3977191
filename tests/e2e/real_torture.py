"""One run of a schedule of hydro-torture on real processes over UDP. What sim/torture/ does to simulated processes this does to
real ones: the same faults at the same times after the plant's first state."""

import heapq
import itertools
import os
import signal
import tempfile
import time

import stack
import torture_intruder

RESTART = 0.3  # s: how soon whoever watches a process starts it again, as sim/torture/world_processes.cc
RETURN = 5.0  # s after the last fault in which control returns, as sim/torture/world_end.cc
PATIENCE = 0.4  # s of the operator, as sim/torture/programs.cc
REQUESTS = 6  # of the operator, half a second apart, as sim/torture/world_end.cc
CONFIG = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "sim", "torture", "torture.toml")
OTHER = ("--set", "position.c1=3000", "--set", "limits.arm_torque=400")  # as sim/torture/run_schedule.cc


class RealTorture:
    ROLES = ("logger", "position_ctrl", "pressure_ctrl", "plant")

    def __init__(self, case, schedule, network, url, hashes, key_file=None):
        self.case, self.schedule, self.network = case, schedule, network
        run = schedule.run
        settings = {"bus.url": url, "model.file": f'"{stack.config("models/table1.toml")}"', "time.mode": '"realtime"',
                    "time.duration_s": 0, "limits.rearm": f'"{run["rearm"]}"', "limits.stale_input_s": run["stale"]}
        if run["key"] == "yes":
            settings["bus.key_file"] = f'"{key_file}"'
        self.arguments = [CONFIG, *(word for key, value in settings.items() for word in ("--set", f"{key}={value}"))]
        self.processes = {}  # by role
        self.intruder = network.opened_there(lambda: torture_intruder.Intruder(url, hashes, self.now))
        case.addCleanup(self.intruder.close)
        self.folder = tempfile.mkdtemp(dir=case.folder)
        self.logs = []
        self.other = set()  # roles that start with the other configuration
        self.restart_at = {}  # by role, for those that have ended
        self.began = time.monotonic()  # when the plant's first state came
        self.began_us = 0
        self.waiting = []  # heap of (time, number, what goes on then)
        self.number = itertools.count()

    def now(self):
        return time.monotonic() - self.began

    # Processes.

    def begin(self, role):
        more = OTHER if role in self.other else ()
        if role == "logger":
            self.logs.append(os.path.join(self.folder, f"run_{len(self.logs)}.lcmlog"))
            more = (*more, "-o", self.logs[-1])
        if role == "plant":
            more = (*more, "--expect", "logger")
        self.processes[role] = self.start_program(role, stack.PROGRAMS[role], *more)

    def start_program(self, place, name, *more):
        argv = self.network.command(place, [stack.program(name), *self.arguments, *more])
        return self.case.start(*argv, label=place)

    def find(self, role):
        process = self.processes[role]
        return process if process.running else None

    def kill(self, role, restart_at):
        if process := self.find(role):
            process.kill()
            process.wait()
        self.restart_at[role] = restart_at

    def watch(self):
        """Whoever has ended is started again."""
        for role in self.ROLES:
            if self.find(role):
                self.restart_at.pop(role, None)
            elif self.now() >= self.restart_at.setdefault(role, self.now() + RESTART):
                del self.restart_at[role]
                self.begin(role)

    def operator(self, flag):
        return self.start_program("operator", "hydro-launch", flag)

    # The injected faults. Each yields the times at which it continues.

    def hang(self, injection):
        process = self.find(injection.target)
        if not process:
            return
        process.send(signal.SIGSTOP)
        yield injection.at + injection.duration
        if process.running:
            process.send(signal.SIGCONT)

    def crash(self, injection):
        self.kill(injection.target, injection.at + injection.duration)
        yield from ()

    def signal(self, injection):
        if process := self.find(injection.target):
            process.send(signal.SIGTERM)
        yield from ()

    def other_configuration(self, injection):
        before = self.processes[injection.target]
        self.other.add(injection.target)
        self.kill(injection.target, self.now() + 0.02)
        yield injection.at + injection.duration
        # A busy machine may take longer to start the process. It is refused once, however long that takes.
        while self.processes[injection.target] is before or self.find(injection.target):
            yield self.now() + 0.005
        self.other.discard(injection.target)
        self.kill(injection.target, self.now() + 0.02)

    def partition(self, injection):
        self.network.connect(injection.target, False)
        yield injection.at + injection.duration
        self.network.connect(injection.target, True)

    def bad_link(self, injection):
        if injection.kind == "loss":
            self.case.assertEqual(injection.amount, 1, "a share that is lost depends on chance")
        link = self.network.make_bad(injection.target, injection.amount if injection.kind == "delay" else None)
        yield injection.at + injection.duration
        link.end_fault()
        while not link.ended:
            yield self.now() + 0.005
        self.network.make_good(injection.target)

    loss = delay = bad_link

    def stop(self, _):
        # hydro-launch asks until no process is left, including those that are started again in the meantime.
        # The simulated operator gives up earlier.
        operator = self.operator("--stop")
        yield self.now() + PATIENCE
        if operator.running:
            operator.kill()

    def rearm(self, _):
        self.operator("--rearm")
        yield from ()

    # The run.

    def at(self, moment, generator):
        heapq.heappush(self.waiting, (moment, next(self.number), generator))

    def requests(self):
        """In explicit mode the operator asks for a re-arm when the faults have ended."""
        for _ in range(REQUESTS):
            self.operator("--rearm")
            yield self.now() + 0.5

    def run(self):
        """Returns the logs of the run, when all processes have ended as told."""
        for role in self.ROLES:
            self.begin(role)
        self.case.wait_until(lambda: self.intruder.listen(0.05) or self.intruder.plant, "the plant's first state")
        self.began, self.began_us = time.monotonic(), time.time() * 1e6
        self.intruder.commands.clear()  # of another zero of time
        for injection in self.schedule.injections:
            inject = getattr(self, injection.kind, None) or getattr(self.intruder, injection.kind)
            self.at(injection.at, inject(injection))
        if self.schedule.run["rearm"] == "explicit":
            self.at(self.schedule.until, self.requests())
        watched = 0
        while self.now() < self.schedule.until + RETURN:
            due = self.waiting[0][0] if self.waiting else self.now() + 1
            self.intruder.listen(max(0.0, min(due - self.now(), 0.01)))
            while self.waiting and self.waiting[0][0] <= self.now():
                generator = heapq.heappop(self.waiting)[-1]
                if (next_time := next(generator, None)) is not None:
                    self.at(next_time, generator)
            if self.now() - watched > 0.01:
                watched = self.now()
                self.watch()
        self.end()
        return self.logs

    def end(self):
        for process in self.processes.values():
            self.case.assertTrue(process.running, process.report())
        self.case.assertEqual(self.operator("--stop").wait(), 0)
        for process in self.processes.values():
            self.case.assertEqual(process.wait(), 0, process.report())
