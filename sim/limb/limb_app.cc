#include "sim/limb/limb_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <hydro/arm_plan_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/stop_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <memory>

#include "bus/output_left.h"
#include "process/stop_signal.h"
#include "process/timing/fixed_rate_loop.h"

namespace hydro::limb {
namespace {

using namespace std::chrono_literals;

constexpr char kRole[] = "limb";
constexpr char kProgram[] = "hydro-limb";
constexpr auto kDescriptionPeriod = 1s;
constexpr auto kFarewellPause = 500us;  // between the ends of two joints
constexpr auto kWait = 50ms;            // after which a wait for others checks for signals
// Lockstep: the number of ticks by which a limb of one joint may run ahead of a logger. It fills about half
// of Linux's default receive buffer (208 KiB). A logger reports four times as often (logger_app.cc).
constexpr int64_t kLoggerWindow = 64;
// Real time: the share of a tick that may be spent on sending.
constexpr double kSendingShare = 0.3;

// Lets many callers ask one source of heartbeats. Each caller learns whether a beat has come since its own
// last question.
std::function<bool()> SharedHeartbeat(const std::function<bool()>& source, int64_t* count) {
  if (!source) return {};
  return [source, count, seen = int64_t{0}]() mutable {
    if (source()) ++*count;
    return std::exchange(seen, *count) != *count;
  };
}

std::vector<settings::Sibling> JointsElsewhere(const settings::LimbConfig& config,
                                               const std::vector<std::string>& here) {
  std::vector<settings::Sibling> elsewhere;
  if (here.empty()) return elsewhere;
  for (const settings::JointConfig& joint : config.joints) {
    if (std::find(here.begin(), here.end(), joint.name) == here.end()) {
      elsewhere.push_back({.name = joint.name,
                           .suffix = joint.config.bus.channel_suffix,
                           .silence_s = settings::AllowedSilence(config.common, config.limb)});
    }
  }
  return elsewhere;
}

}  // namespace

LimbApp::LimbApp(bus::Bus& bus, bus::Clock& clock, const settings::LimbConfig& config, LimbAppOptions options)
    : config_(config),
      options_(std::move(options)),
      participant_(bus, clock, bus::Channels(config.common.bus.channel_suffix), kRole, config.common.agreed),
      roll_call_(plant::ExpectedRoles(options_.expected)),
      logger_watch_(participant_, {participant_.channels()},
                    bus::FromSeconds(std::max(config.common.limits.stale_logger_s, 1.0))),
      elsewhere_(participant_, JointsElsewhere(config_, options_.joints),
                 {.follows = config.limb.on_joint_fault == settings::OnJointFault::kAllToZero,
                  .last_tick = config.common.last_tick,
                  .on_newcomer =
                      [this] {
                        for (auto& joint : limb_.joints()) joint->plant().participant().RepeatFaults();
                      }}),
      limb_(config_, {.joints = options_.joints,
                      .program = kProgram,
                      .clock = config.common.time.mode == settings::TimeMode::kLockstep ? nullptr : &clock,
                      .heartbeat = SharedHeartbeat(options_.heartbeat, &heartbeats_)}),
      telemetry_(bus, config.common.time.mode == settings::TimeMode::kLockstep
                          ? 1
                          : config.limb.telemetry_interval_ticks) {
  const bus::Channels& channels = participant_.channels();
  bus.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                  [this](const process_status_t& status) { roll_call_.Observe(status); });
  bus.Subscribe<log_progress_t>(channels.Of<log_progress_t>(), [this](const log_progress_t& progress) {
    // Only loggers that were present when the run began count, so that a flood of forged ones is not kept.
    const auto known = log_progress_.find(progress.session);
    if (known != log_progress_.end()) known->second = progress.tick;
  });
  const auto count = static_cast<int64_t>(limb_.joints().size());
  for (int64_t i = 0; i < count; ++i) {
    Joint& joint = *limb_.joints()[static_cast<size_t>(i)];
    const int64_t phase = i * config_.limb.telemetry_interval_ticks / count;
    telemetry_.Add(joint.bus(), joint.config().bus.channel_suffix, phase,
                   [&joint](int64_t session) { return joint.IsOwn(session); });
    Forward(joint);
  }
}

