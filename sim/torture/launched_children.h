// The children of a simulated launcher: processes of the world.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "launch/logic/children.h"
#include "launch/logic/stop_sequence.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

class World;

class LaunchedChildren : public launch::Children {
 public:
  // `launcher` is the process whose body uses this.
  LaunchedChildren(World& world, SimulatedProcess& launcher, const launch::Grace& grace)
      : world_(world), launcher_(launcher), stop_(grace) {}

  int32_t Start(const launch::ChildSpec& spec) override;
  void Wait(TimePoint deadline) override;
  std::optional<launch::Ended> NextEnded() override;
  std::optional<int> NextSignal() override;
  void Stop(TimePoint first_signal) override { stop_.Begin(first_signal); }
  bool stopping() const override { return stop_.begun(); }
  void KillAll() override;
  int running() const override { return stop_.running(); }
  size_t unread() const override { return 0; }

 private:
  struct Child : public launch::Stoppable {
    Child(World& w, SimulatedProcess& p, const launch::ChildSpec& s) : world(w), process(p), spec(s) {}
    bool running() const override { return !reaped; }
    bool last() const override { return spec.last; }
    void Signal(int signal_number) override;

    World& world;
    SimulatedProcess& process;
    const launch::ChildSpec spec;
    bool reaped = false;
  };

  bool AnythingToReport() const;
  void Reap();

  World& world_;
  SimulatedProcess& launcher_;
  launch::StopSequence stop_;
  std::vector<std::unique_ptr<Child>> children_;
  std::deque<launch::Ended> ended_;
};

}  // namespace hydro::torture
