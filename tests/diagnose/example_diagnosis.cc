#include "tests/diagnose/example_diagnosis.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/table1.h"

namespace hydro::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A motor that turns back and forth; `before` overshoots at reversals, `after` does not.
diagnose::RunCurves Curves(const std::string& run, bool held_out, size_t samples, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  diagnose::RunCurves curves;
  curves.run = run;
  curves.held_out = held_out;
  curves.curves = {{model::Channel::kMotorSpeed, {}, {}, {}},
                   {model::Channel::kP1, {}, {}, {}},
                   {model::Channel::kP2, {}, {}, {}}};
  for (size_t i = 0; i < samples; ++i) {
    const double t = 5.0 * static_cast<double>(i) / static_cast<double>(samples);
    const double speed = 120 * std::sin(2 * t) + 20 * std::sin(9 * t);
    const double off = std::exp(-std::abs(speed) / 30) * (speed > 0 ? 1 : -1);
    curves.time.push_back(t);
    const double values[3] = {speed, 500 - 350 * std::sin(2 * t + 0.4), 500 + 350 * std::sin(2 * t + 0.4)};
    const double noise[3] = {0.3, 1.5, 1.5};
    const double sizes[3] = {9, -60, 60};
    for (size_t c = 0; c < 3; ++c) {
      diagnose::RunCurves::Curve& curve = curves.curves[c];
      curve.measured.push_back(i % 97 == 13 ? kNan : values[c] + noise[c] * normal(random));
      curve.before.push_back(values[c] + sizes[c] * off);
      curve.after.push_back(values[c]);
    }
  }
  return curves;
}

diagnose::MeasuredCurve FrictionTerm(const std::string& effect = "") {
  diagnose::MeasuredCurve term{effect, "pump_torque", "in-lbf", "motor_speed", "rad/s", {}, {}, {}};
  for (int i = -10; i <= 10; ++i) {
    term.at.push_back(12.0 * i);
    term.measured.push_back(2 * std::exp(-std::abs(i) / 2.5) * (i > 0 ? 1 : i < 0 ? -1 : 0));
    term.error.push_back(0.08 + 0.01 * std::abs(i));
  }
  if (!effect.empty()) term.found = term.measured;
  return term;
}

std::vector<diagnose::FoundEffect> Effects() {
  diagnose::FoundEffect stribeck{
      "pump.stribeck",
      "static friction above kinetic",
      "T_s becomes T_s (1 + static_excess exp(-(abs(theta')/speed)^2)), T_s (1 + static_excess) "
      "at rest",
      {{"static_excess", 0.52, 0.47, 0.57, "1"}, {"speed", 3.1, 2.5, 3.7, "rad/s"}},
      {},
      {}};
  diagnose::FoundEffect warming{"fluid.warming",
                                "viscous friction and leakage drift as the oil warms",
                                "b exp(-rate t), c_E and c_I exp(+rate t)",
                                {{"rate", 0.011, 0.004, 0.018, "1/s"}},
                                {},
                                {"sensor.skew"}};
  diagnose::FoundEffect skew{"sensor.skew",
                             "one channel is late",
                             "one channel is late by delay",
                             {{"delay", 0.0021, 0.0019, 0.0023, "s"}},
                             {"signal = p1"},
                             {"fluid.warming"}};
  stribeck.share = 0.86;
  stribeck.weight = 0.95;
  return {stribeck, warming, skew};
}

