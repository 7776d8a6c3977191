// What is known about parameters and effects.
#include "model/terms/parameter_info.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/table1.h"

namespace hydro::testing {
namespace {

// Tests that every member of Parameters has one entry, and that Table 1 lies within all bounds.
TEST(BaseParameters, AreComplete) {
  std::set<std::string> names;
  model::Parameters marked;
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    EXPECT_TRUE(names.insert(parameter.info.name).second) << parameter.info.name;
    EXPECT_FALSE(parameter.info.unit.empty());
    EXPECT_FALSE(parameter.info.meaning.empty());
    EXPECT_EQ(marked.*parameter.member, 0) << parameter.info.name << " shares a member";
    marked.*parameter.member = 1;
    const double value = Table1().*parameter.member;
    EXPECT_TRUE(parameter.info.min_allowed ? value >= parameter.info.min : value > parameter.info.min);
    EXPECT_LE(value, parameter.info.max);
  }
  EXPECT_EQ(names.size() * sizeof(double), sizeof(model::Parameters));
}

// Tests that the catalogue is ordered, and that each entry is complete and is found by its id.
TEST(EffectCatalogue, IsComplete) {
  std::string previous;
  for (const model::EffectInfo& effect : model::EffectCatalogue()) {
    EXPECT_LT(previous, effect.id);
    previous = effect.id;
    EXPECT_FALSE(effect.summary.empty());
    EXPECT_FALSE(effect.equation.empty());
    EXPECT_FALSE(effect.parameters.empty());
    EXPECT_EQ(model::FindEffect(effect.id), &effect);
    for (const model::ParameterInfo& parameter : effect.parameters) {
      if (parameter.is_name()) continue;
      const double example = parameter.example;
      EXPECT_NE(example, 0) << effect.id << "." << parameter.name << " needs an example";
      EXPECT_TRUE(example >= parameter.min && example <= parameter.max) << effect.id << "." << parameter.name;
    }
  }
  for (const char* id : {"amp.lag", "line.wave", "pump.pressure_friction", "pump.stribeck"}) {
    EXPECT_NE(model::FindEffect(id), nullptr) << id;
  }
  EXPECT_EQ(model::FindEffect("pump.unknown"), nullptr);
}

// Tests that a parameter's entry is found by its effect and its name, and that no other name has one.
TEST(EffectCatalogue, EntryOfAParameter) {
  EXPECT_EQ(model::ParameterOf({"pump.stribeck", {}, {}}, "speed").unit, "rad/s");
  EXPECT_THROW(model::ParameterOf({"pump.stribeck", {}, {}}, "mass"), model::ModelError);
  EXPECT_THROW(model::ParameterOf({"pump.unknown", {}, {}}, "speed"), model::ModelError);
}

}  // namespace
}  // namespace hydro::testing
