// A data-acquisition board as a file: its registers are in shared memory. The driver opens the file through
// the C functions of comedi_functions.cc; the rig behind the board (a test, or simulated_actuator_main.cc)
// writes the input registers. The last output stays in the file, whatever happens to the driver.
//
//   subdevice 0   8 analog inputs of 16 bits, ranges +/-10 V, +/-5 V and 0 to 10 V
//   subdevice 1   2 analog outputs of 16 bits, +/-10 V, +/-5 V
//   subdevice 2   8 digital lines, each an input or an output
//   subdevice 3   2 counters of 24 bits
#pragma once

#include <cstdint>

namespace hydro::testing {

// tests/e2e/board.py reads and writes it as well: each field has 8 bytes except the two of the doorbell.
struct SimulatedBoard {
  static constexpr int64_t kMagic = 0x6472616f62;
  static constexpr int kInputs = 8;
  static constexpr int kOutputs = 2;
  static constexpr int kLines = 8;
  static constexpr int kCounters = 2;
  static constexpr int64_t kMaxCode = 0xffff;
  static constexpr int64_t kMaxCount = 0xffffff;
  static constexpr int64_t kZeroCode = 0x8000;  // the code nearest to 0 V of +/-10 V

  // What goes wrong with the board, or in the driver's process, at its next reading. All but the first eight
  // happen once.
  enum Order : int64_t {
    kNothing,
    kReadsFail,
    kWritesFail,
    kNextWriteFails,
    kInterrupt,   // every other read or write is interrupted by a signal
    kInput0High,  // analog input 0 is beyond its range
    kInput0Open,  // analog input 0 reads 0 V: its wire is broken
    kOutputLies,  // an output reads back as its highest code, whatever it is
    kLastToStay = kOutputLies,
    kThrow,        // a std::exception
    kThrowNumber,  // something that is none
    kTerminate,
    kExit,
    kQuickExit,
    kUnderscoreExit,  // _exit()
    kAbort,
    kNullPointer,
    kStackOverflow,
  };

  int64_t magic = kMagic;
  int64_t order = kNothing;
  int64_t attended = 0;  // a process stands behind the board: readings wait for it
  uint32_t request = 0;  // the doorbell: counted up by the driver, then `reply` by the process
  uint32_t reply = 0;
  int64_t asked_ns = 0;  // steady clock: for which moment the driver asks
  // Registers.
  int64_t inputs[kInputs] = {};
  int64_t counters[kCounters] = {};
  int64_t outputs[kOutputs] = {};
  int64_t lines = 0;       // one bit each
  int64_t directions = 0;  // 1: output
  // What the driver did.
  int64_t opened = 0;
  int64_t closed = 0;
  int64_t reads = 0;
  int64_t delayed_reads = 0;
  int64_t writes = 0;
  int64_t nonzero_writes = 0;
  int64_t line_writes = 0;
  int64_t edges = 0;  // changes of line 0
  // What the process behind it says.
  int64_t enabled = 0;  // the watchdog lets the voltage through
  int64_t trips = 0;    // how often it stopped to, while a driver had the board open
  double time_s = 0;
  double voltage = 0;  // V of eq. (1), at the motor
  double p1 = 0;
  double p2 = 0;
  double motor_speed = 0;
  double arm_angle = 0;
};

// Maps the file, which CreateBoard() or the other side made. Null, with errno, when it is none.
SimulatedBoard* MapBoard(const char* file, int* fd);

// Makes the file, its outputs as a program that crashed would leave them: not at zero.
SimulatedBoard* CreateBoard(const char* file);

}  // namespace hydro::testing
