// Samples of a recording that are not measurements: values held while the recorder lost samples, and spikes.
#pragma once

#include <string>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::diagnose {

// Makes such samples missing values (NaN), and cuts a run in two where rows are lost across a step of the
// command, because nobody knows when the command stepped. A part that is too short to be a run is left out. Returns
// a line for each signal and cut, with run, signal and count; empty when there is nothing of the kind, and
// the runs then stay unchanged.
//
// A value is held when a signal that has noise repeats it for longer than chance allows; an encoder's steps, a
// slow sensor and the end of a sensor's range are none. A spike is a single sample far outside all of its neighbours.
std::vector<std::string> SetAsideDamage(std::vector<runs::MeasuredRun>* runs);

}  // namespace hydro::diagnose
