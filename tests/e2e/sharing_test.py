"""Several stacks, and several senders, on one network."""

import contextlib
import os
import signal
import subprocess

import event_log
import lcm_peer
import outcome
import stack


class SharingTest(stack.TestCase):
    # Tests that two stacks on one port whose channels have different suffixes do not disturb each other.
    def test_two_suffixes(self):
        plans = {"": ("--seed", "1"), "_2": ("--seed", "2")}
        alone = {}
        for suffix, options in plans.items():
            alone[suffix] = self.path(f"alone{suffix}.lcmlog")
            self.run_program("hydro-sim", stack.config("demo.toml"), *options, "-o", alone[suffix])
        launches, shared = {}, {}
        for suffix, options in plans.items():
            shared[suffix] = self.path(f"shared{suffix}.lcmlog")
            launches[suffix] = self.launch(stack.config("demo.toml"), "--time", "lockstep", "--log", shared[suffix],
                                           "--set", f'bus.channel_suffix="{suffix}"', *options)
        for launch in launches.values():
            self.assertEqual(launch.wait(60), 0, launch.report())
        for suffix in plans:
            compare = self.run_program("hydro-log", "compare", alone[suffix], shared[suffix], "--suffix-a", "",
                                       "--suffix-b", suffix)
            self.assertEqual(compare.stdout, "identical\n", compare.report())
            log = event_log.Log(shared[suffix], suffix)
            self.assertEqual(len({s.session for s in log.states}), 1)
            self.assertEqual({f.code for f in log.faults}, set())

    def start_with_second_plant(self):
        """Both plants wait for the same controllers."""
        # Above the lateness of wake-ups here, so that neither plant counts as gone before it is.
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", "--set",
                         "limits.stale_input_s=0.4")
        plants = [run.start("plant", "--expect", "logger", label=f"plant {n}") for n in (1, 2)]
        for plant in plants:
            plant.wait_for("waiting for")  # it is on the network
        run.start("logger", "-o", self.path("run.lcmlog"))
        run.start("position_ctrl")
        run.start("pressure_ctrl")
        return stack.LiveLog(self, self.path("run.lcmlog")), plants

    # Tests that with two plants on one set of channels the pressure loop goes to zero volts and names the
    # fault, and resumes when one of them has gone.
    def test_two_plants(self):
        log, plants = self.start_with_second_plant()
        fault = log.wait_for("HYDRO_FAULT", lambda f: f.code == "second_state_sender" and f.active,
                             "the fault second_state_sender")
        self.assertEqual(fault.source, "pressure_ctrl")
        log.update()
        begin = len(log.messages["HYDRO_MOTOR_COMMAND"])
        safe = log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.SAFE, "a safe command")
        log.wait_for_tick(safe.tick + 300)
        log.update()
        between = log.messages["HYDRO_MOTOR_COMMAND"][begin:]
        self.assertGreater(len(between), 50)
        for command in between:
            self.assertEqual((command.status, command.voltage), (event_log.SAFE, 0), command)
        # Neither actuator has a voltage.
        log.update()
        begin = len(log.messages["HYDRO_STATE"])
        self.wait_until(lambda: log.count("HYDRO_STATE") > begin + 200, "more states")
        states = log.messages["HYDRO_STATE"][begin:]
        self.assertEqual(len({s.session for s in states}), 2)
        self.assertEqual([s for s in states if s.voltage != 0], [])
        plants[1].kill()
        log.wait_for("HYDRO_FAULT", lambda f: f.code == "second_state_sender" and not f.active, "the fault's end")
        log.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW, "commands of the law again",
                     start=log.count("HYDRO_MOTOR_COMMAND"))
        plants[0].send(signal.SIGTERM)
        self.assertEqual(plants[0].wait(), 0, plants[0].report())

    # Tests that a second launch on the same channels refuses before it starts anything, names what runs
    # there, and harms neither the first run nor its end.
    def test_second_launch_is_refused(self):
        log_file = self.path("first.lcmlog")
        first = self.launch(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", "--log", log_file,
                            "--set", "limits.stale_input_s=0.4")
        log = stack.LiveLog(self, log_file)
        log.wait_for_tick(200)
        second = self.launch(stack.config("demo.toml"), "--duration", "1", "--log", self.path("second.lcmlog"))
        self.assertEqual(second.wait(), 2, second.report())
        self.assertEqual(second.stdout, "")
        self.assertEqual(len(second.stderr.splitlines()), 1, second.report())
        self.assertRegex(second.stderr, r"found another hydro-launch on this machine that has started a plant on udpm:.*--stop")
        self.assertFalse(os.path.exists(self.path("second.lcmlog")))
        log.wait_for_tick(log.count("HYDRO_STATE") + 500)
        first.send(signal.SIGINT)
        self.assertEqual(first.wait(), 0, first.report())
        whole = event_log.Log(log_file)
        self.assertEqual({f.code for f in whole.faults} - {"late_plant"}, set())

    # Tests that of two launches at the same instant one runs undisturbed and the other refuses.
    def test_two_launches_at_once(self):
        launches = [self.launch(stack.config("demo.toml"), "--duration", "1", "--set", "limits.stale_input_s=0.5") for _ in range(2)]
        codes = sorted(launch.wait() for launch in launches)
        self.assertEqual(codes, [0, 2], launches[0].report() + launches[1].report())
        refused = next(launch for launch in launches if launch.wait() == 2)
        self.assertRegex(refused.stderr, "another hydro-launch on this machine|a stack on udpm:")
        ran = next(launch for launch in launches if launch.wait() == 0)
        self.assertNotRegex(ran.report(), "second_|other_stack")

    # Tests that a launch refuses beside a stack whose processes are all stopped and cannot say that they are
    # there.
    def test_stopped_stack_counts(self):
        first = self.launch(stack.config("demo.toml"), "--duration", "0", "--set", "limits.stale_input_s=0.5")
        first.wait_for("ready after")
        children = subprocess.run(["pgrep", "-P", str(first.child.pid)], capture_output=True, text=True, check=True).stdout.split()
        for pid in children:
            os.kill(int(pid), signal.SIGSTOP)
        try:
            second = self.launch(stack.config("demo.toml"), "--duration", "1")
            self.assertEqual(second.wait(), 2, second.report())
            # --stop does not wait for processes that cannot answer. The launcher, which can, kills them.
            stopper = self.launch(stack.config("demo.toml"), "--stop")
            self.assertEqual(stopper.wait(), 0, stopper.report())
            self.assertEqual(first.wait(), 1, first.report())
            self.assertRegex(first.stderr, "hydro-plant did not end on SIGTERM and was killed|was killed")
        finally:
            for pid in children:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(pid), signal.SIGCONT)

    # Tests that a launch refuses beside processes that were started by hand, and names them.
    def test_beside_processes_started_by_hand(self):
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0")
        run.start("pressure_ctrl")
        self.wait_until(lambda: run["pressure_ctrl"].running, "a process")
        second = self.launch(stack.config("demo.toml"), "--duration", "1")
        self.assertEqual(second.wait(), 2, second.report())
        self.assertRegex(second.stderr, r"found a stack on udpm:.* that runs: pressure_ctrl on .* \(process \d+\); end it with .*--stop")

    # Tests that a stop with another run's address ends no process, and that one with this run's address ends
    # all.
    def test_stop_of_another_run_is_none(self):
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", "--set",
                         "limits.stale_input_s=0.4")
        log_file = self.path("run.lcmlog")
        run.start("logger", "-o", log_file)
        for role in ("position_ctrl", "pressure_ctrl"):
            run.start(role)
        run.start("plant", "--expect", "logger")
        log = stack.LiveLog(self, log_file)
        log.wait_for_tick(100)
        log.update()
        session = log.messages["HYDRO_STATE"][0].session
        peer = lcm_peer.Peer(self.url, lcm_peer.type_hashes(log_file) | stop_hash(self))
        self.addCleanup(peer.close)
        for addressee in (session ^ 1, 1, -1):
            peer.publish("HYDRO_STOP", source="stranger", reason="not yours", session=5, addressee=addressee, exit_code=1)
        log.wait_for_tick(log.count("HYDRO_STATE") + 300)
        peer.publish("HYDRO_STOP", source="somebody", reason="yours", session=5, addressee=session)
        for process in run.processes.values():
            self.assertEqual(process.wait(), 0, process.report())


def stop_hash(case):
    """The type of HYDRO_STOP, from a short run's own end."""
    sample = case.path("sample.lcmlog")
    case.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.02", "-o", sample)
    return lcm_peer.type_hashes(sample)


if __name__ == "__main__":
    outcome.main()
