"""Limbs: the joints of one configuration in one process, as stacks of processes, mixed, and on two hosts."""

import os
import signal

import event_log
import lcm_peer
import outcome
import stack
import two_hosts

JOINTS = ("hip", "knee")
LIMB = stack.config("limb.toml")
# The knee has processes of its own here.
MIXED = """
[[process]]
program = "hydro-limb"
joints = ["hip"]
{first}
[[process]]
program = "hydro-plant"
joint = "knee"
{second}
[[process]]
program = "hydro-pressure-ctrl"
joint = "knee"
{second}
[[process]]
program = "hydro-position-ctrl"
joint = "knee"
{second}
"""
# s; even on a loaded machine, nothing is late by that much.
PATIENT = ("--set", "limits.stale_input_s=5", "--set", "limits.stale_supervisor_s=5")


def with_processes(case, name, first="", second="", sections=MIXED):
    """The shipped limb with the knee in processes of its own, or these sections; returns the file, beside the models."""
    with open(LIMB, encoding="utf-8") as file:
        text = file.read()
    text = text.replace('"models/', f'"{os.path.dirname(LIMB)}/models/').split("[[process]]")[0]
    path = case.path(name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + sections.format(first=first, second=second))
    return path


def resident_bytes(pid):
    """What of its memory a process has in use."""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        return next(int(line.split()[1]) << 10 for line in file if line.startswith("VmRSS:"))


def two_limbs(case):
    """The shipped limb with the hip in a hydro-limb on the rig, and the knee in one on the desk."""
    return with_processes(case, "limbs.toml", sections="".join(
        f'[[process]]\nprogram = "hydro-limb"\nhost = "{host}"\njoints = ["{joint}"]\n'
        for host, joint in (("rig", "hip"), ("desk", "knee"))))


