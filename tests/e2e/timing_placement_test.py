"""hydro-launch puts each process where its [[process]] section says: processor, priority, locked memory."""

import os

import outcome
import stack


def permitted():
    """Whether this user may have real-time priority and locked memory here: asked of the kernel, in a child."""
    child = os.fork()
    if child == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
            with open("/proc/self/limits", encoding="utf-8") as limits:
                locked = next(line for line in limits if line.startswith("Max locked memory"))
            os._exit(0 if os.geteuid() == 0 or "unlimited" in locked else 1)
        except OSError:
            os._exit(1)
    return os.waitpid(child, 0)[1] == 0


def locked_kb(pid):
    with open(f"/proc/{pid}/status", encoding="utf-8") as status:
        return int(next(line for line in status if line.startswith("VmLck")).split()[1])


class PlacementTest(stack.TestCase):
    def start_with(self, sections):
        """A launch of demo.toml with these [[process]] sections; returns {role: pid} when the run is under way."""
        with open(stack.config("demo.toml"), encoding="utf-8") as file:
            text = file.read()
        text = text[:text.index("[[process]]")]
        text = text.replace("models/table1.toml", os.path.join(stack.CONFIG, "models", "table1.toml"))
        for section in sections:
            text += "\n[[process]]\n" + "".join(f"{key} = {value}\n" for key, value in section.items())
        config = self.path("placed.toml")
        with open(config, "w", encoding="utf-8") as file:
            file.write(text)
        self.launched = self.launch(config, "--duration", "0", "--log", self.path("run.lcmlog"))
        log = stack.LiveLog(self, self.path("run.lcmlog"))
        log.wait_for_tick(100)
        return log.pids()

    def threads(self, pid):
        threads = []
        for task in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{task}/comm", encoding="utf-8") as name:
                if name.read().strip() != "stderr_log":
                    threads.append(int(task))
        return threads

    # Tests processor, priority and memory of every program, including the logger, each with other values.
    # They apply to all threads, because a thread without them would delay the others. The thread that prints
    # is exempt, because no other waits for it.
    def test_each_program(self):
        if not permitted():
            self.skipTest("real-time priority and locked memory are not permitted to this user")
        cpus = sorted(os.sched_getaffinity(0))
        wanted = {
            "plant": (cpus[-1], 12, None),
            "pressure_ctrl": (cpus[0], 11, None),
            "position_ctrl": (cpus[-1], 10, "false"),
            "logger": (cpus[0], 0, "true"),
        }
        sections = []
        for role, (cpu, priority, lock) in wanted.items():
            section = {"program": f'"{stack.PROGRAMS[role]}"', "cpu": cpu, "priority": priority}
            if lock:
                section["lock_memory"] = lock
            sections.append(section)
        pids = self.start_with(sections)
        self.assertEqual(set(pids), set(wanted))
        preparations = {}
        for role, (cpu, priority, lock) in wanted.items():
            for thread in self.threads(pids[role]):
                self.assertEqual(os.sched_getaffinity(thread), {cpu}, role)
                with open(f"/proc/{pids[role]}/task/{thread}/comm", encoding="utf-8") as file:
                    preparing = file.read().strip() == "preparation"  # what the plant checks beside its loop keeps no loop waiting
                preparations[role] = preparations.get(role, 0) + preparing
                wished = 0 if preparing else priority
                self.assertEqual(os.sched_getscheduler(thread), os.SCHED_FIFO if wished else os.SCHED_OTHER, role)
                self.assertEqual(os.sched_getparam(thread).sched_priority, wished, role)
            # By default, memory is locked where there is a priority; the key can change that.
            is_locked = locked_kb(pids[role]) > 0
            self.assertEqual(is_locked, lock != "false" and (priority > 0 or lock == "true"), role)
        self.assertEqual(preparations, {"plant": 1, "pressure_ctrl": 0, "position_ctrl": 0, "logger": 0})
        self.assertEqual(self.launched.stderr, "")

    # Tests that without these keys the kernel's own choice is kept.
    def test_nothing_asked_for(self):
        roles = ("plant", "pressure_ctrl", "position_ctrl", "logger")
        pids = self.start_with([{"program": f'"{stack.PROGRAMS[role]}"'} for role in roles])
        for role, pid in pids.items():
            self.assertEqual(os.sched_getaffinity(pid), os.sched_getaffinity(0), role)
            self.assertEqual(os.sched_getscheduler(pid), os.SCHED_OTHER, role)
            self.assertEqual(locked_kb(pid), 0, role)


if __name__ == "__main__":
    outcome.main()
