"""Somebody on the network of a run of torture_real_test.py who listens, and sends what no process of the stack would: what
sim/torture/intruder.cc does in the simulator. Each injection is a generator of the times at which it goes on."""

import collections
import random

import event_log
import lcm_peer


def decoded(channel, data):
    """A message of a fixed size, without the seal that follows it if the stack has a key."""
    type_ = event_log.TYPES[channel]
    return type_.decode(data[:8 + type_.fixed.size])


class Intruder(lcm_peer.Peer):
    def __init__(self, url, hashes, now):
        """`now()` is the time of the run; it is asked from the first injection on."""
        super().__init__(url, hashes)
        self.now = now
        self.own = set()  # what it has sent and does not hear
        self.plant = None  # the newest state
        self.commands = collections.deque(maxlen=4096)  # (time, bytes) of the motor commands
        self.counts = collections.Counter()  # of messages, by injection

    def publish_bytes(self, channel, data):
        self.own.add(data)
        super().publish_bytes(channel, data)

    def listen(self, timeout):
        for channel, data in self.receive(timeout):
            if data in self.own:
                continue
            if channel == "HYDRO_STATE":
                self.plant = decoded(channel, data)
            elif channel == "HYDRO_MOTOR_COMMAND":
                self.commands.append((self.now(), data))

    def foreign_stop(self, injection):
        draw = random.Random(injection.seed)
        self.publish("HYDRO_STOP", tick=-1, session=draw.getrandbits(62) + 1, addressee=draw.getrandbits(62) + 1,
                     source="launch", reason="hydro-plant has ended with exit code 1", exit_code=1)
        yield from ()

    def repeated(self, injection, period, send):
        while self.now() < injection.at + injection.duration:
            send(injection)
            self.counts[injection] += 1
            yield self.now() + period

    def second_plant(self, injection):
        session = injection.seed + 77
        self.publish("HYDRO_RUN", session=session, program="hydro-plant", host="elsewhere")

        def send(i):
            self.publish("HYDRO_STATE", tick=self.counts[i], session=session, sequence=self.counts[i], p1=100.0, p2=100.0)
        yield from self.repeated(injection, 0.005, send)

    def second_sender(self, injection):
        def send(i):
            self.publish("HYDRO_MOTOR_COMMAND", tick=self.plant.tick, session=i.seed + 99, sequence=self.counts[i],
                         voltage=i.amount)
        yield from self.repeated(injection, 0.001, send)

    def replay(self, injection):
        def send(i):
            old = [data for sent, data in self.commands if sent <= self.now() - i.amount]
            if old:
                self.publish_bytes("HYDRO_MOTOR_COMMAND", old[-1])
        yield from self.repeated(injection, 0.001, send)

    def flood(self, injection):
        draw = random.Random(injection.seed)

        def send(_):
            self.publish("HYDRO_PROCESS_STATUS", session=draw.getrandbits(63), host="elsewhere",
                         role=draw.choice(["pressure_ctrl", "logger"]), state=event_log.READY, text="x" * draw.randrange(200))
        yield from self.repeated(injection, 1 / injection.amount, send)

    def changed_command(self, injection):
        if not self.commands:
            return
        command = decoded("HYDRO_MOTOR_COMMAND", self.commands[-1][1])._asdict()
        command["sequence"] += 1
        if injection.kind == "huge_sequence":
            command["sequence"] = 1 << round(injection.amount)
        elif injection.kind == "huge_tick":
            command["tick"] += 1 << round(injection.amount)
        else:
            command["voltage"] = float("nan") if injection.kind == "nonfinite_command" else injection.amount
        self.publish("HYDRO_MOTOR_COMMAND", **command)
        yield from ()

    huge_sequence = huge_tick = nonfinite_command = excessive_command = changed_command
