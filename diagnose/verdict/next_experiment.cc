#include "diagnose/verdict/next_experiment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "model/response.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

constexpr double kDuration = 3;     // s
constexpr double kRate = 1000;      // Hz
constexpr size_t kStride = 5;       // one sample in this many is compared
constexpr double kHeadroom = 1.05;  // over what the rig has seen
constexpr size_t kFinalists = 3;  // for each way to hold the shaft: trials that base parameters are fitted to
constexpr double kWorthwhile = 1;  // noise units; below this the models look the same

// What the rig has been through, and how precisely its sensors measure.
struct Rig {
  double voltage = 0, pressure = 0, speed = 0;
  double low_angle = std::numeric_limits<double>::infinity(), high_angle = -low_angle;
  bool free = false, clamped = false;
  std::array<double, model::kChannels> noise{};  // 0: not measured
};

Rig Inspect(const std::vector<const RunData*>& runs) {
  Rig rig;
  for (const RunData* run : runs) {
    for (const double v : run->stimulus.voltage) rig.voltage = std::max(rig.voltage, std::abs(v));
    (run->stimulus.shaft == model::Shaft::kFree ? rig.free : rig.clamped) = true;
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

struct Trial {
  model::Shaft shaft = model::Shaft::kClamped;
  double arm_angle = 0;
  bool bypass = false;
  std::string reference;  // keys of the [reference] table
  std::shared_ptr<const trajectory::Trajectory> voltage;
  double separation = 0;
};

std::string Text(const char* format, double a, double b = 0, double c = 0, double d = 0) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

double Rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::strtod(text, nullptr);
}

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
      for (const double frequency : {0.7, 2.5}) {
        add(Text("kind = \"square\"\noffset = %.10g\namplitude = %.10g\nfrequency_hz = %.10g\n", offset,
                 amplitude, frequency),
            trajectory::MakeSquare(offset, amplitude, frequency, 0));
      }
      add(Text("kind = \"sine\"\noffset = %.10g\namplitude = %.10g\nfrequency_hz = 0.5\n", offset, amplitude),
          trajectory::MakeSine(offset, amplitude, 0.5, 0, 0));
      add(Text("kind = \"chirp\"\noffset = %.10g\namplitude = %.10g\nfirst_frequency_hz = 0.5\n"
               "last_frequency_hz = 30.0\nduration_s = %.10g\n",
               offset, amplitude, kDuration),
          trajectory::MakeChirp(offset, amplitude, 0.5, 30, 0, kDuration));
    }
    // Up, down past 0 and back: each level lasts long enough to settle, in both directions.
    std::vector<trajectory::Step> steps;
    std::string text = "kind = \"steps\"\nsteps = [";
    constexpr double kLevels[] = {0.3, 0.6, 1, 0.5, 0.1, -0.3, -0.6, -1, -0.5, -0.1, 0.8, -0.8};
    for (const double level : kLevels) {
      const double time = kDuration * static_cast<double>(steps.size()) / std::size(kLevels);
      steps.push_back({time, Rounded(level * part * largest)});
      text += (steps.size() > 1 ? ", " : "") + Text("[%.10g, %.10g]", time, steps.back().value);
    }
    add(text + "]\n", trajectory::MakeSteps(0, steps));
  }
  return all;
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
    // An arm that was clamped in one place can be clamped in others.
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

model::Response Predict(const model::ModelDescription& model, const Trial& trial,
                        const std::vector<model::Unknown>& unknowns) {
  model::ResponseOptions options;
  options.stride = kStride;
  const double p_3 = model.parameters.p_3;
  return model::Respond(model, StimulusOf(trial), {0, 0, p_3, p_3, trial.arm_angle, 0}, unknowns, options);
}

bool Inside(const model::Response& response, const Rig& rig, bool free) {
  const auto largest = [&](model::Channel channel) {
    double size = 0;
    for (const double value : response.values[static_cast<size_t>(channel)]) {
      size = std::max(size, std::abs(value));
    }
    return size;
  };
  if (rig.speed > 0 && largest(model::Channel::kMotorSpeed) > kHeadroom * rig.speed) return false;
  if (rig.pressure > 0 &&
      std::max(largest(model::Channel::kP1), largest(model::Channel::kP2)) > kHeadroom * rig.pressure) {
    return false;
  }
  if (!free) return true;
  const double slack = (kHeadroom - 1) * (rig.high_angle - rig.low_angle);
  for (const double angle : response.values[static_cast<size_t>(model::Channel::kArmAngle)]) {
    if (angle < rig.low_angle - slack || angle > rig.high_angle + slack) return false;
  }
  return true;
}

