"""A planner of one's own, in Python: the types that lcm-gen writes, the standard library, and a stack in real time."""

import importlib
import math
import os
import shutil
import subprocess
import sys
import threading

import event_log
import fault_case
import lcm_peer
import outcome

TYPES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "lcmtypes")
EVERY = 0.2  # s from plan to plan
DELAY = 0.15  # s, reference.delay_s: as late as processes wake up here, so that plans come in time; below EVERY
TIMEOUT = 1.0  # s, reference.timeout_s: several plans
LEAD = 1.6  # s that a plan reaches ahead: beyond both, so that it is silence that ends it, not the plan's end
STEP = 0.02  # s from point to point
INTERVAL = 5  # ticks from sample to sample
AMPLITUDE, FREQUENCY = 0.1, 0.4  # rad and Hz: a third of what the motor's torque allows
REFERENCE = f'signal = "arm_angle"\nkind = "planner"\ndelay_s = {DELAY}\ntimeout_s = {TIMEOUT}'


class Course:
    """Where the planner wants the arm: at rest at 0 until `start`, then to 0.2 rad and back, and again."""

    def __init__(self, start):
        self.start = start

    def at(self, time):
        """Angle and speed; both, and the acceleration, have no jump."""
        rate = 2 * math.pi * FREQUENCY
        phase = rate * max(0, time - self.start)
        rise = 1 - math.cos(phase)
        return AMPLITUDE * rise * rise / 2, AMPLITUDE * rate * rise * math.sin(phase)


class Far:
    """Where no arm can go."""

    def at(self, _time):
        return 2.0, 0.0


class Rest:
    """Somewhere else, within the limits."""

    def at(self, _time):
        return -0.1, 0.0


class Planner:
    """Hears the states and answers one of them `every` s with a plan ahead, in a thread."""

    def __init__(self, case, course, session=77, every=EVERY):
        self.case, self.course, self.session, self.every = case, course, session, every
        self.peer = lcm_peer.Peer(case.url, {})
        self.sent = []
        self.error = None
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        """No plan is sent after this. May be called again."""
        self._end.set()
        self._thread.join()
        self.peer.close()
        if self.error:
            raise self.error

    def _run(self):
        try:
            answered = -math.inf
            while not self._end.is_set():
                states = [self.case.state_t.decode(data) for channel, data in self.peer.receive(0.1) if channel == "HYDRO_STATE"]
                if states and states[-1].time >= answered + self.every - 1e-9:
                    answered = states[-1].time
                    self.send(states[-1])
        except Exception as error:  # noqa: BLE001 - told to the test's own thread
            self.error = error

    def send(self, state):
        plan = self.case.arm_plan_t()
        plan.tick, plan.session, plan.sequence = state.tick, self.session, len(self.sent)
        plan.time = [state.time + STEP * n for n in range(round(LEAD / STEP) + 1)]
        plan.count = len(plan.time)
        plan.arm_angle, plan.arm_speed = map(list, zip(*map(self.course.at, plan.time)))
        plan.torque = [0.0] * plan.count
        self.sent.append(plan)
        self.peer.publish_bytes("HYDRO_ARM_PLAN", plan.encode())


