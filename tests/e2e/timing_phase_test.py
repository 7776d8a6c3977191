"""Every process is held up again and again for some milliseconds: ticks are late, but what belongs to a tick stays so."""

import random

import event_log
import outcome
import timing_case

BURSTS = 60
LONGEST = 0.05  # s; a receive buffer of Linux's default size holds four times as much


class PhaseTest(timing_case.TimingCase):
    # Tests the slow loop's phase, the plant's count of skipped ticks, and the order of messages, in a run
    # with many delays.
    def test_delays_in_every_process(self):
        # Longer than the bursts and this machine can delay anything in total, because this test is not about
        # stops for safety.
        self.start_stack("--set", "limits.stale_input_s=3")
        chance = random.Random(1)
        for i in range(BURSTS):
            self.hold(timing_case.ROLES[i % len(timing_case.ROLES)], chance.uniform(0.005, LONGEST))
            self.live.wait_for_tick(self.live.messages["HYDRO_STATE"][-1].tick + chance.randrange(1, 40))
        log = self.finish()
        for kind in event_log.NUMBERED:
            self.assertEqual(event_log.missing_numbers(log.of(kind)), {}, kind)
        skipped = self.check_ticks(log)
        ticks = self.check_phase(log)
        motor = self.check_cause_and_effect(log)
        print(f"{len(log.states)} states, {skipped} ticks skipped, {len(ticks)} samples of the slow loop")
        # The plant was delayed, and reports it.
        self.assertGreaterEqual(skipped, 3 * BURSTS // len(timing_case.ROLES))
        self.assertGreater(len(ticks), 50)
        # Each state was answered, late or not: all by the fast loop, and those in its phase by the slow loop.
        self.assertEqual([s.tick for s in log.states[timing_case.DELAY:] if s.tick not in motor][1:], [])
        sampled = [s.tick for s in log.states if s.tick % timing_case.INTERVAL == 0]
        self.assertLessEqual(set(ticks) ^ set(sampled), {sampled[-1]})
        # Nothing was lost, and the loops report that some messages had to wait.
        for role, total in self.totals(log).items():
            self.assertEqual(total.lost_messages, 0, role)
        for role in ("pressure_ctrl", "position_ctrl"):
            self.assertGreater(self.histogram(log, role, "queue_depth").highest, 1, role)
        # The round trip on the plant's own clock, once for each state that was answered while it was
        # remembered.
        trip = self.histogram(log, "plant", "round_trip")
        self.assertGreater(trip.count, len(motor) // 2)
        self.assertLessEqual(trip.count, len(log.states))


if __name__ == "__main__":
    outcome.main()
