#include "diagnose/say/trials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace hydro::diagnose {
namespace {

constexpr double kDuration = 3;  // s
constexpr double kRate = 1000;   // Hz

// Lines of TOML.
std::string Key(const std::string& key, double value) { return key + " = " + ShortestNumber(value) + "\n"; }
std::string Kind(const std::string& kind) { return "kind = \"" + kind + "\"\n"; }

double Rounded(double value) { return ParseNumber(ShortNumber(value, 3)).value_or(0); }

std::vector<Trial> Voltages(double largest) {
  std::vector<Trial> all;
  const auto add = [&](std::string reference, std::unique_ptr<trajectory::Trajectory> voltage) {
    Trial trial;
    trial.reference = std::move(reference);
    trial.voltage = std::move(voltage);
    all.push_back(std::move(trial));
  };
  for (const double part : {0.4, 0.7, 1.0}) {
    for (const double mean : {0.0, 0.4}) {
      const double offset = Rounded(mean * part * largest);
      const double amplitude = Rounded((1 - mean) * part * largest);
      const std::string size = Key("offset", offset) + Key("amplitude", amplitude);
      for (const double frequency : {0.7, 2.5}) {
        add(Kind("square") + size + Key("frequency_hz", frequency),
            trajectory::MakeSquare(offset, amplitude, frequency, 0));
      }
      add(Kind("sine") + size + Key("frequency_hz", 0.5), trajectory::MakeSine(offset, amplitude, 0.5, 0, 0));
      add(Kind("chirp") + size + Key("first_frequency_hz", 0.5) + Key("last_frequency_hz", 30) +
              Key("duration_s", kDuration),
          trajectory::MakeChirp(offset, amplitude, 0.5, 30, 0, kDuration));
    }
    // Up, down past 0 and back. Each level lasts long enough to settle, in both directions.
    std::vector<trajectory::Step> steps;
    std::string text = Kind("steps") + "steps = [";
    constexpr double kLevels[] = {0.3, 0.6, 1, 0.5, 0.1, -0.3, -0.6, -1, -0.5, -0.1, 0.8, -0.8};
    for (const double level : kLevels) {
      const double time = kDuration * static_cast<double>(steps.size()) / std::size(kLevels);
      steps.push_back({time, Rounded(level * part * largest)});
      text += (steps.size() > 1 ? ", [" : "[") + ShortestNumber(time) + ", " +
              ShortestNumber(steps.back().value) + "]";
    }
    add(text + "]\n", trajectory::MakeSteps(0, steps));
  }
  return all;
}

}  // namespace

Rig Inspect(const std::vector<const RunData*>& runs) {
  Rig rig;
  for (const RunData* run : runs) {
    for (const double v : run->stimulus.voltage) rig.voltage = std::max(rig.voltage, std::abs(v));
    rig.free = rig.free || run->stimulus.shaft == model::Shaft::kFree;
    const auto angle = [&](double value) {
      rig.low_angle = std::min(rig.low_angle, value);
      rig.high_angle = std::max(rig.high_angle, value);
    };
    if (run->stimulus.shaft == model::Shaft::kClamped) angle(run->stimulus.arm_angle);
    if (run->stimulus.motion != nullptr) {
      angle(run->stimulus.motion->Min());
      angle(run->stimulus.motion->Max());
    }
    for (const SignalData& signal : run->signals) {
      const size_t channel = static_cast<size_t>(signal.channel);
      const double noise = std::max(signal.noise, 1e-9);
      rig.noise[channel] = rig.noise[channel] == 0 ? noise : std::min(rig.noise[channel], noise);
      for (const double value : signal.values) {
        if (std::isnan(value)) continue;
        if (signal.channel == model::Channel::kArmAngle) angle(value);
        if (signal.channel == model::Channel::kMotorSpeed) rig.speed = std::max(rig.speed, std::abs(value));
        if (signal.channel == model::Channel::kP1 || signal.channel == model::Channel::kP2) {
          rig.pressure = std::max(rig.pressure, value);
        }
      }
    }
  }
  if (rig.low_angle > rig.high_angle) rig.low_angle = rig.high_angle = 0;
  return rig;
}

std::vector<Trial> Trials(const Rig& rig, const model::Parameters& p) {
  std::vector<Trial> all;
  const auto held = [&](model::Shaft shaft, double angle, bool bypass) {
    for (Trial trial : Voltages(rig.voltage)) {
      trial.shaft = shaft;
      trial.arm_angle = Rounded(angle);
      trial.bypass = bypass;
      all.push_back(std::move(trial));
    }
  };
  double low = rig.low_angle, high = rig.high_angle;
  if (high - low < 0.1 * p.V_ms / p.c) {
    // An arm that was clamped in one place can also be clamped in others.
    low -= 0.4 * p.V_ms / p.c;
    high += 0.4 * p.V_ms / p.c;
    const double limit = 0.8 * p.V_ms / p.c;
    low = std::max(low, -limit);
    high = std::min(high, limit);
  }
  for (const double part : {0.0, 0.5, 1.0}) held(model::Shaft::kClamped, low + part * (high - low), false);
  if (rig.free) held(model::Shaft::kFree, 0.5 * (low + high), false);
  held(model::Shaft::kClamped, 0.5 * (low + high), true);
  return all;
}

model::Stimulus StimulusOf(const Trial& trial) {
  model::Stimulus stimulus;
  stimulus.shaft = trial.shaft;
  stimulus.arm_angle = trial.arm_angle;
  stimulus.bypass = trial.bypass;
  const size_t samples = static_cast<size_t>(kDuration * kRate);
  for (size_t k = 0; k < samples; ++k) {
    const double time = static_cast<double>(k) / kRate;
    stimulus.time.push_back(time);
    stimulus.voltage.push_back(trial.voltage->Value(time));
  }
  return stimulus;
}

std::string Configuration(const Trial& trial, const Rig& rig) {
  std::string text = "# An experiment that distinguishes models which the recorded runs do not.\n\n[model]\n";
  text += "file = \"model.toml\"\n";
  text += std::string("shaft = \"") + (trial.shaft == model::Shaft::kFree ? "free" : "clamped") + "\"\n";
  text += Key("arm_angle", trial.arm_angle);
  text += std::string("bypass = ") + (trial.bypass ? "true" : "false") + "\n\n[time]\nmode = \"lockstep\"\n";
  text += Key("duration_s", kDuration) + "\n[plant]\n" + Key("rate_hz", kRate);
  text += "\n[pressure]\nk_p = 0.0\nk_v = 0.0\n\n";
  text += "[reference]\nsignal = \"voltage\"  # bypasses both loops\n" + trial.reference;
  // Limits somewhat above the prediction, because a fault would end the run.
  if (rig.pressure > 0) text += "\n[limits]\n" + Key("pressure", std::ceil(1.2 * rig.pressure));
  return text;
}

}  // namespace hydro::diagnose
