"""Reads LCM event logs and the messages of package hydro in them.

Written from the description of the format, with the types as docs/messages.md lists them, so that it tests the programs' reader
and writer instead of repeating them.
"""

import collections
import os
import re
import struct
import zlib

SYNC_WORD = 0xEDA1DA01
HEADER = struct.Struct(">IqqII")  # sync word, event number, timestamp us, channel length, data length

# How struct packs a field that is not a string. docs/messages.md names the types.
CODES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "boolean": "b", "byte": "B",
         "string": "s"}
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "messages.md")


def _read_page(path=PAGE):
    """What docs/messages.md says of each channel: its fields after the 8 bytes of the type's hash, and when it is sent.

    A field is a pair of its name and a code: q int64, i int32, b int8 or boolean, d double, s string (its length with the zero
    byte as int32, then the bytes), *FIELD:CODE that as many times as the field says."""
    with open(path, encoding="utf-8") as file:
        overview, *sections = file.read().split("\n## ")
    fields = {}
    for section in sections:
        rows = re.findall(r"^\| `(\w+)` \| `(\w+)(?:\[(\w+)\])?` \|", section, re.MULTILINE)
        fields[section.split("\n", 1)[0]] = [(name, f"*{count}:{CODES[type_]}" if count else CODES[type_]) for name, type_, count in rows]
    rows = re.findall(r"^\| \[`(\w+)`\]\(#\w+\) \| `(\w+)` \|[^|]*\| ([^|]*) \|", overview, re.MULTILINE)
    return {channel: fields[type_] for channel, type_, _ in rows}, {channel: rate for channel, _, rate in rows}


FIELDS, RATES = _read_page()
NUMBERED = tuple(channel for channel, rate in RATES.items() if rate.startswith("each "))  # what the loops compute at a tick

# motor_command_t.status and process_status_t.state
LAW, OPEN_LOOP, SAFE, STOPPED = range(4)
READY, RUNNING, DONE, FAILED = 1, 2, 3, 4


class LogError(Exception):
    """A log, or a message in it, is not what it should be."""


class Type:
    """Decodes the messages of one channel into named tuples."""

    def __init__(self, channel, pairs):
        self.tuple = collections.namedtuple(channel.title().replace("_", ""), [name for name, _ in pairs])
        self.codes = [code for _, code in pairs]
        varies = any(code == "s" or code.startswith("*") for code in self.codes)
        self.fixed = None if varies else struct.Struct(">" + "".join(self.codes))

    def decode(self, data):
        if self.fixed:
            if len(data) != 8 + self.fixed.size:
                raise LogError(f"{self.tuple.__name__}: {len(data)} bytes, expected {8 + self.fixed.size}")
            return self.tuple._make(self.fixed.unpack_from(data, 8))
        values, at = [], 8
        for code in self.codes:
            if code.startswith("*"):
                count, code = code[1:].split(":")
                items = []
                for _ in range(values[self.tuple._fields.index(count)]):
                    item, at = self._value(code, data, at)
                    items.append(item)
                values.append(tuple(items))
            else:
                value, at = self._value(code, data, at)
                values.append(value)
        if at != len(data):
            raise LogError(f"{self.tuple.__name__}: {len(data)} bytes, decoded {at}")
        return self.tuple._make(values)

    @staticmethod
    def _value(code, data, at):
        """A field's value, and where the next begins."""
        if code == "s":
            (length,) = struct.unpack_from(">i", data, at)
            return data[at + 4:at + 3 + length].decode(), at + 4 + length
        return struct.unpack_from(">" + code, data, at)[0], at + struct.calcsize(">" + code)

    def encode(self, type_hash, message):
        """The bytes of a message; `type_hash` is the 8 bytes that open each message of this type."""
        data = type_hash
        for code, value in zip(self.codes, message):
            if code == "s":
                text = value.encode() + b"\0"
                data += struct.pack(">i", len(text)) + text
            else:
                data += struct.pack(">" + code, value)
        return data


TYPES = {channel: Type(channel, fields) for channel, fields in FIELDS.items()}

CHECK_CHANNEL = "\nLOG_CHECK"
Event = collections.namedtuple("Event", "number utime channel data")


def kind_of(channel):
    """HYDRO_STATE for HYDRO_STATE and HYDRO_STATE_2; None for a channel that is not of this stack."""
    fits = [kind for kind in TYPES if channel.startswith(kind)]
    return max(fits, key=len) if fits else None


def _event_at(data, at):
    """The event that begins at `at` and where the next begins; None where the data end within it."""
    if at + HEADER.size > len(data):
        return None
    sync, number, utime, channel_length, data_length = HEADER.unpack_from(data, at)
    if sync != SYNC_WORD:
        raise LogError(f"no sync word at byte {at}")
    body = at + HEADER.size + channel_length
    if body + data_length > len(data):
        return None
    channel = data[at + HEADER.size:body].decode()
    return Event(number, utime, channel, data[body:body + data_length]), body + data_length


def read_all_events(path, torn_tail=False):
    """All events of a log in file order, check events among them, each with the byte at which it begins. A last event that is
    cut off is an error unless `torn_tail`."""
    with open(path, "rb") as file:
        data = file.read()
    events, at = [], 0
    while at < len(data):
        found = _event_at(data, at)
        if found is None:
            if torn_tail:
                break
            raise LogError(f"{path}: ends within an event that begins at byte {at} of {len(data)}")
        events.append((at, found[0]))
        at = found[1]
    return events


