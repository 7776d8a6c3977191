#include "sim/limb/limb_app.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <hydro/arm_plan_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/stop_t.hpp>
#include <hydro/tuning_request_t.hpp>

#include "bus/output_left.h"
#include "process/stop_signal.h"
#include "process/timing/fixed_rate_loop.h"

namespace hydro::limb {
namespace {

using namespace std::chrono_literals;

constexpr char kRole[] = "limb";
constexpr char kProgram[] = "hydro-limb";
constexpr auto kFarewellPause = 500us;  // between the ends of two joints
constexpr auto kWait = 50ms;            // after which a wait for others checks for signals
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
      logger_watch_(participant_, {participant_.channels()},
                    bus::FromSeconds(std::max(config.common.limits.stale_logger_s, 1.0))),
      elsewhere_(participant_, JointsElsewhere(config_, options_.joints),
                 {.follows = config.limb.on_joint_fault == settings::OnJointFault::kAllToZero,
                  .last_tick = config.common.last_tick,
                  .on_newcomer =
                      [this] {
                        for (auto& joint : limb_.joints()) joint->plant().participant().RepeatFaults();
                      }}),
      start_(participant_, elsewhere_,
             {.roles = plant::ExpectedRoles(options_.expected),
              .joints = plant::ExpectedJoints(options_.expected),
              .loggers = {participant_.channels()},
              .timeout_s = config.common.time.start_timeout_s,
              .description = plant::DescriptionOf(config.common, kProgram)}),
      limb_(config_, {.joints = options_.joints,
                      .program = kProgram,
                      .clock = config.common.time.mode == settings::TimeMode::kLockstep ? nullptr : &clock,
                      .heartbeat = SharedHeartbeat(options_.heartbeat, &heartbeats_)}),
      telemetry_(bus, config.common.time.mode == settings::TimeMode::kLockstep
                          ? 1
                          : config.limb.telemetry_interval_ticks) {
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
  participant_.Announce(process_status_t::READY);
  // Other processes of the limb wait for the joints here.
  for (auto& joint : limb_.joints()) joint->plant().participant().Announce(process_status_t::READY);
  const bool begins = start_.Await([this] { return Ended(); },
                                   [this](bus::Clock::TimePoint) {
                                     for (auto& joint : limb_.joints()) {
                                       joint->plant().participant().Poll(joint->clock().Now());
                                       joint->Dispatch(joint->clock().Now());
                                     }
                                     Poll();
                                   });
  if (!begins) return false;
  start_.Begin();
  const bool began = limb_.Begin();
  telemetry_.SendAll();
  return began;
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

// The joints share what one rig may run ahead.
bool LimbApp::LoggersKeepUp() const {
  const auto joints = static_cast<int64_t>(limb_.joint_count());
  return start_.loggers().HasTaken(limb_.tick() - plant::LoggerWindow::kTicks / joints);
}

bool LimbApp::AwaitLoggers() {
  const bus::Clock& clock = participant_.clock();
  const auto deadline = clock.Now() + bus::FromSeconds(config_.common.time.stall_timeout_s);
  while (!LoggersKeepUp()) {
    if (Ended()) return false;
    if (const std::string departure = start_.Departure(limb_.tick()); !departure.empty()) {
      participant_.RequestStop(departure, 1);
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

void LimbApp::Poll() {
  participant_.Poll();
  start_.Poll(participant_.clock().Now());
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
