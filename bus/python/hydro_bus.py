"""LCM's UDP multicast for a program of your own, with nothing but Python's standard library.

    import hydro_bus
    from hydro import state_t, pressure_command_t          # what lcm-gen -p makes; installed beside this file

    bus = hydro_bus.Bus()                                  # that of the stack whose hydro-launch started this program
    bus.subscribe("HYDRO_STATE", state_t, print)
    while True:
        bus.handle(1.0)

Loop is a controller's whole life on it: docs/own_controller.md. A stack with a key (bus.key_file) does not listen to what is not
sealed, and this module does not seal: such a controller is written in C++.
"""

import os
import re
import select
import signal
import socket
import struct
import time

SHORT, FRAGMENT = 0x4C433032, 0x4C433033  # the first word of a packet: "LC02", "LC03"
_SHORT_HEADER = struct.Struct(">II")  # magic, sequence number
_FRAGMENT_HEADER = struct.Struct(">IIIIHH")  # magic, sequence number, size, offset, number, number of fragments
_LARGEST_SHORT = 65499  # bytes of channel and data in a packet that is not a fragment
_LARGEST_FRAGMENT = 65487
_LARGEST_MESSAGE = 1 << 24  # bytes; longer ones are not put together
_MOST_UNFINISHED = 16  # messages in fragments that wait for the rest


class Bus:
    """One participant of the network of `url`, "udpm://GROUP:PORT?ttl=N", on channels that end in `suffix` (bus.url and
    bus.channel_suffix of the configuration). Without them, those of who started this program, else the usual network. Raises
    ValueError for another url."""

    def __init__(self, url=None, suffix=None):
        url = url or os.environ.get("HYDRO_BUS_URL") or "udpm://239.255.76.67:7667?ttl=0"
        self._suffix = os.environ.get("HYDRO_CHANNEL_SUFFIX", "") if suffix is None else suffix
        found = re.fullmatch(r"udpm://(\d+\.\d+\.\d+\.\d+):(\d+)(?:\?(?:.*&)?ttl=(\d+).*)?", url)
        if not found:
            raise ValueError(f'found url "{url}", allowed is e.g. "udpm://239.255.76.67:7667?ttl=0"')
        self._to = (found[1], int(found[2]))
        self._sent = 0
        self._handlers = {}
        self._unfinished = {}  # (sender, sequence number): {size, name of the channel, pieces by number}
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self._socket.bind(self._to)  # the group's address: what is sent to other groups on this port stays away
        member = socket.inet_aton(self._to[0]) + socket.inet_aton("0.0.0.0")
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, int(found[3] or 0))
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)

    def close(self):
        self._socket.close()

    def subscribe(self, channel, type_, handler):
        """Calls handler(message) for each message on `channel` that is one of `type_`, from within handle(). Others are ignored."""
        self._handlers[channel + self._suffix] = (type_, handler)

    def publish(self, channel, message):
        """Sends a message of a type that lcm-gen made."""
        data = message.encode()
        name = (channel + self._suffix).encode() + b"\0"
        if len(name) + len(data) <= _LARGEST_SHORT:
            self._socket.sendto(_SHORT_HEADER.pack(SHORT, self._sent) + name + data, self._to)
        else:
            self._publish_fragments(name, data)
        self._sent = (self._sent + 1) & 0xFFFFFFFF

    def _publish_fragments(self, name, data):
        begins = [0, *range(_LARGEST_FRAGMENT - len(name), len(data), _LARGEST_FRAGMENT)]
        for number, (begin, end) in enumerate(zip(begins, [*begins[1:], len(data)])):
            header = _FRAGMENT_HEADER.pack(FRAGMENT, self._sent, len(data), begin, number, len(begins))
            self._socket.sendto(header + (name if number == 0 else b"") + data[begin:end], self._to)

    def handle(self, timeout):
        """Waits up to `timeout` s for a message, and hands over all that are there. Whether there was one."""
        handled = False
        while select.select([self._socket], [], [], 0 if handled else max(0, timeout))[0]:
            packet, sender = self._socket.recvfrom(65536)
            message = self._message_of(packet, sender)
            if message is None:
                continue
            handled = True
            type_, handler = self._handlers.get(message[0], (None, None))
            if type_ is None:
                continue
            try:
                decoded = type_.decode(message[1])
            except (ValueError, struct.error, IndexError, UnicodeDecodeError):
                continue  # of another version
            handler(decoded)
        return handled

    def _message_of(self, packet, sender):
        """(channel, data) of a packet; None: it is none, or not whole yet."""
        if len(packet) < _SHORT_HEADER.size:
            return None
        magic, number = _SHORT_HEADER.unpack_from(packet)
        if magic == FRAGMENT:
            return self._assembled(packet, (sender, number))
        name, end, data = packet[_SHORT_HEADER.size:].partition(b"\0")
        return (name.decode("utf-8", "replace"), data) if magic == SHORT and end else None

    def _assembled(self, packet, key):
        if len(packet) < _FRAGMENT_HEADER.size:
            return None
        _, _, size, offset, number, count = _FRAGMENT_HEADER.unpack_from(packet)
        data = packet[_FRAGMENT_HEADER.size:]
        name = None
        if number == 0:
            name, end, data = data.partition(b"\0")
            if not end:
                return None
        if size > _LARGEST_MESSAGE or number >= count or offset + len(data) > size:
            return None
        if key not in self._unfinished and len(self._unfinished) >= _MOST_UNFINISHED:
            self._unfinished.pop(next(iter(self._unfinished)))  # the oldest lost a piece
        message = self._unfinished.setdefault(key, {"size": size, "name": None, "pieces": {}})
        message["pieces"][number] = (offset, data)
        if name is not None:
            message["name"] = name.decode("utf-8", "replace")
        if len(message["pieces"]) < count or message["name"] is None:
            return None
        del self._unfinished[key]
        whole = b"".join(piece for _, piece in sorted(message["pieces"].values()))
        return (message["name"], whole) if len(whole) == message["size"] else None