// A response's signals in noise units, stacked into one vector.
Eigen::VectorXd InNoise(const std::array<std::vector<double>, model::kChannels>& values, const Rig& rig) {
  std::vector<double> all;
  for (size_t channel = 0; channel < model::kChannels; ++channel) {
    if (rig.noise[channel] == 0) continue;
    for (const double value : values[channel]) all.push_back(value / rig.noise[channel]);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

double Rms(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0 : values.norm() / std::sqrt(static_cast<double>(values.size()));
}

// The smallest root-mean-square difference between two rivals; with `absorb`, after the base parameters of
// either have taken up what they can of it. Nothing when the trial leaves the rig's limits or cannot be
// simulated.
std::optional<double> Separation(const std::vector<model::ModelDescription>& rivals, const Trial& trial,
                                 const Rig& rig, bool absorb) {
  std::vector<model::Unknown> unknowns;
  if (absorb) {
    for (size_t i = 0; i < model::BaseParameters().size(); ++i)
      unknowns.push_back({model::Unknown::Kind::kBase, i});
  }
  std::vector<Eigen::VectorXd> predicted;
  std::vector<Eigen::MatrixXd> sensitivities;
  try {
    for (const model::ModelDescription& rival : rivals) {
      const model::Response response = Predict(rival, trial, unknowns);
      if (!Inside(response, rig, trial.shaft == model::Shaft::kFree)) return std::nullopt;
      predicted.push_back(InNoise(response.values, rig));
      if (!absorb) continue;
      Eigen::MatrixXd matrix(predicted.back().size(), static_cast<Eigen::Index>(unknowns.size()));
      for (size_t i = 0; i < unknowns.size(); ++i) {
        Eigen::VectorXd column = InNoise(response.derivatives[i], rig);
        const double size = column.norm();
        if (size > 0) column /= size;
        matrix.col(static_cast<Eigen::Index>(i)) = column;
      }
      sensitivities.push_back(std::move(matrix));
    }
  } catch (const model::ModelError&) {
    return std::nullopt;
  }
  double smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < rivals.size(); ++i) {
    for (size_t j = 0; j < rivals.size(); ++j) {
      if (i == j || (!absorb && j < i)) continue;
      Eigen::VectorXd difference = predicted[j] - predicted[i];
      if (absorb) {
        const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(sensitivities[i]);
        difference -= sensitivities[i] * qr.solve(difference);
      }
      const double rms = Rms(difference);
      if (!std::isfinite(rms)) return std::nullopt;
      smallest = std::min(smallest, rms);
    }
  }
  return smallest;
}

std::string Config(const Trial& trial, const Rig& rig) {
  std::string text = "# An experiment that tells models apart that the recorded runs do not.\n\n[model]\n";
  text += "file = \"model.toml\"\n";
  text += std::string("shaft = \"") + (trial.shaft == model::Shaft::kFree ? "free" : "clamped") + "\"\n";
  text += Text("arm_angle_rad = %.10g\n", trial.arm_angle);
  text += std::string("bypass = ") + (trial.bypass ? "true" : "false") + "\n\n[time]\nmode = \"lockstep\"\n";
  text += Text("duration_s = %.10g\n\n[plant]\nrate_hz = %.10g\n\n[pressure]\nk_p = 0.0\nk_v = 0.0\n\n",
               kDuration, kRate);
  text += "[reference]\nsignal = \"voltage\"  # past both loops\n" + trial.reference;
  // Limits somewhat above the prediction: a fault would end the run.
  if (rig.pressure > 0) text += Text("\n[limits]\npressure_psi = %.10g\n", std::ceil(1.2 * rig.pressure));
  return text;
}

}  // namespace

NextExperiment DesignNextExperiment(const std::vector<model::ModelDescription>& rivals,
                                    const std::vector<const RunData*>& runs, const std::string& why) {
  NextExperiment next;
  next.why = why;
  if (rivals.size() < 2 || runs.empty()) return next;
  const Rig rig = Inspect(runs);
  if (!(rig.voltage > 0)) return next;
  std::vector<Trial> trials = Trials(rig, rivals.front().parameters);
  const auto judge = [&](bool absorb) {
    for (Trial& trial : trials) {
      trial.separation = Separation(rivals, trial, rig, absorb).value_or(-1);
    }
    std::erase_if(trials, [](const Trial& trial) { return trial.separation < kWorthwhile; });
    std::stable_sort(trials.begin(), trials.end(),
                     [](const Trial& a, const Trial& b) { return a.separation > b.separation; });
  };
  judge(false);
  std::vector<Trial> finalists;
  for (const Trial& trial : trials) {
    const auto alike = std::count_if(finalists.begin(), finalists.end(), [&](const Trial& other) {
      return other.shaft == trial.shaft && other.arm_angle == trial.arm_angle && other.bypass == trial.bypass;
    });
    if (static_cast<size_t>(alike) < kFinalists) finalists.push_back(trial);
  }
  trials = std::move(finalists);
  judge(true);
  if (trials.empty()) return next;
  next.config = Config(trials.front(), rig);
  next.expected_separation = trials.front().separation;
  return next;
}

}  // namespace hydro::diagnose
