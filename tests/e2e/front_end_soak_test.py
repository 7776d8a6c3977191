"""A soak of front ends, minutes long, and so not in ./check: both modes, over a pseudo terminal and UDP, on a wire with bit errors, lost, doubled
and late frames, cables that are pulled and plugged in again, and devices that reset themselves.

scripts/soak-front-end MINUTES runs it: a quarter of that for each mode and link, a cycle of all that can happen at the least."""

import itertools
import os
import re
import signal
import struct
import time

import damaged_wire
import front_end
import front_end_test
import front_end_wire as wire
import outcome
import stack

MINUTES = float(os.environ.get("HYDRO_SOAK_MINUTES", "0"))
STAGE_S = 4
FRAMES = [{kind: rate for kind in ("lost", "doubled", "late")} for rate in (1e-5, 1e-4, 1e-3, 1e-2)]
BITS = [{"bit": rate} for rate in (1e-5, 1e-4, 1e-3)]
NO_FRAME_IS_WHOLE = {"bit": 1e-2}  # 1 sample in 5000, 1 command in 60
# Where more than half of the samples are lost, a loop is some ticks later than the delay for which it was
# designed, and this machine has no end stops.
GENTLE = ('reference={ signal = "arm_angle", kind = "sine", amplitude = 0.1, frequency_hz = 0.5 }', "driver.voltage.limit_V=3",
          "pressure.natural_frequency_rad_s=20", "pressure.damping_ratio=1", "position.c1=600", "position.c2=300")
STILL_S = 0.12  # a machine that stood still for so long may have tripped a device, whose watchdog bears 0.2 s


def f32(number):
    return struct.unpack("<f", struct.pack("<f", number))[0]


class Witness:
    """What each side sent, before any damage: whether the device did what it was told, and when it tripped."""

    def __init__(self):
        self.commands = {}
        self.samples, self.obeyed, self.wrong, self.oldest_at_zero = 0, 0, [], 0
        self.trips, self.boots = [], 0  # (when, faults, whether the output was at zero)
        self.newest = None
        self.frames_bad = self.frames_refused = 0

    def commanded(self, kind, sequence, fields):
        if kind in (wire.VOLTAGE, wire.PRESSURE):
            self.commands[sequence] = (kind, fields)
            self.commands.pop(sequence - 5000, None)

    def sampled(self, sample):
        before, self.newest = self.newest, sample
        self.samples += 1
        self.judge(sample)
        if before is None or sample["tick"] < before["tick"]:
            self.boots += 1
            before = {"trips": 0, "frames_bad": 0, "frames_refused": 0, "state": wire.READY, "command_age": 0, "tick": 0}
        self.frames_bad += (sample["frames_bad"] - before["frames_bad"]) % 2**16
        self.frames_refused += (sample["frames_refused"] - before["frames_refused"]) % 2**16
        if sample["trips"] != before["trips"] and sample["state"] == wire.TRIPPED:
            self.trips.append((time.monotonic(), sample["faults_latched"], sample["voltage"] == 0))
            if before["state"] == wire.ARMED and before["command_sequence"]:
                self.oldest_at_zero = max(self.oldest_at_zero, before["command_age"])

    def judge(self, sample):
        """Zero, or what the command that it names says and no other."""
        kind, command = self.commands.get(sample["command_sequence"], (None, None))
        right = sample["voltage"] == 0
        if sample["state"] == wire.ARMED and kind is not None and sample["source"] != 0:
            self.obeyed += 1
            right = sample["host_tick"] == command["host_tick"]
            if sample["source"] == 1:
                right = right and kind == wire.VOLTAGE and sample["voltage"] == f32(command["voltage"])
            else:
                right = right and kind == wire.PRESSURE and sample["pressure_ref"] == command["pressure_ref"] and abs(sample["voltage"]) <= 3
        if not right:
            self.wrong.append((sample, kind, command))

    def armed(self):
        return self.newest is not None and self.newest["state"] == wire.ARMED and self.newest["source"] != 0


