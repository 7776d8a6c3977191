"""The example of a driver on a serial port, examples/own_driver/serial_board. Its simulated device is a terminal, whose bytes wait for
the kernel when the computer is busy, so this test runs with nothing beside it."""

import outcome
import own_driver_test


class TerminalTest(own_driver_test.OwnDriverCase):
    # Tests that its arm ends at its target, as that of the other examples does.
    def test_arm_reaches_its_target(self):
        self.arrives("serial_board")

    # Tests that it keeps what docs/safety.md promises.
    def test_promises(self):
        self.keeps_its_promises("serial_board")


if __name__ == "__main__":
    outcome.main()
