// One configuration, whose values are texts with units, drives the same rig in the same way whatever units
// the rig's model is in.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <hydro/state_t.hpp>
#include <string>
#include <utility>
#include <vector>

#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"
#include "tests/model_in_units.h"
#include "tests/temporary_folder.h"
#include "tune/design/loop_check.h"

namespace hydro::sim {
namespace {

// What a linear rig has in the place of an angle: an inch of its stroke for each rad.
std::string ConfigText(bool linear) {
  std::string text = R"([model]
file = "model.toml"
arm_angle = "0.05 ARM"
[time]
duration_s = 1.2
[plant]
rate_hz = 1000
relative_tolerance = 1e-10
[pressure]
natural_frequency_rad_s = 150
damping_ratio = 0.5
reference_feedforward = true
arm_speed_feedforward = true
[position]
c1 = "6000 psi/ARM"
c2 = "1200 psi s/ARM"
braking = "120 ARM/s^2"
[reference]
steps = [[0.2, "0.3 ARM"], ["700 ms", "-0.1 ARM"]]
[limits]
arm_torque = "500 TORQUE"
pressure = "130 bar"
arm_angle = "0.7 ARM"
)";
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from))
      text.replace(at, from.size(), to);
  };
  replace("TORQUE", linear ? "lbf" : "in-lbf");
  replace("ARM", linear ? "in" : "rad");
  return text;
}

struct Motion {
  int exit_code = 1;
  std::vector<state_t> states;
};

settings::StackConfig ConfigOf(const std::string& config_text, const model::ModelDescription& model) {
  return settings::ParseStackConfig(config_text, "stack.toml", settings::FormatModel(model), "model.toml");
}

Motion MotionOf(const std::string& config_text, const model::ModelDescription& model) {
  const settings::StackConfig config = ConfigOf(config_text, model);
  Motion motion;
  motion.exit_code = Simulate(config, [&](const bus::RawMessage& message) {
                       if (!std::string(message.channel).starts_with("HYDRO_STATE")) return;
                       state_t state;
                       EXPECT_GT(state.decode(message.data, 0, static_cast<int>(message.size)), 0);
                       motion.states.push_back(state);
                     }).exit_code;
  return motion;
}

struct Signal {
  double state_t::*value;
  const char* unit;
  int arm;
};
constexpr Signal kSignals[] = {{&state_t::motor_angle, "rad", 0}, {&state_t::motor_speed, "rad/s", 0},
                               {&state_t::arm_angle, "rad", 1},   {&state_t::arm_speed, "rad/s", 1},
                               {&state_t::p1, "psi", 0},          {&state_t::p2, "psi", 0},
                               {&state_t::voltage, "V", 0}};

// The largest difference of a signal in `units` from the same in the paper's, over the signal's size.
double Difference(const Motion& first, const UnitSystem& paper, const Motion& other,
                  const UnitSystem& units) {
  double worst = 0;
  for (const Signal& signal : kSignals) {
    const double factor = hydro::testing::Factor(signal.unit, signal.arm, units, paper);
    double size = 0, difference = 0;
    for (size_t k = 0; k < first.states.size(); ++k) {
      const double wanted = first.states[k].*signal.value;
      size = std::max(size, std::abs(wanted));
      difference = std::max(difference, std::abs(factor * (other.states[k].*signal.value) - wanted));
    }
    worst = std::max(worst, size > 0 ? difference / size : difference);
  }
  return worst;
}

// Every shipped model of a rotary actuator in the paper's units; a weight is added, which none of them moves
// but one.
std::vector<model::ModelDescription> ShippedModels() {
  std::vector<model::ModelDescription> models;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(HYDRO_SOURCE_DIR) / "config/models")) {
    model::ModelDescription model = settings::LoadModelFile(entry.path().string());
    if (model.units.linear_arm)
      continue;  // a cylinder, whose loops are others (differential_cylinder_test.cc)
    models.push_back(hydro::testing::InUnits(std::move(model), {}));
    models.back().name = entry.path().stem().string();
    if (models.back().parameters.mgl == 0) models.back().parameters.mgl = 60;
  }
  return models;
}

// Tests that the whole stack with every shipped model moves in the same way in all systems of units, also as
// a linear rig whose piston has the actuator's displacement as its area.
TEST(SameInAllUnits, EveryShippedModel) {
  const std::vector<model::ModelDescription> models = ShippedModels();
  EXPECT_GE(models.size(), 5u);
  for (model::ModelDescription model : models) {
    for (const bool linear : {false, true}) {
      model.units.linear_arm = linear;
      const Motion first = MotionOf(ConfigText(linear), model);
      ASSERT_EQ(first.exit_code, 0) << model.name;
      ASSERT_EQ(first.states.size(), 1201u);
      EXPECT_GT(std::abs(first.states[600].arm_angle), 0.1) << model.name << ": the arm moves";
      for (const UnitSystem& system : hydro::testing::kSystems) {
        const UnitSystem units = hydro::testing::WithArm(system, linear);
        const Motion other = MotionOf(ConfigText(linear), hydro::testing::InUnits(model, units));
        ASSERT_EQ(other.states.size(), first.states.size()) << model.name << " in " << units.length;
        EXPECT_LT(Difference(first, model.units, other, units), 1e-9)
            << model.name << (linear ? ", linear, in " : " in ") << units.length;
      }
    }
  }
}