class LimbTest(stack.TestCase):
    # Tests that in lockstep each joint of a limb gives, bit by bit, what it gives in hydro-sim and alone in
    # processes of its own.
    def test_lockstep(self):
        short = ("--duration", "0.5")
        together = self.path("together.lcmlog")
        launch = self.launch(LIMB, "--time", "lockstep", *short, "--log", together)
        self.assertEqual(launch.wait(60), 0, launch.report())
        simulated = self.path("simulated.lcmlog")
        self.run_program("hydro-sim", LIMB, *short, "-o", simulated)
        for joint in JOINTS:
            alone = self.path(f"{joint}.lcmlog")
            launch = self.launch(LIMB, "--joint", joint, "--time", "lockstep", *short, "--log", alone)
            self.assertEqual(launch.wait(60), 0, launch.report())
            suffix = ("--suffix", f"_{joint}")
            self.assert_identical(together, alone, *suffix)
            self.assert_identical(together, simulated, *suffix)
            # The same comparison with this folder's own reader.
            logs = [event_log.Log(log, f"_{joint}") for log in (together, alone)]
            for kind in event_log.NUMBERED:
                messages = [{m._replace(utime=0, session=0) for m in log.of(kind)} for log in logs]
                self.assertEqual(messages[0], messages[1], kind)
            self.assertEqual(logs[0].states[-1].tick, 500)

    # Tests that in real time a joint's states are on its own channels at the chosen rate, numbered without a
    # gap up to the last, and that every output is left at zero.
    def test_realtime(self):
        log_file = self.path("run.lcmlog")
        launch = self.launch(LIMB, "--time", "realtime", "--duration", "1.5", "--log", log_file, *PATIENT)
        self.assertEqual(launch.wait(60), 0, launch.report())
        for joint in JOINTS:
            log = event_log.Log(log_file, f"_{joint}")
            for kind in event_log.NUMBERED:
                self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
            self.assertEqual(log.states[-1].tick, 1500)
            # One state in every 20 ticks, and the last one. The first is not the same for every joint.
            self.assertLessEqual(len(log.states), 1500 // 20 + 3)
            self.assertGreater(len(log.states), 30)
            self.assertTrue(any(s.voltage != 0 for s in log.states))
            self.assertEqual([(left.accepted, left.voltage) for left in log.outputs_left], [(1, 0.0)])
            self.assertIn(f"{joint} plant: the output reads back 0 V", launch.stdout)
        self.assertEqual({s.role for s in event_log.Log(log_file).statuses} - {"launch"}, {"limb", "logger"})

    # Tests that a flood of foreign states and of processes that do not exist neither stops the running limb
    # nor causes any of its faults, and that the memory for them is bounded.
    def test_a_flood(self):
        log_file, sim = self.path("run.lcmlog"), self.path("sim.lcmlog")
        self.run_program("hydro-sim", LIMB, "--duration", "0.1", "-o", sim)
        examples = {event.channel: event.data for event in event_log.read_events(sim)}
        options = ("--set", f"bus.url={self.url}", "--time", "realtime", "--duration", "0", *PATIENT)
        logger = self.start("hydro-logger", LIMB, *options, "-o", log_file)
        limb = self.start("hydro-limb", LIMB, *options, "--expect", "logger")
        live = JointLog(self, log_file)
        for joint in JOINTS:
            live.wait_for(joint, "HYDRO_STATE", lambda s: s.tick > 100, "the joint runs")
        peer = lcm_peer.Peer(self.url, {})
        self.addCleanup(peer.close)
        before = resident_bytes(limb.pid)
        status = event_log.TYPES["HYDRO_PROCESS_STATUS"]
        hash_ = next(data for channel, data in examples.items() if channel.startswith("HYDRO_PROCESS_STATUS"))[:8]
        for session in range(1, 20001):
            joint = JOINTS[session % 2]
            state = examples[f"HYDRO_STATE_{joint}"]  # the session stands behind hash, utime and tick
            peer.publish_bytes(f"HYDRO_STATE_{joint}", state[:24] + session.to_bytes(8, "big") + state[32:])
            fields = {"session": session, "role": "tool", "host": "elsewhere", "state": event_log.READY, "text": "x" * 500}
            values = [fields.get(name, "" if code == "s" else 0) for name, code in zip(status.tuple._fields, status.codes)]
            peer.publish_bytes(f"HYDRO_PROCESS_STATUS_{joint}", status.encode(hash_, values))
        grown = resident_bytes(limb.pid) - before
        self.assertLess(grown, 20 << 20)
        print(f"grown by {grown >> 10} KiB", flush=True)
        limb.send(signal.SIGINT)
        self.assertEqual(limb.wait(60), 0, limb.report())
        for joint in JOINTS:
            live.wait_for(joint, "HYDRO_STOP", lambda s: True, "its end")
            faults = [event_log.TYPES["HYDRO_FAULT"].decode(data) for data in live.messages.get(f"HYDRO_FAULT_{joint}", [])]
            self.assertEqual({fault.code for fault in faults} - {"late_plant", "other_joint", "logger_gone"}, set(), faults)
        logger.send(signal.SIGTERM)
        logger.wait()

    # Tests that a fault of one joint, which only a re-arm ends, holds the other at zero volts, and that the
    # other joint says whose fault it is.
    def test_a_fault_of_one_joint(self):
        log_file = self.path("run.lcmlog")
        launch = self.launch(LIMB, "--time", "realtime", "--duration", "1.5", "--log", log_file, *PATIENT, "--set",
                             "limits.rearm=explicit", "--set", "joint.knee.limits.motor_speed=2", "--set",
                             "limb.telemetry_hz=every_tick")
        self.assertEqual(launch.wait(60), 1, launch.report())
        logs = {joint: event_log.Log(log_file, f"_{joint}") for joint in JOINTS}
        knee = next(f for f in logs["knee"].faults if f.code == "motor_speed_limit" and f.source == "plant")
        hip = next(f for f in logs["hip"].faults if f.code == "other_joint")
        self.assertEqual(hip.tick, knee.tick)
        self.assertIn("joint knee has the fault motor_speed_limit", hip.text)
        for log in logs.values():
            after = [s.voltage for s in log.states if s.tick > knee.tick]
            self.assertGreater(len(after), 100)
            self.assertEqual(set(after), {0.0})
        self.assertTrue(any(s.voltage != 0 for s in logs["hip"].states))

    # Tests that a joint in processes of its own runs beside a limb, and that a fault of one zeroes the other.
    def test_mixed(self):
        self.check_mixed(with_processes(self, "mixed.toml"))

    # Tests the same with a key. Also tests that each joint's values can then be changed, in the limb and in
    # processes of its own, and that a fault without a seal stops no joint.
    def test_mixed_with_a_key(self):
        config = with_processes(self, "keyed.toml")
        key = ("--set", "bus.key_file=" + self.path("limb.key"))
        self.run_program("hydro-launch", config, "--make-key", *key)
        self.check_mixed(config, *key)
        fault = next(event.data for event in event_log.read_events(self.path("run.lcmlog")) if event.channel == "HYDRO_FAULT_knee")

        log_file = self.path("again.lcmlog")
        launch = self.launch(config, "--time", "realtime", "--duration", "0", "--log", log_file, *key, *PATIENT)
        launch.wait_for("ready")
        live = JointLog(self, log_file)
        for joint in JOINTS:
            live.wait_for(joint, "HYDRO_STATE", lambda s: s.tick > 300, "the joint runs")
            self.run_program("hydro-set", config, *key, "--set", f"bus.url={self.url}", "--joint", joint, "position.c1=5500")
        forger = lcm_peer.Peer(self.url, {})
        self.addCleanup(forger.close)

        def warned():
            forger.publish_bytes("HYDRO_FAULT_knee", fault)
            return "refused" in launch.stderr and "HYDRO_FAULT_knee" in launch.stderr

        self.wait_until(warned, "the forged fault is refused")
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertNotIn("other_joint", {f.code for f in event_log.Log(log_file, "_hip").faults})

    def check_mixed(self, config, *options):
        log_file = self.path("run.lcmlog")
        launch = self.launch(config, "--time", "realtime", "--duration", "0", "--log", log_file, "--set",
                             "limits.stale_input_s=0.3", "--set", "limb.telemetry_hz=every_tick", *options)
        launch.wait_for("ready")
        live = JointLog(self, log_file)
        for joint in JOINTS:
            live.wait_for(joint, "HYDRO_STATE", lambda s: s.tick > 300 and s.voltage != 0, "the joint moves")
        pressure_loop = self.child_of(launch, "hydro-pressure-ctrl")
        os.kill(pressure_loop, signal.SIGSTOP)
        try:
            fault = live.wait_for("hip", "HYDRO_FAULT", lambda f: f.code == "other_joint" and f.active, "the hip is held")
            self.assertRegex(fault.text, "joint knee has the fault stale_motor_command")
            live.wait_for("hip", "HYDRO_STATE", lambda s: s.tick > fault.tick + 5 and s.voltage == 0, "zero volts")
        finally:
            os.kill(pressure_loop, signal.SIGCONT)
        live.wait_for("hip", "HYDRO_FAULT", lambda f: f.code == "other_joint" and not f.active, "the hip goes on")
        launch.send(signal.SIGINT)
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertEqual(stack.still_running([pressure_loop]), [])

    # Tests that joints whose processes were not launched together still end together when one passes its
    # limit.
    def test_ends_without_a_launcher(self):
        options = ("--time", "realtime", "--duration", "0", "--set", f"bus.url={self.url}", "--set", "limits.stale_input_s=5")
        low = ("--set", "joint.hip.limits.motor_speed=20")
        limbs = [self.start("hydro-limb", LIMB, *options, *low, "--joints", joint, "--expect", f"joint:{other}")
                 for joint, other in (JOINTS, reversed(JOINTS))]
        for limb in limbs:
            self.assertEqual(limb.wait(60), 1, limb.report())
        limbs[1].wait_for("joint hip: .*motor_speed_limit")

    # Tests that a second limb on the same channels, which no launcher has seen, holds both at zero volts
    # within two seconds, and that both name it.
    def test_another_limb(self):
        log_file = self.path("run.lcmlog")
        launch = self.launch(LIMB, "--time", "realtime", "--duration", "0", "--log", log_file, *PATIENT)
        launch.wait_for("ready")
        live = JointLog(self, log_file)
        live.wait_for("hip", "HYDRO_STATE", lambda s: s.tick > 300 and s.voltage != 0, "the hip moves")
        other = self.start("hydro-limb", LIMB, "--set", f"bus.url={self.url}", "--time", "realtime", "--duration", "0")
        for joint in JOINTS:
            live.wait_for(joint, "HYDRO_FAULT", lambda f: f.code == "other_stack" and f.active, "another plant is named")
        other.wait_for("fault other_stack")
        launch.send(signal.SIGINT)
        other.send(signal.SIGINT)
        self.assertIn(launch.wait(60), (0, 1), launch.report())
        other.wait(60)

    # Tests that two limbs of one configuration run on one host, and that the log has both from their first
    # states on.
    def test_two_limbs_and_two_own_joints(self):
        with open(LIMB, encoding="utf-8") as file:
            text = file.read().replace('"models/', f'"{os.path.dirname(LIMB)}/models/').split("[[process]]")[0]
        own = "".join(f'[[process]]\nprogram = "{program}"\njoint = "{joint}"\n' for joint in JOINTS
                      for program in ("hydro-plant", "hydro-pressure-ctrl", "hydro-position-ctrl"))
        limbs = "".join(f'[[process]]\nprogram = "hydro-limb"\njoints = ["{joint}"]\n' for joint in JOINTS)
        for name, sections in (("own.toml", own), ("limbs.toml", limbs)):
            with self.subTest(name):
                with open(self.path(name), "w", encoding="utf-8") as file:
                    file.write(text + sections)
                log_file = self.path(name + ".lcmlog")
                launch = self.launch(self.path(name), "--time", "realtime", "--duration", "0.5", "--log", log_file, *PATIENT)
                self.assertEqual(launch.wait(60), 0, launch.report())
                for joint in JOINTS:
                    log = event_log.Log(log_file, f"_{joint}")
                    self.assertEqual(log.states[0].tick, 0)
                    self.assertEqual(log.descriptions[0].rate_hz, 1000)

    def child_of(self, launch, program):
        for pid in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as file:
                    parent = int(file.read().rsplit(") ", 1)[1].split()[1])
                with open(f"/proc/{pid}/cmdline", encoding="utf-8", errors="replace") as file:
                    command = file.read().split("\0")[0]
            except OSError:
                continue
            if parent == launch.pid and os.path.basename(command) == program:
                return int(pid)
        self.fail(f"{program} is not running\n" + launch.report())
        return None

    # Tests that wrong joints are named with their place and what is allowed.
    def test_wrong_input(self):
        def refuse(name, *arguments, says):
            process = self.run_program(name, *arguments, expect=2)
            self.assertRegex(process.stderr, says)
            self.assertEqual(process.stderr.count("\n"), 1, process.stderr)

        refuse("hydro-plant", LIMB, says='limb.toml:[0-9]+: joint: found joints \\("hip" or "knee"\\), .*--joint NAME')
        refuse("hydro-sim", LIMB, "--joint", "toe", says='--joint: found "toe", allowed "hip" or "knee"')
        refuse("hydro-sim", stack.config("demo.toml"), "--joint", "hip", says="--joint: found \"hip\", allowed with")
        refuse("hydro-sim", LIMB, "--set", "joint.toe.position.c1=1", says='joint: found "toe", allowed "hip" or "knee"')
        refuse("hydro-sim", LIMB, "--set", "joint.hip.bus.url='x'", says="joint.hip.bus: found what all joints of the limb share")
        refuse("hydro-sim", LIMB, "--set", "limb.telemetry_hz=300",
               says='telemetry_hz: found 300, allowed plant.rate_hz = 1000 divided by a whole number, or "every_tick"')
        refuse("hydro-sim", LIMB, "--set", "limb.colour=3", says="colour.*unknown key")
        with open(self.path("none.toml"), "w", encoding="utf-8") as file:
            file.write("joint = []\n")
        for name in ("hydro-sim", "hydro-limb", "hydro-plant"):
            refuse(name, self.path("none.toml"), says="none.toml:1: joint: found none, allowed sections")
        refuse("hydro-limb", stack.config("demo.toml"), says="found no \\[\\[joint\\]\\] section")
        refuse("hydro-limb", LIMB, "--joints", "toe", says='--joints: found "toe", allowed "hip" or "knee"')


class JointLog:
    """The messages of several joints in a log that is being written."""

    def __init__(self, case, path):
        self.case = case
        case.wait_until(lambda: os.path.exists(path), "the log is there")
        self.follower = event_log.Follower(path)
        self.messages = {}

    def wait_for(self, joint, kind, condition, what):
        def look():
            for event in self.follower.new_events():
                self.messages.setdefault(event.channel, []).append(event.data)
            found = (event_log.TYPES[kind].decode(data) for data in self.messages.get(f"{kind}_{joint}", []))
            return next(filter(condition, found), None)

        return self.case.wait_until(look, what)


class LimbOnTwoHostsTest(two_hosts.TestCase):
    # Tests that the joints of one limb run on two hosts and end together, each output at zero.
    def test_realtime(self):
        config = with_processes(self, "hosts.toml", 'host = "rig"', 'host = "desk"')
        launches = {}
        for host in ("desk", "rig"):
            launches[host] = self.start_in(host, [stack.program("hydro-launch"), config, "--host", host, "--time", "realtime",
                                                  "--duration", "1", "--set", f"bus.url={two_hosts.URL}", *PATIENT])
        for host, launch in launches.items():
            self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertIn("hip plant: the output reads back 0 V", launches["rig"].stdout)
        self.assertIn("knee plant: the output reads back 0 V", launches["desk"].stdout)

    # Tests that half a limb does not begin: each half waits for the other, and names it when it does not
    # come.
    def test_half_a_limb(self):
        config = with_processes(self, "hosts.toml", 'host = "rig"', 'host = "desk"')
        for host, other in (("rig", "joint knee"), ("desk", "joint hip")):
            launch = self.launch_on(host, "--time", "realtime", "--duration", "1", "--log", self.log_of(host), "--set",
                                    "time.start_timeout_s=1", config=config)
            self.assertEqual(launch.wait(60), 1, launch.report())
            self.assertRegex(launch.stderr, "not ready after 1 s .time.start_timeout_s.: .*" + other)
            for joint in JOINTS:
                self.assertEqual(event_log.Log(self.log_of(host), f"_{joint}").states, [], joint)

    # Tests that with "others_go_on" a joint that passes its limit on one host ends alone, and the joint on
    # the other host continues to its end.
    def test_others_go_on(self):
        config = two_limbs(self)
        launches = {host: self.launch_on(host, "--time", "realtime", "--duration", "2", "--log", self.log_of(host), "--set",
                                         "limb.on_joint_fault=others_go_on", "--set", "joint.hip.limits.motor_speed=2",
                                         *PATIENT, config=config) for host in ("desk", "rig")}
        self.assertEqual(launches["rig"].wait(60), 1, launches["rig"].report())
        self.assertEqual(launches["desk"].wait(60), 1, launches["desk"].report())
        hip = event_log.Log(self.log_of("rig"), "_hip")
        self.assertIn("motor_speed_limit", {f.code for f in hip.faults})
        self.assertLess(hip.states[-1].tick, 2000)
        self.assertEqual(event_log.Log(self.log_of("desk"), "_knee").states[-1].tick, 2000)


class LimbCableTest(two_hosts.TestCase):
    relay_options = ("--outage", 600, 1.5)

    # Tests that joints on two hosts are at zero volts while neither host hears the other, and continue when
    # they hear each other again.
    def test_cable_out(self):
        config = two_limbs(self)
        launches = {host: self.launch_on(host, "--time", "realtime", "--duration", "0", "--log", self.log_of(host), "--set",
                                         "limits.stale_input_s=0.3", config=config) for host in ("desk", "rig")}
        for host, joint in (("rig", "hip"), ("desk", "knee")):
            log = JointLog(self, self.log_of(host))
            fault = log.wait_for(joint, "HYDRO_FAULT", lambda f: f.code == "joint_gone" and f.active, f"{joint} is held")
            self.assertRegex(fault.text, "joint (hip|knee), which another process runs, has not been heard for 0[.][34]")
            over = log.wait_for(joint, "HYDRO_FAULT", lambda f: f.code == "joint_gone" and not f.active, f"{joint} goes on")
            log.wait_for(joint, "HYDRO_STATE", lambda s: s.tick > over.tick and s.voltage != 0, f"{joint} moves again")
            states = [event_log.TYPES["HYDRO_STATE"].decode(data) for data in log.messages[f"HYDRO_STATE_{joint}"]]
            self.assertTrue(any(s.voltage != 0 for s in states if s.tick < fault.tick))
            held = [s.voltage for s in states if fault.tick + 5 < s.tick <= over.tick]
            self.assertGreater(len(held), 20)
            self.assertEqual(set(held), {0.0})
        launches["rig"].send(signal.SIGINT)
        for launch in launches.values():
            self.assertEqual(launch.wait(60), 0, launch.report())


if __name__ == "__main__":
    outcome.main()