// Forwards messages from outside on a joint's channels. The joint's own messages come back too and are left
// out.
template <class Message>
void LimbApp::ForwardTo(Joint& joint) {
  const std::string channel = bus::Channels(joint.config().bus.channel_suffix).Of<Message>();
  participant_.bus().Subscribe<Message>(channel, [&joint, channel](const Message& message) {
    if (!joint.ended() && !joint.IsOwn(message.session)) joint.bus().Publish(channel, message);
  });
}

void LimbApp::Forward(Joint& joint) {
  ForwardTo<stop_t>(joint);
  ForwardTo<rearm_t>(joint);
  ForwardTo<process_status_t>(joint);
  ForwardTo<tuning_request_t>(joint);
  ForwardTo<run_description_t>(joint);  // from another plant on these channels: a fault
  if (joint.config().reference.trajectory.kind == settings::TrajectorySpec::Kind::kPlanner) {
    ForwardTo<arm_plan_t>(joint);
  }
}

int LimbApp::Run() {
  try {
    if (Begin()) {
      config_.common.time.mode == settings::TimeMode::kLockstep ? RunLockstep() : RunRealtime();
    }
  } catch (...) {
    limb_.End({});  // zero volts first, the explanation afterwards
    throw;
  }
  return End();
}

bool LimbApp::Ended() const {
  return participant_.stop().has_value() || elsewhere_.stop().has_value() ||
         process::StopSignal(participant_.bus()) != 0;
}

bool LimbApp::Begin() {
  description_ = DescriptionOf(config_, kProgram);
  description_.session = participant_.session();
  description_.host = participant_.host();
  participant_.Announce(process_status_t::READY);
  // Other processes of the limb wait for the joints here.
  for (auto& joint : limb_.joints()) joint->plant().participant().Announce(process_status_t::READY);
  const auto deadline = participant_.clock().Now() + bus::FromSeconds(config_.common.time.start_timeout_s);
  for (std::vector<std::string> missing; !(missing = Missing()).empty();) {
    if (Ended()) return false;
    if (participant_.clock().Now() >= deadline) {
      participant_.RequestStop(fmt::format("not ready after {} s (time.start_timeout_s): {}",
                                           config_.common.time.start_timeout_s, fmt::join(missing, ", ")),
                               1);
      return false;
    }
    participant_.bus().HandleUntil(std::min(participant_.clock().Now() + kWait, deadline));
    for (auto& joint : limb_.joints()) {
      joint->plant().participant().Poll(joint->clock().Now());
      joint->Dispatch(joint->clock().Now());
    }
    Poll();
  }
  for (const int64_t session : roll_call_.Loggers()) log_progress_.emplace(session, -1);
  participant_.Announce(process_status_t::RUNNING);
  PublishDescription();  // once more, because a logger may have joined since
  const bool began = limb_.Begin();
  telemetry_.SendAll();
  return began;
}

std::vector<std::string> LimbApp::Missing() const {
  std::vector<std::string> missing = roll_call_.Missing();
  for (const std::string& joint : elsewhere_.Missing(plant::ExpectedJoints(options_.expected)))
    missing.push_back(joint);
  return missing;
}

void LimbApp::RunLockstep() {
  bus::Bus& bus = participant_.bus();
  while (!Ended() && limb_.StepLockstep()) {
    participant_.set_tick(limb_.tick());
    telemetry_.SendAll();
    bus.HandleUntil({});
    Poll();
    if (!LoggersKeepUp() && !AwaitLoggers()) return;
  }
}

bool LimbApp::LoggersKeepUp() const {
  const auto joints = static_cast<int64_t>(limb_.joint_count());
  const int64_t window = kLoggerWindow / joints;
  return std::all_of(log_progress_.begin(), log_progress_.end(),
                     [&](const auto& logger) { return logger.second >= limb_.tick() - window; });
}

