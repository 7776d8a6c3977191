// What a free arm carries, as a recording shows it.
#pragma once

#include <optional>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// The model with the weight of a free arm that its measured motion needs in this window, eq. (15): gravity and friction
// that the model lacks are as good as constant there. Empty where pressures or the arm's angle are missing.
std::optional<model::ModelDescription> WithLoadOf(const model::ModelDescription& model,
                                                  const runs::MeasuredRun& window);

}  // namespace hydro::diagnose
