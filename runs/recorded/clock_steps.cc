#include "runs/recorded/clock_steps.h"

namespace hydro::runs {
namespace {

constexpr double kSilence = 1;  // s by which a silence exceeds what plant time takes
constexpr double kBack = 0.01;  // s; messages of several senders are out of order by less than this

}  // namespace

void ClockWatch::Take(int64_t event, int64_t utime, std::optional<double> state_time) {
  if (last_utime_.has_value() && last_time_.has_value()) {
    const double passed = (static_cast<double>(utime) - static_cast<double>(*last_utime_)) * 1e-6;
    if (passed > kSilence || passed < -kBack) pending_.push_back({event, *last_time_, passed});
  }
  if (state_time.has_value() && state_time != last_time_) Resolve(*state_time);
  last_utime_ = utime;
  last_time_ = state_time;
}

void ClockWatch::Resolve(double state_time) {
  for (ClockStep step : pending_) {
    const double planned = state_time - step.at_time_s;
    step.joined = planned < 0;
    if (!step.joined) step.seconds -= planned;
    step.at_time_s = state_time;
    if (step.seconds > kSilence || step.seconds < -kBack) steps_.push_back(step);
  }
  pending_.clear();
}

double SecondsOfSteps(const std::vector<ClockStep>& steps, int64_t first_event, int64_t last_event) {
  double seconds = 0;
  for (const ClockStep& step : steps) {
    if (step.event > first_event && step.event <= last_event) seconds += step.seconds;
  }
  return seconds;
}

}  // namespace hydro::runs
