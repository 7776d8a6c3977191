// Whether numbers that were found can be true of a rig.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// "moves by a factor of 3" where a base parameter moves by more than a factor of 2; "" otherwise, and where it
// was given as 0.
std::string WhyRemarkable(const ChangedParameter& changed);

// One line for each number that no rig has, by decades: a base parameter that moves by a factor of 10 or more,
// and its interval by more than 2; of an effect of motor or pump a torque above T_pmax; pressures above a tenth
// of the bulk modulus, times above half a second, and what the table in plausible.cc limits by name.
std::vector<std::string> Implausible(const std::vector<ChangedParameter>& parameters,
                                     const std::vector<FoundEffect>& effects, const model::Parameters& given);

}  // namespace hydro::diagnose
