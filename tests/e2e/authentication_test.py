"""A stack with a key (bus.key_file): it works as it does without, and nobody without the key can influence it."""

import collections
import csv
import os
import re
import shutil
import socket
import struct
import time

import event_log
import outcome
import stack

CODE = "unauthenticated_command"
# Far longer than wake-ups are late here, so that no stale input is blamed on an intruder.
PATIENT = ("--set", "limits.stale_input_s=2")


def encoded(kind, template, **changes):
    """The bytes of a message of the same type as `template`, the encoded form of one."""
    values = dict(event_log.TYPES[kind].decode(template)._asdict(), **changes)
    data = template[:8]  # the type's hash
    for name, code in event_log.FIELDS[kind]:
        if code == "s":
            text = values[name].encode() + b"\0"
            data += struct.pack(">i", len(text)) + text
        else:
            data += struct.pack(">" + code, values[name])
    return data


class Sender:
    """Sends LCM messages, as anybody on the network can; written from LCM's description alone."""

    def __init__(self, url):
        group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
        self.address = (group, int(port))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.sequence = 0

    def send(self, channel, data):
        self.sequence += 1
        packet = struct.pack(">II", 0x4C433032, self.sequence) + channel.encode() + b"\0" + data
        self.socket.sendto(packet, self.address)

    def close(self):
        self.socket.close()


class AuthenticationTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        self.key = self.make_key("key")
        self.keyed = ("--set", f"bus.key_file={self.key}")

    def make_key(self, name):
        path = self.path(name)
        self.run_program("hydro-launch", stack.config("demo.toml"), "--set", f"bus.key_file={path}", "--make-key")
        return path

    def sender(self):
        sender = Sender(self.url)
        self.addCleanup(sender.close)
        return sender

    def recorder(self, name):
        """LCM's own logger, which records what is on the wire, seals and all, and says nothing."""
        recorder = self.start(shutil.which("lcm-logger"), "--lcm-url=" + self.url, "--flush-interval=20", self.path(name))
        return recorder, event_log.Follower(self.path(name))

    def assert_voltages_are_the_loops_own(self, log):
        """Each voltage that acted was commanded by the one pressure loop that the log knows."""
        self.assertEqual(len({c.session for c in log.motor_commands}), 1)
        commanded = {c.tick: c.voltage for c in log.motor_commands}
        acted = [s for s in log.states if s.command_tick >= 0]
        self.assertGreater(len(acted), 20)
        for state in acted:
            self.assertEqual(state.voltage, commanded[state.command_tick], state)

    # Tests that a key changes nothing in a run: the log is that of hydro-sim, bit by bit, and holds plain
    # messages.
    def test_lockstep_is_identical(self):
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "1", "-o", self.path("sim.lcmlog"))
        launch = self.launch(stack.config("demo.toml"), "--time", "lockstep", "--duration", "1", *self.keyed, "--log",
                             self.path("stack.lcmlog"))
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assert_identical(self.path("sim.lcmlog"), self.path("stack.lcmlog"))
        self.assertEqual({f.code for f in event_log.Log(self.path("stack.lcmlog")).faults}, set())

    # Tests that the commands, states, stops, failures and faults of an intruder without the key are refused,
    # counted and named, while the run continues as if they had not been sent: to the last bit, in lockstep.
    def test_intruder(self):
        options = ("--duration", "5", *self.keyed)  # in lockstep some 1.5 s, which the intruder has
        self.run_program("hydro-sim", stack.config("demo.toml"), *options, "-o", self.path("sim.lcmlog"))
        templates = {event.channel: event.data for event in event_log.read_events(self.path("sim.lcmlog"))}
        attacks = [
            ("HYDRO_MOTOR_COMMAND", dict(session=666, voltage=10.0, status=event_log.OPEN_LOOP)),
            ("HYDRO_MOTOR_COMMAND", dict(voltage=float("nan"))),
            ("HYDRO_PRESSURE_COMMAND", dict(session=666, voltage=10.0, open_loop=1)),
            ("HYDRO_STATE", dict(session=666, p1=1e9)),
            ("HYDRO_PROCESS_STATUS", dict(state=event_log.FAILED, role="pressure_ctrl")),
            ("HYDRO_STOP", dict(reason="an intruder's")),
        ]
        rubbish = [("HYDRO_MOTOR_COMMAND", b""), ("HYDRO_MOTOR_COMMAND", b"\xff" * 100),
                   ("HYDRO_INTRODUCTION", b"hydroMAC" + bytes(32))]

        launch = self.launch(stack.config("demo.toml"), "--time", "lockstep", *options, "--log", self.path("run.lcmlog"))
        log = event_log.Follower(self.path("run.lcmlog"))
        intruder = self.sender()
        seen = collections.Counter()

        def look():
            seen.update(event.channel for event in log.new_events())
            return seen

        self.wait_until(lambda: look()["HYDRO_STATE"] > 10, "the run has begun")
        sent = collections.Counter()
        for number in range(500):
            for kind, data in [(kind, encoded(kind, templates[kind], **changes, **(
                    dict(tick=seen["HYDRO_STATE"], sequence=10**6 + number) if "COMMAND" in kind or "STATE" in kind else {})))
                               for kind, changes in attacks] + rubbish:
                intruder.send(kind, data)
                sent["REFUSED_" + kind] += 1
            time.sleep(0.004)  # never more in flight than the receivers can hold
            look()
            if not launch.running:
                break
        self.assertEqual(launch.wait(120), 0, launch.report())
        look()
        self.assertGreater(sum(sent.values()), 100)
        for channel in sent:
            self.assertGreater(seen[channel], 0, channel)
            self.assertLessEqual(seen[channel], sent[channel])

        sim, run = event_log.Log(self.path("sim.lcmlog")), event_log.Log(self.path("run.lcmlog"))
        for kind in event_log.NUMBERED:
            # A repetition that was requested does not count as a difference.
            def essence(messages):
                return {m.sequence: m._replace(utime=0, session=0) for m in messages}
            self.assertEqual(essence(run.of(kind)), essence(sim.of(kind)), kind)
        self.assertEqual({f.code for f in run.faults}, {CODE}, run.faults)
        for role in ("plant", "pressure_ctrl"):
            begins = [f for f in run.faults if f.source == role and f.active]
            self.assertTrue(begins, role)
            self.assertRegex(begins[0].text, r"refused \d+ messages? not of this stack \(.*without a seal")
            self.assertFalse(begins[0].latched)
            self.assertGreater(begins[0].value, 0)
        info = self.run_program("hydro-log", "info", self.path("run.lcmlog"))
        self.assertIn("REFUSED_HYDRO_MOTOR_COMMAND", info.stdout)

    # Tests that a part of a stack that was started with another key than the plant's ends by itself, and says
    # why.
    def test_part_with_another_key(self):
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read().split("[[process]]")[0]
        models = os.path.join(os.path.dirname(stack.config("demo.toml")), "models")
        text = text.replace("models/table1.toml", os.path.join(models, "table1.toml"))
        hosts = {"hydro-plant": "rig", "hydro-pressure-ctrl": "rig", "hydro-position-ctrl": "desk"}
        for name, host in hosts.items():
            text += f'\n[[process]]\nprogram = "{name}"\nhost = "{host}"\n'
        with open(self.path("spread.toml"), "w", encoding="utf-8") as file:
            file.write(text)
        limits = ("--set", "time.start_timeout_s=4")  # enough for the parts with the right key on a busy machine
        rig = self.launch(self.path("spread.toml"), "--host", "rig", *self.keyed, *limits)
        desk = self.launch(self.path("spread.toml"), "--host", "desk", "--set", f"bus.key_file={self.make_key('other')}", *limits)
        self.assertEqual(rig.wait(), 1, rig.report())
        self.assertRegex(rig.stderr, "not ready after 4 s .time.start_timeout_s.: position_ctrl")
        self.assertEqual(desk.wait(), 1, desk.report())
        self.assertRegex(desk.stderr, "no plant or driver is heard .*messages were refused: is bus.key_file the same")

    # Tests that a process with another key, or without one, never gets control: the plant does not even count
    # it as ready.
    def test_another_key(self):
        other = self.make_key("other")
        for options, reason in (("--set", f"bus.key_file={other}"), "another key"), ((), "without a seal"):
            run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "1", "--set",
                             "time.start_timeout_s=4")
            plant = run.start("plant", *self.keyed)
            run.start("position_ctrl", *self.keyed)
            run.start("pressure_ctrl", *options)
            self.assertEqual(plant.wait(), 1, plant.report())
            self.assertRegex(plant.stderr, r"not ready after .*: pressure_ctrl\n")
            self.assertRegex(plant.stderr, rf"fault {CODE}: refused .*{reason}")
            for role in ("position_ctrl", "pressure_ctrl"):
                run[role].end()

    # Tests that a recording is refused, in a later run and in the same run, with the seals or without.
    def test_recording(self):
        recorder, wire = self.recorder("wire.lcmlog")
        # It opens its file before it listens.
        probe = self.sender()
        self.wait_until(lambda: probe.send("PROBE", b"") or (os.path.exists(self.path("wire.lcmlog")) and wire.new_events()),
                        "the recorder is on the network")
        launch = self.launch(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", *self.keyed, *PATIENT,
                             "--log", self.path("plain.lcmlog"))
        # By messages, not by time: on a machine with other work, LCM's logger loses most of what is sent.
        states = []
        self.wait_until(lambda: states.extend(e for e in wire.new_events()
                                              if e.channel == "HYDRO_STATE" and e.data[-40:-32] == b"hydroMAC") or len(states) > 750,
                        "sealed states")
        launch.send(2)
        self.assertEqual(launch.wait(), 0, launch.report())
        recorder.send(2)
        recorder.wait()
        # Both logs read the same without the key, except for what LCM's logger lost.
        rows = {}
        for name in ("wire.lcmlog", "plain.lcmlog"):
            self.run_program("hydro-log", "export", self.path(name), "-o", self.path(name + ".csv"))
            with open(self.path(name + ".csv"), encoding="utf-8") as file:
                rows[name] = {row["tick"]: (row["p1_psi"], row["p2_psi"], row["arm_angle_rad"])
                              for row in csv.DictReader(file)}
        both = rows["wire.lcmlog"].keys() & rows["plain.lcmlog"].keys()
        self.assertGreater(len(both), 750)
        self.assertGreater(len(both), 0.5 * len(rows["wire.lcmlog"]))
        for tick in both:
            self.assertEqual(rows["wire.lcmlog"][tick], rows["plain.lcmlog"][tick])

        launch = self.launch(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", *self.keyed, *PATIENT,
                             "--log", self.path("live.lcmlog"))
        log = stack.LiveLog(self, self.path("live.lcmlog"))
        log.wait_for_tick(100)
        for name in ("wire.lcmlog", "plain.lcmlog"):
            player = self.start(shutil.which("lcm-logplayer"), "--lcm-url=" + self.url, self.path(name))
            self.assertEqual(player.wait(), 0, player.report())
        # Also a recording of what this very run is sending.
        recorder, wire = self.recorder("here.lcmlog")
        events = []
        self.wait_until(lambda: events.extend(wire.new_events()) or len(events) > 200, "a recording")
        again = self.sender()
        for event in events[:200]:
            again.send(event.channel, event.data)
        fault = log.wait_for("HYDRO_FAULT", lambda f: f.source == "plant" and not f.active and "played again" in f.text,
                             "the fault's end")
        log.wait_for_tick(fault.tick + 100)
        launch.send(2)
        self.assertEqual(launch.wait(), 0, launch.report())
        run = event_log.Log(self.path("live.lcmlog"))
        self.assertEqual({f.code for f in run.faults}, {CODE}, run.faults)
        ends = " ".join(f.text for f in run.faults if not f.active and f.source == "plant")
        for reason in ("recorded in another run", "without a seal", "played again"):
            self.assertIn(reason, ends)
        self.assert_voltages_are_the_loops_own(run)
        self.assertEqual(len({s.session for s in run.states}), 1)

    # Tests that a pressure loop that was killed and restarted takes over, and that a recording of the first
    # does not.
    def test_restart(self):
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", *self.keyed, *PATIENT)
        log = run.start_all(self.path("run.lcmlog"))
        log.wait_for_tick(100)
        first = {c.session for c in log.messages["HYDRO_MOTOR_COMMAND"]}
        run["pressure_ctrl"].kill()
        run["pressure_ctrl"].wait()
        log.wait_for("HYDRO_FAULT", lambda f: f.code == "stale_motor_command" and f.active, "zero volts")
        run.start("pressure_ctrl", label="pressure_ctrl again")
        command = log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.session not in first and c.status == event_log.LAW,
                               "a command of the new one")
        log.wait_for("HYDRO_STATE", lambda s: s.command_tick >= command.tick and s.voltage != 0, "which acts")
        run["plant"].send(15)
        self.assertEqual(run["plant"].wait(), 0, run["plant"].report())

    # Tests that a key file that is missing, readable by others or not a key stops a program at once, naming
    # the file.
    def test_bad_key_files(self):
        def check(name, found):
            for program in ("hydro-plant", "hydro-pressure-ctrl", "hydro-launch"):
                process = self.run_program(program, stack.config("demo.toml"), "--set", f"bus.url={self.url}", "--set",
                                           f"bus.key_file={self.path(name)}", expect=2)
                self.assertEqual(process.stderr.count("\n"), 1, process.report())
                self.assertIn(self.path(name), process.stderr)
                self.assertRegex(process.stderr, found)

        check("missing", "No such file")
        os.chmod(self.make_key("wide"), 0o644)
        check("wide", "0644.*chmod 600")
        with open(os.open(self.path("short"), os.O_CREAT | os.O_WRONLY, 0o600), "w", encoding="utf-8") as file:
            file.write("0123")
        check("short", "64 hexadecimal digits")
        again = self.run_program("hydro-launch", stack.config("demo.toml"), *self.keyed, "--make-key", expect=2)
        self.assertIn("remove it first", again.stderr)
        none = self.run_program("hydro-launch", stack.config("demo.toml"), "--make-key", expect=2)
        self.assertIn("bus.key_file", none.stderr)

    # Tests that a plant on a network that others can reach says that it has no key, and that no other program
    # says so. It runs in a network of its own, so that nothing leaves this machine.
    def test_warns_of_open_network(self):
        unshare = shutil.which("unshare")
        if unshare is None or os.system(f"{unshare} -n true 2>/dev/null") != 0:
            self.skipTest("network namespaces cannot be made here")

        def first_words(program, *options):
            script = "ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec \"$@\""
            process = self.start(unshare, "-n", "sh", "-c", script, "sh", stack.program(program),
                                 stack.config("demo.toml"), "--set", "time.start_timeout_s=0.2", *options)
            if program != "hydro-plant":
                process.send(15)
            process.wait()
            return process.stderr

        near, far = "udpm://239.255.76.67:7667?ttl=0", "udpm://239.255.76.67:7667?ttl=1"
        words = "there is no bus.key_file"
        self.assertIn(words, first_words("hydro-plant", "--set", f"bus.url={far}"))
        self.assertNotIn(words, first_words("hydro-plant", "--set", f"bus.url={far}", *self.keyed))
        self.assertNotIn(words, first_words("hydro-plant", "--set", f"bus.url={near}"))


if __name__ == "__main__":
    outcome.main()
