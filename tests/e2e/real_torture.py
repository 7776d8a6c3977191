"""One run of a schedule of hydro-torture on real processes over UDP. What torture/ does to simulated processes this does to
real ones: the same faults at the same times after the plant's first state."""

import collections
import heapq
import os
import random
import signal
import time

import event_log
import lcm_peer
import stack

RESTART = 0.3  # s: how soon whoever watches a process starts it again, as torture/world_processes.cc
RETURN = 5.0  # s after the last fault in which control returns, as torture/world_end.cc
REQUESTS = 6  # of the operator, half a second apart, as torture/world_end.cc
CONFIG = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "torture", "torture.toml")
OTHER = ("--set", "position.c1=3000", "--set", "limits.arm_torque_in_lbf=400")  # as torture/torture_config.cc


class Intruder(lcm_peer.Peer):
    """Listens, and sends what no process of the stack would. Does not hear itself."""

    def __init__(self, url, hashes):
        super().__init__(url, hashes)
        self.own = set()

    def publish_bytes(self, channel, data):
        self.own.add(data)
        super().publish_bytes(channel, data)

    def heard(self, timeout):
        return [(channel, data) for channel, data in self.receive(timeout) if data not in self.own]


class RealTorture:
    ROLES = ("logger", "position_ctrl", "pressure_ctrl", "plant")

    def __init__(self, case, schedule, network, url, hashes, key_file=None):
        self.case, self.schedule, self.network = case, schedule, network
        run = schedule.run
        settings = {"bus.url": url, "model.file": f'"{stack.config("models/table1.toml")}"', "time.mode": '"realtime"', "time.duration_s": 0,
                    "limits.rearm": f'"{run["rearm"]}"', "limits.stale_input_s": run["stale"]}
        if run["key"] == "yes":
            settings["bus.key_file"] = f'"{key_file}"'
        self.arguments = [CONFIG, *(word for key, value in settings.items() for word in ("--set", f"{key}={value}"))]
        self.processes = {}  # by role
        self.intruder = network.opened_there(lambda: Intruder(url, hashes))
        case.addCleanup(self.intruder.close)
        self.logs = []
        self.other = set()  # roles that start with the other configuration
        self.restart_at = {}  # by role, for those that have ended
        self.plant = None  # its newest state
        self.began = None  # monotonic time of its first
        self.start_us = 0
        self.commands = collections.deque(maxlen=4096)  # (time, bytes) of the motor commands
        self.sent = collections.Counter()  # by injection
        self.waiting = []  # heap of (time, number, what goes on then)

    def now(self):
        return time.monotonic() - self.began

    # Processes.

    def begin(self, role):
        more = OTHER if role in self.other else ()
        if role == "logger":
            self.logs.append(self.case.path(f"run_{len(self.logs)}.lcmlog"))
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

    # What is injected: each yields the times at which it goes on.

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
        # A busy machine may take longer to start it: it is refused once, however long that takes.
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
        self.operator("--stop")
        yield from ()

    def rearm(self, _):
        self.operator("--rearm")
        yield from ()

    def foreign_stop(self, injection):
        draw = random.Random(injection.seed)
        self.intruder.publish("HYDRO_STOP", tick=-1, session=draw.getrandbits(62) + 1, addressee=draw.getrandbits(62) + 1,
                              source="launch", reason="hydro-plant has ended with exit code 1", exit_code=1)
        yield from ()

    def repeated(self, injection, period, send):
        while self.now() < injection.at + injection.duration:
            send(injection)
            self.sent[injection] += 1
            yield self.now() + period

    def second_plant(self, injection):
        session = injection.seed + 77
        self.intruder.publish("HYDRO_RUN", session=session, program="hydro-plant", host="elsewhere")

        def send(i):
            self.intruder.publish("HYDRO_STATE", tick=self.sent[i], session=session, sequence=self.sent[i], p1=100.0, p2=100.0)
        yield from self.repeated(injection, 0.005, send)

    def second_sender(self, injection):
        def send(i):
            self.intruder.publish("HYDRO_MOTOR_COMMAND", tick=self.plant.tick, session=i.seed + 99, sequence=self.sent[i],
                                  voltage=i.amount)
        yield from self.repeated(injection, 0.001, send)

    def replay(self, injection):
        def send(i):
            old = [data for sent, data in self.commands if sent <= self.now() - i.amount]
            if old:
                self.intruder.publish_bytes("HYDRO_MOTOR_COMMAND", old[-1])
        yield from self.repeated(injection, 0.001, send)

    def flood(self, injection):
        draw = random.Random(injection.seed)

        def send(_):
            self.intruder.publish("HYDRO_PROCESS_STATUS", session=draw.getrandbits(63), host="elsewhere",
                                  role=draw.choice(["pressure_ctrl", "logger"]), state=event_log.READY,
                                  text="x" * draw.randrange(200))
        yield from self.repeated(injection, 1 / injection.amount, send)

    def changed_command(self, injection):
        command = event_log.TYPES["HYDRO_MOTOR_COMMAND"].decode(self.commands[-1][1])._asdict()
        command["sequence"] += 1
        if injection.kind == "huge_sequence":
            command["sequence"] = 1 << round(injection.amount)
        elif injection.kind == "huge_tick":
            command["tick"] += 1 << round(injection.amount)
        else:
            command["voltage"] = float("nan") if injection.kind == "nonfinite_command" else injection.amount
        self.intruder.publish("HYDRO_MOTOR_COMMAND", **command)
        yield from ()

    huge_sequence = huge_tick = nonfinite_command = excessive_command = changed_command

    # The run.

    def listen(self, timeout):
        for channel, data in self.intruder.heard(timeout):
            if channel == "HYDRO_STATE":
                # With a key a seal follows the message.
                self.plant = event_log.TYPES[channel].decode(data[:8 + event_log.TYPES[channel].fixed.size])
            elif channel == "HYDRO_MOTOR_COMMAND" and self.began:
                self.commands.append((self.now(), data))

    def at(self, moment, generator):
        heapq.heappush(self.waiting, (moment, len(self.waiting), id(generator), generator))

    def requests(self):
        """In explicit mode the operator asks for a re-arm when the faults have ended."""
        for _ in range(REQUESTS):
            self.operator("--rearm")
            yield self.now() + 0.5

    def run(self):
        """Returns the logs of the run, when all processes have ended as told."""
        for role in self.ROLES:
            self.begin(role)
        self.case.wait_until(lambda: self.listen(0.05) or self.plant, "the plant's first state")
        self.began, self.start_us = time.monotonic(), time.time() * 1e6
        for injection in self.schedule.injections:
            self.at(injection.at, getattr(self, injection.kind)(injection))
        if self.schedule.run["rearm"] == "explicit":
            self.at(self.schedule.until, self.requests())
        watched = 0
        while self.now() < self.schedule.until + RETURN:
            due = self.waiting[0][0] if self.waiting else self.now() + 1
            self.listen(max(0.0, min(due - self.now(), 0.01)))
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
