#include "diagnose/recording/recording_mistake.h"

#include <algorithm>
#include <cmath>

#include "runs/measured/measured_run.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

void Multiply(double factor, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) value *= factor;
  if (signal->noise.has_value()) *signal->noise *= std::abs(factor);
  signal->source.scale *= factor;
  signal->source.offset *= factor;
}

void ReadAsSigned(double span, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) {
    if ((value - signal->source.offset) / span > 0.5) value -= span;
  }
}

double MeanOf(const std::vector<double>& values) {
  double sum = 0, count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

const char* NameOf(SignalOfRun signal) { return runs::RowOf(signal).ours; }

bool RecordingMistake::IsSign() const { return !factors.empty() && factors[0].second == -1; }

bool RecordingMistake::IsOfUnknownUnit() const { return !factors.empty() && unit.empty() && !IsSign(); }

bool RecordingMistake::IsOfOnePressure() const {
  return factors.size() == 1 && (factors[0].first == &Run::p1 || factors[0].first == &Run::p2);
}

std::string RecordingMistake::InvertedSensor() const {
  const bool sensor = factors.size() == 1 && IsSign() && factors[0].first != &Run::voltage;
  return sensor ? NameOf(factors[0].first) : "";
}

bool Exclude(const RecordingMistake& a, const RecordingMistake& b) {
  if ((a.time_factor != 1 && b.time_factor != 1) || (a.pressures_exchanged && b.pressures_exchanged))
    return true;
  if (a.shaft.has_value() && b.shaft.has_value()) return true;
  if (a.unsigned_signal.has_value() && a.unsigned_signal == b.unsigned_signal) return true;
  if (a.IsSign() != b.IsSign()) return false;
  // Two pressures in one unit count as a mistake of their own.
  const bool pressures = a.IsOfOnePressure() && b.IsOfOnePressure();
  if (pressures && a.unit == b.unit) return true;
  return std::ranges::any_of(a.factors, [&](const auto& one) {
    return std::ranges::any_of(b.factors, [&](const auto& other) { return one.first == other.first; });
  });
}

void Correct(const RecordingMistake& mistake, Run* run) {
  for (double& time : run->time) time *= mistake.time_factor;
  if (run->begun.has_value()) *run->begun *= mistake.time_factor;
  run->time_source.scale *= mistake.time_factor;
  run->time_source.offset *= mistake.time_factor;
  if (mistake.unsigned_signal.has_value()) ReadAsSigned(mistake.span, &(run->**mistake.unsigned_signal));
  for (const auto& [signal, factor] : mistake.factors) Multiply(factor, &(run->*signal));
  if (mistake.pressures_exchanged) std::swap(run->p1, run->p2);
  if (!mistake.shaft.has_value()) return;
  run->shaft = *mistake.shaft;
  if (run->shaft == model::Shaft::kClamped && run->arm_angle.measured()) {
    run->arm_angle_rad = MeanOf(run->arm_angle.values);
  }
}

}  // namespace hydro::diagnose
