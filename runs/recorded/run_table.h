// The table of a run: what hydro-log export writes and import reads.
#pragma once

#include <array>
#include <string>

#include "base/tables/table.h"
#include "base/unit_system.h"
#include "runs/recorded/run_log.h"

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

// One row for each plant tick (state message), in tick order; NaN where there is no value.
// - voltage_V acts from this row's tick until the next row's. A state carries the voltage that acted before
//   its tick, so each row takes the next state's; the last row takes that of the motor command that acts
//   next, if the log has it.
// - pressure_ref_psi is the reference in force for the pressure loop at this tick: that of this tick's motor
//   command or, without one, that of the last pressure command that could have arrived. There is none before
//   the first, and none in open loop.
// - arm_ref_rad is the last arm reference (signal ARM_ANGLE) up to this tick.
// Throws InputError when the log has no state, or states of more than one run.
tables::Table ExportRun(const RunLog& log);

// The name of a column of kRunColumns in exported tables of a run in these units: "p1_Pa" for "p1_psi".
std::string RunColumnIn(const UnitSystem& units, const std::string& column);

// Writes a log that ExportRun() turns back into the same table. The table may hold any subset of kRunColumns
// that includes time_s. It may also be in other units of one system, which the log then states. The given
// columns come back bit by bit, the others empty (tick: the row number from 0). `program_version` goes into
// the log's description. Events are stamped with time_s, so lcm-logplayer plays the log at the pace of the
// measurement. Throws InputError with file, row and column for unknown columns, a missing time_s, times that
// do not increase and ticks that are not increasing whole numbers; throws WriteError.
void ImportRun(const tables::Table& table, const std::string& program_version, const std::string& log_file);

}  // namespace hydro::runs
