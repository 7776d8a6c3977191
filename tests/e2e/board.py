"""The simulated board and the actuator behind it (tests/driver/), as tests see them.

HYDRO_TEST_TOOLS names the folder where the build has put simulated_actuator and libsimulated_comedi.so.
"""

import os
import struct

import stack

_TOOLS = os.environ.get("HYDRO_TEST_TOOLS", os.path.join(os.path.dirname(stack.BIN), "tests"))
LIBRARY = os.path.join(_TOOLS, "libsimulated_comedi.so")
ACTUATOR = os.path.join(_TOOLS, "simulated_actuator")

# SimulatedBoard of tests/plant/driver/simulated_board.h: eight bytes for each field, except the doorbell in
# between.
_NAMES = ("magic order attended doorbell asked_ns "
          + " ".join(f"input{i}" for i in range(8)) + " counter0 counter1 output0 output1 lines directions "
          "opened closed reads delayed_reads writes nonzero_writes line_writes edges enabled trips "
          "time_s voltage p1 p2 motor_speed arm_angle").split()
_FORMAT = struct.Struct("<" + "q" * (len(_NAMES) - 6) + "d" * 6)
_ORDER_AT = 8

ZERO_CODE = 0x8000
MAX_COUNT = 0xFFFFFF

ORDERS = ("nothing", "reads_fail", "writes_fail", "next_write_fails", "interrupt", "input0_high", "input0_open", "output_lies",
          "throw", "throw_number", "terminate", "exit", "quick_exit", "underscore_exit", "abort", "null_pointer",
          "stack_overflow")


class Board:
    """A board of its own for one test, with the actuator that moves behind it."""

    def __init__(self, case, name="board"):
        self.case = case
        self.file = case.path(name)
        self.actuator = case.start(ACTUATOR, self.file, os.path.join(stack.CONFIG, "models", "table1.toml"))
        self.actuator.wait_for("^ready")

    def read(self):
        """All registers and counters by name."""
        with open(self.file, "rb") as file:
            values = _FORMAT.unpack(file.read())
        return dict(zip(_NAMES, values))

    def __getattr__(self, name):
        if name in _NAMES:
            return self.read()[name]
        raise AttributeError(name)

    def order(self, name):
        """Sets what goes wrong from the driver's next reading on."""
        with open(self.file, "r+b") as file:
            file.seek(_ORDER_AT)
            file.write(struct.pack("<q", ORDERS.index(name)))

    def wait_for(self, condition, what):
        """Waits until `condition` holds for the registers; returns them."""
        def look():
            registers = self.read()
            return registers if condition(registers) else None
        return self.case.wait_until(look, what)

    def wait_until_driven(self):
        """Waits for an output voltage other than zero."""
        return self.wait_for(lambda b: b["nonzero_writes"] > 20 and b["output0"] != ZERO_CODE, "a voltage")
