// What to write into a sidecar to undo a mistake.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/recording_mistake.h"

namespace hydro::diagnose {

// The lines of the run's sidecar, separated by "; ", that undo these mistakes. "" where only a factor without
// a unit is known.
std::string SidecarLines(const std::vector<RecordingMistake>& mistakes, const runs::MeasuredRun& run);

// The line of the run's sidecar that gives the signal this source.
std::string LineOf(const runs::MeasuredRun& run, SignalOfRun signal, const runs::ColumnSource& source);

}  // namespace hydro::diagnose
