#include "plant/output_safety.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "bus/output_left.h"
#include "process/fault_codes.h"
#include "process/status.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

// A plant describes itself once a second.
constexpr auto kOtherStackAlive = 2500ms;
// A re-arm request that names a tick older than this comes from a recording.
constexpr double kRearmAge_s = 5;

std::string Line(const std::string& text, const char* key) {
  const size_t begin = text.find(key);
  return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace

OutputSafety::OutputSafety(process::Participant& participant, const settings::StackConfig& config)
    : participant_(participant),
      limits_(config.limits),
      units_(config.model.description.units),
      ticks_per_s_(config.plant.rate_hz * config.time.speed),
      guard_(config.limits.rearm),
      suspended_(participant.clock().Suspended()) {
  bus::Bus& bus = participant_.bus();
  const bus::Channels& channels = participant_.channels();
  bus.Subscribe<run_description_t>(channels.Of<run_description_t>(),
                                   [this](const run_description_t& other) { OnDescription(other); });
  bus.Subscribe<rearm_t>(channels.Of<rearm_t>(), [this](const rearm_t& request) { OnRearm(request); });
  if (limits_.rearm != settings::Rearm::kExplicit) return;
  bus.Subscribe<fault_t>(channels.Of<fault_t>(), [this](const fault_t& fault) { OnFault(fault); });
  bus.Subscribe<active_faults_t>(channels.Of<active_faults_t>(), [this](const active_faults_t& active) {
    if (active.session != participant_.session()) remote_.Observe(active, participant_.clock().Now());
  });
  bus.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                  [this](const process_status_t& status) { OnStatus(status); });
}

void OutputSafety::CheckMeasured(const state_t& state) {
  const double pressure = std::fmax(state.p1, state.p2);
  Set(Cause::kPressureLimit, pressure > limits_.pressure_psi, [&] {
    return Finding{fmt::format("tick {}: p{} is {:.6g} {unit}, allowed is {} {unit} (limits.pressure)",
                               state.tick, state.p1 > state.p2 ? 1 : 2, pressure, limits_.pressure_psi,
                               fmt::arg("unit", units_.UnitFor("psi"))),
                   pressure, limits_.pressure_psi};
  });
  const double speed = std::fabs(state.motor_speed);
  Set(Cause::kMotorSpeedLimit, speed > limits_.motor_speed_rad_s, [&] {
    return Finding{fmt::format("tick {}: the motor turns at {:.6g} rad/s, allowed is {} rad/s "
                               "(limits.motor_speed)",
                               state.tick, speed, limits_.motor_speed_rad_s),
                   speed, limits_.motor_speed_rad_s};
  });
  const double angle = std::fabs(state.arm_angle);
  Set(Cause::kArmAngleLimit, angle > limits_.arm_angle_rad, [&] {
    return Finding{fmt::format("tick {}: the arm is at {:.6g} {unit}, allowed is |alpha| <= {:.6g} {unit} "
                               "(limits.arm_angle)",
                               state.tick, state.arm_angle, limits_.arm_angle_rad,
                               fmt::arg("unit", units_.UnitFor("rad", 1))),
                   angle, limits_.arm_angle_rad};
  });
}

void OutputSafety::CheckSuspended() {
  const bus::Clock::Duration suspended = participant_.clock().Suspended();
  const double gone = bus::ToSeconds(suspended - std::exchange(suspended_, suspended));
  Set(Cause::kSuspended, gone > limits_.stale_input_s, [&] {
    return Finding{fmt::format("tick {}: the machine was suspended for {:.3g} s, allowed are {} s "
                               "(limits.stale_input_s)",
                               participant_.tick(), gone, limits_.stale_input_s),
                   gone, limits_.stale_input_s};
  });
}

void OutputSafety::CheckOtherStack(bus::Clock::TimePoint now) {
  const bool other = other_stack_heard_ && now - *other_stack_heard_ <= kOtherStackAlive;
  Set(Cause::kOtherStack, other, [&] { return Finding{other_stack_, 2, 1}; });
}

void OutputSafety::CheckController(bool safe_command, bus::Clock::TimePoint now) {
  if (limits_.rearm != settings::Rearm::kExplicit) return;
  const bool remote = remote_.any(now);
  Set(Cause::kControllerFault, safe_command || remote, [&] {
    std::string why = "the pressure loop commands a safe output";
    if (remote) {
      const fault_t& first = remote_.first();
      why = fmt::format("{}: {}: {}", bus::ReasonText(first.source, "an unnamed process"),
                        bus::ReasonText(first.code, "a fault without a name"), bus::ReasonText(first.text));
    }
    return Finding{why, NAN, NAN};
  });
}

void OutputSafety::CheckRig(const std::vector<RigFault>& faults) {
  if (limits_.rearm != settings::Rearm::kExplicit) return;
  Set(Cause::kRigFault, !faults.empty(), [&] {
    const RigFault& first = faults.front();
    return Finding{first.code + ": " + bus::ReasonText(first.text), first.value, first.limit};
  });
}

