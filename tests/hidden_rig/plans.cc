#include "plans.h"

#include <random>

namespace hidden_rig {

namespace {

using Kind = Segment::Kind;
using Form = Segment::Form;

Segment Hold(Kind kind, double start, double value) { return {kind, Form::kHold, start, value, 0, 0, 0, 0}; }
Segment Ramp(Kind kind, double start, double end, double from, double to) {
  return {kind, Form::kRamp, start, from, to - from, 0, 0, end};
}
Segment Sine(Kind kind, double start, double offset, double amplitude, double hz) {
  return {kind, Form::kSine, start, offset, amplitude, hz, 0, 0};
}
Segment Square(Kind kind, double start, double offset, double amplitude, double hz) {
  return {kind, Form::kSquare, start, offset, amplitude, hz, 0, 0};
}
Segment Chirp(Kind kind, double start, double end, double offset, double amplitude, double hz,
              double hz_end) {
  return {kind, Form::kChirp, start, offset, amplitude, hz, hz_end, end};
}

}  // namespace

std::vector<Plan> Plans(uint64_t seed, double seconds, bool driven) {
  std::mt19937_64 engine(seed * 7919 + 17);
  // Within +/- 10 % of what is written.
  const auto about = [&](double value) {
    return value * (0.9 + 0.2 * (static_cast<double>(engine() >> 11) * 0x1p-53));
  };
  // Times are written for 2.5 s.
  const double s = seconds / 2.5;
  constexpr Kind kV = Kind::kVoltage, kP = Kind::kPressure, kA = Kind::kAngle;
  std::vector<Plan> plans;

  plans.push_back({"run 1", Shaft::kClamped, 0, true, {}, 0, 0});
  plans.back().segments = {Hold(kV, 0, 0),
                           Hold(kV, 0.03 * s, 11.2),
                           Hold(kV, 0.25 * s, about(3.6)),
                           Hold(kV, 0.55 * s, -11.2),
                           Hold(kV, 0.95 * s, about(-3.4)),
                           Hold(kV, 1.2 * s, about(5.0)),
                           Ramp(kV, 1.45 * s, 2.1 * s, about(2.0), about(-2.6)),
                           Sine(kV, 2.1 * s, 0, about(2.6), 6 / s)};
  plans.push_back({"run 2", Shaft::kClamped, 0, true, {}, 0, 0});
  plans.back().segments = {Hold(kV, 0, 0),
                           Sine(kV, 0.03 * s, 0, about(5.5), 2.2 / s),
                           Hold(kV, 0.9 * s, about(-10.8)),
                           Hold(kV, 1.1 * s, about(-2.4)),
                           Ramp(kV, 1.4 * s, 1.9 * s, about(-1.6), about(1.7)),
                           Hold(kV, 1.9 * s, 11.0),
                           Hold(kV, 2.12 * s, about(2.2)),
                           Hold(kV, 2.35 * s, about(-3))};
  plans.push_back({"run 3", Shaft::kClamped, 0, false, {}, 0, 0});
  plans.back().segments = {Hold(kV, 0, 0),
                           Hold(kV, 0.03 * s, about(1.5)),
                           Ramp(kV, 0.3 * s, 0.6 * s, about(1.6), about(3.0)),
                           Hold(kV, 0.6 * s, about(-1.8)),
                           Square(kP, 0.8 * s, about(100), about(800), 4.5 / s),
                           Sine(kP, 1.4 * s, about(300), about(900), 4 / s),
                           Chirp(kP, 1.9 * s, 2.5 * s, 0, about(500), 4 / s, 20 / s)};
  plans.push_back({"run 4", Shaft::kClamped, 0.35, false, {}, 0, 0});
  plans.back().segments = {Hold(kV, 0, 0),
                           Hold(kV, 0.03 * s, about(-2.6)),
                           Hold(kV, 0.25 * s, about(-1.4)),
                           Hold(kV, 0.5 * s, about(2.8)),
                           Hold(kV, 0.75 * s, about(1.4)),
                           Sine(kP, 1.0 * s, 0, about(600), 8 / s),
                           Square(kP, 1.4 * s, about(-150), about(750), 5 / s),
                           Hold(kV, 2.0 * s, about(-11)),
                           Hold(kV, 2.02 * s, about(-1.8)),
                           Hold(kV, 2.3 * s, about(1.2))};
  plans.push_back({"run 5", Shaft::kFree, 0, false, {}, 0, 0});
  plans.back().segments = {Hold(kA, 0, 0), Hold(kA, 0.05 * s, about(0.2)), Hold(kA, 0.8 * s, about(-0.15)),
                           Sine(kA, 1.5 * s, about(-0.05), about(0.12), 2.0 / s), Hold(kA, 2.2 * s, 0)};
  plans.push_back({"run 6", Shaft::kFree, -0.1, false, {}, 0, 0});
  plans.back().segments = {Hold(kA, 0, -0.1), Hold(kA, 0.05 * s, about(-0.3)),
                           Sine(kA, 0.75 * s, about(-0.1), about(0.3), 1.2 / s),
                           Hold(kA, 1.65 * s, about(0.1)), Hold(kA, 2.0 * s, about(0.02))};
  if (driven) {
    plans.push_back({"run 7", Shaft::kDriven, 0, false, {}, 0.2, 0.8 / s});
    plans.back().segments = {Hold(kV, 0, 0), Sine(kV, 0.1 * s, 0, about(2.5), 3 / s)};
  }
  return plans;
}

}  // namespace hidden_rig
