"""A link of a host to the switch (process_network.py) that for a while loses or delays what the host sends. In order: what is sent
later never arrives earlier, as in sim/torture/machines/network.cc. The kernel that the tests run on has no netem, which would do the same."""

import collections
import select
import socket
import threading
import time

OUTGOING = 4  # PACKET_OUTGOING: seen on its way out, not received
ALL_PROTOCOLS = 3  # ETH_P_ALL


def frames_of(port):
    made = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ALL_PROTOCOLS))
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
    made.bind((port, ALL_PROTOCOLS))
    return made


def without_checksum(frame):
    """What leaves a host through such an interface may have its UDP checksum still to be computed; 0 means none."""
    first_of_udp = frame[12:14] == b"\x08\x00" and frame[23] == socket.IPPROTO_UDP and not (frame[20] & 0x1F or frame[21])
    return frame[:40] + b"\0\0" + frame[42:] if first_of_udp else frame


class BadLink:
    """Forwards between the port of a host, which the switch does not serve meanwhile, and the switch."""

    def __init__(self, port, switch, delay=None):
        """`delay` in s; None: what the host sends is lost."""
        self.delay = delay
        self.late = collections.deque()  # (when, frame)
        self.ending = False
        self.port, self.switch = frames_of(port), frames_of(switch)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def end_fault(self):
        """From now on nothing is lost, and nothing is later than the order wants. Then the link ends."""
        self.delay = 0
        self.ending = True

    @property
    def ended(self):
        return not self.thread.is_alive()

    def _run(self):
        with self.port, self.switch:
            while self.late or not self.ending:
                timeout = min(max(0.0, self.late[0][0] - time.monotonic()), 0.02) if self.late else 0.02
                for source in select.select([self.port, self.switch], [], [], timeout)[0]:
                    self._take(source)
                while self.late and self.late[0][0] <= time.monotonic():
                    self.switch.send(self.late.popleft()[1])

    def _take(self, source):
        frame, address = source.recvfrom(65536)
        if address[2] == OUTGOING:
            return
        if source is self.switch:
            self.port.send(without_checksum(frame))
        elif self.delay is not None:
            before = self.late[-1][0] if self.late else 0.0
            self.late.append((max(before, time.monotonic() + self.delay), without_checksum(frame)))
