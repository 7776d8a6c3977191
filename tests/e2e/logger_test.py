"""The logger at 5 kHz for 20 s in real time: nothing that was sent is lost, and little when it is killed.

One run serves all: a first logger records all of it and is the measure; a second one begins a new file every few
megabytes and is ended by SIGTERM while the run goes on; a third one joins then and is killed.
"""

import glob
import os
import signal
import time

import event_log
import outcome
import stack

RATE = 5000
DURATION = 20
FLUSH = 0.05  # s, the promise: what is older has been written when the logger is killed
# s. Between the arrival of a packet and the clock to which the promise refers, two threads of the logger wake
# up, one that receives and one that writes. On this kind of machine each is late by up to 150 ms when the
# neighbours are busy.
WAKE_UPS = 0.3


def identity(event):
    """The part that is the same in every logger's log: all but the event's number and time of arrival."""
    return event.channel, event.data


class LoggerTest(stack.TestCase):
    def start_second(self, arguments, name, *more):
        log_file = self.path(name)
        logger = self.start("hydro-logger", *arguments, "-o", log_file, *more)
        return log_file, logger

    # Tests that nothing is lost at 5 kHz, and what remains after a kill and a rotation.
    def test_five_kilohertz(self):
        # The voltage does not move the motor. Otherwise, a loop of which a busy machine skips many ticks
        # would reach a limit and end the run.
        run = self.stack(stack.config("paper.toml"), "--time", "realtime", "--duration", DURATION, "--set",
                         'reference={ signal = "voltage", kind = "steps", steps = [[0.2, 0.1]] }')
        whole_file = self.path("whole.lcmlog")
        rotated_file, rotated = self.start_second(run.arguments, "rotated.lcmlog", "--rotate-mb", "2")
        stack.LiveLog(self, rotated_file).wait_for("HYDRO_PROCESS_STATUS", lambda s: s.pid == rotated.pid,
                                                   "a rotating logger that is ready")
        live = run.start_all(log=whole_file)
        live.wait_for_tick(8 * RATE)
        rotated.send(signal.SIGTERM)
        self.assertEqual(rotated.wait(), 0, rotated.report())
        killed_file, killed = self.start_second(run.arguments, "killed.lcmlog")
        live.wait_for_tick(14 * RATE)
        kill_time = time.time()
        killed.kill()
        killed.wait()
        for process in run.processes.values():
            self.assertEqual(process.wait(60), 0, process.report())

        whole = event_log.Log(whole_file)
        self.check_whole(whole)
        self.check_killed(whole, killed_file, kill_time)
        self.check_rotated(whole, rotated_file)
        self.check_verdicts(whole_file, killed_file)

    def check_whole(self, log):
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        # Nothing is missing at the end: the plant ran to its end, and each sender's last message is there.
        self.assertEqual(log.states[-1].tick, DURATION * RATE)
        self.assertEqual(log.motor_commands[-1].status, event_log.STOPPED)
        gone = {s.role for s in log.statuses if s.state == event_log.DONE}
        self.assertLessEqual({"plant", "pressure_ctrl", "position_ctrl"}, gone)
        self.assertEqual([(o.role, bool(o.accepted), o.voltage) for o in log.outputs_left], [("plant", True, 0)])
        # Where no state was sent, the plant says so. Where one was sent, the pressure loop answered it.
        expected = 0
        for state in log.states:
            self.assertEqual(state.tick, expected + state.skipped_ticks)
            expected = state.tick + 1
        answered = {c.tick for c in log.motor_commands}
        self.assertEqual([s.tick for s in log.states if s.tick not in answered], [])
        skipped = sum(s.skipped_ticks for s in log.states)
        print(f"{len(log.events)} events, {skipped} of {DURATION * RATE} ticks skipped by the plant")
        self.assertEqual([s for s in log.statistics if s.lost_messages], [])

    def check_killed(self, whole, killed_file, kill_time):
        # A kill may tear the last event.
        self.run_program("hydro-log", "repair", killed_file, "-o", self.path("repaired.lcmlog"))
        repaired = event_log.read_events(self.path("repaired.lcmlog"))
        torn = event_log.read_events(killed_file, torn_tail=True)
        self.assertEqual(len(repaired), len(torn))
        have = {identity(event) for event in repaired}
        # Each logger stamps what it receives itself, so the order of the two records means nothing around the
        # moment at which this one subscribed. The claim is about what comes after that.
        first = repaired[0].utime * 1e-6 + WAKE_UPS
        due = [e for e in whole.events if first < e.utime * 1e-6 < kill_time - FLUSH - WAKE_UPS]
        self.assertGreater(len(due), RATE)  # of a plant that may skip many ticks
        absent = [e for e in due if identity(e) not in have]
        self.assertEqual([(e.channel, kill_time - e.utime * 1e-6) for e in absent], [])
        late = [kill_time - e.utime * 1e-6 for e in whole.events
                if e.utime * 1e-6 < kill_time and e.utime * 1e-6 > first and identity(e) not in have]
        print(f"killed logger: lacks the last {1e3 * max(late, default=0):.1f} ms, {len(late)} events")

    def check_verdicts(self, whole_file, killed_file):
        """Each log says what it is: by our own reader, and the whole one by this folder's."""
        self.assertIn("\nlog: complete\n", self.run_program("hydro-log", "info", whole_file).stdout)
        event_log.verify(whole_file)
        self.assertIn("\nlog: incomplete: ", self.run_program("hydro-log", "info", killed_file).stdout)

    def check_rotated(self, whole, first_file):
        pieces = sorted(glob.glob(first_file.replace(".lcmlog", "*.lcmlog")),
                        key=lambda path: (len(path), path))
        self.assertEqual(pieces[0], first_file)
        self.assertGreater(len(pieces), 2)
        events, before = [], 0
        for number, piece in enumerate(pieces):
            part = event_log.read_events(piece)
            if number > 0:
                self.assertEqual(part[0].channel, "HYDRO_RUN", piece)
                part = part[1:]  # a copy of what the piece before it holds
            events += part
            end = event_log.verify(piece, before)[-1]
            before = end.checksum
            self.assertEqual(end.text, "" if piece == pieces[-1] else "goes on in " + os.path.basename(pieces[number + 1]))
            info = self.run_program("hydro-log", "info", piece)
            self.assertIn("hydro-plant", info.stdout)  # it describes itself
        # Together the parts hold, in order, everything that was sent between the rotating logger's start and
        # its end.
        joined = [identity(e) for e in events]
        numbered = [item for item in joined if item[0] in event_log.NUMBERED]
        reference = [identity(e) for e in whole.events if e.channel in event_log.NUMBERED]
        self.assertGreater(len(numbered), RATE)
        self.assertEqual(len(set(numbered)), len(numbered))
        for channel in event_log.NUMBERED:
            mine = [item for item in numbered if item[0] == channel]
            all_ = [item for item in reference if item[0] == channel]
            begin = all_.index(mine[0])
            self.assertEqual(mine, all_[begin:begin + len(mine)], channel)


