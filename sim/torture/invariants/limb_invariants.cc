#include "sim/torture/invariants/limb_invariants.h"

#include <fmt/format.h>

#include "bus/channels.h"
#include "bus/messages.h"
#include "process/fault_codes.h"
#include "process/safety/safety_table.h"
#include "process/status.h"

namespace hydro::torture {
namespace {

const int64_t kNoticed = process::TicksWithin("other_joint");
constexpr double kSilenceNoticed_s = 0.06;  // it may wake late by 20 ms (fault_kinds.cc: slow) each time
constexpr double kClaimed_s = 2.4;          // a fault that no process claims for 2.5 s has ended

template <class Message>
int ChannelOf(Network& network, const settings::StackConfig& config) {
  return network.ChannelNumber(bus::Channels(config.siblings.front().suffix).Of<Message>());
}

}  // namespace

LimbInvariants::LimbInvariants(const settings::StackConfig& config, Network& network, const TrueTime* now)
    : silence_s_(config.siblings.front().silence_s),
      now_(now),
      state_(ChannelOf<state_t>(network, config)),
      fault_(ChannelOf<fault_t>(network, config)),
      active_faults_(ChannelOf<active_faults_t>(network, config)),
      status_(ChannelOf<process_status_t>(network, config)) {}

void LimbInvariants::OnSent(const Packet& packet, Coverage* coverage) {
  if (fault_t fault; packet.channel == fault_ && Decode(packet, &fault) && fault.active != 0)
    ++coverage->codes[fault.code];
  if (state_t state; packet.channel == state_ && Decode(packet, &state) && state.voltage != 0)
    sibling_driven_ = *now_;
}

void LimbInvariants::OnHandled(const Packet& packet, const SimulatedProcess& plant) {
  Heard& heard = heard_[plant.number()];
  const bus::Clock::TimePoint now = plant.machine().Now();
  if (state_t state; packet.channel == state_ && Decode(packet, &state)) {
    if (!heard.left.contains(state.session)) heard.state = now;
  }
  if (process_status_t status; packet.channel == status_ && Decode(packet, &status)) {
    if (!process::HasLeft(status)) return;
    heard.left.insert(status.session);
    heard.state.reset();
    heard.fault.clear();
  }
  // A message that is lost or changed on the way may end a fault, or make one, so only the newest message
  // counts.
  if (packet.channel == active_faults_) heard.fault.clear();
  if (packet.channel != fault_) return;
  heard.fault.clear();
  fault_t fault;
  if (packet.origin != Origin::kProcess || !Decode(packet, &fault) || fault.active == 0) return;
  if (!process::LeadsToZeroVolts(fault.code) || fault.code == "other_joint") return;
  heard.fault = fault.code;
  heard.fault_tick = heard.tick;
  heard.fault_at = now;
}

std::string LimbInvariants::OnDrive(const SimulatedProcess& plant, int64_t tick, double voltage) {
  Heard& heard = heard_[plant.number()];
  heard.tick = tick;
  if (voltage == 0) return "";
  const bus::Clock::TimePoint now = plant.machine().Now();
  if (heard.state) {
    const double silence_s = bus::ToSeconds(now - *heard.state);
    if (silence_s > silence_s_ + kSilenceNoticed_s) {
      return fmt::format("tick {}: {:.6g} V, no state of the other joint for {:.3f} s, allowed are {:.3f} s",
                         tick, voltage, silence_s, silence_s_);
    }
  }
  if (!heard.fault.empty() && tick > heard.fault_tick + kNoticed &&
      bus::ToSeconds(now - heard.fault_at) < kClaimed_s) {
    return fmt::format("tick {}: {:.6g} V, the other joint's {} was heard at tick {}", tick, voltage,
                       heard.fault, heard.fault_tick);
  }
  return "";
}

}  // namespace hydro::torture
