// Samples of a recording that are not measurements: values held while the recorder lost samples, and spikes.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// Makes such samples missing values (NaN), and cuts a run in two where rows are lost across a step of the
// command, because the time of the step is then unknown. A part that is too short to be a run is left out.
// Returns a line for each signal and cut, with run, signal and count. When there is no damage, the result is
// empty and the runs stay unchanged.
//
// A value is held when a signal with noise repeats it for longer than chance allows. An encoder's steps, a
// slow sensor and the end of a sensor's range do not count as held, nor does most of a run during which the
// command does not change either. A spike is a single sample far outside all of its neighbours, or one of a
// few cells with a value that no sensor of the machine reads.
std::vector<std::string> SetAsideDamage(const model::ModelDescription& model,
                                        std::vector<runs::MeasuredRun>* runs);

}  // namespace hydro::diagnose
