#include <algorithm>
#include <hydro/active_faults_t.hpp>
#include <hydro/arm_plan_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <vector>

#include "bus/channels.h"
#include "bus/session.h"
#include "launch/logic/operator_request.h"
#include "process/fault_codes.h"
#include "tune/live/rearm_forecast.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr auto kListen = 300ms;  // long enough to hear a second plant
constexpr auto kRearmRepeat = 100ms;

// Of codes with a blank between them.
bool AnyZeroesVoltage(const std::string& codes) {
  std::istringstream words(codes);
  for (std::string code; words >> code;) {
    if (process::ZeroesVoltage(code)) return true;
  }
  return false;
}

// The plant of a stack, or of a joint, that is asked.
class Asked {
 public:
  Asked(bus::Bus& bus, std::string joint, const std::string& suffix, int64_t session)
      : bus_(bus), joint_(std::move(joint)), channels_(suffix), session_(session) {
    bus.Subscribe<state_t>(channels_.Of<state_t>(), [this](const state_t& state) {
      plants_.insert(state.session);
      tick_ = state.tick;
      // Keeps the state in which the plant was asked: later ones may show what the re-arm did.
      if (!asked_ || (!answer_ && state.command_tick < 0)) heard_.state = state;
    });
    bus.Subscribe<run_description_t>(channels_.Of<run_description_t>(),
                                     [this](const run_description_t& run) { heard_.run = run; });
    bus.Subscribe<tuned_settings_t>(channels_.Of<tuned_settings_t>(), [this](const tuned_settings_t& s) {
      if (s.stage == tuned_settings_t::IN_FORCE) heard_.in_force = s;
    });
    bus.Subscribe<arm_plan_t>(channels_.Of<arm_plan_t>(),
                              [this](const arm_plan_t& plan) { heard_.plan = plan; });
    bus.Subscribe<active_faults_t>(channels_.Of<active_faults_t>(), [this](const active_faults_t& active) {
      if (plants_.contains(active.session) && !answer_) heard_.holds = AnyZeroesVoltage(active.codes);
    });
    bus.Subscribe<rearm_t>(channels_.Of<rearm_t>(), [this](const rearm_t& message) {
      const bool ours = message.kind != rearm_t::REQUEST && message.addressee == session_;
      if (!ours || !plants_.contains(message.session) || answer_) return;
      answer_ = message;
      heard_.holds = message.kind == rearm_t::ACCEPTED;
    });
  }

  const std::string& joint() const { return joint_; }
  bool heard() const { return !plants_.empty(); }
  size_t plants() const { return plants_.size(); }
  bool answered() const { return answer_.has_value(); }
  // All that a forecast is made of. A plant that holds the voltage says so once a second, and one that does
  // not says nothing.
  bool described() const {
    const bool held = answer_ || heard_.holds || (heard_.state && heard_.state->command_tick < 0);
    return held && heard_.run && heard_.in_force;
  }
  bool accepted() const { return answer_ && answer_->kind == rearm_t::ACCEPTED; }
  bool nothing_latched() const { return answer_ && answer_->kind == rearm_t::NOTHING_LATCHED; }

  void Ask(int64_t utime, const Asker& asker) {
    asked_ = true;
    rearm_t request;
    request.utime = utime;
    request.tick = tick_;
    request.session = session_;
    request.addressee = *plants_.begin();
    request.kind = rearm_t::REQUEST;
    request.source = asker.role;
    request.text = asker.rearm;
    bus_.Publish(channels_.Of<rearm_t>(), request);
  }

  // The outcome in words.
  std::string Text() const {
    if (!answer_) return "the plant does not answer";
    const bool nothing = nothing_latched() && !joint_.empty();  // of a limb, another joint may have had one
    return accepted() || nothing ? answer_->text : "refused by the " + answer_->source + ": " + answer_->text;
  }

  // Uses the last state before an answer, when the voltage was still held at zero.
  tuning::RearmForecast Forecast() const { return tuning::ForecastRearm(heard_); }

 private:
  bus::Bus& bus_;
  std::string joint_;  // empty for a single stack
  bus::Channels channels_;
  int64_t session_;
  std::set<int64_t> plants_;
  int64_t tick_ = -1;
  bool asked_ = false;
  std::optional<rearm_t> answer_;
  tuning::HeardOfStack heard_;
};

using Joints = std::vector<std::unique_ptr<Asked>>;

Joints PlantsOf(bus::Bus& bus, const settings::StackConfig& config, int64_t session) {
  Joints all;
  if (config.joints.empty()) {
    all.push_back(std::make_unique<Asked>(bus, "", config.bus.channel_suffix, session));
  }
  for (size_t i = 0; i < config.joints.size(); ++i) {
    all.push_back(std::make_unique<Asked>(bus, config.joints[i], config.bus.joint_suffixes.at(i), session));
  }
  return all;
}

template <class Is>
bool All(const Joints& joints, Is is) {
  return std::all_of(joints.begin(), joints.end(), [&](const auto& joint) { return is(*joint); });
}