def read_events(path, torn_tail=False):
    """The messages of a log in file order: all its events but the check events."""
    return [event for _, event in read_all_events(path, torn_tail) if event.channel != CHECK_CHANNEL]


def write_plain(path, events):
    """Writes a log as lcm-logger does, without check events."""
    with open(path, "wb") as file:
        for number, event in enumerate(events):
            channel = event.channel.encode()
            file.write(HEADER.pack(SYNC_WORD, number, event.utime, len(channel), len(event.data)) + channel + event.data)


Check = collections.namedtuple("Check", "version kind offset previous checksums text checksum")
BEGIN, BLOCK, END = range(3)
CHECK_HEAD = struct.Struct(">8sBBHIQI")  # magic, version, kind, length of the text, count, offset, previous


def parse_check(data):
    """What docs/logs.md says that the data of a check event hold."""
    magic, version, kind, text_length, count, offset, previous = CHECK_HEAD.unpack_from(data)
    if magic != b"HYDROCHK" or len(data) != CHECK_HEAD.size + 4 * count + text_length + 4:
        raise LogError("a check event of other contents")
    at = CHECK_HEAD.size
    checksums = struct.unpack_from(f">{count}I", data, at)
    text = data[at + 4 * count:at + 4 * count + text_length].decode()
    return Check(version, kind, offset, previous, checksums, text, struct.unpack(">I", data[-4:])[0])


def verify(path, follows=0):
    """Compares a whole log with its check events, and returns those. LogError where it is not what was written.

    follows: for a later file of a rotation, the checksum of the end of the one before."""
    with open(path, "rb") as file:
        data = file.read()
    events = read_all_events(path)
    ends = [at for at, _ in events[1:]] + [len(data)]
    checks, pending = [], []
    for (begin, event), end in zip(events, ends):
        if event.channel != CHECK_CHANNEL:
            pending.append(zlib.crc32(data[begin:end]))
            continue
        check = parse_check(event.data)
        expected = Check(1, check.kind, begin, checks[-1].checksum if checks else follows, tuple(pending), check.text,
                         zlib.crc32(data[begin:end - 4]))
        if check != expected or (check.kind == BEGIN) != (not checks):
            raise LogError(f"{path}: byte {begin}: {check}, expected {expected}")
        checks.append(check)
        pending = []
    if not checks or checks[-1].kind != END or events[-1][1].channel != CHECK_CHANNEL:
        raise LogError(f"{path}: no mark of the end")
    return checks


class Follower:
    """Reads a log while it is being written."""

    def __init__(self, path):
        self.path = path
        self.rest = b""
        self.offset = 0

    def new_events(self):
        """The whole events written since the last call."""
        try:
            with open(self.path, "rb") as file:
                file.seek(self.offset)
                more = file.read()
        except FileNotFoundError:
            return []
        self.offset += len(more)
        data, at, events = self.rest + more, 0, []
        while (found := _event_at(data, at)) is not None:
            if found[0].channel != CHECK_CHANNEL:
                events.append(found[0])
            at = found[1]
        self.rest = data[at:]
        return events


class Log:
    """The decoded messages of a log. `items` are (kind, message) in file order; `suffix` picks one stack of several; with
    `foreign`, messages that are not of their channel's type are left out."""

    def __init__(self, path, suffix="", torn_tail=False, foreign=False):
        self.events = read_events(path, torn_tail)
        self.items = []
        self._by_kind = {kind: [] for kind in TYPES}
        for event in self.events:
            kind = kind_of(event.channel)
            if kind is None or event.channel != kind + suffix:
                continue
            try:
                message = TYPES[kind].decode(event.data)
            except (LogError, struct.error):
                if not foreign:
                    raise
                continue
            self.items.append((kind, message))
            self._by_kind[kind].append(message)

    def __getattr__(self, name):
        table = {"states": "HYDRO_STATE", "motor_commands": "HYDRO_MOTOR_COMMAND",
                 "pressure_commands": "HYDRO_PRESSURE_COMMAND", "arm_references": "HYDRO_ARM_REFERENCE",
                 "faults": "HYDRO_FAULT", "stops": "HYDRO_STOP", "outputs_left": "HYDRO_OUTPUT_LEFT", "statuses": "HYDRO_PROCESS_STATUS",
                 "statistics": "HYDRO_LOOP_STATISTICS", "histograms": "HYDRO_LOOP_HISTOGRAM",
                 "rearms": "HYDRO_REARM",
                 "descriptions": "HYDRO_RUN", "progress": "HYDRO_LOG_PROGRESS"}
        if name not in table:
            raise AttributeError(name)
        return self._by_kind[table[name]]

    def of(self, kind):
        return self._by_kind[kind]


def missing_numbers(messages):
    """Missing sequence numbers by session: {session: [numbers]}. A session begins with 0."""
    by_session = {}
    for message in messages:
        by_session.setdefault(message.session, set()).add(message.sequence)
    gaps = {}
    for session, numbers in by_session.items():
        absent = sorted(set(range(max(numbers) + 1)) - numbers)
        if absent:
            gaps[session] = absent
    return gaps