bool LimbApp::AwaitLoggers() {
  const bus::Clock& clock = participant_.clock();
  const auto deadline = clock.Now() + bus::FromSeconds(config_.common.time.stall_timeout_s);
  while (!LoggersKeepUp()) {
    if (Ended()) return false;
    if (!roll_call_.left().empty()) {
      participant_.RequestStop(
          fmt::format("{} has left the lockstep run at tick {}", roll_call_.left(), limb_.tick()), 1);
      return false;
    }
    if (clock.Now() >= deadline) {
      participant_.RequestStop(fmt::format("logger has not taken tick {} within {} s (time.stall_timeout_s)",
                                           limb_.tick(), config_.common.time.stall_timeout_s),
                               1);
      return false;
    }
    participant_.bus().HandleUntil(std::min(clock.Now() + kWait, deadline));
    Poll();
  }
  return true;
}

void LimbApp::RunRealtime() {
  const std::chrono::duration<double> period(1 / (config_.common.plant.rate_hz * config_.common.time.speed));
  const auto share = bus::FromSeconds(kSendingShare * period.count());
  timing::FixedRateLoop loop(participant_.bus(), participant_.clock(), period, participant_.statistics(),
                             config_.common.last_tick);
  while (!Ended()) {
    const int64_t elapsed = loop.Wait();
    if (elapsed == 0) continue;  // a signal interrupted the wait
    limb_.HoldForOthers(elsewhere_.Fault(loop.woke()), elsewhere_.Silence(loop.woke()));
    const bool goes_on = limb_.StepRealtime({elapsed, loop.skipped(), loop.woke(), loop.late()});
    participant_.set_tick(limb_.tick());
    if (!goes_on) return;
    const auto until = participant_.clock().Now() + share;
    telemetry_.Send([&] { return participant_.clock().Now() < until; });
    logger_watch_.Poll(participant_.clock().Now());
    Poll();
  }
}

void LimbApp::PublishDescription() {
  next_description_ = participant_.clock().Now() + kDescriptionPeriod;
  description_.utime = participant_.clock().Utime();
  participant_.bus().Publish(participant_.channels().Of<run_description_t>(), description_);
}

void LimbApp::Poll() {
  participant_.Poll();
  if (participant_.clock().Now() >= next_description_) PublishDescription();
}

// The end of the limb, or of one joint, ends all joints, and each announces it.
void LimbApp::AgreeOnTheEnd() {
  if (const auto& stop = elsewhere_.stop()) participant_.RequestStop(stop->reason, stop->exit_code);
  for (const auto& joint : limb_.joints()) {
    const auto& stop = joint->plant().participant().stop();
    if (stop && stop->exit_code == 0) participant_.RequestStop(stop->reason, 0, stop->source);
  }
  const auto& stop = participant_.stop();
  if (!stop) return;
  for (const auto& joint : limb_.joints()) {
    if (!joint->ended())
      joint->plant().participant().RequestStop(stop->reason, stop->exit_code, stop->source);
  }
}

int LimbApp::End() {
  telemetry_.PassAll();
  if (limb_.failure().empty()) AgreeOnTheEnd();
  const int exit_code = limb_.End([this] {
    telemetry_.SendAll();
    // The receivers' buffers have a limited size.
    participant_.bus().HandleUntil(participant_.clock().Now() + kFarewellPause);
  });
  const std::string failure = limb_.failure();
  const bool others_go_on = !elsewhere_.follows() && limb_.joint_count() < config_.joints.size();
  if (!failure.empty() && others_go_on && !participant_.stop())
    return std::max(exit_code, participant_.Leave(failure));
  if (!failure.empty()) {
    participant_.RequestStop(failure, 1);
  } else if (const process::StopRequest asked = process::StopReason(); !asked.reason.empty()) {
    participant_.RequestStop(asked.reason, 0, asked.role);
  } else if (const int signal = process::StopSignal(participant_.bus()); signal != 0) {
    participant_.RequestStop(fmt::format("hydro-limb was stopped by signal {}", signal), 0);
  } else {
    const double seconds = static_cast<double>(limb_.tick()) / config_.common.plant.rate_hz;
    participant_.RequestStop(fmt::format("{} after {} s", bus::kRunComplete, seconds), exit_code);
  }
  return std::max(exit_code, participant_.Leave());
}

}  // namespace hydro::limb