// "hip, knee": the joints for which `is` is true.
template <class Is>
std::string Names(const Joints& joints, Is is) {
  std::string names;
  for (const auto& joint : joints) {
    if (is(*joint)) names += (names.empty() ? "" : ", ") + joint->joint();
  }
  return names;
}

// The reason why no plant is asked; empty when all are heard, each once. A limb is re-armed as a whole or not
// at all: its operator counts on each joint.
std::string WhyNot(const Joints& joints, const std::string& url) {
  const auto silent = [](const Asked& joint) { return !joint.heard(); };
  if (All(joints, silent)) return "no plant or driver is heard on " + url;
  if (const std::string names = Names(joints, silent); !names.empty()) {
    return "no plant or driver of " + names + " is heard on " + url +
           "; no joint was re-armed (--joint NAME re-arms one alone)";
  }
  for (const auto& joint : joints) {
    if (joint->plants() == 1) continue;
    return (joint->joint().empty() ? "" : joint->joint() + ": ") + "heard the states of " +
           std::to_string(joint->plants()) + " plants on " + url + ", allowed is one";
  }
  return "";
}

// "hip: ended pressure_limit; knee, ankle: no fault is latched": joints with the same answer come together,
// refusals first.
std::string Answers(const Joints& joints) {
  std::string text;
  for (const bool answers : {false, true}) {
    std::map<std::string, std::string> names;
    for (const auto& joint : joints) {
      if ((joint->accepted() || joint->nothing_latched()) != answers) continue;
      std::string& list = names[joint->Text()];
      list += (list.empty() ? "" : ", ") + joint->joint();
    }
    for (const auto& [answer, list] : names) text += (text.empty() ? "" : "; ") + list + ": " + answer;
  }
  return text;
}

// Listens until `done` is true for all joints.
template <class Done>
void Listen(bus::Bus& bus, const bus::Clock& clock, const Joints& joints, bus::Clock::Duration longest,
            Done done) {
  const auto start = clock.Now();
  while (!All(joints, done) && clock.Now() - start < longest) bus.HandleUntil(clock.Now() + kRearmRepeat);
}

void ListenForAll(bus::Bus& bus, const bus::Clock& clock, const Joints& joints,
                  const OperatorTiming& timing) {
  const auto heard = [](const Asked& joint) { return joint.heard(); };
  Listen(bus, clock, joints, timing.presence, heard);
  if (!All(joints, heard)) return;
  for (const auto until = clock.Now() + kListen; clock.Now() < until;) bus.HandleUntil(until);
}

// Adds "hip: the arm is at ...; knee: ..."; with `all`, also for joints whose voltage is not held.
void AddForecasts(const Joints& joints, bool all, OperatorResult* result) {
  for (const auto& joint : joints) {
    result->forecasts.emplace_back(joint->joint(), joint->Forecast());
    if (!all && !result->forecasts.back().second.held) continue;
    const std::string& said = result->forecasts.back().second.text;
    result->text +=
        (result->text.empty() ? "" : "; ") + (joint->joint().empty() ? "" : joint->joint() + ": ") + said;
  }
}

}  // namespace

OperatorResult ForecastRearm(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                             const OperatorTiming& timing) {
  const Joints joints = PlantsOf(bus, config, bus::IdentityOn(bus, clock).session);
  ListenForAll(bus, clock, joints, timing);
  if (const std::string why = WhyNot(joints, config.bus.url); !why.empty()) return {1, why};
  Listen(bus, clock, joints, timing.description, [](const Asked& joint) { return joint.described(); });
  OperatorResult result{0, ""};
  AddForecasts(joints, true, &result);
  return result;
}

OperatorResult RearmStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                          const OperatorTiming& timing, const Asker& asker) {
  const Joints joints = PlantsOf(bus, config, bus::IdentityOn(bus, clock).session);
  ListenForAll(bus, clock, joints, timing);
  if (const std::string why = WhyNot(joints, config.bus.url); !why.empty()) return {1, why};
  const auto answered = [](const Asked& joint) { return joint.answered(); };
  const auto asked = clock.Now();
  while (!All(joints, answered) && clock.Now() - asked < timing.presence) {
    for (const auto& joint : joints) {
      if (!joint->answered()) joint->Ask(clock.Utime(), asker);
    }
    for (const auto until = clock.Now() + kRearmRepeat; !All(joints, answered) && clock.Now() < until;)
      bus.HandleUntil(until);
  }
  const auto refused = [](const Asked& joint) { return !joint.accepted() && !joint.nothing_latched(); };
  const bool accepted =
      std::none_of(joints.begin(), joints.end(), [&](const auto& joint) { return refused(*joint); }) &&
      std::any_of(joints.begin(), joints.end(), [](const auto& joint) { return joint->accepted(); });
  const std::string text = config.joints.empty() ? joints.front()->Text() : Answers(joints);
  OperatorResult result{accepted ? 0 : 1, (accepted ? "re-armed: " : "") + text};
  if (!accepted) return result;
  Listen(bus, clock, joints, timing.description, [](const Asked& joint) { return joint.described(); });
  AddForecasts(joints, false, &result);
  return result;
}

}  // namespace hydro::launch
