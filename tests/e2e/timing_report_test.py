"""hydro-launch --timing and hydro-log timing: the same figures from a run and from its log, and that they are true."""

import json
import os
import re

import event_log
import outcome
import stack

RATE = 1000
DURATION = 3
TIMES = ("period_us", "latency_us", "round_trip_us")


class ReportTest(stack.TestCase):
    # Tests both reports of one run against each other, against themselves and against the contents of the
    # log.
    def test_report(self):
        log_file, report_file = self.path("run.lcmlog"), self.path("report.json")
        launch = self.launch(stack.config("demo.toml"), "--duration", str(DURATION), "--log", log_file, "--timing",
                             report_file)
        self.assertEqual(launch.wait(60), 0, launch.report())
        self.assertIn(report_file, launch.stdout)
        with open(report_file, encoding="utf-8") as file:
            report = json.load(file)
        log = event_log.Log(log_file)
        self.check_against_log(report, log)
        self.check_histograms(report)
        self.check_page(self.path("report.html"), report)

        again_file, page_file = self.path("again.json"), self.path("again.html")
        timing = self.run_program("hydro-log", "timing", log_file, "--json", again_file, "--page", page_file)
        with open(again_file, encoding="utf-8") as file:
            again = json.load(file)
        # The logger's own last messages are not in its log, because it sent them afterwards.
        for one, other in zip(self.by_role(report).items(), self.by_role(again).items()):
            if one[0] != "logger":
                self.assertEqual(one, other)
        self.check_page(page_file, again)
        for role, process in self.by_role(again).items():
            self.assertRegex(timing.stdout, rf"(?m)^{role} on \S+: {process['total']['cycles']} cycles")

    def by_role(self, report):
        processes = {process["role"]: process for process in report["processes"]}
        self.assertEqual(list(processes), ["plant", "pressure_ctrl", "position_ctrl", "logger"])
        return processes

    def check_against_log(self, report, log):
        processes = self.by_role(report)
        plant = processes["plant"]
        self.assertTrue(plant["complete"])
        self.assertEqual(plant["total"]["missed_deadlines"], sum(s.skipped_ticks for s in log.states))
        self.assertEqual(plant["total"]["cycles"], len(log.states) - 1)
        self.assertEqual(plant["histograms"]["latency_us"]["count"], len(log.states) - 1)
        skipped = [s.skipped_ticks for s in log.states if s.skipped_ticks]
        self.assertEqual(plant["histograms"].get("skipped", {"count": 0})["count"], len(skipped))
        # A round trip for each state that was answered before the plant left.
        trips = plant["histograms"]["round_trip_us"]
        answered = {c.tick for c in log.motor_commands if c.status != event_log.STOPPED}
        self.assertLessEqual(trips["count"], len(answered))
        self.assertGreaterEqual(trips["count"], len(answered) - 50)
        # The time from sending a state to its command's arrival includes the pressure loop's own time.
        self.assertGreater(trips["min"], processes["pressure_ctrl"]["histograms"]["latency_us"]["min"])
        self.assertEqual(processes["pressure_ctrl"]["total"]["cycles"], len(answered))
        self.assertEqual(processes["position_ctrl"]["total"]["cycles"], len(log.pressure_commands))
        for process in processes.values():
            self.assertEqual(sum(r["missed_deadlines"] for r in process["reports"])
                             <= process["total"]["missed_deadlines"], True)
            self.assertGreaterEqual(len(process["reports"]), DURATION - 1)
        for role in ("plant", "pressure_ctrl", "position_ctrl"):
            self.assertEqual(processes[role]["total"]["lost_messages"], 0, role)

    def check_histograms(self, report):
        for process in report["processes"]:
            self.assertIn("period_us", process["histograms"])
            for name, histogram in process["histograms"].items():
                where = f"{process['role']} {name}"
                self.assertEqual(sum(count for _, _, count in histogram["buckets"]), histogram["count"], where)
                quantiles = [histogram[key] for key in ("min", "p50", "p90", "p99", "p99_9", "max")]
                self.assertEqual(quantiles, sorted(quantiles), where)
                self.assertGreater(histogram["count"], 0, where)
                edges = [edge for first, last, _ in histogram["buckets"] for edge in (first, last)]
                self.assertEqual(edges, sorted(edges), where)
                self.assertLessEqual(edges[0], histogram["min"], where)
                self.assertGreaterEqual(edges[-1], histogram["max"], where)
            # The percentiles in the report on the whole run are those of the histogram, to within its ranges.
            total = process["total"]
            for name in ("period_us", "latency_us"):
                for key in ("p50", "p99"):
                    exact = total[name][key]
                    self.assertAlmostEqual(process["histograms"][name][key], exact, delta=0.05 * exact + 0.1)
                self.assertAlmostEqual(process["histograms"][name]["max"], total[name]["max"], delta=0.001)

    def check_page(self, path, report):
        with open(path, encoding="utf-8") as file:
            page = file.read()
        plots = page.count("<svg ")
        histograms = sum(len(process["histograms"]) for process in report["processes"])
        self.assertGreaterEqual(plots, histograms + len(report["processes"]))
        self.assertEqual(plots, page.count("</svg>"))
        for process in report["processes"]:
            self.assertIn(f"<h2>{process['role']} on ", page)
        # The page needs nothing from elsewhere.
        self.assertEqual(re.findall(r"(?:src|href)\s*=|url\(|@import|<script", page), [])
        self.assertNotIn("nan", page)

    # Tests that a report that cannot be written is noticed before anything starts.
    def test_bad_name(self):
        for name, says in (("report.txt", "ends in .json"), (os.path.join("missing", "report.json"), "missing")):
            launch = self.launch(stack.config("demo.toml"), "--duration", "1", "--timing", self.path(name))
            self.assertEqual(launch.wait(), 2, launch.report())
            self.assertEqual(len(launch.stderr.splitlines()), 1, launch.stderr)
            self.assertIn(says, launch.stderr)
            self.assertNotIn("ready", launch.stdout)
        self.assertEqual(os.listdir(self.folder), [])

    # Tests that a log of a run on simulated time, which has no wall time to report, is identified as such.
    def test_log_without_reports(self):
        log_file = self.path("sim.lcmlog")
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "0.5", "-o", log_file)
        timing = self.run_program("hydro-log", "timing", log_file, expect=2)
        self.assertIn("no report of a loop", timing.stderr)


if __name__ == "__main__":
    outcome.main()
