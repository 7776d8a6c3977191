// The table of a run: what hydro-log export writes and import reads.
#pragma once

#include <array>
#include <string>

#include "runs/run_log.h"
#include "tables/table.h"

namespace hydro::runs {

// The columns of every exported table, in order.
inline constexpr std::array<const char*, 11> kRunColumns = {"time_s",
                                                            "tick",
                                                            "voltage_V",
                                                            "pressure_ref_psi",
                                                            "arm_ref_rad",
                                                            "motor_angle_rad",
                                                            "motor_speed_rad_s",
                                                            "arm_angle_rad",
                                                            "arm_speed_rad_s",
                                                            "p1_psi",
                                                            "p2_psi"};

// One row a plant tick (state message), in order of ticks; NaN where there is no value.
// - voltage_V acts from this row's tick until the next row's. state_t.voltage is what acted before its tick,
// so it is the
//   next state's; the last row has the voltage of the motor command that acts next, if the log has it.
// - pressure_ref_psi is what was in force for the pressure loop at this tick: the motor command's of this
// tick; where
//   there is none, the last pressure command's that could have arrived. None before the first, and none in
//   open loop.
// - arm_ref_rad is the last arm reference's (of signal ARM_ANGLE) at this tick or before.
// Throws InputError when the log has no state, or the states of more than one run.
tables::Table ExportRun(const RunLog& log);

// Writes the log that ExportRun() turns into the same table: for any subset of kRunColumns that has time_s,
// the columns given come back bit by bit and the others empty (tick: the row number from 0).
// `program_version` goes into the log's description. Events are received at time_s, so that lcm-logplayer
// plays the log at the pace of the measurement. Throws InputError naming file, row and column: unknown
// columns, no time_s, times that do not increase, ticks that are not increasing whole numbers; WriteError.
void ImportRun(const tables::Table& table, const std::string& program_version, const std::string& log_file);

}  // namespace hydro::runs
