"""One stack on two hosts with a cable between them: the plant and the pressure loop on one, the position loop and the
logger on the other, the same configuration on each."""

import event_log
import outcome
import two_hosts


class HostsTest(two_hosts.TestCase):
    # Tests that a real-time run over two hosts loses nothing and brings the arm to its target.
    def test_realtime(self):
        self.run_both("--time", "realtime", "--duration", "2.1", *two_hosts.GENTLE, *two_hosts.PATIENT)
        log = event_log.Log(self.log_of("desk"))
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        self.assertEqual(log.states[-1].tick, 2100)
        self.assertGreater(max(abs(s.voltage) for s in log.states), 1)
        self.assertLess(abs(two_hosts.final_error(log)), 0.03)
        self.assertEqual({s.role for s in log.statuses} - {"launch"}, {"plant", "pressure_ctrl", "position_ctrl", "logger"})

    # Tests that with ttl=0 no message leaves its host: the run does not start, and each side names the
    # processes for which it waits.
    def test_ttl_0_stays(self):
        options = ("--set", "bus.url=" + two_hosts.URL.replace("ttl=1", "ttl=0"), "--set", "time.start_timeout_s=6")
        launches = self.start_both("--time", "lockstep", "--duration", "1", *options)
        self.assertEqual(launches["rig"].wait(), 1, launches["rig"].report())
        self.assertRegex(launches["rig"].stderr, "not ready after 6 s.*position_ctrl")
        launches["desk"].send(2)
        launches["desk"].wait()
        self.assertEqual(event_log.Log(self.log_of("desk")).states, [])


if __name__ == "__main__":
    outcome.main()
