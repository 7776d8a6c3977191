#include "sim/limb/limb.h"

#include <algorithm>

#include "base/input_error.h"
#include "base/text_file.h"
#include "plant/simulated_rig.h"
#include "sim/limb/joint.h"

namespace hydro::limb {
namespace {

// In real time each joint's watchdogs and statistics run once in this many ticks. Each tick handles a part of
// the joints, because handling all at once would delay it.
constexpr size_t kPollTicks = 16;

bool IsWanted(const std::string& name, const std::vector<std::string>& wanted) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

void CheckWanted(const settings::LimbConfig& config, const std::vector<std::string>& wanted) {
  const std::vector<std::string>& names = config.common.joints;
  for (const std::string& name : wanted) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError("--joints: found " + Quoted(name) + ", allowed " + QuotedList(names));
  }
  if (config.arm && !wanted.empty() && wanted.size() < names.size()) {
    throw InputError(
        "--joints: found some of the joints of an [arm], allowed all of them: it couples their loads");
  }
}

void CheckSimulated(const settings::JointConfig& joint) {
  if (!joint.config.driver) return;
  throw InputError(joint.config.file + ": joint." + joint.name +
                   ".driver: found a board, allowed is a simulated joint: one on a board runs as processes "
                   "of its own ([[process]] joint = \"" +
                   joint.name + "\")");
}

}  // namespace

Limb::Limb(const settings::LimbConfig& config, const LimbOptions& options)
    : on_joint_fault_(config.limb.on_joint_fault), last_tick_(config.common.last_tick) {
  CheckWanted(config, options.joints);
  if (options.clock != nullptr) clock_.emplace(*options.clock);
  std::vector<std::unique_ptr<plant::SimulatedMachine>> machines;
  if (config.arm) machines = MakeJointedArm(config);
  for (size_t i = 0; i < config.joints.size(); ++i) {
    settings::JointConfig joint = config.joints[i];
    if (!IsWanted(joint.name, options.joints)) continue;
    CheckSimulated(joint);
    joint.config.time.mode =
        options.clock == nullptr ? settings::TimeMode::kLockstep : settings::TimeMode::kRealtime;
    auto rig = config.arm ? std::make_unique<plant::SimulatedRig>(joint.config, std::move(machines[i]))
                          : std::make_unique<plant::SimulatedRig>(joint.config);
    joints_.push_back(std::make_unique<Joint>(joint, std::move(rig), clock_ ? &*clock_ : nullptr,
                                              options.program, options.heartbeat, options.session));
  }
}

bool Limb::Begin() {
  for (auto& joint : joints_) {
    if (!joint->plant().Begin()) return false;
    joint->StartClock();
  }
  for (auto& joint : joints_) {
    if (!joint->plant().Safely([&] { joint->plant().Start(joint->clock().Now()); })) over_ = true;
  }
  return !over_;
}

bool Limb::StepLockstep() {
  for (auto& joint : joints_) {
    if (!joint->ended() && !joint->plant().AwaitAnswers()) NoteEnds();
  }
  if (over_ || tick_ == last_tick_) return false;
  CheckAll();
  DriveAll();
  NoteEnds();
  if (over_) return false;
  ++tick_;
  for (auto& joint : joints_) {
    if (joint->ended()) continue;
    if (!joint->plant().Safely([&] { joint->plant().AdvanceTo(tick_); })) continue;
    joint->Dispatch(joint->DueTime(tick_));
    joint->plant().PublishState(joint->clock().Now());
  }
  NoteEnds();
  return !over_;
}

bool Limb::StepRealtime(const plant::WakeUp& wake_up) {
  tick_ += wake_up.elapsed;
  clock_->Stop();
  for (auto& joint : joints_) {
    if (joint->ended()) continue;
    joint->plant().participant().statistics().RecordCycle(wake_up.at, wake_up.late);
    joint->plant().Safely([&] { joint->plant().Wake(wake_up); });
  }
  CheckAll();
  DriveAll();
  for (auto& joint : joints_) joint->Dispatch({});
  for (size_t i = polled_++ % kPollTicks; i < joints_.size(); i += kPollTicks) {
    if (!joints_[i]->ended()) joints_[i]->Poll();
  }
  NoteEnds();
  clock_->Run();
  return !over_ && tick_ != last_tick_;
}

// The first joint other than `besides` whose own fault zeroes its voltage.
Joint* Limb::FirstFault(const Joint* besides) const {
  for (const auto& joint : joints_) {
    if (joint.get() != besides && !joint->ended() && joint->plant().HasOwnFault()) return joint.get();
  }
  return nullptr;
}

// Checks all joints before any voltage is chosen, so that a fault of the last joint zeroes the first in the
// same tick.
void Limb::CheckAll() {
  for (auto& joint : joints_) {
    if (!joint->ended()) joint->plant().Check(joint->clock().Now());
  }
  if (on_joint_fault_ == settings::OnJointFault::kOthersGoOn) return;
  joints_.front()->plant().HoldForSilence(silence_);  // the other joints follow its fault
  Joint* const first = FirstFault(nullptr);
  Joint* const second = first != nullptr ? FirstFault(first) : nullptr;
  for (auto& joint : joints_) {
    const Joint* other = joint.get() != first ? first : second;
    std::string text = elsewhere_;
    if (other != nullptr) text = "joint " + other->name() + " has the fault " + other->plant().OwnFault();
    joint->plant().HoldForOthers(text);
  }
}

void Limb::DriveAll() {
  for (auto& joint : joints_) {
    if (joint->ended()) continue;
    joint->plant().Safely([&] {
      joint->plant().ChooseVoltage();
      joint->plant().Drive();
    });
  }
}

// A joint whose run is over (it passed a limit, its rig failed, or it was stopped) ends all joints, or only
// itself.
void Limb::NoteEnds() {
  for (auto& joint : joints_) {
    if (joint->ended() || !joint->plant().Ended()) continue;
    const bool failed = !joint->plant().failure().empty();
    if (on_joint_fault_ == settings::OnJointFault::kAllToZero || !failed) {
      over_ = true;
    } else {
      joint->End();
    }
  }
  over_ =
      over_ || std::all_of(joints_.begin(), joints_.end(), [](const auto& joint) { return joint->ended(); });
}

int Limb::End(const std::function<void()>& after_each) {
  for (auto& joint : joints_) joint->rig().Zero();
  int exit_code = 0;
  for (auto& joint : joints_) {
    exit_code = std::max(exit_code, joint->End());
    if (after_each) after_each();
  }
  return exit_code;
}

std::string Limb::failure() const {
  for (const auto& joint : joints_) {
    if (const std::string why = joint->plant().failure(); !why.empty()) return joint->name() + ": " + why;
  }
  return "";
}

}  // namespace hydro::limb
