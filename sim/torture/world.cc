#include "sim/torture/world.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <utility>

#include "process/stop_signal.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/programs.h"
#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

constexpr size_t kMostRecorded = 4096;
constexpr TrueTime kStarts = 50'000'000;  // ns within which the processes of a stack start

TrueTime FromSeconds(double seconds) { return static_cast<TrueTime>(seconds * 1e9); }

}  // namespace

size_t AllocatedBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

World::World(const Schedule& schedule, const Stacks& stacks)
    : schedule_(schedule),
      config_(stacks.right),
      stacks_(stacks),
      channels_(config_.bus.channel_suffix),
      network_(schedule.seed, &now_,
               [this](TrueTime time, PacketPtr packet, int receiver) {
                 Push(time, Happening::kArrival, receiver, std::move(packet));
               }),
      observer_(config_, network_, &now_, outcome_.coverage),
      random_(schedule.seed, 2),
      launches_(config_, network_, &now_, observer_),
      start_random_(schedule.seed, 5),
      disk_random_(schedule.seed, 3) {
  static constexpr const char* kHosts[] = {"rig", "loop", "desk", "store", "office"};
  for (const char* host : kHosts) {
    machines_.push_back(
        std::make_unique<Machine>(host, &now_, random_.Between(10, 1e5), 1.7e9 + random_.Between(0, 1e6)));
  }
  if (schedule.key) observer_.SetSealed();
  command_channel_ = network_.ChannelNumber(channels_.Of<motor_command_t>());
  reference_channel_ = network_.ChannelNumber(channels_.Of<pressure_command_t>());
  plan_channel_ = network_.ChannelNumber(channels_.Of<arm_plan_t>());
  if (schedule.planner) Push(kStarts, Happening::kPlanner, 0);
  std::vector<Role> first{Role::kPlant, Role::kPressure, Role::kPosition};
  if (schedule.logger) first.push_back(Role::kLogger);
  if (schedule.launcher) first = {Role::kLauncher};
  if (schedule.limb) {
    machines_.resize(static_cast<size_t>(Role::kCount));
    Random draw(schedule.seed, 7);
    machines_[static_cast<size_t>(Role::kKneePlant)] =
        std::make_unique<Machine>("knee", &now_, draw.Between(10, 1e5), 1.7e9 + draw.Between(0, 1e6));
    first.insert(first.end(), {Role::kKneePlant, Role::kKneePressure, Role::kKneePosition});
  }
  for (const Role role : first) {
    Push(static_cast<TrueTime>(random_.Index(kStarts)), Happening::kStart, static_cast<int>(role));
  }
  for (size_t i = 0; i < schedule_.injections.size(); ++i) {
    const Injection& injection = schedule_.injections[i];
    active_.push_back(std::make_unique<ActiveFault>(*this, injection));
    Push(FromSeconds(injection.at_s), Happening::kBegin, static_cast<int>(i));
    Push(FromSeconds(injection.at_s + injection.duration_s), Happening::kEnd, static_cast<int>(i));
  }
  Push(FromSeconds(schedule_.faults_until_s), Happening::kPhase, 0);
}

World::~World() {
  alive_.clear();
  processes_.clear();  // unwinds the fibers while everything that they use still exists
}

void World::Push(TrueTime time, Happening what, int number, PacketPtr packet) {
  events_.push_back({time, order_++, what, number, std::move(packet)});
  std::push_heap(events_.begin(), events_.end(), &Later);
}

bool World::Later(const Event& a, const Event& b) {
  return a.time != b.time ? a.time > b.time : a.order > b.order;
}

RunOutcome World::Run() {
  while (!over_ && observer_.violations().empty() && process::StopSignal() == 0) Step();
  outcome_.violations = observer_.violations();
  trace_.Add(static_cast<uint64_t>(now_));
  outcome_.trace = trace_.value();
  outcome_.coverage.runs = 1;
  outcome_.coverage.simulated_s = static_cast<double>(now_) * 1e-9;
  outcome_.coverage.AddPairs(schedule_.injections);
  outcome_.coverage.AddRows(schedule_.injections);
  return std::move(outcome_);
}

