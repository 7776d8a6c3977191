// A simulated stack and everything around it: processes on machines, the network between them, and the faults
// of a schedule. There is one thread and one order of events, so the same schedule gives the same run, bit by
// bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/faulty_rig.h"
#include "sim/torture/invariants/launch_invariants.h"
#include "sim/torture/invariants/observer.h"
#include "sim/torture/invariants/records.h"
#include "sim/torture/machines/machine.h"
#include "sim/torture/machines/network.h"
#include "sim/torture/machines/simulated_process.h"
#include "sim/torture/message_tail.h"
#include "sim/torture/run_outcome.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// The number of bytes that this program has allocated.
size_t AllocatedBytes();

class World : public NetworkPort {
 public:
  // `stacks` must outlive it.
  World(const Schedule& schedule, const Stacks& stacks);
  ~World() override;

  // From now on, also tells `tail` what happens. It must outlive the run.
  void SetTail(MessageTail* tail) { tail_ = tail; }

  // Performs the whole run: start, faults, return to control, end. Stops at the first violation.
  RunOutcome Run();

  // For the injector: times are true times.
  TrueTime now() const { return now_; }
  const settings::StackConfig& config() const { return config_; }
  Network& network() { return network_; }
  Observer& observer() { return observer_; }
  std::vector<SensorFault>& sensor_faults() { return sensor_faults_; }
  BoardFaults& board() { return board_; }
  bool has_driver() const { return schedule_.driver; }
  bool has_knee() const { return schedule_.limb; }
  // How many injected faults stop the launcher now.
  int& launcher_hangs() { return launcher_hangs_; }
  Machine& MachineOf(Role role) { return *machines_[static_cast<size_t>(HomeOf(role))]; }
  SimulatedProcess& process(int number) { return *by_number_[static_cast<size_t>(number)]; }
  // The living process of a role; null: none.
  SimulatedProcess* Find(Role role);
  // Kills the process of a role. Without a launcher, it is started again at that time.
  void Kill(Role role, TrueTime restart_at);
  // Kills the launcher. The kernel then sends SIGTERM to its children.
  void KillLauncher();
  void InterruptLauncher();
  void HangLauncher(TrueTime until);
  // From now on, starts a role with that configuration; null: with the right one again.
  void StartWith(Role role, const settings::StackConfig* other) {
    starts_with_[static_cast<size_t>(role)] = other;
  }
  const Stacks& stacks() const { return stacks_; }
  bool has_launcher() const { return schedule_.launcher; }
  // For a launcher: these start the process of a role, send a process a signal and print a line.
  SimulatedProcess& StartChild(Role role);
  void SendSignal(const SimulatedProcess& process, int signal);
  void Say(int process, const std::string& text);
  // The clocks of a role's machine have changed.
  void ClockChanged(Role role);
  // Everything of a machine stands still until `until`, and its clocks count the time as suspended.
  void Suspend(Role role, TrueTime until);
  // Sends a message that no process has sent to everyone. Origin::kProcess marks a message that the operator
  // may send.
  template <class Message>
  void Forge(const Message& message, Origin origin = Origin::kForged) {
    ForgeBytes(channels_.Of<Message>(), bus::TypeOf<Message>(), &message, origin);
  }
  void ForgeAgain(const Packet& packet);
  // The newest motor command that was sent before that time; null: none is remembered.
  const Packet* RecordedCommand(TrueTime before) const;
  // An operator's process asks the plant to continue, or everybody to end.
  void SendRearm();
  void SendStop();
  // An intruder with the stack's key sends motor commands.
  void SendInsider(double voltage, double seconds, int64_t first_sequence);
  void SendSet(int which);
  // Ends the planner and starts it again at `until`. Where none runs, nothing happens.
  void SilencePlanner(TrueTime until);
  // The newest pressure command, and the newest plan; null: there was none.
  const Packet* newest_reference() const { return newest_reference_.get(); }
  const Packet* newest_plan() const { return newest_plan_.get(); }
  Disk& disk() { return disk_; }
  bool has_logger() const { return schedule_.logger; }
  // The path of a new log for the process `number`.
  std::string NewLog(int number);
  // Notes a fault of the log that is being written.
  void NoteLogFault(bool LogRecord::*what);
  // Notes that a bit of the newest log was changed.
  void NoteLie();
  // Deletes the newest log. Its logger continues to write into the deleted file.
  void DeleteLog();
  Coverage& coverage() { return outcome_.coverage; }

