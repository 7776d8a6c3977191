// The effect of an injected fault on the world: at its beginning, repeatedly while it lasts, and at its end.
#pragma once

#include <optional>
#include <vector>

#include "sim/torture/schedule/schedule.h"
#include "sim/torture/world.h"

namespace hydro::torture {

class ActiveFault {
 public:
  ActiveFault(World& world, const Injection& injection)
      : world_(world), injection_(injection), random_(injection.seed) {}

  void Begin();
  // Empty: the fault does nothing in between. Otherwise: the time in ns until it acts again.
  std::optional<int64_t> Continue();
  void End();

 private:
  Role role() const { return static_cast<Role>(injection_.target); }
  TrueTime end() const { return world_.now() + static_cast<TrueTime>(injection_.duration_s * 1e9); }
  bool BeginOnNetwork();
  bool BeginOnMachine();
  bool BeginOnBoard();
  void BeginOnProcess();
  void SendForeignStop();
  void SendSecondPlant();
  void SendSecondSender();
  void SendSecondReference();
  void SendNonfiniteReference();
  void SendStrangeRequest();
  void SendWrongPlan();
  void SendReplay();
  void SendFlood();
  // Sends the newest genuine motor command with one number changed.
  void SendChangedCommand();

  World& world_;
  const Injection injection_;
  Random random_;
  std::vector<int> links_;
  int64_t sent_ = 0;
};

}  // namespace hydro::torture