class DeletedLogTest(stack.TestCase):
    # Tests that a log that is deleted, or whose folder is moved, is named, that the logger continues, and
    # that it ends with 1.
    def test_deleted_or_moved(self):
        for gone in ("deleted", "moved"):
            with self.subTest(gone):
                folder = self.path(gone)
                os.mkdir(folder)
                log_file = os.path.join(folder, "run.lcmlog")
                logger = self.start("hydro-logger", stack.config("demo.toml"), "--set", f"bus.url={self.new_url()}", "-o", log_file)
                self.wait_until(lambda path=log_file: os.path.exists(path) and os.path.getsize(path) > 0, "a log")
                if gone == "deleted":
                    os.remove(log_file)
                else:
                    os.rename(folder, folder + "_away")
                self.wait_until(lambda p=logger: "renamed or deleted" in p.stderr, "a word on it")
                self.assertIn(log_file, logger.stderr)
                self.assertTrue(logger.running)
                logger.send(signal.SIGTERM)
                self.assertEqual(logger.wait(), 1, logger.report())


    # Tests the same for --log of a program that is not a logger.
    def test_deleted_log_of_a_loop(self):
        log_file = self.path("run.lcmlog")
        loop = self.start("hydro-pressure-ctrl", stack.config("demo.toml"), "--set", f"bus.url={self.new_url()}", "--log", log_file)
        self.wait_until(lambda: os.path.exists(log_file) and os.path.getsize(log_file) > 0, "a log")
        os.remove(log_file)
        self.wait_until(lambda: "renamed or deleted" in loop.stderr, "a word on it")
        self.assertTrue(loop.running)
        loop.send(signal.SIGTERM)
        self.assertEqual(loop.wait(), 1, loop.report())


class TornLogTest(stack.TestCase):
    # Tests that a log cut off within its last message is read up to there, with a warning, and that a repair
    # loses only that message.
    def test_torn_tail(self):
        log_file = self.path("run.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.2", "-o", log_file)
        before = event_log.read_events(log_file)
        with open(log_file, "rb") as file:
            data = file.read()
        last = [at for at, event in event_log.read_all_events(log_file) if event.channel != event_log.CHECK_CHANNEL][-1]
        with open(log_file, "wb") as file:
            file.write(data[:last + 40])
        compare = self.run_program("hydro-log", "compare", log_file, log_file)
        self.assertEqual(compare.stdout, "identical in what is there (the logs are not whole)\n")
        self.assertIn(f"{log_file}: incomplete: ", compare.stderr)
        self.run_program("hydro-log", "repair", log_file)
        self.assertEqual(event_log.read_events(log_file), before[:-1])


if __name__ == "__main__":
    outcome.main()
