"""What Slurm itself does for a study when nobody watches, with its own times: minutes, so only on request."""

import outcome
import slurm_cluster  # noqa: F401  (says what is missing)
import slurm_test

setUpModule = slurm_test.setUpModule


class RequeueTest(slurm_test.ClusterCase):
    # Tests that the jobs of a node that dies run again by themselves (Slurm waits two minutes), even when
    # there is no driver.
    def test_dead_node(self):
        driver = self.start_on_slurm("--detach", free=4)
        self.assertEqual(driver.wait(), 0, driver.report())
        self.wait_for_begun(8)
        self.cluster.kill_node("n1")
        self.open_gate()
        self.wait_until(lambda: len(self.noted("ended")) == slurm_test.CASES, "all cases", timeout=240)
        self.check_end(self.start_on_slurm())
        self.assertEqual(len(self.arrays()), 1)
        self.cluster.start_node("n1")
        self.wait_until(lambda: self.cluster.node_states()["n1"] == "idle", "n1 is back")


class ControllerTest(slurm_test.ClusterCase):
    # Tests that a study outlives its cluster's controller: the driver waits for a new one.
    def test_dead_controller(self):
        driver = self.start_on_slurm(free=4)
        self.wait_for_begun(8)
        self.cluster.kill_controller()
        self.open_gate()
        self.wait_until(lambda: len(self.noted("ended")) >= 8, "the jobs that ran go on", timeout=60)
        self.assertIsNone(driver.child.poll(), driver.report())
        self.cluster.start_controller()
        for node in self.cluster.nodes:  # a controller that has lost its memory takes silent nodes for dead
            self.cluster.restart_slurmd(node)
        self.assertEqual(driver.wait(60), 0, driver.report())
        self.check_end(driver)


class OwnTimesTest(slurm_test.ClusterCase):
    settings = {name: None for name in ("SchedulerParameters", "KillWait", "MessageTimeout", "TCPTimeout")}

    # Tests a study on a cluster that looks for jobs as rarely as Slurm does by default.
    def test_ends(self):
        self.open_gate()
        driver = self.start_on_slurm()
        self.assertEqual(driver.wait(120), 0, driver.report())
        self.check_end(driver)


if __name__ == "__main__":
    outcome.main()