void OutputSafety::PublishChanges() {
  changed_ = false;
  for (size_t i = 0; i < findings_.size(); ++i) {
    const Cause cause = static_cast<Cause>(i);
    const char* code = VoltageGuard::CodeOf(cause);
    const Finding& finding = findings_[i];
    if (!guard_.active(cause)) {
      participant_.Clear(code);
    } else if (participant_.Raise(code, finding.text, finding.value, finding.limit, guard_.latched(cause)) &&
               VoltageGuard::Trips(cause) && limits_.rearm == settings::Rearm::kRestart) {
      participant_.RequestStop(fmt::format("fault {}: {}", code, finding.text), 1);
    }
  }
}

std::string OutputSafety::Latched() const {
  std::string codes;
  for (size_t i = 0; i < findings_.size(); ++i) {
    const Cause cause = static_cast<Cause>(i);
    if (!guard_.latched(cause)) continue;
    codes += (codes.empty() ? "" : ", ") + std::string(VoltageGuard::CodeOf(cause));
  }
  return codes;
}

std::string OutputSafety::OwnCause() const {
  for (size_t i = 0; i < findings_.size(); ++i) {
    const Cause cause = static_cast<Cause>(i);
    if (cause != Cause::kOtherJoint && guard_.active(cause)) return VoltageGuard::CodeOf(cause);
  }
  return "";
}

// OutputSafety receives descriptions from its own channels, on this group and port.
void OutputSafety::OnDescription(const run_description_t& description) {
  if (description.session == participant_.session()) return;
  other_stack_heard_ = participant_.clock().Now();
  const std::string url = Line(description.config_text, "url = ");
  other_stack_ = fmt::format(
      "another plant is on this port: {} on {} (session {}{}); allowed is one: give each stack its own port "
      "or "
      "bus.channel_suffix",
      description.program, description.host, description.session, url.empty() ? "" : ", its bus." + url);
}

void OutputSafety::OnFault(const fault_t& fault) {
  if (fault.session != participant_.session()) remote_.Observe(fault, participant_.clock().Now());
}

void OutputSafety::OnStatus(const process_status_t& status) {
  process::HasLeft(status) ? remote_.ForgetSession(status.session)
                           : remote_.ForgetOthersOfRole(status.role, status.session);
}

std::string OutputSafety::DescribePresent(const std::vector<Cause>& causes) const {
  std::string text;
  for (const Cause cause : causes) {
    text += fmt::format("{}{} persists: {}", text.empty() ? "" : "; ", VoltageGuard::CodeOf(cause),
                        findings_[static_cast<size_t>(cause)].text);
  }
  return text;
}

void OutputSafety::OnRearm(const rearm_t& request) {
  if (request.kind != rearm_t::REQUEST || request.addressee != participant_.session()) return;
  if (limits_.rearm != settings::Rearm::kExplicit) {
    Answer(request, rearm_t::REFUSED, "limits.rearm is \"restart\": a latched fault ends the run");
    return;
  }
  const double age_s =
      (static_cast<double>(participant_.tick()) - static_cast<double>(request.tick)) / ticks_per_s_;
  if (!(age_s >= 0 && age_s <= kRearmAge_s)) {
    Answer(request, rearm_t::REFUSED,
           fmt::format("the request names tick {}, it is now {}; allowed are {} s", request.tick,
                       participant_.tick(), kRearmAge_s));
    return;
  }
  // Whoever sent the request before a fault began has not seen that fault; and a request that was recorded or
  // delivered twice must not end a new one.
  if (request.tick < newest_cause_tick_) {
    Answer(request, rearm_t::REFUSED,
           fmt::format("the request names tick {}; a fault has begun since, at tick {}", request.tick,
                       newest_cause_tick_));
    return;
  }
  if (why_no_rearm_) {
    if (const std::string why = why_no_rearm_(); !why.empty()) return Answer(request, rearm_t::REFUSED, why);
  }
  std::vector<Cause> present;
  const std::vector<Cause> ended = guard_.Release(&present);
  if (!present.empty()) {
    Answer(request, rearm_t::REFUSED, DescribePresent(present));
    return;
  }
  std::string codes;
  for (const Cause cause : ended) {
    const char* code = VoltageGuard::CodeOf(cause);
    participant_.Release(code);
    codes += (codes.empty() ? "" : ", ") + std::string(code);
  }
  if (ended.empty()) return Answer(request, rearm_t::NOTHING_LATCHED, "no fault is latched");
  Answer(request, rearm_t::ACCEPTED, "ended " + codes);
}

void OutputSafety::Answer(const rearm_t& request, int8_t kind, const std::string& text) {
  rearm_t answer;
  answer.utime = participant_.clock().Utime();
  answer.tick = participant_.tick();
  answer.session = participant_.session();
  answer.addressee = request.session;
  answer.kind = kind;
  answer.source = participant_.role();
  answer.text = text;
  participant_.bus().Publish(participant_.channels().Of<rearm_t>(), answer);
}

}  // namespace hydro::plant