// Handles the next event, or runs the next process that can continue, whichever comes first.
void World::Step() {
  SimulatedProcess* next = nullptr;
  TrueTime wake = kNever;
  for (SimulatedProcess* process : alive_) {
    if (process->wake() >= wake) continue;
    wake = process->wake();
    next = process;
  }
  if (!events_.empty() && events_.front().time <= wake) {
    std::pop_heap(events_.begin(), events_.end(), &Later);
    Event event = std::move(events_.back());
    events_.pop_back();
    now_ = std::max(now_, event.time);
    Happen(event);
    return;
  }
  if (next == nullptr) {
    observer_.Report("the run ends", "nothing is left that could happen");
    return;
  }
  now_ = std::max(now_, wake);
  next->Resume();
  if (next->ended()) Reap(*next);
}

void World::Happen(const Event& event) {
  switch (event.what) {
    case Happening::kArrival:
      Arrive(event.packet, event.number);
      break;
    case Happening::kBegin:
      ++outcome_.coverage.injected;
      ++outcome_.coverage.kinds[schedule_.injections[static_cast<size_t>(event.number)].kind];
      TellInjection(event.number, "begins");
      active_[static_cast<size_t>(event.number)]->Begin();
      [[fallthrough]];
    case Happening::kContinue: {
      const Injection& injection = schedule_.injections[static_cast<size_t>(event.number)];
      const auto pause = active_[static_cast<size_t>(event.number)]->Continue();
      if (pause && now_ + *pause < FromSeconds(injection.at_s + injection.duration_s)) {
        Push(now_ + *pause, Happening::kContinue, event.number);
      }
      break;
    }
    case Happening::kEnd:
      TellInjection(event.number, "ends");
      active_[static_cast<size_t>(event.number)]->End();
      break;
    case Happening::kStart:
      Start(static_cast<Role>(event.number));
      break;
    case Happening::kAwake:
      Awake(static_cast<Role>(event.number));
      break;
    case Happening::kPhase:
      EnterPhase(event.number);
      break;
    case Happening::kSignal:
      Signal(*by_number_[static_cast<size_t>(event.number / kSignals)], event.number % kSignals);
      break;
    case Happening::kLaunchDue:
      CheckLaunchIsOver(event.number);
      break;
    case Happening::kPlanner:
      StartPlanner();
      break;
  }
}

void World::Arrive(const PacketPtr& packet, int receiver) {
  for (SimulatedProcess* process : alive_) {
    if (receiver != kEveryone && process->number() != receiver) continue;
    if (process->ended() || process->killed() || !process->bus().Hears(packet->channel)) continue;
    if (awake_at_[static_cast<size_t>(HomeOf(process->role()))] > now_) continue;
    process->Arrive(packet);
  }
}

void World::Send(PacketPtr packet, int sender) {
  Tell(*packet, sender, "sends");
  const SimulatedProcess& process = *by_number_[static_cast<size_t>(sender)];
  trace_.Add(static_cast<uint64_t>(now_));
  trace_.Add(packet->bytes);
  if (packet->channel == command_channel_) {
    if (process.role() == Role::kOperator) packet->origin = Origin::kInsider;
    recorded_.push_back(packet);
    if (recorded_.size() > kMostRecorded) recorded_.pop_front();
  }
  if (packet->channel == reference_channel_) newest_reference_ = packet;
  if (packet->channel == plan_channel_) newest_plan_ = packet;
  network_.Send(packet, static_cast<int>(process.role()), receivers_);
  observer_.OnSent(*packet, process);
}

void World::Handled(const Packet& packet, int receiver) {
  Tell(packet, receiver, "handles");
  trace_.Add(static_cast<uint64_t>(now_) ^ static_cast<uint64_t>(receiver) << 56);
  const SimulatedProcess& process = *by_number_[static_cast<size_t>(receiver)];
  observer_.OnHandled(packet, process);
  if (process.role() == Role::kLauncher) {
    launches_.OnHandled(packet, process);
    NoteDue();
  }
  if (const auto log = logs_.find(receiver); log != logs_.end()) {
    const auto size = static_cast<int>(packet.bytes.size());
    const int visible = schedule_.key ? bus::SizeWithoutSeal(packet.bytes.data(), size) : size;
    log->second.Handle(network_.ChannelName(packet.channel), packet.bytes.data(),
                       static_cast<size_t>(visible));
  }
}

}  // namespace hydro::torture
