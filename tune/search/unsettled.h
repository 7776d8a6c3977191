// Why an arm does not settle after a step: the limit that keeps it from that.
#pragma once

#include <string>

#include "tune/search/step_judge.h"

namespace hydro::tune {

// Tries the step, and names what keeps the arm from settling within kNeverSettled times the shortest time:
// "limits.pressure 200 psi ends the run at 263 psi", "the motor is at its torque T_pmax 40 in-lbf in 71 % of
// that time". Where no limit is reached, it says so: then it is the gains. Empty: the arm settles.
std::string WhyUnsettled(const StepJudge& judge, const Gains& gains, const StepCase& step);

// rad: how far from its target friction may hold the arm with these gains.
double FrictionError(const settings::StackConfig& config, const Gains& gains);

}  // namespace hydro::tune
