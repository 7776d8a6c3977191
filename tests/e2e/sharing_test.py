"""Several stacks, and several senders, on one network."""

import signal

import event_log
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
        # Above what wake-ups are late by here: neither plant is to be taken for gone before it is.
        run = self.stack(stack.config("demo.toml"), "--time", "realtime", "--duration", "0", "--set",
                         "limits.stale_input_s=0.4")
        plants = [run.start("plant", "--expect", "logger", label=f"plant {n}") for n in (1, 2)]
        for plant in plants:
            plant.wait_for("waiting for")  # it is on the network
        run.start("logger", "-o", self.path("run.lcmlog"))
        run.start("position_ctrl")
        run.start("pressure_ctrl")
        return stack.LiveLog(self, self.path("run.lcmlog")), plants

    # Tests that with two plants on one set of channels the pressure loop goes to zero volts and names the fault, and
    # resumes when one of them has gone.
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
        # Both actuators stand without voltage.
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


if __name__ == "__main__":
    outcome.main()
