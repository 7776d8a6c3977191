// How a World's run ends: faults stop, control must return, the operator stops the stack, and every process
// must end.
#include <fmt/format.h>

#include <algorithm>

#include "sim/torture/active_fault.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

// Control returns within this time after the last fault: another stack is forgotten after 2.5 s, and a stack
// that has ended is started again and gathers its processes in 1 s.
constexpr TrueTime kReturn = 5 * kSecond;
constexpr TrueTime kEnd = 2 * kSecond;  // within which every process has ended after a stop
constexpr TrueTime kLookBack = kSecond / 4;
constexpr int kRequests = 6;  // requests of the operator, half a second apart

constexpr size_t kMostBytes = 16u << 20;

enum Phase { kQuiet = 0, kReturned = 100, kEnded = 200 };

}  // namespace

void World::EnterPhase(int phase) {
  if (phase == kQuiet) Push(now_ + kReturn, Happening::kPhase, kReturned);
  if (phase < kRequests && config_.limits.rearm == settings::Rearm::kExplicit) {
    const PlantRecord* const plant = observer_.newest_plant();
    // An arm that stands beyond its limit stays there, and only a new start helps.
    if (phase == 2 && plant != nullptr && plant->over_limit) SendStop();
    SendRearm();
    Push(now_ + kSecond / 2, Happening::kPhase, phase + 1);
  } else if (phase == kReturned && StillStopping()) {
    Push(now_ + kSecond / 2, Happening::kPhase, kReturned);
  } else if (phase == kReturned) {
    CheckReturned();
    ending_ = true;
    SendStop();
    Push(now_ + kEnd, Happening::kPhase, kEnded);
  } else if (phase == kEnded) {
    CheckEnded();
    over_ = true;
  }
}

// A stop waits up to 12 s for a process that has fallen silent, and ends what is started meanwhile. After
// that, a launch begins again.
bool World::StillStopping() {
  return schedule_.launcher && (!stops_.empty() || (stopped_at_ > 0 && now_ - stopped_at_ < kReturn));
}

void World::CheckReturned() {
  if (const auto driven = observer_.sibling_driven(); driven && *driven < now_ - kLookBack) {
    observer_.Report("control returns when faults stop",
                     fmt::format("{:.3f} s after the last fault the motor of the knee is still at zero volts",
                                 static_cast<double>(kReturn) * 1e-9));
  }
  if (schedule_.planner && observer_.reference_moved() < now_ - kLookBack) {
    observer_.Report("a planner is followed when faults stop",
                     fmt::format("{:.3f} s after the last fault the reference stands at one value",
                                 static_cast<double>(kReturn) * 1e-9));
  }
  if (observer_.last_obeyed() >= now_ - kLookBack) return;
  const PlantRecord* const plant = observer_.newest_plant();
  std::string codes;
  if (plant != nullptr) {
    for (const auto& [code, latched] : plant->zero_faults) codes += " " + code;
  }
  observer_.Report(
      "control returns when faults stop",
      fmt::format("{:.3f} s after the last fault the motor is still at zero volts, active are:{}",
                  static_cast<double>(kReturn) * 1e-9, codes.empty() ? " no faults" : codes));
}

void World::CheckEnded() {
  if (const size_t grown = AllocatedBytes() - std::min(AllocatedBytes(), allocated_); grown > kMostBytes) {
    observer_.Report(
        "memory is bounded",
        fmt::format("the run has taken {} bytes more than at its start, allowed are {}", grown, kMostBytes));
  }
  if (!last_stop_->ended() || last_stop_->exit_code() != 0) {
    observer_.Report(
        "an operator's stop says that all have ended",
        last_stop_->ended() ? fmt::format("its exit code is {}", last_stop_->exit_code()) : "it still waits");
  }
  for (const SimulatedProcess* process : alive_) {
    if (process->role() == Role::kOperator) continue;
    observer_.Report("every run ends", fmt::format("{} has not ended {:.1f} s after a stop",
                                                   TargetName(static_cast<int>(process->role())),
                                                   static_cast<double>(kEnd) * 1e-9));
  }
}

}  // namespace hydro::torture
