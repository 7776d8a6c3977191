// What happens to a stack in one run, and when. It holds everything on which a run depends, as text that
// people can read and `hydro-torture --replay` can run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/torture/schedule/injection.h"

namespace hydro::torture {

struct Schedule {
  uint64_t seed = 1;            // seed of latencies, clocks, sessions and start times
  bool lockstep = false;        // time.mode
  bool key = false;             // messages are sealed
  bool logger = false;          // a logger records; otherwise there is none, and its faults do nothing
  bool logger_required = true;  // logger.required
  bool launcher =
      false;  // a launcher starts, watches and stops the others; otherwise each is restarted by itself
  bool driver = false;   // the plant is a driver with a simulated board
  bool planner = false;  // a planner sets the arm's reference: reference.kind
  bool limb = false;     // the stack is a joint, the hip, of a limb whose knee has processes of its own
  bool explicit_rearm = false;        // limits.rearm
  double stale_input_s = 0.1;         // limits.stale_input_s
  double faults_until_s = 12;         // by which all faults have ended
  std::vector<Injection> injections;  // sorted by time
};

// Draws a schedule.
Schedule DrawSchedule(uint64_t seed);

// One line for the run and one for every injection.
std::string ScheduleText(const Schedule& schedule);

// Reads ScheduleText(); throws InputError that names `file` and the line.
Schedule ReadSchedule(const std::string& file, const std::string& text);

}  // namespace hydro::torture
