// Models whose numbers are legal but absurd.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/random.h"
#include "model/effects/catalogue.h"
#include "settings/model_file.h"
#include "sim/simulation.h"
#include "tests/model/some_of_each.h"
#include "tests/table1.h"
#include "tune/design/fastest_motion.h"

namespace hydro::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// The motor is shaken, so that each effect acts within ten ticks.
constexpr char kShakenConfig[] = R"([model]
file = "m.toml"
shaft = "free"
[time]
mode = "lockstep"
duration_s = 0.01
[plant]
rate_hz = 1000
[pressure]
k_p = 0.1
k_v = 1.0
[position]
sample_interval_s = 0.001
[reference]
signal = "voltage"
kind = "sine"
amplitude = 8.0
frequency_hz = 150.0
[limits]
motor_speed = inf
)";

const std::vector<double> kExtremes = {0,    5e-324, 1e-320, 1e-300,  1e-30, 1e-12, 1e9,
                                       1e18, 1e30,   1e308,  -1e-320, -1e30, -1e308};

// What becomes of ten ticks of a model: "refused: ...", "failed: ..." or "done".
std::string OutcomeOf(const model::ModelDescription& model) {
  const std::string text = settings::FormatModel(model);
  try {
    const settings::StackConfig config =
        settings::ParseStackConfig(kShakenConfig, "stack.toml", text, "m.toml");
    CheckSimulates(config);
    design::FastMotionRemark(config);
    const SimulationResult result = Simulate(config, {});
    if (result.exit_code == 0) return result.ticks == 10 ? "done" : "wrong: " + std::to_string(result.ticks);
    return "failed: " + result.failure;
  } catch (const InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

// Every outcome but a hang: the test's time limit is for those.
void ExpectEnds(const model::ModelDescription& model, const std::string& what) {
  const std::string outcome = OutcomeOf(model);
  EXPECT_THAT(outcome, Not(HasSubstr("\n"))) << what;
  EXPECT_THAT(outcome, Not(HasSubstr("wrong: "))) << what;
  if (outcome.starts_with("failed: ")) {
    EXPECT_THAT(outcome, HasSubstr("tick ")) << what;
  }
}

// The same value in each place of a model that is a number, in turn.
template <class Act>
void ForEachNumber(const Act& act) {
  const model::ModelDescription plain{.name = "plain", .parameters = testing::Table1(), .effects = {}};
  for (const model::BaseParameter& base : model::BaseParameters()) {
    model::ModelDescription model = plain;
    act(&model, &(model.parameters.*base.member), base.info.name);
  }
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    for (const model::ParameterInfo& parameter : info.parameters) {
      if (!parameter.is_number()) continue;
      model::ModelDescription model = plain;
      model.effects = {testing::ExampleOf(info)};
      act(&model, &model.effects[0].parameters[parameter.name], info.id + "." + parameter.name);
    }
  }
}

// Tests that each number of a model, however absurd, is refused on one line or ends within its bound of work.
TEST(ExtremeModelsTest, OneNumber) {
  int done = 0;
  ForEachNumber([&](model::ModelDescription* model, double* value, const std::string& name) {
    for (const double extreme : kExtremes) {
      *value = extreme;
      ExpectEnds(*model, name + " = " + NumberText(extreme));
    }
    *value = 1;
    done += OutcomeOf(*model) == "done";
  });
  EXPECT_GT(done, 20) << "the models are good but for the number";
}

// Tests the same of models with several such numbers and effects.
TEST(ExtremeModelsTest, SeveralNumbers) {
  const std::vector<model::EffectInfo>& catalogue = model::EffectCatalogue();
  for (uint64_t seed = 0; seed < 150; ++seed) {
    uint64_t drawn = 0;
    const auto draw = [&](size_t size) { return Scatter(Scatter(seed) ^ ++drawn) % size; };
    model::ModelDescription model{.name = "drawn", .parameters = testing::Table1(), .effects = {}};
    for (int i = 0; i < 2; ++i) {
      const model::EffectInfo& info = catalogue[draw(catalogue.size())];
      if (!model.effects.empty() && model.effects[0].id == info.id) continue;
      model.effects.push_back(testing::ExampleOf(info));
      for (auto& [name, value] : model.effects.back().parameters) {
        if (draw(2) == 0) value = kExtremes[draw(kExtremes.size())];
      }
    }
    for (size_t i = draw(3); i > 0; --i) {
      const model::BaseParameter& base = model::BaseParameters()[draw(model::BaseParameters().size())];
      model.parameters.*base.member = kExtremes[draw(kExtremes.size())];
    }
    ExpectEnds(model, "seed " + std::to_string(seed));
  }
}

// Tests that a model file's numbers that no machine has are refused with the key, what was found and what is
// allowed.
TEST(ExtremeModelsTest, Refusals) {
  const auto outcome = [](const std::string& name, double extreme) {
    std::string found;
    ForEachNumber([&](model::ModelDescription* model, double* value, const std::string& one) {
      if (one != name) return;
      *value = extreme;
      found = OutcomeOf(*model);
    });
    return found;
  };
  for (const auto& [name, extreme, allowed] :
       {std::tuple("b", 1e-320, "of a size of at least 2.225e-308"),
        {"J_a", 1e-300, "above 0, of a size of at least 1e-30"},
        {"sensor.pressure_lag.tau", 1e-320, "above 0, of a size of at least 1e-30"},
        {"pump.turbulent_leakage.k", 1e308, "of a size of at most 1e+30"},
        {"motor.cogging.periods", 1e9, "at most 1000; at a usual speed more would pass within each tick"},
        {"motor.cogging.periods", 1e18, "at most 1000"}}) {
    const std::string key = std::string(name).substr(std::string(name).rfind('.') + 1);
    EXPECT_THAT(outcome(name, extreme),
                AllOf(HasSubstr("refused: m.toml:"), HasSubstr(key + ": found "), HasSubstr(allowed)));
  }
}

// Tests that a model that is too fast for the integrator ends after so many steps, and that the line names
// tick, state and the number that is likely the cause.
TEST(ExtremeModelsTest, TooFast) {
  model::ModelDescription model{.name = "fast", .parameters = testing::Table1(), .effects = {}};
  model.parameters.J_a = 1e-9;
  EXPECT_THAT(OutcomeOf(model),
              AllOf(HasSubstr("too fast to simulate: more than 200000 steps within 0.01 s at t = "),
                    HasSubstr("motor_speed = "), HasSubstr(", before tick "),
                    HasSubstr("; the cause may be J_a = 1e-09 lbf-in-s^2, where 23 is usual")));
}

}  // namespace
}  // namespace hydro::sim
