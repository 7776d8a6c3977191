// The simulated machines of a limb whose joints move one arm ([arm]): gravity and inertia couple their loads.
#pragma once

#include <memory>
#include <vector>

#include "plant/simulated_rig.h"
#include "settings/limb_config.h"

namespace hydro::limb {

// Makes a machine for each joint, in the order of the configuration, which must have an arm. The machines
// advance together: the first one that is told to advance takes the others along, each under the voltage that
// it holds. Throws InputError.
std::vector<std::unique_ptr<plant::SimulatedMachine>> MakeJointedArm(const settings::LimbConfig& config);

}  // namespace hydro::limb