class PlannerTest(fault_case.FaultCase):
    def setUp(self):
        super().setUp()
        generator = shutil.which("lcm-gen")
        if generator is None:
            self.skipTest("needs lcm-gen: apt-get install liblcm-bin")
        types = [os.path.join(TYPES, f"hydro_{name}_t.lcm") for name in ("arm_plan", "state")]
        # The package has a name of this test's own, so that another test's types cannot be found in its
        # place.
        subprocess.run([generator, "-p", "--ppath", self.path("python"), *types], check=True, capture_output=True)
        sys.path.insert(0, self.path("python"))
        self.addCleanup(sys.path.remove, self.path("python"))
        for name in [name for name in sys.modules if name.split(".")[0] == "hydro"]:
            del sys.modules[name]
        self.arm_plan_t = importlib.import_module("hydro.arm_plan_t").arm_plan_t
        self.state_t = importlib.import_module("hydro.state_t").state_t

    def start_planned(self, *options):
        """Returns a state of the arm at rest at 0, where the reference is until a plan comes."""
        self.start_stack(*options, config=self.config_with(REFERENCE))
        return self.log.wait_for_tick(100)

    def planner(self, course, **options):
        planner = Planner(self, course, **options)
        self.addCleanup(planner.close)
        return planner

    def answered(self, log, first, last):
        """The references of a span by their ticks: of nearly all samples that a late plant has not skipped."""
        references = {r.tick: r.value for r in log.arm_references if first <= r.tick <= last}
        due = [s.tick for s in log.states if first <= s.tick <= last and s.tick % INTERVAL == 0]
        self.assertGreater(len(due), 10)
        self.assertGreaterEqual(len(references), 0.9 * len(due))
        return references

    def assert_on_course(self, log, course, last):
        """The reference is the planned angle at every sample."""
        references = self.answered(log, round(course.start * fault_case.RATE), last)
        # A cubic over STEP between points with the course's angles and speeds differs from it by at most
        # STEP^4/384 of the fourth derivative, which is up to 5 AMPLITUDE (2 pi FREQUENCY)^4: 1e-8 rad.
        for tick, value in references.items():
            self.assertAlmostEqual(value, course.at(tick / fault_case.RATE)[0], delta=2e-8, msg=f"tick {tick}")

    # Tests that the types that lcm-gen writes for Python need nothing but the standard library, and encode as
    # the description of the format says.
    def test_generated_types(self):
        plan = self.arm_plan_t()
        plan.utime, plan.tick, plan.session, plan.sequence, plan.count = 1, 2, 3, 4, 2
        plan.time, plan.arm_angle, plan.arm_speed, plan.torque = [0.5, 1], [0.1, -0.1], [2, 3], [4, 5]
        data = plan.encode()
        decoded = event_log.TYPES["HYDRO_ARM_PLAN"].decode(data)
        self.assertEqual(tuple(decoded), (1, 2, 3, 4, 2, (0.5, 1), (0.1, -0.1), (2, 3), (4, 5)))
        again = self.arm_plan_t.decode(data)
        self.assertEqual(list(again.arm_angle), [0.1, -0.1])
        # Runs alone in an interpreter without any installed package (-I -S).
        done = subprocess.run([sys.executable, "-I", "-S", "-B", "-c", f"import sys; sys.path.insert(0, {self.path('python')!r})\n"
                               "from hydro.arm_plan_t import arm_plan_t; print(arm_plan_t().encode().hex())"],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.strip()), (0, self.arm_plan_t().encode().hex()), done.stderr)

    # Tests that the arm goes where the planner wants it: the reference exactly, and the arm to within the
    # errors of the laws.
    def test_the_arm_follows(self):
        # It runs at a quarter of the pace, because a wake-up that is 10 ms late holds a voltage for 10 more
        # ticks, by which the arm leaves its plan.
        course = Course(self.start_planned("--set", "time.speed=0.25").time + 0.5)
        planner = self.planner(course)
        end = self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 1 / FREQUENCY, "there and back")
        self.assertEqual([f for f in self.log.messages["HYDRO_FAULT"] if "plan" in f.code], [])
        log = self.finish()
        planner.close()
        self.assert_on_course(log, course, end.tick)
        first = round(course.start * fault_case.RATE)
        moved = [s for s in log.states if first <= s.tick <= end.tick]
        self.assertGreater(max(s.arm_angle for s in moved), 1.9 * AMPLITUDE)
        worst = max(abs(s.arm_angle - course.at(s.time)[0]) for s in moved)
        print(f"arm off its plan by at most {worst:.5f} rad", flush=True)
        # Neither loop has an integral term. The motor's own inertia, friction and drag take up to 17 + 4 + 2
        # in-lbf, for which the pressure loop (k_1 k_p = 0.53 in-lbf/psi) needs an error of 44 psi; the arm's
        # inertia takes 8 psi more. At c1 = 6000 psi/rad that is 0.0087 rad.
        self.assertLess(worst, 0.01)

    # Tests that a planner that plans at every sample is followed as well: the newest plan replaces the one
    # before, but does not keep it from ever acting.
    def test_fast_planner(self):
        course = Course(self.start_planned().time + 0.5)
        planner = self.planner(course, every=0.005)
        end = self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 1, "the arm moves")
        log = self.finish()
        self.assertGreater(len(planner.sent), 50)
        self.assert_on_course(log, course, end.tick)

    # Tests that the replay of the log follows the plans.
    def test_replay(self):
        course = Course(self.start_planned().time + 0.5)
        self.planner(course)
        self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 0.5, "the arm moves")
        self.finish()
        self.assertIn("position: identical", self.run_program("hydro-log", "replay", self.log_file, timeout=120).stdout)

    # Tests that plans beyond the limits are refused and reported, while the reference continues along the
    # plan before.
    def test_beyond_the_limits(self):
        course = Course(self.start_planned().time + 0.5)
        planner = self.planner(course)
        self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 0.3, "the arm moves")
        planner.course = Far()
        fault = self.wait_for_fault("refused_arm_plan", source="position_ctrl")
        self.assertRegex(fault.text, r"not followed; the newest: point 0: found arm angle 2 rad, allowed \|alpha\| <= 0\.[0-9]+ rad "
                                     r"\(limits.arm_angle\)")
        planner.course = course
        self.wait_for_fault("refused_arm_plan", active=False)
        self.log.wait_for_tick(fault.tick + 500)
        log = self.finish()
        self.assert_on_course(log, course, fault.tick)
        self.assertLess(max(abs(r.value) for r in log.arm_references), 2 * AMPLITUDE + 1e-6)

    # Tests that a second planner is not followed while there is a first one, and is told why.
    def test_second_planner(self):
        course = Course(self.start_planned().time + 0.5)
        self.planner(course)
        self.log.wait_for("HYDRO_ARM_PLAN", lambda p: True, "the first planner's")
        self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 0.2, "the arm moves")
        self.planner(Rest(), session=78)
        fault = self.wait_for_fault("refused_arm_plan", source="position_ctrl")
        self.assertIn("another planner is followed already; allowed is one", fault.text)
        self.log.wait_for_tick(fault.tick + 300)
        log = self.finish()
        self.assertEqual({p.session for p in log.of("HYDRO_ARM_PLAN")}, {77, 78})
        self.assert_on_course(log, course, log.arm_references[-1].tick)

    # Tests that the reference holds its value when the planner is silent for longer than allowed, that this
    # is reported, and that the next plan ends it.
    def test_silence(self):
        course = Course(self.start_planned().time + 0.5)
        planner = self.planner(course)
        self.log.wait_for("HYDRO_STATE", lambda s: s.time >= course.start + 0.4, "the arm moves")
        planner.close()
        newest = planner.sent[-1].tick
        fault = self.wait_for_fault("silent_planner")
        self.assertRegex(fault.text, rf"no plan for more than {TIMEOUT:g} s \(reference.timeout_s\): the reference holds")
        self.log.wait_for_tick(fault.tick + 500)
        again = self.planner(course)
        end = self.wait_for_fault("silent_planner", active=False)
        self.log.wait_for_tick(end.tick + 100)
        again.close()
        log = self.finish()
        ends = newest + round((DELAY + TIMEOUT) * fault_case.RATE)  # of what that plan says
        self.assert_on_course(log, course, ends)
        self.assertGreater(fault.tick, ends)
        self.assertLess(fault.tick, ends + 300)  # that is the next sample, and wake-ups may be late
        held = self.answered(log, fault.tick, end.tick - 1)
        self.assertEqual(len(set(held.values())), 1, held)


if __name__ == "__main__":
    outcome.main()