def new_session():
    """The identity of a process: a number that no other one has."""
    return int.from_bytes(os.urandom(8), "big") >> 1


class Loop:
    """A control loop's life on the bus: READY ten times a second until the first state, an answer to each state that it should answer,
    DONE when the run is over.

    role: whose place it takes, "position_ctrl" or "pressure_ctrl". channel, type_: what it answers with. answer(state, command):
    fills in the command; tick, session, sequence and utime are filled in already. every: plant ticks from one answer to the next
    (position_ctrl: sample_interval_s times rate_hz), where the loop is started by hand; hydro-launch says it in HYDRO_EVERY.

    reference(state), where it is given: the angle that a position loop wants of the arm, rad. It is published for tables, pictures and
    hydro-log summary.

    A pressure loop finds in self.asked the pressure command in force, the newest of an earlier tick; None before the first. In
    lockstep (HYDRO_TIME) it answers a state only when the command that is due then (HYDRO_POSITION_EVERY, HYDRO_COMMAND_DELAY) is
    here: in the network it may come after the state. While the command in force is an open-loop one, its voltage is passed on, and
    answer() is not asked. Nor is it while that command is older than HYDRO_STALE_TICKS: zero volts, and a fault that says so.
    """

    def __init__(self, bus, role, channel, type_, answer, every=1, reference=None):
        import hydro  # the types of lcm-gen

        self.bus, self.role, self.channel, self.type_, self.answer = bus, role, channel, type_, answer
        self.every = int(os.environ.get("HYDRO_EVERY", every))
        self.reference, self._reference_t = reference, hydro.arm_reference_t
        self._position_every = int(os.environ.get("HYDRO_POSITION_EVERY", 1))
        self._delay = int(os.environ.get("HYDRO_COMMAND_DELAY", 1))
        self._waits = role == "pressure_ctrl" and os.environ.get("HYDRO_TIME") == "lockstep"
        self._oldest = int(os.environ.get("HYDRO_STALE_TICKS", 0)) if role == "pressure_ctrl" else 0  # ticks; 0: not watched
        self._stale = False
        self._faults = 0  # sent
        self._pending = None  # lockstep: a state that waits for the pressure command that it needs
        self.session = new_session()
        self._status_t, self._fault_t = hydro.process_status_t, hydro.fault_t
        self.asked = None
        self._heard = []  # the pressure commands that are, or will be, in force
        self._command = None  # the last, which is sent again when its state is
        self._sequence = 0
        self._plant = 0  # session of the plant that is followed
        self._running = False
        self._over = None  # why
        self._signal = False
        bus.subscribe("HYDRO_STATE", hydro.state_t, self._on_state)
        bus.subscribe("HYDRO_STOP", hydro.stop_t, self._on_stop)
        if role == "pressure_ctrl":
            bus.subscribe("HYDRO_PRESSURE_COMMAND", hydro.pressure_command_t, self._on_pressure_command)

    def run(self):
        """Runs until the run is over. Returns the exit code that the launcher expects: 0, or that of the stop."""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._on_signal)
        next_status = 0
        while self._over is None and not self._signal:
            if not self._running and time.monotonic() >= next_status:
                next_status = time.monotonic() + 0.1
                self._say(self._status_t.READY, "waits for the first state")
            try:
                self.bus.handle(0.1)
            except BaseException as error:  # of answer(): zero volts first, explanation second
                self._ask_for_nothing()
                self._say(self._status_t.FAILED, f"{type(error).__name__}: {error}"[:200])
                raise
        if self._over is None or self.role == "pressure_ctrl":
            self._ask_for_nothing()
        self._say(self._status_t.DONE, "")
        return self._over or 0

    def _ask_for_nothing(self):
        """A last command of zero volts: what was asked for last must not stay in force."""
        if self._command is None:
            return
        command = self.type_()
        command.tick, command.session, command.sequence = self._command.tick, self.session, self._sequence
        command.utime = time.time_ns() // 1000
        if self.role == "pressure_ctrl":
            command.status = self.type_.STOPPED
        else:
            command.open_loop = True
        self.bus.publish(self.channel, command)

    def _on_signal(self, _number, _frame):
        self._signal = True

    def _say(self, state, text):
        status = self._status_t()
        status.utime, status.session, status.role, status.pid = time.time_ns() // 1000, self.session, self.role, os.getpid()
        status.host, status.version, status.state, status.text = socket.gethostname(), "", state, text
        self.bus.publish("HYDRO_PROCESS_STATUS", status)

    def _on_stop(self, stop):
        if stop.addressee in (0, self.session, self._plant):
            self._over = stop.exit_code

    def _on_pressure_command(self, command):
        if not self._heard or command.tick > self._heard[-1].tick:
            self._heard.append(command)
        if self._pending and not self._lacks_command(self._pending.tick):
            state, self._pending = self._pending, None
            self._answer(state)

    def _lacks_command(self, tick):
        if not self._waits or tick < self._delay:
            return False
        due = (tick - self._delay) // self._position_every * self._position_every
        newest = self._heard[-1].tick if self._heard else self.asked.tick if self.asked else -1
        return newest < due

    def _publish_reference(self, state):
        sent = self._reference_t()
        sent.tick, sent.session, sent.sequence, sent.utime = state.tick, self.session, self._sequence, time.time_ns() // 1000
        sent.signal, sent.value = sent.ARM_ANGLE, self.reference(state)
        self.bus.publish("HYDRO_ARM_REFERENCE", sent)

    def _take_pressure_command(self, state, command):
        while self._heard and self._heard[0].tick <= state.tick - self._delay:
            self.asked = self._heard.pop(0)
        command.pressure_command_tick = self.asked.tick if self.asked else -1
        command.pressure_ref = self.asked.pressure_ref if self.asked else 0.0

    def _on_state(self, state):
        if not self._running:
            self._running, self._plant = True, state.session
            self._say(self._status_t.RUNNING, "")
        if state.session != self._plant or state.tick % self.every:
            return
        if self._command is not None and state.tick <= self._command.tick:
            if state.tick == self._command.tick:  # comes again, and asks for the answer again; an older one was overtaken
                self.bus.publish(self.channel, self._command)
        elif self._lacks_command(state.tick):
            self._pending = state
        else:
            self._answer(state)

    def _answer(self, state):
        command = self.type_()
        command.tick, command.session, command.sequence = state.tick, self.session, self._sequence
        command.utime = time.time_ns() // 1000
        if self.role == "pressure_ctrl":
            self._take_pressure_command(state, command)
        age = state.tick - (self.asked.tick if self.asked else 0)
        stale = 0 < self._oldest < age
        if stale:
            command.status = self.type_.SAFE
        elif self.asked is not None and self.asked.open_loop:
            command.voltage, command.status = self.asked.voltage, self.type_.OPEN_LOOP
        elif self.answer(state, command) is not None:
            raise TypeError("answer() returned a value, which nobody reads; it fills in the command, e.g. command.pressure_ref = 10.0")
        if self.reference is not None:
            self._publish_reference(state)
        self._sequence += 1
        self._command = command
        self.bus.publish(self.channel, command)
        if stale != self._stale:  # zero volts first, explanation second
            self._stale = stale
            self._say_stale(state.tick, age)

    def _say_stale(self, tick, age):
        fault = self._fault_t()
        fault.utime, fault.tick, fault.session, fault.sequence = time.time_ns() // 1000, tick, self.session, self._faults
        fault.source, fault.code, fault.active, fault.latched = self.role, "stale_pressure_command", self._stale, False
        fault.value, fault.limit = float(age), float(self._oldest)
        fault.text = f"tick {tick}: the newest pressure command is {age} ticks old, allowed are {self._oldest} (limits.stale_input_s)"
        self._faults += 1
        self.bus.publish("HYDRO_FAULT", fault)
