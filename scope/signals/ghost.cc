#include "scope/signals/ghost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/input_error.h"
#include "base/maths/spread.h"
#include "base/number_text.h"
#include "model/terms/model_error.h"
#include "model/terms/state.h"

namespace hydro::scope {
namespace {

constexpr size_t kWindow = 2048;
constexpr size_t kUpdateAfter = 512;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// A second difference of independent samples has sqrt(1 + 4 + 1) times their deviation; the median of a
// normal distribution's absolute values is 0.67449 times its deviation.
constexpr double kOfNormal = 0.6744897501960817 * 2.449489742783178;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kSlopeSamples = 8;  // samples for the rate of an angle where no speed is measured
constexpr double kTolerance = 1e-6;  // far below any noise, and five times as fast as the plant's own 1e-8

double& At(Ghost::Row& row, GhostColumn column) { return row[static_cast<size_t>(column)]; }

}  // namespace

NoiseEstimate::NoiseEstimate() : before_(kNotKnown), last_(kNotKnown), sigma_(kNotKnown) {}

void NoiseEstimate::Add(double value) {
  const double difference = std::abs(before_ - 2 * last_ + value);
  before_ = last_;
  last_ = value;
  if (std::isnan(difference)) return;
  if (differences_.size() < kWindow) {
    differences_.push_back(difference);
  } else {
    differences_[next_] = difference;
    next_ = (next_ + 1) % kWindow;
  }
  const bool first = std::isnan(sigma_) && differences_.size() == kFirst;
  if (++fresh_ >= kUpdateAfter || first) Update();
}

void NoiseEstimate::Update() {
  fresh_ = 0;
  if (differences_.size() < kFirst) return;
  const double middle = maths::Median(differences_);
  sigma_ = middle > 0 ? middle / kOfNormal : kNotKnown;
}

Ghost::Ghost(std::shared_ptr<const settings::StackConfig> config, double resync_s)
    : config_(std::move(config)), resync_s_(resync_s) {
  if (!(resync_s >= 0 && std::isfinite(resync_s))) {
    throw InputError("resync_s: found " + ShortestNumber(resync_s) + ", allowed is 0 (never) or above");
  }
  if (config_->model.motion) motion_ = settings::MakeTrajectory(*config_->model.motion);
}

Ghost::~Ghost() = default;

std::optional<double> Ghost::Slope(double model::Measurement::*angle) const {
  const GhostSample& first = newest_.front();
  const GhostSample& last = newest_.back();
  if (!(last.time > first.time)) return std::nullopt;
  const double slope = (last.measured.*angle - first.measured.*angle) / (last.time - first.time);
  return std::isfinite(slope) ? std::optional(slope) : std::nullopt;
}

void Ghost::Start(const GhostSample& sample) {
  actuator_.reset();
  model::Measurement begin = sample.measured;
  const auto fill = [&](double model::Measurement::*speed, double model::Measurement::*angle) {
    if (!std::isfinite(begin.*speed)) begin.*speed = Slope(angle).value_or(kMissing);
  };
  fill(&model::Measurement::motor_speed, &model::Measurement::motor_angle);
  fill(&model::Measurement::arm_speed, &model::Measurement::arm_angle);
  if (!std::isfinite(begin.motor_angle)) begin.motor_angle = 0;
  const model::StartState start = model::StartOf(begin, config_->model.shaft);
  for (size_t i = 0; i < 6; ++i) {
    if (std::isfinite(start[i])) continue;
    if (newest_.size() >= kSlopeSamples) problem_ = "a state that it begins from is not measured";
    return;
  }
  model::ActuatorOptions options;
  options.shaft = config_->model.shaft;
  options.arm_angle = config_->model.arm_angle_rad;
  options.motion = motion_.get();
  options.bypass = config_->model.bypass;
  options.integrator = config_->plant.integrator;
  options.relative_tolerance = std::max(kTolerance, config_->plant.relative_tolerance);
  try {
    actuator_.emplace(config_->model.description, options, start, sample.time);
    started_ = sample.time;
    sync_ = false;
    ++starts_;
  } catch (const model::ModelError& error) {
    problem_ = error.what();
  }
}

double Ghost::Sigma(double given, double resolution, const NoiseEstimate& estimate) const {
  // Rounding to a grid is also noise, spread evenly over one step.
  const double known = std::hypot(given, resolution / std::sqrt(12.0));
  return known > 0 ? known : estimate.sigma();
}

std::optional<Ghost::Row> Ghost::Add(const GhostSample& sample) {
  if (sample.after_gap) {
    newest_.clear();
    actuator_.reset();
    for (NoiseEstimate* estimate : {&p1_, &p2_, &motor_speed_}) estimate->Add(kMissing);
  }
  newest_.push_back(sample);
  if (newest_.size() > kSlopeSamples) newest_.pop_front();
  const model::Measurement& measured = sample.measured;
  p1_.Add(measured.p1);
  p2_.Add(measured.p2);
  motor_speed_.Add(measured.motor_speed);
  if (actuator_ && std::isfinite(sample.voltage)) {
    try {
      actuator_->Advance(sample.voltage, sample.time);
    } catch (const model::ModelError& error) {
      problem_ = error.what();
      actuator_.reset();
    }
  }
  const bool fresh = !actuator_;
  if (fresh) Start(sample);
  if (!actuator_) return std::nullopt;
  const model::Measurement ghost = actuator_->Measure();
  const settings::NoiseSection& noise = config_->noise;
  Row row;
  At(row, GhostColumn::kP1) = ghost.p1;
  At(row, GhostColumn::kP2) = ghost.p2;
  At(row, GhostColumn::kDp) = ghost.p2 - ghost.p1;
  At(row, GhostColumn::kMotorSpeed) = ghost.motor_speed;
  At(row, GhostColumn::kArmAngle) = ghost.arm_angle;
  const auto residual = [&](double of, double model, double sigma) {
    return fresh ? kMissing : (of - model) / sigma;
  };
  At(row, GhostColumn::kResidualP1) =
      residual(measured.p1, ghost.p1, Sigma(noise.p1_psi, noise.p1_resolution_psi, p1_));
  At(row, GhostColumn::kResidualP2) =
      residual(measured.p2, ghost.p2, Sigma(noise.p2_psi, noise.p2_resolution_psi, p2_));
  At(row, GhostColumn::kResidualMotorSpeed) =
      residual(measured.motor_speed, ghost.motor_speed,
               Sigma(noise.motor_speed_rad_s, noise.motor_speed_resolution_rad_s, motor_speed_));
  const bool due = resync_s_ > 0 && sample.time - started_ >= resync_s_;
  if (!fresh && (due || sync_)) Start(sample);  // this row still belongs to the ghost before
  return row;
}

}  // namespace hydro::scope
