"""A bad network between two hosts: takes multicast datagrams from one interface, and sends them out of another late, in
another order, or not at all. Both ways. What it did to each message is in its record.

    relay.py --a veth-rig --b veth-desk --group 239.255.76.67 --port 7667 --loss 0.05 --delay 20 --jitter 6 --seed 1 \\
             --outage 3000 2.0 --drop-first HYDRO_STOP 4 --record relay.json

The kernel that the tests run on has no netem, which would do the same. Runs until SIGTERM, then writes the record: counts
by way and channel, and the session and sequence number of each numbered message that it did not forward.
"""

import argparse
import collections
import heapq
import json
import random
import select
import signal
import socket
import struct
import time

import event_log

LCM_SHORT = 0x4C433032
WAYS = ("a>b", "b>a")
SO_BINDTODEVICE = getattr(socket, "SO_BINDTODEVICE", 25)


def open_socket(interface, group, port):
    """Hears the group on that interface alone, and sends to it on that interface alone, never to itself."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    made.setsockopt(socket.SOL_SOCKET, SO_BINDTODEVICE, interface.encode() + b"\0")
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    made.bind((group, port))
    request = struct.pack("=4s4si", socket.inet_aton(group), b"\0\0\0\0", socket.if_nametoindex(interface))
    made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, request)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, request)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 0)
    return made


class Message:
    """What a datagram carries, as far as it matters here."""

    def __init__(self, packet):
        self.channel, self.kind, self.session, self.sequence, self.tick = "?", None, None, None, None
        if len(packet) < 9 or struct.unpack_from(">I", packet)[0] != LCM_SHORT:
            return
        end = packet.find(b"\0", 8)
        if end < 0:
            return
        self.channel = packet[8:end].decode(errors="replace")
        self.kind = event_log.kind_of(self.channel)
        type_ = event_log.TYPES.get(self.kind)
        if type_ and "sequence" in type_.tuple._fields:
            decoded = type_.decode(packet[end + 1:])
            self.session, self.sequence = decoded.session, decoded.sequence
            self.tick = getattr(decoded, "tick", None)


class Relay:
    def __init__(self, options):
        self.options = options
        self.random = random.Random(options.seed)
        self.sockets = [open_socket(name, options.group, options.port) for name in (options.a, options.b)]
        self.waiting = []  # heap of (when, number, way, packet, message)
        self.number = 0
        self.outage_until = None  # None: has not begun
        self.to_drop = collections.Counter()
        if options.drop_first:
            self.to_drop[options.drop_first[0]] = int(options.drop_first[1])
        self.counts = {way: collections.defaultdict(collections.Counter) for way in WAYS}
        self.missing = {way: [] for way in WAYS}
        self.newest = {}
        self.ended = False

    def fate(self, message, now):
        """What becomes of it: forwarded, lost, outage (lost while the network is out) or dropped (asked for)."""
        lost = self.random.random() < self.options.loss  # drawn for each, whatever else is decided
        if self.options.outage and self.outage_until is None and message.kind == "HYDRO_STATE" and \
                message.tick >= self.options.outage[0]:
            self.outage_until = now + self.options.outage[1]
        if self.outage_until is not None and now < self.outage_until:
            return "outage"
        if self.to_drop[message.channel] > 0:
            self.to_drop[message.channel] -= 1
            return "dropped"
        return "lost" if lost else "forwarded"

    def take(self, way, packet, now):
        message = Message(packet)
        fate = self.fate(message, now)
        counts = self.counts[WAYS[way]][message.channel]
        counts[fate] += 1
        if fate != "forwarded":
            if message.sequence is not None:
                self.missing[WAYS[way]].append((message.channel, message.session, message.sequence, fate))
            return
        delay = self.options.delay + self.random.uniform(-self.options.jitter, self.options.jitter)
        self.number += 1
        heapq.heappush(self.waiting, (now + max(0.0, delay) * 1e-3, self.number, way, packet, message))

    def send_due(self, now):
        while self.waiting and self.waiting[0][0] <= now:
            _, _, way, packet, message = heapq.heappop(self.waiting)
            self.sockets[1 - way].sendto(packet, (self.options.group, self.options.port))
            if message.sequence is not None:
                key = (way, message.channel, message.session)
                if message.sequence < self.newest.get(key, -1):
                    self.counts[WAYS[way]][message.channel]["overtaken"] += 1
                self.newest[key] = max(message.sequence, self.newest.get(key, -1))

    def run(self):
        while not self.ended:
            timeout = max(0.0, self.waiting[0][0] - time.monotonic()) if self.waiting else 0.2
            readable, _, _ = select.select(self.sockets, [], [], min(timeout, 0.2))
            for made in readable:
                for _ in range(64):  # then the others, and what is due
                    try:
                        packet = made.recv(65536)
                    except BlockingIOError:
                        break
                    self.take(self.sockets.index(made), packet, time.monotonic())
            self.send_due(time.monotonic())

    def record(self):
        return {"counts": self.counts, "missing": self.missing, "outage": self.outage_until is not None}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--a", required=True)
    parser.add_argument("--b", required=True)
    parser.add_argument("--group", required=True)
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--loss", type=float, default=0, help="share of the datagrams")
    parser.add_argument("--delay", type=float, default=0, help="ms")
    parser.add_argument("--jitter", type=float, default=0, help="ms, evenly about the delay: datagrams overtake each other")
    parser.add_argument("--outage", type=float, nargs=2, help="plant tick at which nothing passes any more; for how many s")
    parser.add_argument("--drop-first", nargs=2, help="CHANNEL N: the first N datagrams of it")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--record", required=True)
    options = parser.parse_args()
    relay = Relay(options)

    def end(*_):
        relay.ended = True
    signal.signal(signal.SIGTERM, end)
    print("relaying", flush=True)
    relay.run()
    with open(options.record, "w", encoding="utf-8") as file:
        json.dump(relay.record(), file)


if __name__ == "__main__":
    main()
