// Designs the experiment that separates models which explain the runs equally well.
#pragma once

#include <string>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/recording/run_data.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Chooses a trial among voltages over 3 s (squares, sines slow enough to creep through 0, chirps, staircases;
// each about 0 and about an offset) and ways to hold the shaft. It takes the trial in which the rivals'
// predictions differ most, in noise units, after base parameters have absorbed what they can of the
// difference. No trial leaves the range of voltage, pressure, speed and arm angle that the runs have seen.
// `rivals` has at least two models, each as fitted. `config` is a stack whose model is "model.toml" beside
// it; "" when no experiment distinguishes the rivals or none can be simulated. `why` is passed on.
NextExperiment DesignNextExperiment(const std::vector<model::ModelDescription>& rivals,
                                    const std::vector<const RunData*>& runs, const std::string& why);

}  // namespace hydro::diagnose
