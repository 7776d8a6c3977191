// The scale of torques and flows: what no run can show, and prior knowledge decides.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

// Nothing in a run has the unit of a torque of the motor or of a flow: a model whose torques and flows are
// all larger by one factor, and its volumes with them, predicts the same angles, pressures and voltages to
// the last digit. Nearly so does a model with a larger volume and a larger bulk modulus. An estimate that
// holds one torque therefore puts that torque's error into all other values, also into those that are known
// best.
//
// Moves those of `model`'s values that have places in `base` (BaseParameters()), and the torques and flows of
// its effects, by these two factors to where they are likeliest, by how well `given` knows its values
// ([uncertainty]). One value that is far off is likelier than many that are a little off: the tails are those
// of Cauchy's distribution. A value that one of the `changes` calls wrong holds no scale. Nothing moves
// unless that gains more than is worth a mention, or where k_1 or D may not move: in a bare motor, all that
// is known of the others is measured by k_1.
void MoveToLikeliestScale(const model::ModelDescription& given, const std::vector<size_t>& base,
                          const std::vector<Change>& changes, model::ModelDescription* model);
// The same for what a fit has found.
void MoveToLikeliestScale(const model::ModelDescription& given, Hypothesis* hypothesis);

// Whether a free number grows with all torques of the motor: it is one, or a friction or inertia.
bool FollowsTorques(const model::ModelDescription& model, const FreeParameter& parameter);

}  // namespace hydro::diagnose
