"""The messages' types for Java, and hydro-spy, which shows a running stack in LCM's lcm-spy on a virtual screen. What it needs besides
a build with a JDK and liblcm-java: libjchart2d-java, xvfb, x11-utils."""

import os
import shutil
import subprocess

import event_log
import outcome
import stack

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# From the sources and their build folder, or installed.
JARS = os.environ.get("HYDRO_JARS", os.path.join(os.path.dirname(stack.BIN), "generated", "java"))
SPY = os.environ.get("HYDRO_SPY", os.path.join(ROOT, "packaging", "java", "hydro-spy"))
TYPES = os.path.join(ROOT, "lcmtypes")
LCM_JAR = "/usr/share/java/lcm.jar"


class JavaTest(stack.TestCase):
    def setUp(self):
        super().setUp()
        if not os.path.exists(os.path.join(JARS, "hydro.jar")) or not os.path.exists(LCM_JAR) or not shutil.which("java"):
            self.skipTest("needs hydro.jar, which a build makes where default-jdk-headless and liblcm-java are installed")
        os.environ["HYDRO_JARS"] = JARS

    # Tests that Java decodes every message of a run and encodes it to the same bytes.
    def test_types(self):
        self.run_program("hydro-sim", stack.config("demo.toml"), "--duration", "2", "-o", self.path("run.lcmlog"))
        log = event_log.Log(self.path("run.lcmlog"))
        sent = {channel: len(log.of(channel)) for channel in ("HYDRO_STATE", "HYDRO_MOTOR_COMMAND", "HYDRO_PRESSURE_COMMAND")}
        self.assertGreater(sent["HYDRO_STATE"], 1000)
        java = self.run_program(shutil.which("java"), "-cp", f"{LCM_JAR}:{JARS}/hydro.jar", os.path.join(ROOT, "tests/e2e/ReadLog.java"),
                                self.path("run.lcmlog"))
        for channel, count in sent.items():
            self.assertIn(f"{channel}={count}", java.stdout)
        for channel in ("HYDRO_RUN", "HYDRO_CONFIGURATION", "HYDRO_LOOP_STATISTICS"):
            self.assertIn(f"{channel}=", java.stdout)
        self.assertEqual(float(java.stdout.split()[-1]), log.of("HYDRO_STATE")[-1].arm_angle)

    # Tests that lcm-spy starts beside a stack, with all types.
    def test_spy(self):
        if not all(map(shutil.which, ("Xvfb", "xwininfo"))) or not os.path.exists("/usr/share/java/jchart2d.jar"):
            self.skipTest("needs Xvfb (xvfb), xwininfo (x11-utils) and libjchart2d-java")
        screen = self.start(shutil.which("Xvfb"), "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp", label="Xvfb")
        os.environ["DISPLAY"] = ":" + screen.wait_for(r"^(\d+)$")[1]
        self.launch(stack.config("demo.toml"), "--duration", "60")
        spy = self.start(SPY, "--url", self.url)
        self.assertEqual(int(spy.wait_for(r"Found (\d+) LCM types")[1]), len([name for name in os.listdir(TYPES) if name.endswith(".lcm")]))
        self.wait_until(lambda: "LCM Spy" in subprocess.run(["xwininfo", "-root", "-tree"], capture_output=True, text=True).stdout,
                        "the window of lcm-spy")
        self.assertTrue(spy.running, spy.report())

    # Tests that errors are reported in one line.
    def test_bad_input(self):
        for arguments, said in ((["--speed"], "hydro-spy: found --speed, allowed --url URL or a configuration\n"),
                                (["gone.toml"], "hydro-spy: gone.toml: cannot be read\n")):
            self.assertEqual(self.run_program(SPY, *arguments, expect=2).stderr, said)


if __name__ == "__main__":
    outcome.main()
