#include "plant/check/driver_trial.h"

#include <cmath>
#include <stdexcept>

#include "settings/toml/toml_document.h"

namespace hydro::plant {
namespace {

constexpr double kZero_V = 0.02;  // above half a step of a converter of 12 bits
constexpr double kHeld_s = 0.08;  // longer than a half-wave of the loops' voltage
constexpr double kDriven_s = 10;
constexpr double kSays_s = 5;  // for a driver to say why, after it has waited for its device

std::vector<std::string> OverridesFor(const TrialSettings& settings, const std::string& url) {
  std::vector<std::string> overrides = settings.overrides;
  // The run has no end; and with "restart", the cases can see a fault that began by itself also end by
  // itself.
  for (const std::string& more : {"bus.url=" + settings::TomlString(url), std::string("time.duration_s=0"),
                                  std::string("limits.rearm=\"restart\"")})
    overrides.push_back(more);
  return overrides;
}

}  // namespace

DriverTrial::DriverTrial(const TrialSettings& settings) {
  std::vector<std::string> overrides = OverridesFor(settings, port_.Url());
  const settings::StackConfig config = settings::LoadStackConfig(settings.file, overrides);
  stale_s_ = config.limits.stale_input_s;
  tick_s_ = 1 / config.plant.rate_hz;
  ready_s_ = config.time.start_timeout_s + kSays_s;
  device_.emplace(config);
  overrides.emplace_back("driver.simulated_device=[]");  // it is there already
  stack_.emplace(settings::LoadStackConfig(settings.file, overrides), overrides, settings.verbose);
}

bool DriverTrial::IsZero(double voltage) { return std::fabs(voltage) < kZero_V; }

void DriverTrial::AwaitReady() {
  if (stack_->Await([this] { return stack_->ready() || stack_->Ended(); }, ready_s_) && !stack_->Ended())
    return;
  throw NotBegun((stack_->Ended() ? process::DescribeEnd("the driver", stack_->end()) + " as it began"
                                  : "the driver has not said that it is ready") +
                 WhatItSaid());
}

std::string DriverTrial::WhatItSaid() const {
  const std::string said = stack_->LastLine();
  return said.empty() ? "" : "; it said: " + said;
}

void DriverTrial::Drive() {
  AwaitReady();
  stack_->StartLoops();
  if (!AwaitVoltage(kDriven_s)) throw std::runtime_error("the driver puts out no voltage" + WhatItSaid());
}

bool DriverTrial::AwaitVoltage(double limit_s) {
  return stack_->Await([this] { return !IsZero(device_->Output()); }, limit_s);
}

std::optional<double> DriverTrial::AwaitZero(double limit_s) {
  const double begin = stack_->Now();
  std::optional<double> since;
  const bool held = stack_->Await(
      [&] {
        const double now = stack_->Now();
        if (!IsZero(device_->Output())) {
          since.reset();
          // A zero that begins after the limit does not count: after the limit, only a zero that has already
          // begun is watched.
          return now - begin > limit_s;
        }
        if (!since) since = now;
        return now - *since >= kHeld_s;
      },
      limit_s + kHeld_s);
  if (!held || !since || *since - begin > limit_s) return std::nullopt;
  return *since - begin;
}

}  // namespace hydro::plant
