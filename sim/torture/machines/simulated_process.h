// A process of the stack in the simulation: its real application on a fiber, with a bus and a machine.
#pragma once

#include <boost/context/fiber.hpp>
#include <csignal>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "bus/bus.h"
#include "sim/torture/machines/machine.h"
#include "sim/torture/machines/network_bus.h"

namespace hydro::torture {

// A function with a stack of its own that can stop in the middle and continue later. It lets several blocking
// loops (PlantApp::Run(), process::RunApp()) take turns on one thread.
class Fiber {
 public:
  // `body` runs from the first Resume() on. It must not let an exception out.
  explicit Fiber(std::function<void()> body);
  // Unwinds the body if it has not returned. It is better to let the body end.
  ~Fiber() = default;
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // Runs the body until it calls Suspend() or returns. Called from outside.
  void Resume();

  // Returns to the caller of Resume(). Called by the body, also from within a catch block.
  void Suspend();

  bool done() const { return done_; }

 private:
  // The C++ runtime's record of the exceptions that a thread is handling. Each fiber has its own.
  struct ExceptionState {
    void* caught = nullptr;
    unsigned int uncaught = 0;
  };
  static void Swap(ExceptionState* state);

  std::function<void()> body_;
  bool done_ = false;
  ExceptionState exceptions_;
  boost::context::fiber outside_;
  boost::context::fiber inside_;
};

inline constexpr TrueTime kNever = std::numeric_limits<TrueTime>::max() / 4;

// The processes of a stack. Faults also name their targets by these numbers.
enum class Role : int8_t {
  kPlant,
  kPressure,
  kPosition,
  kLogger,
  kOperator,
  kLauncher,
  // Those of the other joint of a limb:
  kKneePlant,
  kKneePressure,
  kKneePosition,
  kCount
};

inline bool IsOfKnee(Role role) { return role >= Role::kKneePlant && role < Role::kCount; }

// The role whose machine a role runs on. The launcher starts the plant on its own machine; the knee's
// processes share one machine.
inline Role HomeOf(Role role) {
  if (IsOfKnee(role)) return Role::kKneePlant;
  return role == Role::kLauncher ? Role::kPlant : role;
}

class SimulatedProcess : public Waiter {
 public:
  // What a process does; returns its exit code.
  using Body = std::function<int(bus::Bus&, bus::Clock&)>;

  SimulatedProcess(int number, Role role, Machine& machine, const TrueTime* now, bus::HostedProcess identity,
                   NetworkPort& port, Body body);
  ~SimulatedProcess() override;

  int number() const { return number_; }
  Role role() const { return role_; }
  Machine& machine() const { return machine_; }
  const bus::HostedProcess& identity() const { return identity_; }
  NetworkBus& bus() { return bus_; }

  // The time at which it wants to run next.
  TrueTime wake() const { return wake_; }
  // Runs the process until it waits again or ends.
  void Resume();

  // A packet has arrived to which the process subscribes.
  void Arrive(PacketPtr packet);
  // The process does not run before `until`, whatever happens.
  void FreezeUntil(TrueTime until);
  // From now on, it runs each time this much later than it could.
  void SetSlowness(int64_t ns);
  // Its machine's clock runs differently from now on.
  void ClockChanged();
  // A signal that the process cannot catch: it ends without another message.
  void Kill(int signal = SIGKILL);
  // SIGTERM and the like.
  void Signal(int signal);
  // Makes its current wait return.
  void Interrupt();
  // Returns the signal that it has been sent, once; 0: none.
  int TakeSignal() { return std::exchange(identity_.stop_signal, 0); }
  // Beat() is a heartbeat of its launcher; TakeBeat() tells whether one has come since the last call.
  void Beat() { beat_ = true; }
  bool TakeBeat() { return std::exchange(beat_, false); }

  bool ended() const { return fiber_.done(); }
  // Whether it has run. Until then it does not catch signals.
  bool begun() const { return begun_; }
  TrueTime frozen_until() const { return frozen_until_; }
  bool killed() const { return killed_by_ != 0; }
  int killed_by() const { return killed_by_; }  // the signal; 0: it was not killed
  int exit_code() const { return exit_code_; }
  const std::string& failure() const { return failure_; }  // of an exception that left the application
  // Whether it runs with another configuration than the rest of the stack.
  void set_misconfigured(bool misconfigured) { misconfigured_ = misconfigured; }
  bool misconfigured() const { return misconfigured_; }

  // Waiter:
  bool WaitUntil(bus::Bus::TimePoint deadline) override { return Await(deadline, true); }
  // The same, but packets only accumulate.
  void SleepUntil(bus::Bus::TimePoint deadline) { Await(deadline, false); }

 private:
  void RunBody();
  bool Await(bus::Bus::TimePoint deadline, bool packets);
  void UpdateWake();

  const int number_;
  const Role role_;
  Machine& machine_;
  const TrueTime* now_;
  bus::HostedProcess identity_;
  NetworkBus bus_;
  Body body_;
  TrueTime deadline_;                   // of its current wait
  bus::Bus::TimePoint local_deadline_;  // that deadline on its own clock
  TrueTime ready_ = kNever;
  TrueTime frozen_until_ = 0;
  int64_t slowness_ns_ = 0;
  TrueTime wake_;
  bool misconfigured_ = false;
  bool begun_ = false;
  bool beat_ = false;
  int killed_by_ = 0;
  bool interrupted_ = false;  // by a signal for which no wait has returned yet
  int exit_code_ = -1;
  std::string failure_;
  TrueTime idle_since_ = -1;
  int idle_turns_ = 0;  // number of waits at that time that were over at once
  Fiber fiber_;
};

}  // namespace hydro::torture
