// The gap finder treats parameters by their role: twins of the catalogue's effects, with ids, names and units
// as a user might choose, are treated like the originals. Without roles they are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "diagnose/diagnose.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/prove/propose.h"
#include "model/effects/catalogue.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using model::Role;
using ::testing::Contains;
using ::testing::Not;

// Registers an effect with the equation of another, with its parameters in the same order.
bool AddTwin(const std::string& id, std::unique_ptr<model::Effect> (*make)(const model::EffectDescription&),
             std::vector<model::ParameterInfo> parameters) {
  return model::AddToCatalogue({.info = {.id = id,
                                         .summary = "a twin",
                                         .equation = "as another",
                                         .confused_with = "its twin",
                                         .parameters = std::move(parameters)},
                                .make = make});
}
template <const char* kId>
std::unique_ptr<model::Effect> MakeAs(const model::EffectDescription& description) {
  return model::FindCatalogueEntry(kId)->make(description);
}

constexpr char kCogging[] = "motor.cogging", kRipple[] = "pump.flow_ripple", kLag[] = "amp.lag",
               kFriction[] = "pump.pressure_friction";

model::ParameterInfo Positive(const std::string& name, const std::string& unit, Role role) {
  return {
      .name = name, .unit = unit, .min_allowed = false, .meaning = "of a twin", .starts = {1}, .role = role};
}
model::ParameterInfo Any(const std::string& name, const std::string& unit, Role role) {
  return {.name = name, .unit = unit, .min = -model::kUnbounded, .meaning = "of a twin", .role = role};
}

[[maybe_unused]] const bool kAdded =
    AddTwin("own.runout", MakeAs<kCogging>,
            {Any("height", "lbf", Role::kTorqueWave), Positive("lobes", "per turn", Role::kPeriods),
             Any("mark", "radians", Role::kPhase)}) &&
    AddTwin(
        "own.swash", MakeAs<kRipple>,
        {Any("tilt", "part", Role::kDisplacementWave), Positive("pistons", "per turn", Role::kPeriods)}) &&
    AddTwin("own.lag", MakeAs<kLag>, {Positive("after", "seconds", Role::kTime)}) &&
    AddTwin("own.lag_without_role", MakeAs<kLag>, {Positive("after", "s", Role::kSize)}) &&
    AddTwin(
        "own.friction", MakeAs<kFriction>,
        {{.name = "more", .unit = "in-lbf/psi", .meaning = "of a twin", .adds_to = &model::Parameters::f}}) &&
    AddTwin("own.side", MakeAs<kFriction>,
            {{.name = "size", .unit = "1", .meaning = "of a twin"},
             {.name = "side", .unit = "name", .meaning = "of the pump", .names = {"left", "right"}}}) &&
    AddTwin("own.channel", MakeAs<kFriction>,
            {{.name = "size", .unit = "1", .meaning = "of a twin"},
             {.name = "of",
              .unit = "name",
              .meaning = "a channel",
              .names = {"p1", "arm_angle"},
              .role = Role::kChannel}});

// The numbers of the effect that the balances propose for runs of a rig that has it; empty where none does.
std::map<std::string, double> Proposed(const model::EffectDescription& effect) {
  const std::vector<diagnose::RunData> runs = OneOfEach(Table1With({effect}), 1.0, 1);
  diagnose::ProofContext context;
  context.given = Table1With();
  context.runs = PointersTo(runs);
  context.sizes = diagnose::SizesOf(context.given, context.runs);
  context.changes = {{effect.id, {}, ""}};
  for (const diagnose::Proposal& proposal : diagnose::Propose(context, {}).proposals) {
    if (!proposal.model.effects.empty()) return proposal.model.effects.back().parameters;
  }
  return {};
}

// Tests that what repeats within a turn is read off the balances, with the same numbers as for the
// catalogue's effects.
TEST(OwnRoles, PeriodsAreReadOffTheBalances) {
  const std::map<std::string, double> own =
      Proposed({"own.runout", {{"height", 1}, {"lobes", 12}, {"mark", 0.7}}, {}});
  const std::map<std::string, double> ours =
      Proposed({kCogging, {{"amplitude", 1}, {"periods", 12}, {"phase", 0.7}}, {}});
  ASSERT_FALSE(own.empty());
  EXPECT_EQ(own.at("lobes"), 12);
  EXPECT_NEAR(own.at("mark"), 0.7, 0.4);
  EXPECT_NEAR(own.at("height"), 1, 0.2);
  ASSERT_FALSE(ours.empty());
  EXPECT_EQ(own.at("height"), ours.at("amplitude"));
  EXPECT_EQ(own.at("lobes"), ours.at("periods"));
  EXPECT_EQ(own.at("mark"), ours.at("phase"));
}

// The 95 % interval of the only parameter of a lag.
diagnose::Interval IntervalOf(const std::string& id, const std::string& name,
                              const std::vector<diagnose::RunData>& runs) {
  const model::ModelDescription lagging = Table1With({{id, {{name, 0.002}}, {}}});
  const diagnose::Fitted fitted = diagnose::Fit(WithFree(lagging, {}), PointersTo(runs), StartsOf(runs), {});
  EXPECT_TRUE(fitted.ok());
  return diagnose::Intervals(fitted, PointersTo(runs), 1).at(0);
}

// Tests that the interval of a time allows for what is assumed to be immediate, whatever the unit is called.
TEST(OwnRoles, TimesAreNotSharperThanSensors) {
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With({{kLag, {{"tau", 0.002}}, {}}}), 1, 1);
  const diagnose::Interval ours = IntervalOf(kLag, "tau", runs), own = IntervalOf("own.lag", "after", runs),
                           without = IntervalOf("own.lag_without_role", "after", runs);
  EXPECT_EQ(own.low, ours.low);
  EXPECT_EQ(own.high, ours.high);
  EXPECT_LT(without.high - without.low, 0.9 * (own.high - own.low));
}

// The gap finder's ratings of the effects that it may name.
std::vector<std::string> Rated(double f, const std::vector<std::string>& effects) {
  model::ModelDescription given = Table1With();
  given.parameters.f = f;
  diagnose::DiagnoseOptions options;
  options.effects = effects;
  options.free = {"b"};
  const diagnose::RunData run = SmallRun(given, model::Shaft::kClamped, false, 0.4, 0, 1);
  std::vector<std::string> labels;
  for (const diagnose::Candidate& candidate :
       diagnose::Diagnose(given, {run.measured}, {}, options, {}).candidates) {
    labels.push_back(candidate.id);
  }
  return labels;
}

// Tests that an effect which only adds to a parameter of the model is left to that parameter.
TEST(OwnRoles, ATermOfTheModelIsNoEffect) {
  EXPECT_THAT(Rated(0, {"own.friction"}), Contains("own.friction"));
  EXPECT_THAT(Rated(1e-3, {"own.friction"}), Not(Contains("own.friction")));
}

// Tests that names are tried as they are, and channel names only where the runs have the channel.
TEST(OwnRoles, NamesOfChannelsNeedTheChannel) {
  const std::vector<std::string> rated = Rated(0, {"own.side", "own.channel"});
  EXPECT_THAT(rated, Contains("own.side (left)"));
  EXPECT_THAT(rated, Contains("own.side (right)"));
  EXPECT_THAT(rated, Contains("own.channel (p1)"));
  EXPECT_THAT(rated, Not(Contains("own.channel (arm_angle)")));
}

}  // namespace
}  // namespace hydro::testing
