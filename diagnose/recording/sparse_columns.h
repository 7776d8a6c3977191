// Columns of which most rows are empty: those of a slower sensor are evenly so, others have lost values.
#pragma once

#include <string>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// "missing in 80 % of the rows, and not evenly, as of a slower device" where more than the share `most` of
// the values is missing and at least 5 % of the run lacks them at the rate that they have elsewhere; else "".
// A sensor may be even in rows or in time, as in a table that joins two devices.
std::string UnevenlyMissing(const std::vector<double>& time, const std::vector<double>& values, double most);
// Of a sensor that lacks less, what is missing is missing (recording_remarks.h).
inline constexpr double kSlowerSensor = 0.5;

// One line for each sensor of which that is so. The runs are as read: what later counts as missing, because
// it repeats itself, is not.
std::vector<std::string> SparseSensorRemarks(const std::vector<runs::MeasuredRun>& runs);

// The same of the commands that a table has, for the run's line; "" where too few are missing to say so.
std::string UnevenCommands(const runs::MeasuredRun& run);
// One line for each such run: among `lost`, or among `changes` where the command is another each time it is
// written, as it is with a recorder that writes changes only, which is right.
void AddCommandRemarks(const std::vector<runs::MeasuredRun>& runs, std::vector<std::string>* lost,
                       std::vector<std::string>* changes);

}  // namespace hydro::diagnose
