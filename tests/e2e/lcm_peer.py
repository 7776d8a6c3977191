"""Speaks LCM's UDP protocol without LCM, so that a test can send what none of our programs would, or replace one.

Written from the protocol's description: a short message is the magic word, a sequence number, the channel and a zero byte,
and the data.
"""

import re
import select
import socket
import struct
import threading

import event_log

MAGIC = 0x4C433032
HEADER = struct.Struct(">II")


def type_hashes(log_file):
    """The 8 bytes that open the messages of each type, as the programs under test themselves write them."""
    hashes = {}
    for event in event_log.read_events(log_file):
        kind = event_log.kind_of(event.channel)
        if kind:
            hashes.setdefault(kind, event.data[:8])
    return hashes


class Peer:
    """One more participant of the network of `url`. `group` sends to another multicast group on the same port."""

    def __init__(self, url, hashes, group=None):
        found = re.match(r"udpm://([0-9.]+):([0-9]+)", url)
        self.group, self.port = group or found[1], int(found[2])
        self.hashes = hashes
        self.sent = 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self.socket.bind(("", self.port))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                               socket.inet_aton(self.group) + socket.inet_aton("0.0.0.0"))
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)

    def close(self):
        self.socket.close()

    def publish_bytes(self, channel, data):
        packet = HEADER.pack(MAGIC, self.sent) + channel.encode() + b"\0" + data
        self.sent += 1
        self.socket.sendto(packet, (self.group, self.port))

    def publish_packet(self, packet):
        """Sends bytes as they are: LCM's packets, or what only looks like them."""
        self.socket.sendto(packet, (self.group, self.port))

    def publish(self, kind, **fields):
        """Sends a message of that kind; fields that are not given are 0 or empty."""
        type_ = event_log.TYPES[kind]
        values = [fields.pop(name, "" if code == "s" else 0) for name, code in zip(type_.tuple._fields, type_.codes)]
        assert not fields, fields
        self.publish_bytes(kind, type_.encode(self.hashes[kind], values))

    def receive(self, timeout):
        """The (channel, data) of all that has arrived within `timeout` s; at once when something has."""
        messages = []
        while select.select([self.socket], [], [], 0 if messages else timeout)[0]:
            packet = self.socket.recv(65536)
            magic, _ = HEADER.unpack_from(packet)
            if magic != MAGIC:
                continue  # a fragment of a long message
            channel, _, data = packet[HEADER.size:].partition(b"\0")
            messages.append((channel.decode(), data))
        return messages


class Loop:
    """Stands in for a control loop: announces itself, and answers each state with what `answer(state)` yields, each the
    fields of a command, tick, session, sequence and all where they are to differ from the right ones."""

    def __init__(self, peer, role, kind, answer, session=4242, interval=1):
        self.peer, self.role, self.kind, self.answer = peer, role, kind, answer
        self.session, self.interval = session, interval
        self.sequence = 0
        self.running = False
        self.error = None
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self._end.set()
        self._thread.join()
        if self.error:
            raise self.error

    def _announce(self, state):
        self.peer.publish("HYDRO_PROCESS_STATUS", session=self.session, role=self.role, host="test", version="test",
                          pid=1, state=state)

    def _run(self):
        try:
            while not self._end.is_set():
                if not self.running:
                    self._announce(event_log.READY)
                for channel, data in self.peer.receive(0.1):
                    if channel == "HYDRO_STATE":
                        self._on_state(event_log.TYPES[channel].decode(data))
        except Exception as error:  # noqa: BLE001 - told to the test's own thread
            self.error = error

    def _on_state(self, state):
        if not self.running:
            self.running = True
            self._announce(event_log.RUNNING)
        if state.tick % self.interval:
            return
        for fields in self.answer(state):
            command = {"tick": state.tick, "session": self.session, "sequence": self.sequence}
            command.update(fields)
            self.sequence = max(self.sequence, command["sequence"]) + 1
            self.peer.publish(self.kind, **command)