  // NetworkPort:
  int ChannelNumber(const std::string& name) override { return network_.ChannelNumber(name); }
  const std::string& ChannelName(int channel) const override { return network_.ChannelName(channel); }
  PacketPtr NewPacket() override { return network_.NewPacket(); }
  void Send(PacketPtr packet, int sender) override;
  void Handled(const Packet& packet, int receiver) override;

 private:
  enum class Happening : uint8_t {
    kArrival,
    kBegin,
    kContinue,
    kEnd,
    kStart,
    kAwake,
    kPhase,
    kSignal,
    kLaunchDue,
    kPlanner
  };
  static constexpr int kSignals = 64;  // a kSignal's number: the process's times this, plus the signal
  struct Event {
    TrueTime time;
    uint64_t order;
    Happening what;
    int number;  // receiver, injection, role
    PacketPtr packet;
  };

  void Push(TrueTime time, Happening what, int number, PacketPtr packet = nullptr);
  static bool Later(const Event& a, const Event& b);
  void Step();
  void Tell(const Packet& packet, int process, const char* what);
  std::string NameOf(int process) const;
  void TellInjection(int number, const char* what);
  void Happen(const Event& event);
  void Arrive(const PacketPtr& packet, int receiver);
  void Start(Role role);
  SimulatedProcess& Begin(Role role, SimulatedProcess::Body body, bool misconfigured);
  SimulatedProcess& BeginRole(Role role);
  void StartAt(Role role, TrueTime time);
  void Awake(Role role);
  void StartPlanner();
  void NoteConfigurations();
  void Signal(SimulatedProcess& process, int signal);
  void Destroy(SimulatedProcess& process, int signal);
  void Reap(SimulatedProcess& process);
  void NoteDue();
  void CheckLaunchIsOver(int launcher);
  void CheckLog(const SimulatedProcess& logger);
  void EnterPhase(int phase);
  bool StillStopping();
  void CheckReturned();
  void CheckEnded();
  void ForgeBytes(const std::string& channel, const bus::MessageType& type, const void* message,
                  Origin origin);

  const Schedule schedule_;
  const settings::StackConfig& config_;
  const Stacks& stacks_;
  const bus::Channels channels_;
  TrueTime now_ = 0;
  RunOutcome outcome_;
  Trace trace_;
  Network network_;
  Observer observer_;
  Random random_;
  std::vector<std::unique_ptr<Machine>> machines_;  // by role
  std::vector<std::unique_ptr<SimulatedProcess>> processes_;
  std::vector<SimulatedProcess*> by_number_;
  std::vector<SimulatedProcess*> alive_;
  std::vector<Network::Receiver> receivers_;
  // By role:
  std::array<const settings::StackConfig*, static_cast<size_t>(Role::kCount)> starts_with_{};
  std::array<TrueTime, static_cast<size_t>(Role::kCount)> start_at_{};  // the next start
  std::array<TrueTime, static_cast<size_t>(Role::kCount)> awake_at_{};  // when its machine wakes up
  std::array<TrueTime, static_cast<size_t>(Role::kCount)> asleep_since_{};
  std::vector<SensorFault> sensor_faults_;
  BoardFaults board_;
  SimulatedProcess* planner_ = nullptr;
  PacketPtr newest_reference_, newest_plan_;
  int reference_channel_ = -1, plan_channel_ = -1;
  std::vector<std::unique_ptr<class ActiveFault>> active_;  // by injection
  std::vector<Event> events_;                               // a heap
  int launcher_hangs_ = 0;
  int due_launcher_ = -1;  // the newest launcher whose deadline for its end is known
  TrueTime due_at_ = 0;    // when that deadline is checked
  MessageTail* tail_ = nullptr;
  LaunchInvariants launches_;
  Random start_random_;  // for the time that a launcher's children take to begin
  Disk disk_;
  Random disk_random_;
  std::map<int, LogRecord> logs_;  // by number of the process that writes the log
  uint64_t order_ = 0;
  std::deque<PacketPtr> recorded_;  // the newest motor commands
  int command_channel_ = -1;
  const size_t allocated_ = AllocatedBytes();  // bytes at the start
  bool ending_ = false;
  std::set<const SimulatedProcess*> stops_;  // operators that wait for the stack to end
  const SimulatedProcess* last_stop_ = nullptr;
  TrueTime stopped_at_ = 0;  // when one of them last finished
  bool over_ = false;
};

}  // namespace hydro::torture