// Relative to 1 or more; a margin may be infinite. Double poles near z = 1 keep half of a number's digits,
// and a margin follows from where they go.
void ExpectAlike(double found, double wanted, const std::string& where) {
  if (found == wanted) return;
  EXPECT_NEAR(found, wanted, 1e-4 * std::max(1.0, std::abs(wanted))) << where;
}

// Tests that the loops of every shipped model are judged alike, with the same margins.
TEST(SameInAllUnits, LoopsAreJudgedAlike) {
  for (model::ModelDescription model : ShippedModels()) {
    for (const bool linear : {false, true}) {
      model.units.linear_arm = linear;
      const design::LoopCheck first = design::CheckLoops(ConfigOf(ConfigText(linear), model));
      ASSERT_TRUE(first.pressure && first.position) << model.name;
      for (const UnitSystem& system : hydro::testing::kSystems) {
        const UnitSystem units = hydro::testing::WithArm(system, linear);
        const design::LoopCheck other =
            design::CheckLoops(ConfigOf(ConfigText(linear), hydro::testing::InUnits(model, units)));
        ASSERT_TRUE(other.pressure && other.position) << model.name << " in " << units.length;
        EXPECT_EQ(other.stable(), first.stable());
        for (const auto loop : {&design::LoopCheck::pressure, &design::LoopCheck::position}) {
          const design::LoopMargins &wanted = (first.*loop)->worst, &found = (other.*loop)->worst;
          const std::string where = model.name + " in " + std::string(units.length);
          ExpectAlike(found.gain, wanted.gain, where + ", gain");
          ExpectAlike(found.phase_deg, wanted.phase_deg, where + ", phase");
          ExpectAlike(found.spectral_radius, wanted.spectral_radius, where + ", radius");
          ExpectAlike(found.damping_ratio, wanted.damping_ratio, where + ", damping");
        }
      }
    }
  }
}

// Two joints of an arm with weight, whose models are `hip` and `knee`; each link is as heavy in every system.
constexpr char kLimb[] = R"([limb]
on_joint_fault = "all_to_zero"
[arm]
gravity = "9.81 m/s^2"
payload = "0.5 kg"
[[arm.link]]
mass = "4 kg"
length = "300 mm"
centre = "15 cm"
inertia = "0.05 kg m^2"
[[arm.link]]
mass = "2 kg"
length = "10 in"
centre = "5 in"
inertia = "0.02 kg m^2"
[[joint]]
name = "hip"
[joint.model]
file = "hip.toml"
[[joint]]
name = "knee"
[joint.model]
file = "knee.toml"
[joint.reference]
steps = [[0.1, "-0.2 ARM"]]
)";

// The motion of each joint.
std::vector<Motion> LimbMotion(const std::filesystem::path& folder, const model::ModelDescription& hip,
                               const model::ModelDescription& knee) {
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  write("hip.toml", settings::FormatModel(hip));
  write("knee.toml", settings::FormatModel(knee));
  std::string common = ConfigText(false), joints = kLimb;
  common.erase(common.find("file = "), common.find("arm_angle") - common.find("file = "));
  joints.replace(joints.find("ARM"), 3, "rad");
  write("limb.toml", common + joints);
  std::vector<Motion> motions(2);
  const settings::LimbConfig limb = settings::LoadLimbConfig((folder / "limb.toml").string());
  const int exit_code = SimulateLimb(limb, [&](const bus::RawMessage& message) {
                          const std::string channel(message.channel);
                          for (size_t i = 0; i < motions.size(); ++i) {
                            if (channel != "HYDRO_STATE" + limb.joints[i].config.bus.channel_suffix) continue;
                            state_t state;
                            EXPECT_GT(state.decode(message.data, 0, static_cast<int>(message.size)), 0);
                            motions[i].states.push_back(state);
                          }
                        }).exit_code;
  for (Motion& motion : motions) motion.exit_code = exit_code;
  return motions;
}

// Joints of an arm are integrated to 1e-5 at best (CoupledArmOptions), and their steps depend on roundings. A
// unit that is taken for another shows by far more.
constexpr double kLimbsAlike = 2e-3;

// Tests the same of a limb, whose joints load each other by an arm, with every shipped model.
TEST(SameInAllUnits, Limbs) {
  const TemporaryFolder folder;
  const std::vector<model::ModelDescription> models = ShippedModels();
  for (size_t m = 0; m < models.size(); ++m) {
    const model::ModelDescription &hip = models[m], &knee = models[(m + 1) % models.size()];
    const std::vector<Motion> first = LimbMotion(folder.path(), hip, knee);
    ASSERT_EQ(first[1].states.size(), 1201u) << hip.name;
    EXPECT_EQ(first[0].exit_code, 0) << hip.name;
    EXPECT_GT(std::abs(first[0].states[600].arm_angle - first[0].states[0].arm_angle), 1e-4) << hip.name;
    EXPECT_GT(std::abs(first[1].states[600].arm_angle - first[1].states[0].arm_angle), 1e-4) << knee.name;
    for (const UnitSystem& units : hydro::testing::kSystems) {
      const std::vector<Motion> other = LimbMotion(folder.path(), hydro::testing::InUnits(hip, units),
                                                   hydro::testing::InUnits(knee, units));
      for (size_t i = 0; i < first.size(); ++i) {
        ASSERT_EQ(other[i].states.size(), first[i].states.size()) << hip.name << " in " << units.length;
        EXPECT_LT(Difference(first[i], hip.units, other[i], units), kLimbsAlike)
            << hip.name << " and " << knee.name << ", joint " << i << ", in " << units.length;
      }
    }
  }
}

}  // namespace
}  // namespace hydro::sim
