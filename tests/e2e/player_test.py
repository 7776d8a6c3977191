"""A recorded run through the controllers again: by lcm-logplayer over the network, and by hydro-log replay."""

import shutil
import signal
import unittest

import event_log
import lcm_peer
import outcome
import stack

PLAYER = shutil.which("lcm-logplayer")


class PlayerTest(stack.TestCase):
    def record(self, *options, time="lockstep"):
        log_file = self.path("recorded.lcmlog")
        launch = self.launch(stack.config("demo.toml"), "--time", time, "--log", log_file, *options)
        self.assertEqual(launch.wait(), 0, launch.report())
        return log_file

    def play(self, time):
        recorded = self.record("--duration", "1.5")
        again = self.path("again.lcmlog")
        url = self.new_url()
        run = self.stack(stack.config("demo.toml"), "--time", time, url=url)
        run.start("logger", "-o", again)
        run.start("pressure_ctrl")
        live = stack.LiveLog(self, again)
        live.wait_for("HYDRO_PROCESS_STATUS", lambda s: s.role == "pressure_ctrl" and s.state == event_log.READY,
                      "a pressure loop that is ready")
        # The messages of the recorded pressure loop are left out, because the new loop must send them.
        player = self.start(PLAYER, "-l", url, "-e", "HYDRO_(STATE|PRESSURE_COMMAND)$", recorded)
        self.assertEqual(player.wait(60), 0, player.report())
        before = event_log.Log(recorded)
        last = before.states[-1].tick
        live.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.tick == last, "the answer to the last state")
        for role in ("pressure_ctrl", "logger"):
            run[role].send(signal.SIGTERM)
            self.assertEqual(run[role].wait(), 0, run[role].report())

        after = event_log.Log(again)
        self.assertEqual([s[1:] for s in after.states], [s[1:] for s in before.states])
        old, new = self.answers(before), self.answers(after)
        self.assertEqual(set(old), set(range(last + 1)))
        self.assertEqual(old, new)

    def answers(self, log):
        """What each tick was answered with: the fields that a run decides, not those of the process or of its clock.
        Where the player was late for longer than limits.stale_input_s the pressure loop has said zero volts in
        between, on its own; that is no answer."""
        found = {}
        for c in log.motor_commands:
            if c.status in (event_log.LAW, event_log.OPEN_LOOP):
                self.assertNotIn(c.tick, found)
                found[c.tick] = c._replace(utime=0, session=0, sequence=0)
        return found

    # Tests that a pressure loop in lockstep answers a played log as the recorded one did, bit by bit.
    @unittest.skipUnless(PLAYER, "lcm-logplayer is not installed")
    def test_played_to_lockstep(self):
        self.play("lockstep")

    # Tests the same for a pressure loop in real time: its answers depend on ticks, not on arrival times.
    @unittest.skipUnless(PLAYER, "lcm-logplayer is not installed")
    def test_played_to_realtime(self):
        self.play("realtime")

    # Tests that the check events of a log stay in it: lcm-logplayer skips them without a message, and a peer
    # of the network receives exactly the messages.
    @unittest.skipUnless(PLAYER, "lcm-logplayer is not installed")
    def test_check_events_are_not_played(self):
        log_file = self.path("sim.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.5", "-o", log_file)
        self.assertGreater(len(event_log.verify(log_file)), 5)
        url = self.new_url()
        peer = lcm_peer.Peer(url, {})
        self.addCleanup(peer.close)
        player = self.start(PLAYER, "-l", url, "-s", "0.5", log_file)
        expected = [(e.channel, e.data) for e in event_log.read_events(log_file)]
        # LCM's own test of multicast first sends itself a message.
        received = []
        while len(received) < len(expected) and (more := peer.receive(5)):
            received += [m for m in more if m[0].startswith("HYDRO_") or event_log.CHECK_CHANNEL in m[0]]
        self.assertEqual(player.wait(60), 0, player.report())
        self.assertEqual(received, expected)
        self.assertEqual(peer.receive(0.2), [])
        self.assertEqual(player.stderr, "")

    def assert_replays(self, log_file):
        replay = self.run_program("hydro-log", "replay", log_file)
        self.assertRegex(replay.stdout, r"(?m)^pressure: identical, [1-9]\d* motor commands from [1-9]\d* states$")
        self.assertRegex(replay.stdout, r"(?m)^position: identical, [1-9]\d* pressure commands from [1-9]\d* states$")

    # Tests that hydro-log replay reproduces both controllers of a run in real time, whatever arrived late there.
    def test_replay_realtime(self):
        self.assert_replays(self.record("--duration", "2", time="realtime"))

    # Tests that it reproduces the controllers of a run in real time without a command delay, where the
    # command in force at a tick depends on what had arrived.
    def test_replay_realtime_without_delay(self):
        self.assert_replays(self.record("--duration", "2", "--set", "plant.command_delay_ticks=0", time="realtime"))

    # Tests that replay notices differences, with a log whose commands came from other gains than it states.
    def test_replay_finds_a_difference(self):
        log_file = self.record("--duration", "0.5")
        events = event_log.read_events(log_file)
        changed = [e._replace(data=e.data.replace(b"c1 = 6000", b"c1 = 6001")) for e in events]
        self.assertNotEqual(changed, events, "the description holds the gain")
        event_log.write_plain(log_file, changed)
        replay = self.run_program("hydro-log", "replay", log_file, expect=1)
        self.assertRegex(replay.stdout, "(?m)^pressure: identical")
        self.assertRegex(replay.stdout, r"(?m)^position: .*tick \d+")


if __name__ == "__main__":
    outcome.main()
