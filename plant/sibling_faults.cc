#include "plant/sibling_faults.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <hydro/state_t.hpp>
#include <utility>

#include "bus/channels.h"
#include "process/status.h"

namespace hydro::plant {
namespace {

constexpr char kJoint[] = "joint:";

}  // namespace

std::vector<std::string> ExpectedJoints(const std::vector<std::string>& expected) {
  std::vector<std::string> joints;
  for (const std::string& each : expected) {
    if (each.starts_with(kJoint)) joints.push_back(each.substr(std::size(kJoint) - 1));
  }
  return joints;
}

std::vector<std::string> ExpectedRoles(const std::vector<std::string>& expected) {
  std::vector<std::string> roles = expected;
  std::erase_if(roles, [](const std::string& each) { return each.starts_with(kJoint); });
  return roles;
}

SiblingFaults::SiblingFaults(process::Participant& participant,
                             const std::vector<settings::Sibling>& siblings, Options options)
    : participant_(participant), options_(std::move(options)) {
  for (const settings::Sibling& sibling : siblings) {
    Heard& heard = *siblings_.emplace_back(std::make_unique<Heard>());
    heard.sibling = sibling;
    const bus::Channels channels(sibling.suffix);
    participant.bus().Subscribe<process_status_t>(
        channels.Of<process_status_t>(),
        [this, &heard](const process_status_t& status) { OnStatus(status, heard); });
    if (options_.follows) Follow(heard, channels);
  }
}

void SiblingFaults::Follow(Heard& heard, const bus::Channels& channels) {
  bus::Bus& bus = participant_.bus();
  bus.Subscribe<fault_t>(channels.Of<fault_t>(), [this, &heard](const fault_t& fault) {
    heard.faults.Observe(fault, participant_.clock().Now());
  });
  bus.Subscribe<active_faults_t>(channels.Of<active_faults_t>(),
                                 [this, &heard](const active_faults_t& active) {
                                   heard.faults.Observe(active, participant_.clock().Now());
                                 });
  bus.Subscribe<stop_t>(channels.Of<stop_t>(), [this, &heard](const stop_t& stop) { OnStop(stop, heard); });
  if (heard.sibling.silence_s <= 0) return;
  bus.Subscribe<state_t>(channels.Of<state_t>(),
                         [this, &heard](const state_t& state) { OnState(state, heard); });
}

void SiblingFaults::OnStatus(const process_status_t& status, Heard& heard) {
  if (process::HasLeft(status)) {
    heard.faults.ForgetSession(status.session);
    if (status.session != heard.plant) return;
    if (options_.follows && status.state == process_status_t::FAILED) End(heard, status.text, 1);
    heard.left = std::exchange(heard.plant, std::nullopt);
    heard.state_at.reset();
  } else if (process::IsPlant(status.role)) {
    heard.plant = status.session;
    if (status.state == process_status_t::READY && options_.on_newcomer) options_.on_newcomer();
  }
}

void SiblingFaults::OnState(const state_t& state, Heard& heard) {
  if (state.session == heard.left) return;
  heard.plant = state.session;
  heard.state_at = participant_.clock().Now();
}

// When another joint's plant ends at the run's last tick, this process takes no action: it ends at that tick
// itself.
void SiblingFaults::OnStop(const stop_t& stop, const Heard& heard) {
  if (stop.addressee != 0 && stop.addressee != heard.plant) return;
  if (stop.exit_code == 0 && options_.last_tick >= 0 && stop.tick >= options_.last_tick) return;
  End(heard, stop.reason, stop.exit_code);
}

void SiblingFaults::End(const Heard& heard, const std::string& reason, int exit_code) {
  if (stop_) return;
  stop_.emplace();
  stop_->exit_code = exit_code;
  stop_->reason = "joint " + heard.sibling.name + ": " + (reason.empty() ? "it has failed" : reason);
}

std::vector<std::string> SiblingFaults::Missing(const std::vector<std::string>& joints) const {
  std::vector<std::string> missing;
  for (const std::string& joint : joints) {
    const bool there = std::any_of(siblings_.begin(), siblings_.end(), [&](const auto& heard) {
      return heard->sibling.name == joint && heard->plant;
    });
    if (!there) missing.push_back("joint " + joint);
  }
  return missing;
}

std::string SiblingFaults::Fault(bus::Clock::TimePoint now) {
  for (const auto& heard : siblings_) {
    if (!heard->faults.any(now)) continue;
    const fault_t& first = heard->faults.first();
    return fmt::format("joint {} has the fault {} ({})", heard->sibling.name, first.code, first.source);
  }
  return "";
}

std::string SiblingFaults::Silence(bus::Clock::TimePoint now) const {
  for (const auto& heard : siblings_) {
    if (!heard->state_at) continue;
    const double silence_s = bus::ToSeconds(now - *heard->state_at);
    if (silence_s <= heard->sibling.silence_s) continue;
    return fmt::format(
        "joint {}, which another process runs, has not been heard for {:.3g} s, allowed are {:.3g} s "
        "(limits.stale_input_s and three intervals of limb.telemetry_hz)",
        heard->sibling.name, silence_s, heard->sibling.silence_s);
  }
  return "";
}

}  // namespace hydro::plant
