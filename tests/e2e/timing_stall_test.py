"""A process stands still for 2.5 s: the run goes on afterwards, and what was missed is counted, by whom it concerns."""

import event_log
import outcome
import timing_case

STALL = 2.5  # s
STALE = 0.3  # s, limits.stale_input_s: above what wake-ups are late by on a busy machine
MOST = int(STALL * timing_case.RATE)


class StallTest(timing_case.TimingCase):
    def start_at_rest(self, **options):
        # The command in force continues to act for a while, so the reference asks for no motion.
        self.start_stack("--set", f"limits.stale_input_s={STALE}", "--set", "reference.steps=[[0, 0]]", "--set",
                         "noise={}", **options)

    def stall(self, role, **options):
        self.start_at_rest(**options)
        self.hold(role, STALL)
        # Control has returned when the law acts again on states from after the stall.
        states = self.live.count("HYDRO_STATE")
        resumed = self.live.wait_for("HYDRO_STATE", lambda s: True, "a state after the stall", start=states)
        self.live.wait_for("HYDRO_MOTOR_COMMAND", lambda c: c.status == event_log.LAW and c.tick > resumed.tick,
                           "a command of the law after the stall", start=self.live.count("HYDRO_MOTOR_COMMAND"))
        self.live.wait_for_tick(self.live.messages["HYDRO_STATE"][-1].tick + 300)
        log = self.finish()
        # In all cases ticks come once and in order, samples come in their phase, and causes come before
        # effects.
        skipped = self.check_ticks(log)
        self.check_phase(log)
        self.check_cause_and_effect(log)
        return log, skipped

    # Tests that a stalled plant skips all ticks of that time at once, counts them, and reports them in its
    # next state, and that the slow loop counts the samples for which there was no state.
    def test_plant(self):
        log, skipped = self.stall("plant")
        longest = max(s.skipped_ticks for s in log.states)
        self.assertGreaterEqual(longest, 0.9 * MOST)
        self.assertGreaterEqual(skipped, longest)
        self.assertEqual(self.histogram(log, "plant", "skipped").highest, longest)
        self.assertGreaterEqual(self.totals(log)["position_ctrl"].missed_deadlines, longest // timing_case.INTERVAL - 1)
        self.assertEqual(self.totals(log)["pressure_ctrl"].lost_messages, 0)  # nothing was sent, nothing is lost

    # Tests that a stalled pressure loop counts every state that it did not get.
    def test_pressure_ctrl(self):
        log, _ = self.stall("pressure_ctrl", few_may_wait="pressure_ctrl")
        answered = {c.tick for c in log.motor_commands if c.status != event_log.STOPPED}
        unanswered = [s.tick for s in log.states if s.tick not in answered and s.tick < max(answered)]
        total = self.totals(log)["pressure_ctrl"]
        # The loop loses pressure commands too, and some of those that it did not lose may never have been in
        # force.
        used = {c.pressure_command_tick for c in log.motor_commands}
        unused = [c for c in log.pressure_commands if c.tick not in used]
        print(f"{len(unanswered)} states unanswered, {total.lost_messages} messages lost")
        if len(self.while_held(log.states)) > 300:  # more than can wait; a starved machine sends fewer
            self.assertGreater(len(unanswered), 0)
        self.assertGreaterEqual(total.lost_messages, len(unanswered))
        self.assertLessEqual(total.lost_messages, len(unanswered) + len(unused))
        # What was sent in the meantime either waited or was lost.
        waited = self.histogram(log, "pressure_ctrl", "queue_depth").highest
        self.assertGreaterEqual(total.lost_messages + waited, len(self.while_held(log.states)))

    # Tests that a stalled slow loop continues in its phase and counts the samples and states that it missed.
    def test_position_ctrl(self):
        log, _ = self.stall("position_ctrl", few_may_wait="position_ctrl")
        total = self.totals(log)["position_ctrl"]
        sampled = {c.tick for c in log.pressure_commands}
        last = max(sampled)
        due = [s.tick for s in log.states if s.tick % timing_case.INTERVAL == 0 and s.tick < last]
        missed = [tick for tick in due if tick not in sampled]
        # The samples that were due and had a state, and those that the plant itself had skipped.
        absent = last // timing_case.INTERVAL + 1 - len([t for t in due if t != last]) - 1
        self.assertEqual(total.missed_deadlines, len(missed) + absent)
        waited = self.histogram(log, "position_ctrl", "queue_depth").highest
        self.assertGreaterEqual(total.lost_messages + waited, len(self.while_held(log.states)))

    # Tests that a stalled logger neither disturbs control nor hides which messages it did not get.
    def test_logger(self):
        self.start_at_rest()
        before = self.live.count("HYDRO_STATE")
        self.hold("logger", STALL)
        self.live.wait_for("HYDRO_STATE", lambda s: s.tick > before + MOST, "a state after the stall")
        self.live.wait_for_tick(self.live.messages["HYDRO_STATE"][-1].tick + 300)
        log = self.finish()
        absent = sum(len(numbers) for kind in event_log.NUMBERED
                     for numbers in event_log.missing_numbers(log.of(kind)).values())
        self.assertEqual(self.totals(log)["logger"].lost_messages, absent)
        self.assertEqual(self.totals(log)["plant"].lost_messages, 0)


if __name__ == "__main__":
    outcome.main()
