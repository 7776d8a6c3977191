#include "process/own_loop.h"

#include <cstdlib>
#include <hydro/arm_reference_t.hpp>
#include <sstream>
#include <utility>

#include "process/process_main.h"

namespace hydro::process {
namespace {

constexpr char kRole[] = "position_ctrl";

settings::CommonOptions OptionsOfEnvironment() {
  settings::CommonOptions options;
  if (const char* config = std::getenv("HYDRO_CONFIG")) options.config = config;
  if (options.config.empty()) {
    throw InputError(
        "HYDRO_CONFIG: found nothing, allowed the path of the stack's configuration; hydro-launch sets it "
        "for a "
        "[[process]] with a command");
  }
  const char* set = std::getenv("HYDRO_SET");
  std::istringstream lines(set != nullptr ? set : "");
  for (std::string line; std::getline(lines, line);) options.overrides.push_back(line);
  return options;
}

}  // namespace

OwnPositionLoop::OwnPositionLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                                 PositionAnswer answer, ArmReference reference)
    : participant_(bus, clock, bus::Channels(config.bus.channel_suffix), kRole, config.agreed),
      answer_(std::move(answer)),
      reference_(std::move(reference)),
      interval_(config.position_interval_ticks),
      monitor_(bus::FromSeconds(config.limits.stale_input_s)) {
  bus.Subscribe<state_t>(participant_.channels().Of<state_t>(),
                         [this](const state_t& state) { OnState(state); });
  participant_.Announce(process_status_t::READY);
}

void OwnPositionLoop::OnState(const state_t& state) {
  if (participant_.Refuses(state.session)) return;
  switch (monitor_.Observe(state.session, state.sequence, participant_.clock().Now())) {
    case bus::SequenceMonitor::Verdict::kSecondSender:
      return;
    case bus::SequenceMonitor::Verdict::kRestarted:
      answered_ = -1;
      break;
    case bus::SequenceMonitor::Verdict::kDuplicate:
      if (state.tick == answered_) Send();  // the plant asks again: the answer may have been lost
      // Later states that ask for no answer have overtaken it in the network. One beyond all that was seen is
      // none of these.
      if (state.tick > answered_ && state.tick < participant_.tick() && state.tick % interval_ == 0)
        Answer(state);
      return;
    case bus::SequenceMonitor::Verdict::kAccept:
      break;
  }
  participant_.Follow(state.session);
  if (participant_.state() == process_status_t::READY) participant_.Announce(process_status_t::RUNNING);
  if (state.tick <= answered_) answered_ = -1;  // a log is played again
  participant_.set_tick(state.tick);
  if (state.tick % interval_ == 0) Answer(state);
}

void OwnPositionLoop::Answer(const state_t& state) {
  const auto arrival = participant_.clock().Now();
  if (answered_ >= 0) {
    participant_.statistics().AddMissedDeadlines((state.tick - answered_) / interval_ - 1);
  }
  answered_ = state.tick;
  command_ = {};
  command_.tick = state.tick;
  command_.session = participant_.session();
  command_.sequence = sequence_++;
  command_.utime = participant_.clock().Utime();
  answer_(state, &command_);
  if (reference_) SendReference(state);
  Send();
  participant_.statistics().RecordCycle(arrival, participant_.clock().Now() - arrival);
}

void OwnPositionLoop::SendReference(const state_t& state) {
  arm_reference_t reference{};
  reference.utime = command_.utime;
  reference.tick = state.tick;
  reference.session = participant_.session();
  reference.sequence = command_.sequence;
  reference.signal = arm_reference_t::ARM_ANGLE;
  reference.value = reference_(state);
  participant_.bus().Publish(participant_.channels().Of<arm_reference_t>(), reference);
}

void OwnPositionLoop::Send() {
  participant_.bus().Publish(participant_.channels().Of<pressure_command_t>(), command_);
}

void OwnPositionLoop::Poll() {
  participant_.statistics().set_lost_messages(monitor_.lost());
  participant_.Poll();
}

int OwnPositionLoop::Finish() {
  if (!participant_.stop() && answered_ >= 0) {
    command_ = {};
    command_.utime = participant_.clock().Utime();
    command_.tick = participant_.tick();
    command_.session = participant_.session();
    command_.sequence = sequence_++;
    command_.open_loop = true;
    Send();
  }
  return participant_.Leave();
}

int RunOwnLoop(const std::string& role, const ProcessBody& body) {
  return settings::RunProgram(role, [&] { return RunProcess(role, OptionsOfEnvironment(), body); });
}

int RunOwnPositionLoop(const PositionAnswer& answer, const ArmReference& reference) {
  return RunOwnLoop(kRole, [&](bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config) {
    OwnPositionLoop loop(bus, clock, config, answer, reference);
    return RunApp(bus, clock, loop);
  });
}

}  // namespace hydro::process