class SoakTest(front_end_test.FrontEndCase):
    def soak(self, link, mode):
        settings = front_end_test.LOOP if mode == "loop on the device" else front_end_test.REMOTE
        self.front = front_end.FrontEnd(self, link)
        ends = (damaged_wire.TerminalEnds if link == "pty" else damaged_wire.UdpEnds)(self, self.front)
        self.witness = Witness()
        self.wire = damaged_wire.DamagedWire(self, ends, 36, self.witness.commanded, self.witness.sampled)
        log = ["--log", self.path("run.lcmlog")] if mode == "loop on the device" else []
        self.launched = self.launch(stack.config(self.config), "--duration", "0", *self.options(ends.url, *GENTLE, *settings), *log)
        self.until(self.witness.armed, "an armed device")
        self.cut_trips, self.resets, self.noise, self.slowest = 0, 0, [], 0
        end = time.monotonic() + MINUTES * 60 / 4
        for cycle in itertools.count():
            for stage in ({}, *FRAMES, *BITS):
                self.damaged(stage)
            self.damaged({})
            self.silence()
            self.damaged({})
            self.unplugged()
            self.reset()
            if time.monotonic() > end:
                break
        self.wire.set()
        self.until(self.witness.armed, "an armed device")
        self.ticks(1)
        self.launched.send(signal.SIGINT)
        self.assertEqual(self.launched.wait(), 0, self.launched.report())
        self.judge(link, mode, cycle + 1)
        if log:
            replay = self.run_program("hydro-log", "replay", log[1], timeout=600)
            print(re.search(r"pressure: equal in single precision, .*", replay.stdout)[0], flush=True)

    def until(self, condition, what):
        """Waits for it and for no less; where the wire has broken, says so."""
        begin = time.monotonic()
        self.wait_until(lambda: self.wire.error or condition(), what)
        self.assertIsNone(self.wire.error)
        return time.monotonic() - begin

    def ticks(self, seconds):
        """So many seconds of the device's clock."""
        samples = self.witness.samples
        self.until(lambda: self.witness.samples > samples + seconds * self.front.rate, f"{seconds} s of samples")

    def damaged(self, damage):
        """Changes nothing but counts."""
        self.wire.set(**damage)
        self.ticks(STAGE_S)
        self.wire.set()

    def expected(self, begin):
        """What happens meanwhile is meant to trip the device."""
        self.noise.append((begin, time.monotonic() + 1))

    def silence(self):
        """A wire on which no frame is whole: the device goes to zero volts by itself, and comes back."""
        begin = time.monotonic()
        self.wire.set(**NO_FRAME_IS_WHOLE)
        self.until(lambda: not self.witness.armed(), "zero volts where nothing arrives whole")
        self.ticks(1)
        self.wire.set()
        self.slowest = max(self.slowest, self.until(self.witness.armed, "an armed device"))
        self.expected(begin)

    def unplugged(self):
        begin = time.monotonic()
        self.wire.unplug()
        self.until(lambda: self.witness.newest["state"] == wire.TRIPPED, "the trip of a device that hears nothing")
        self.assertEqual(self.witness.newest["faults_latched"], wire.WATCHDOG)
        self.ticks(1)
        self.assertEqual(self.witness.newest["state"], wire.TRIPPED)
        self.wire.plug()
        self.slowest = max(self.slowest, self.until(self.witness.armed, "an armed device"))
        self.expected(begin)
        self.cut_trips += 1

    def reset(self):
        begin, boots = time.monotonic(), self.witness.boots
        self.front.board.send(signal.SIGUSR1)
        self.until(lambda: self.witness.boots > boots, "samples after a reset")
        self.slowest = max(self.slowest, self.until(self.witness.armed, "an armed device"))
        self.expected(begin)
        self.resets += 1

    def judge(self, link, mode, cycles):
        said = self.launched.wait_for(r"(\d+) samples; of its frames (\d+) were lost, (\d+) damaged, (\d+) repeated or late; of ours it found "
                                           r"(\d+) damaged and refused (\d+), and (\d+) were left out")
        samples, lost, damaged, repeated, device_damaged, device_refused, left_out = map(int, said.groups())
        there, back, w = self.wire.towards_device.count, self.wire.towards_driver.count, self.witness
        stood_still = [when for when, late in self.wire.stalls if late > STILL_S]
        explained = lambda when: any(a <= when <= b for a, b in self.noise) or any(abs(when - s) < 1.5 for s in stood_still)
        unexplained = [trip for trip in w.trips if not explained(trip[0])]
        print(f"\n{mode}, {link}: {cycles} cycles, {w.samples} samples, {there['frames']} frames to the device; {w.obeyed} samples obey a command\n"
              f"  to the device: {there}; it found {w.frames_bad} damaged, refused {w.frames_refused}\n"
              f"  to the driver: {back}; it took {samples} samples, counted {lost} lost, {damaged} damaged, {repeated} repeated or late, {left_out} left out\n"
              f"  {self.cut_trips} cables pulled, {self.resets} resets, {len(w.trips)} trips, {len(unexplained)} of them unexplained; the machine stood still "
              f"{len(stood_still)} times; oldest command at a trip {w.oldest_at_zero} ticks; armed again after {self.slowest:.2f} s at most", flush=True)
        self.assertEqual(w.wrong[:3], [], "samples that obey no command")
        self.assertEqual([trip for trip in w.trips if not trip[2]], [], "a device that tripped and was not at zero")
        self.assertEqual(unexplained, [])
        self.assertGreaterEqual(len(w.trips), self.cut_trips)
        self.assertGreater(w.obeyed, 0.5 * w.samples)
        # Each side counts what arrived at it and nothing else. What was under way when a cable was pulled, a
        # device reset itself or the run ended did not arrive at all.
        most = 10 + 10 * (self.cut_trips + self.resets)
        order = self.wire.order
        for name, found, expected in (("damaged at the driver", damaged, back["damaged"]), ("lost", lost, order.lost),
                                      ("repeated or late", repeated, order.refused), ("damaged at the device", w.frames_bad, there["damaged"])):
            self.assertLessEqual(abs(found - expected), most, (name, found, expected))
        self.assertGreaterEqual(w.frames_refused, self.wire.device_order.refused - most)
        for name in ("lost", "doubled", "late", "flipped bits"):
            self.assertGreater(there[name], 0)
            self.assertGreater(back[name], 0)
        self.assertLessEqual(w.oldest_at_zero, round(front_end_test.WATCHDOG * self.front.rate))

    def test_remote_io_over_a_terminal(self):
        self.soak("pty", "remote I/O")

    def test_remote_io_over_udp(self):
        self.soak("udp", "remote I/O")

    def test_loop_on_the_device_over_a_terminal(self):
        self.soak("pty", "loop on the device")

    def test_loop_on_the_device_over_udp(self):
        self.soak("udp", "loop on the device")


if __name__ == "__main__":
    outcome.main()
