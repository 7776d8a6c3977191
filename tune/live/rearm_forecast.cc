#include "tune/live/rearm_forecast.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "base/number_text.h"
#include "model/sides.h"
#include "settings/process_sections.h"
#include "tune/live/change_check.h"
#include "tune/live/rearm_words.h"

namespace hydro::tuning {
namespace {

using settings::ReferenceSignal;

constexpr int kSamples = 400;  // of the return, and of the time after it
constexpr size_t kMostBreaks = 100'000;

// The quantity that a reference refers to, in words and in the model's units; and the largest value that it
// has.
struct Referred {
  const char* quantity;
  const char* words;
  std::string unit;
  double present;
  double range;
};

Referred ReferredTo(const settings::StackConfig& config, const state_t& state) {
  const UnitSystem& units = config.model.description.units;
  const double pressure =
      model::LoadPressure(model::DifferencesOf(config.model.description).areas, state.p1, state.p2);
  const model::Parameters& p = config.model.description.parameters;
  const double most_pressure = p.T_pmax / p.D;  // what the motor can hold, eq. (3)
  switch (config.reference.signal) {
    case ReferenceSignal::kArmAngle:
      return {"arm_angle", "the arm", units.UnitFor("rad", 1), state.arm_angle, 2 * p.V_ms / p.c};
    case ReferenceSignal::kPressure:
      return {"pressure", "the pressure p2 - p1", units.UnitFor("psi"), pressure, most_pressure};
    case ReferenceSignal::kTorque:
      return {"torque", "the torque on the arm", units.UnitFor("in-lbf", -1), pressure * p.k_2,
              most_pressure * p.k_2};
    case ReferenceSignal::kVoltage:
      return {"voltage", "the voltage", "V", 0, p.T_pmax / p.k_1};
  }
  return {};
}

// What a forecast takes for no move: a count of the arm's encoder, or a millionth of the range.
double ResolutionOf(const settings::StackConfig& config, const Referred& referred) {
  constexpr double kShare = 1e-6;
  const double share = std::isfinite(referred.range) ? kShare * std::fabs(referred.range) : 0;
  const bool counts = config.driver && config.reference.signal == ReferenceSignal::kArmAngle &&
                      config.driver->arm_angle.source == settings::SensorSection::Source::kCounter;
  return counts ? std::max(share, std::fabs(config.driver->arm_angle.scale)) : share;
}

// The angle that a plan prescribes at a time (position_ctrl/plan_follower.cc: cubics between its points).
double PlannedAt(const arm_plan_t& plan, double time) {
  const auto behind = std::upper_bound(plan.time.begin(), plan.time.end(), time);
  if (behind == plan.time.begin()) return plan.arm_angle.front();
  if (behind == plan.time.end()) return plan.arm_angle.back();
  const auto i = static_cast<size_t>(behind - plan.time.begin()) - 1;
  const double h = plan.time[i + 1] - plan.time[i], s = (time - plan.time[i]) / h;
  const double a0 = plan.arm_angle[i], a1 = plan.arm_angle[i + 1];
  const double v0 = plan.arm_speed[i] * h, v1 = plan.arm_speed[i + 1] * h;
  return a0 + s * (v0 + s * (3 * (a1 - a0) - 2 * v0 - v1 + s * (2 * (a0 - a1) + v0 + v1)));
}

// The reference over plant time, as the position loop would have it without a hold.
class Wanted {
 public:
  Wanted(const settings::StackConfig& config, const HeardOfStack& heard)
      : from_(heard.in_force && heard.run->rate_hz > 0
                  ? static_cast<double>(heard.in_force->reference_from) / heard.run->rate_hz
                  : 0) {
    const settings::TrajectorySpec& spec = config.reference.trajectory;
    if (spec.kind != settings::TrajectorySpec::Kind::kPlanner) {
      trajectory_ = settings::MakeTrajectory(spec);
    } else {
      initial_ = spec.initial;
      if (heard.plan && !heard.plan->time.empty()) plan_ = &*heard.plan;
      // If no newer plan arrives in time, the reference holds.
      if (plan_ != nullptr && plan_->tick >= 0 && heard.run->rate_hz > 0)
        holds_from_ = static_cast<double>(plan_->tick) / heard.run->rate_hz + spec.delay_s + spec.timeout_s;
    }
  }

  double At(double time) const {
    if (trajectory_) return trajectory_->Value(time - from_);
    return plan_ == nullptr ? initial_ : PlannedAt(*plan_, std::min(time, holds_from_));
  }

