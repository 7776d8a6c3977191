"""Order and cause in a lockstep run, as its log shows them: what a command was computed from precedes it."""

import event_log
import outcome
import stack


class OrderTest(stack.TestCase):
    def record(self, *options):
        log_file = self.path("order.lcmlog")
        launch = self.launch(stack.config("paper.toml"), "--time", "lockstep", "--duration", "0.5", "--log", log_file,
                             *options)
        self.assertEqual(launch.wait(60), 0, launch.report())
        return event_log.Log(log_file)

    def check(self, log, last_tick, interval, delay):
        laws = [c for c in log.motor_commands if c.status != event_log.STOPPED]
        self.assertEqual([s.tick for s in unrepeated(log.states)], list(range(last_tick + 1)))
        # Exactly one motor command per tick, and pressure commands exactly every `interval` ticks.
        self.assertEqual([c.tick for c in unrepeated(laws)], list(range(last_tick + 1)))
        samples = list(range(0, last_tick + 1, interval))
        self.assertEqual([c.tick for c in unrepeated(log.pressure_commands)], samples)
        self.assertEqual([r.tick for r in unrepeated(log.arm_references)], samples)
        for kind in event_log.NUMBERED:
            numbers = [m.sequence for m in unrepeated(log.of(kind))]
            self.assertEqual(numbers, list(range(len(numbers))), kind)
        # The pressure loop's last command is zero volts.
        last = unrepeated(log.motor_commands)[-1]
        self.assertEqual((last.status, last.voltage), (event_log.STOPPED, 0))

        # The first appearance of each message in the file.
        place = {}
        for position, (kind, message) in enumerate(log.items):
            if kind in event_log.NUMBERED and getattr(message, "status", None) != event_log.STOPPED:
                place.setdefault((kind, message.tick), position)
        for command in laws:
            tick = command.tick
            self.assertLess(place["HYDRO_STATE", tick], place["HYDRO_MOTOR_COMMAND", tick])
            used = command.pressure_command_tick
            newest_allowed = tick - delay
            self.assertEqual(used, newest_allowed // interval * interval if newest_allowed >= 0 else -1)
            if used >= 0:
                self.assertLess(place["HYDRO_PRESSURE_COMMAND", used], place["HYDRO_MOTOR_COMMAND", tick])
        for command in log.pressure_commands:
            tick = command.tick
            self.assertLess(place["HYDRO_STATE", tick], place["HYDRO_PRESSURE_COMMAND", tick])
        # Everything of tick k precedes the state of tick k + 1.
        for (kind, tick), position in place.items():
            if tick < last_tick:
                self.assertLess(position, place["HYDRO_STATE", tick + 1], (kind, tick))
        # The voltage that acted on the actuator is the one that was commanded.
        voltage = {c.tick: c.voltage for c in laws}
        for state in log.states[1:]:
            source = state.tick - 1 - delay
            self.assertEqual(state.command_tick, source if source >= 0 else -1)
            self.assertEqual(state.voltage, voltage[source] if source >= 0 else 0)
        for state in log.states:
            self.assertEqual(state.skipped_ticks, 0)

    # Tests the order with the delay of one tick that hardware has.
    def test_order(self):
        self.check(self.record(), 2500, 25, 1)

    # Tests the order where a command acts from its own tick on.
    def test_order_without_delay(self):
        self.check(self.record("--set", "plant.command_delay_ticks=0"), 2500, 25, 0)

    # Tests the order at another sample interval, one that does not divide the run.
    def test_order_of_odd_interval(self):
        self.check(self.record("--set", "position.sample_interval_s=0.0034"), 2500, 17, 1)


def unrepeated(messages):
    """The items without messages that were resent because an answer was late, identical to an earlier one."""
    seen, kept = set(), []
    for message in messages:
        key = (message.session, message.sequence)
        if key not in seen:
            seen.add(key)
            kept.append(message)
    return kept


if __name__ == "__main__":
    outcome.main()