// The numbers of the gaps, and the parameters.
void FillGaps(diagnose::Diagnosis* diagnosis) {
  diagnose::Diagnosis& d = *diagnosis;
  d.parameters = {{{"b", 0.0203, 0.0199, 0.0207, "in-lbf-s"}, 0.01455, false, ""},
                  {{"J", 0.12, 0.09, 0.15, "lbf-in-s^2"}, 0.03, true, "four times what the model says"},
                  {{"p_3", 103, kNan, kNan, "psi"}, 100, false, ""}};
  d.signals = {{model::Channel::kMotorSpeed, 0.3, {7.2, 6.5, 0.31}, {7.9, 7.0, 0.33}},
               {model::Channel::kP1, 1.5, {41.0, 30.0, 1.6}, {44.0, 31.0, 1.6}},
               {model::Channel::kP2, 1.62, {41.5, 30.5, 1.65}, {45.0, 32.0, 1.7}}};
  d.fit = {22.1, 18.0, 1.04};
  d.held_out = {23.9, 19.5, 1.06};
  d.compared = {{12, 10, 1.04}, 0.4};
  d.horizons = {{0.1, {5, 4, 1.0}, {6, 5, 1.02}, {}},
                {0.4, {11, 9, 1.01}, {12, 10, 1.04}, {}},
                {1.6, {18, 15, 1.02}, {19, 16, 1.05}, {}}};
}

}  // namespace

diagnose::Diagnosis ExampleDiagnosis(size_t samples) {
  diagnose::Diagnosis d;
  d.verdict = diagnose::Verdict::kTied;
  d.sentence =
      "The pump's static friction exceeds its kinetic friction (pump.stribeck), and its friction drifts, "
      "which "
      "these runs cannot tell from a temperature.";
  d.remarks = {"p2 is noisier than stated: 1.62 psi instead of 1.5 psi.",
               "arm_angle was not measured, so eq. (15) could not be checked."};
  d.location = {{"pump_torque",
                 0.93,
                 "|motor_speed| < 5 rad/s, at reversals",
                 {{"square <wave>", 1.4, 1.75}, {"square <wave>", 3.0, 3.3}, {"sine", 1.5, 1.7}}},
                {"flow_2", 0.05, "p2 > 700 psi", {}}};
  d.missing = {FrictionTerm()};
  d.terms = {FrictionTerm("pump.stribeck")};
  d.stretches = {{"sensor.skew",
                  "sine",
                  model::Channel::kP1,
                  {1, 1.1, 1.2},
                  {101, 149, 251},
                  {100, 150, 250},
                  {100, 200, 300}}};
  d.effects = Effects();
  FillGaps(&d);
  d.next = {
      "A slow triangle of +/- 200 psi, held at +/- 20 rad/s, would tell fluid.warming from sensor.skew.",
      "[model]\nfile = \"model.toml\"\n", 6.4};
  d.candidates = {
      {"pump.stribeck", 1.1, 1.12, 1e-12, "", 0.875},
      {"pump.friction_asymmetry", 12.0, 15.1, 0.002, "the held-out gap stays 13 times as large", 0.125},
      {"sensor.pressure_lag", kNan, kNan, 0.8, "no significant gain expected <by its score>"},
      {"parameter k_1", 18.0, 19.5, 0.04, "explains less than pump.stribeck"}};
  d.explanations = {{{"pump.stribeck"}, 0.8125},
                    {{"closure.pump_torque(motor_speed)"}, 0.125},
                    {{"pump.stribeck", "run.T_s"}, 0.05},
                    {{}, 0.0125}};
  d.set_90 = 2;
  d.curves = {Curves("square <wave>", false, samples, 1), Curves("sine", true, samples, 2)};
  d.model = {"bench & rig",
             Table1(),
             {{"pump.stribeck", {{"static_excess", 0.52}, {"speed", 3.1}}, {}},
              {"fluid.warming", {{"rate", 0.011}}, {}},
              {"sensor.skew", {{"delay", 0.0021}}, {{"signal", "p1"}}}}};
  d.runs = {"square <wave>", "sine"};
  d.samples = 2 * samples;
  return d;
}

diagnose::Diagnosis EmptyDiagnosis() {
  diagnose::Diagnosis d;
  d.verdict = diagnose::Verdict::kNothingMissing;
  d.sentence = "The model as given explains the data to the noise.";
  d.fit = d.held_out = d.compared.gap = {1.01, 1.0, 1.01};
  d.model = {"Table 1", Table1(), {}};
  d.runs = {"step"};
  d.samples = 500;
  return d;
}

}  // namespace hydro::testing