  // Calls take(time, value before, value after) for each break of the reference in (begin, end], until it
  // returns false. The reference may jump at a break.
  template <class Take>
  void BreaksBetween(double begin, double end, Take take) const {
    if (!trajectory_) return;
    for (double t = trajectory_->NextBreak(begin - from_); t <= end - from_; t = trajectory_->NextBreak(t)) {
      if (!take(t + from_, trajectory_->Value(std::nextafter(t, -INFINITY)), trajectory_->Value(t))) return;
    }
  }

 private:
  double from_;  // s, when the reference begins
  std::unique_ptr<trajectory::Trajectory> trajectory_;
  double initial_ = 0;  // of a planner's reference, before its first plan
  const arm_plan_t* plan_ = nullptr;
  double holds_from_ = INFINITY;  // s
};

bool Differ(double a, double b) { return std::fabs(a - b) > 1e-9 * (std::fabs(a) + std::fabs(b)); }

bool JumpsBetween(const Wanted& wanted, double begin, double end) {
  bool jumps = false;
  wanted.BreaksBetween(begin, end, [&](double, double before, double after) {
    jumps = Differ(before, after);
    return !jumps;
  });
  return jumps;
}

// The return: a straight line from the current reference to the wanted one
// (position_ctrl/law/position_law.h).
void FollowTheReturn(const Wanted& wanted, double now, RearmForecast* forecast) {
  const double end = now + forecast->return_s;
  forecast->target = wanted.At(end);
  if (forecast->return_s == 0) {
    forecast->jumps = std::fabs(forecast->target - forecast->present) > forecast->resolution;
    return;
  }
  wanted.BreaksBetween(now, end, [&](double t, double before, double after) {
    const double by = (t - now) / forecast->return_s * (after - before);
    if (Differ(before, after) && std::fabs(by) > forecast->resolution)
      forecast->steps.push_back({t - now, by});
    return forecast->steps.size() < kMostSteps;
  });
  forecast->jumps = !forecast->steps.empty();
  const double step = forecast->return_s / kSamples;
  for (int i = 0; i < kSamples; ++i) {
    const double t0 = now + i * step, t1 = t0 + step;
    if (JumpsBetween(wanted, t0, t1)) continue;
    const auto at = [&](double t, double share) {
      return forecast->present + share * (wanted.At(t) - forecast->present);
    };
    const double from = at(t0, static_cast<double>(i) / kSamples), to = at(t1, (i + 1.0) / kSamples);
    forecast->top_rate = std::max(forecast->top_rate, std::fabs(to - from) / step);
  }
}

// The lowest and the highest point of the way back, where they are beyond its ends by more than a hundredth
// of it.
void FindTurns(const Wanted& wanted, double now, RearmForecast* forecast) {
  constexpr double kMaterial = 0.01;
  ReferenceTurn lowest = {0, forecast->present}, highest = lowest;
  const auto take = [&](double after, double wanted_then) {
    const double value = forecast->present + after / forecast->return_s * (wanted_then - forecast->present);
    if (value < lowest.at) lowest = {after, value};
    if (value > highest.at) highest = {after, value};
  };
  for (int i = 0; i <= kSamples; ++i) {
    const double after = forecast->return_s * i / kSamples;
    take(after, wanted.At(now + after));
  }
  size_t breaks = 0;
  wanted.BreaksBetween(now, now + forecast->return_s, [&](double t, double before, double after) {
    take(t - now, before);
    take(t - now, after);
    return ++breaks < kMostBreaks;
  });
  const double least = std::max(kMaterial * (highest.at - lowest.at), forecast->resolution);
  const auto [low, high] = std::minmax(forecast->present, forecast->target);
  if (low - lowest.at > least) forecast->turns.push_back(lowest);
  if (highest.at - high > least) forecast->turns.push_back(highest);
  std::sort(forecast->turns.begin(), forecast->turns.end(),
            [](const auto& a, const auto& b) { return a.after_s < b.after_s; });
}

// What the reference does after that.
void FollowTheReference(const Wanted& wanted, double begin, RearmForecast* forecast) {
  forecast->lowest = forecast->highest = forecast->last = forecast->target;
  bool rises = false, falls = false;
  const auto take = [&](double value) {
    forecast->lowest = std::min(forecast->lowest, value);
    forecast->highest = std::max(forecast->highest, value);
    if (Differ(value, forecast->last)) (value > forecast->last ? rises : falls) = true;
    forecast->last = value;
  };
  const double step = kForecast_s / kSamples;
  size_t breaks =
      0;  // pulses are shorter than the samples, but not each of a table's million points is asked for
  for (int i = 0; i < kSamples; ++i) {
    const double t = begin + i * step;
    take(wanted.At(t));
    wanted.BreaksBetween(t, t + step, [&](double, double before, double after) {
      take(before);
      take(after);
      return ++breaks < kMostBreaks;
    });
  }
  take(wanted.At(begin + kForecast_s));
  forecast->one_way = !(rises && falls);
}

// What a limit lets through of a reference that is no angle.
void FindMost(const settings::StackConfig& config, RearmForecast* forecast) {
  const model::Parameters& p = config.model.description.parameters;
  const UnitSystem& units = config.model.description.units;
  const auto narrow = [&](double most, const std::string& by) {
    if (most < forecast->most) {
      forecast->most = most;
      forecast->most_by = by;
    }
  };
  if (config.reference.signal == ReferenceSignal::kArmAngle) return;
  if (config.reference.signal == ReferenceSignal::kVoltage)
    return narrow(p.T_pmax / p.k_1, fmt::format("the motor's torque T_pmax {} {}", ShortNumber(p.T_pmax),
                                                units.UnitFor("in-lbf")));
  const double per_pressure = config.reference.signal == ReferenceSignal::kTorque ? p.k_2 : 1;
  narrow(config.limits.arm_torque_in_lbf / p.k_2 * per_pressure, ArmTorqueLimit(config));
  if (config.position.dac_bits > 0)
    narrow(config.position.dac_range_psi * per_pressure,
           fmt::format("position.dac_range {} {}", ShortNumber(config.position.dac_range_psi),
                       units.UnitFor("psi")));
}

RearmForecast Unknown(const std::string& why) {
  RearmForecast forecast;
  forecast.text = "where the machine will move to is not known: " + why;
  return forecast;
}

}  // namespace

settings::StackConfig ConfigInForce(const run_description_t& run, const tuned_settings_t& in_force) {
  settings::StackConfig configured =
      settings::ParseStackConfig(run.config_text, run.config_file, run.model_text, run.model_file);
  if (in_force.changes.empty()) return configured;
  return settings::Changed(configured, ParseChanges(in_force.changes), settings::FormerNames::kAsMeant);
}

RearmForecast ForecastRearm(const HeardOfStack& heard) {
  if (!heard.state) return Unknown("no state is heard");
  const bool says_it_acts = heard.state->command_tick >= 0;
  if (says_it_acts && !heard.holds) {
    RearmForecast forecast;
    forecast.held = false;
    forecast.text = "nothing holds the voltage at zero: re-arming changes nothing";
    return forecast;
  }
  if (!heard.run) return Unknown("the stack has not described itself yet");
  try {
    const settings::StackConfig config =
        ConfigInForce(*heard.run, heard.in_force.value_or(tuned_settings_t{}));
    if (const settings::ProcessSection* own = settings::OwnProgramFor(config, "position_ctrl"))
      return Unknown("the position loop is a program of your own, " + own->command.front());
    const Referred referred = ReferredTo(config, *heard.state);
    if (!std::isfinite(referred.present)) return Unknown(std::string(referred.words) + " is not measured");
    RearmForecast forecast;
    forecast.known = true;
    forecast.quantity = referred.quantity;
    forecast.unit = referred.unit;
    forecast.present = referred.present;
    forecast.resolution = ResolutionOf(config, referred);
    forecast.return_s = config.limits.return_s;
    forecast.speed = forecast.quantity == "arm_angle" ? heard.state->arm_speed : NAN;
    const Wanted wanted(config, heard);
    FollowTheReturn(wanted, heard.state->time, &forecast);
    if (forecast.return_s > 0) FindTurns(wanted, heard.state->time, &forecast);
    FollowTheReference(wanted, heard.state->time + forecast.return_s, &forecast);
    FindMost(config, &forecast);
    forecast.motion = SimulateRearm(
        config, *heard.state, [&](double time) { return wanted.At(time); }, forecast.return_s + kForecast_s);
    forecast.text = ForecastText(forecast, referred.words, config);
    if (says_it_acts) {
      forecast.text += fmt::format(
          "; but the device says that it acts by a command, with {} V, though a fault holds the voltage at "
          "zero: find out why "
          "first",
          ShortNumber(heard.state->voltage));
    }
    return forecast;
  } catch (const InputError& error) {
    return Unknown(error.what());
  }
}

}  // namespace hydro::tuning
