// The launcher's decisions, on a simulated clock: no process, no network.
#include "launch/logic/stack_launch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <deque>
#include <functional>
#include <map>

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "process/participant.h"
#include "tests/stack_fixture.h"

namespace hydro::launch {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using namespace std::chrono_literals;

class FakeReport : public LaunchReport {
 public:
  void Print(const std::string& text) override { lines.push_back(text); }
  void PrintError(const std::string& text) override { errors.push_back(text); }
  std::string WriteTiming(const timing::TimingRecord& /*record*/) override { return ""; }

  std::vector<std::string> lines, errors;
};

// Children that do what the test says, each time the launcher waits.
class FakeChildren : public Children {
 public:
  explicit FakeChildren(bus::SimulatedClock& clock) : clock_(clock) {}

  int32_t Start(const ChildSpec& spec) override {
    pids[spec.program()] = ++last_pid_;
    specs_[spec.program()] = spec;
    return last_pid_;
  }
  void Wait(TimePoint deadline) override {
    clock_.AdvanceTo(deadline);
    on_wait();
    if (!stop_at_ || clock_.Now() < *stop_at_ || deaf) return;
    for (const auto& [program, pid] : std::map(pids)) End(program, {0, 0}, true);
  }
  std::optional<Ended> NextEnded() override { return Next(ended_); }
  std::optional<int> NextSignal() override { return Next(signals); }
  void Stop(TimePoint first_signal) override {
    stop_at_ = std::min(first_signal, stop_at_.value_or(first_signal));
  }
  bool stopping() const override { return stop_at_.has_value(); }
  void KillAll() override {
    for (const auto& [program, pid] : std::map(pids)) End(program, {0, SIGKILL}, true);
  }
  int running() const override { return static_cast<int>(pids.size()); }
  size_t unread() const override { return unread_bytes; }

  void End(const std::string& program, ProcessEnd end, bool terminated = false) {
    ended_.push_back(
        {specs_[program].label, program, specs_[program].role(), pids.at(program), end, terminated, false});
    pids.erase(program);
  }

  std::function<void()> on_wait = [] {};
  std::map<std::string, int32_t> pids;  // of those that run
  std::deque<int> signals;
  bool deaf = false;
  size_t unread_bytes = 0;

 private:
  template <class T>
  static std::optional<T> Next(std::deque<T>& queue) {
    if (queue.empty()) return std::nullopt;
    const T next = queue.front();
    queue.pop_front();
    return next;
  }

  bus::SimulatedClock& clock_;
  int32_t last_pid_ = 100;
  std::map<std::string, ChildSpec> specs_;
  std::deque<Ended> ended_;
  std::optional<TimePoint> stop_at_;
};

class StackLaunchTest : public ::testing::Test {
 protected:
  StackLaunchTest() {
    plan_.children = {{"plant", {"hydro-plant"}, false},
                      {"pressure_ctrl", {"hydro-pressure-ctrl"}, false},
                      {"logger", {"hydro-logger"}, true}};
    bus_.Subscribe<stop_t>("HYDRO_STOP", [this](const stop_t& stop) { stops_.push_back(stop); });
  }

  // Runs a launch in which all become ready and `then` happens when so much time has passed since.
  int Run(bus::Clock::Duration after, std::function<void()> then) {
    bool ready = false, done = false;
    bus::Clock::TimePoint start{};
    children_.on_wait = [&, then] {
      if (!ready) AnnounceAll();
      if (!ready) start = clock_.Now();
      ready = true;
      if (done || clock_.Now() - start < after) return;
      done = true;
      then();
    };
    return StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run();
  }

  void AnnounceAll() {
    for (const auto& [program, role] :
         std::map<std::string, std::string>{{"hydro-plant", "plant"},
                                            {"hydro-pressure-ctrl", "pressure_ctrl"},
                                            {"hydro-logger", "logger"}}) {
      if (children_.pids.contains(program)) Announce(role, children_.pids[program]);
    }
  }

  void Announce(const std::string& role, int32_t pid) {
    process_status_t status{};
    status.session = 1000 + pid;
    status.role = role;
    status.pid = pid;
    status.state = process_status_t::READY;
    bus_.Publish("HYDRO_PROCESS_STATUS", status);
  }

  void PublishStop(int exit_code) {
    stop_t stop{};
    stop.session = 7;
    stop.source = "plant";
    stop.reason = "because";
    stop.exit_code = exit_code;
    bus_.Publish("HYDRO_STOP", stop);
  }

  settings::StackConfig config_ = testing::SmallStack();
  LaunchPlan plan_;
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  FakeChildren children_{clock_};
  FakeReport report_;
  std::vector<stop_t> stops_;
};

// Tests that SIGINT ends a run in order, and tells the plant's run so several times.
TEST_F(StackLaunchTest, SignalEndsInOrder) {
  EXPECT_EQ(Run(1s, [&] { children_.signals.push_back(SIGINT); }), 0);
  EXPECT_THAT(report_.lines, Contains("all 3 processes ready after 0.02 s"));
  EXPECT_THAT(report_.lines, Contains("stopped by SIGINT"));
  EXPECT_THAT(report_.errors, IsEmpty());
  ASSERT_FALSE(stops_.empty());
  EXPECT_EQ(stops_[0].addressee, 1101);
  EXPECT_EQ(stops_[0].exit_code, 0);
}

// Tests that a launcher that was told to end does so where nobody takes its output.
TEST_F(StackLaunchTest, AnUnreadOutputDoesNotHoldTheEnd) {
  children_.unread_bytes = 1000;
  bus::Clock::TimePoint told{};
  EXPECT_EQ(Run(1s,
                [&] {
                  told = clock_.Now();
                  children_.signals.push_back(SIGTERM);
                }),
            0);
  EXPECT_GE(clock_.Now() - told, 2s);
  EXPECT_LT(clock_.Now() - told, 4s);
}

// Tests that a reader that takes a little now and then gets all of it.
TEST_F(StackLaunchTest, ASlowReaderGetsAll) {
  // A byte a wait, each of which lasts until the deadline.
  FakeChildren slow(clock_);
  bool ready = false, signalled = false;
  slow.unread_bytes = 10;
  slow.on_wait = [&] {
    if (slow.pids.empty() && slow.unread_bytes > 0) --slow.unread_bytes;
    if (!ready) {
      for (const auto& [program, role] :
           std::map<std::string, std::string>{{"hydro-plant", "plant"},
                                              {"hydro-pressure-ctrl", "pressure_ctrl"},
                                              {"hydro-logger", "logger"}}) {
        Announce(role, slow.pids[program]);
      }
    }
    ready = true;
    if (!signalled) slow.signals.push_back(SIGINT);
    signalled = true;
  };
  EXPECT_EQ(StackLaunch(bus_, clock_, slow, report_, config_, plan_, {}).Run(), 0);
  EXPECT_EQ(slow.unread_bytes, 0u) << "all was taken";
}

// Tests that another host's logger keeps nobody from starting a stack that is spread over hosts, as another
// plant does; and on one machine it does.
TEST_F(StackLaunchTest, AnotherHostsLoggerIsNoOtherStack) {
  std::string other = "logger";
  bus_.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [&](const process_status_t& status) {
    if (status.role == process::kLaunchRole && children_.pids.empty()) Announce(other, 900);
  });
  const auto run = [&] { return Run(1s, [&] { children_.signals.push_back(SIGINT); }); };
  EXPECT_THROW(run(), InputError);
  plan_.spread = true;
  EXPECT_EQ(run(), 0);
  other = "plant";
  EXPECT_THROW(run(), InputError);
}

// Tests that a second SIGINT kills those that do not end.
TEST_F(StackLaunchTest, SecondInterruptKills) {
  children_.deaf = true;
  int interrupts = 0;
  children_.on_wait = [&] {
    AnnounceAll();
    if (clock_.Now().time_since_epoch() > (interrupts + 1) * 1s && interrupts < 2) {
      children_.signals.push_back(SIGINT);
      ++interrupts;
    }
  };
  EXPECT_EQ(StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run(), 1);
  EXPECT_THAT(report_.errors, Contains("second SIGINT: killing what is left"));
  EXPECT_LT(clock_.Now().time_since_epoch(), 3s);
}

// Tests that a child's death ends the run at once, with its name and exit code 1.
TEST_F(StackLaunchTest, DeathEndsTheRun) {
  EXPECT_EQ(Run(1s, [&] { children_.End("hydro-pressure-ctrl", {0, SIGSEGV}); }), 1);
  EXPECT_THAT(report_.errors, Contains("hydro-pressure-ctrl was killed by signal 11 (SIGSEGV)"));
  ASSERT_FALSE(stops_.empty());
  EXPECT_EQ(stops_[0].exit_code, 1);
  EXPECT_LT(clock_.Now().time_since_epoch(), 2s);
}

// Tests that a plant that was killed, and could not say what voltage it left, is named as that.
TEST_F(StackLaunchTest, KilledPlantSaysNothingOfItsOutput) {
  EXPECT_EQ(Run(1s, [&] { children_.End("hydro-plant", {0, SIGKILL}); }), 1);
  EXPECT_THAT(report_.errors, Contains(HasSubstr("no plant or driver has said what voltage it left")));
}

// Tests that the end of a logger that is not required is said, and ends nothing.
TEST_F(StackLaunchTest, OptionalLogger) {
  config_.logger.required = false;
  bool goes_on = false;
  EXPECT_EQ(Run(1s,
                [&] {
                  children_.End("hydro-logger", {1, 0});
                  children_.on_wait = [&] {
                    if (clock_.Now().time_since_epoch() < 30s) return;
                    goes_on = true;
                    children_.signals.push_back(SIGTERM);
                  };
                }),
            1);
  EXPECT_TRUE(goes_on);
  EXPECT_THAT(report_.errors, Contains(HasSubstr("the run goes on (logger.required = false)")));
}

// Tests that after a stop the processes may end by themselves, and get SIGTERM when their time is over.
TEST_F(StackLaunchTest, PatientAfterAStop) {
  EXPECT_EQ(Run(1s, [&] { PublishStop(0); }), 0);
  EXPECT_THAT(report_.lines, Contains("stopped by plant: because"));
  EXPECT_GT(clock_.Now().time_since_epoch(), 4s);
  EXPECT_LT(clock_.Now().time_since_epoch(), 5s);
}

// Tests that the limb says why it ends, and not a joint inside it, which has no session in lockstep.
TEST_F(StackLaunchTest, TheLimbSaysWhy) {
  config_.joints = {"hip"};
  config_.bus.joint_suffixes = {"_hip"};
  EXPECT_EQ(Run(1s,
                [&] {
                  stop_t stop{};
                  stop.source = "plant";
                  bus_.Publish("HYDRO_STOP_hip", stop);
                  stop.session = 5;
                  stop.source = "limb";
                  stop.reason = "because";
                  bus_.Publish("HYDRO_STOP", stop);
                }),
            0);
  EXPECT_THAT(report_.lines, Contains("stopped by limb: because"));
}

// Tests that a stop with an error is one.
TEST_F(StackLaunchTest, StopWithAnError) {
  EXPECT_EQ(Run(1s, [&] { PublishStop(1); }), 1);
}

// Tests that an end with 0 is in order when the stop that it follows from arrives soon, and otherwise not.
TEST_F(StackLaunchTest, EarlyEnd) {
  EXPECT_EQ(Run(1s, [&] { children_.End("hydro-plant", {0, 0}); }), 1);
  EXPECT_THAT(report_.errors, Contains("hydro-plant ended though nobody had stopped the run"));
}

TEST_F(StackLaunchTest, EndBeforeItsStop) {
  EXPECT_EQ(Run(1s,
                [&] {
                  children_.End("hydro-plant", {0, 0});
                  children_.on_wait = [&] { PublishStop(0); };
                }),
            0);
  EXPECT_THAT(report_.errors, IsEmpty());
}

// Tests that a process whose announcement was lost is asked again: it runs, and answers.
TEST_F(StackLaunchTest, AsksAgainWhoIsReady) {
  int questions = 0;
  bus_.Subscribe<process_status_t>("HYDRO_PROCESS_STATUS", [&](const process_status_t& status) {
    if (status.role != "launch" || children_.pids.empty()) return;
    if (++questions == 3) AnnounceAll();
  });
  children_.on_wait = [&] {
    if (clock_.Now().time_since_epoch() > 10s) children_.signals.push_back(SIGTERM);
  };
  EXPECT_EQ(StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run(), 0);
  EXPECT_EQ(questions, 3);
  EXPECT_THAT(report_.errors, IsEmpty());
}

// Tests that a process that does not become ready in time is named.
TEST_F(StackLaunchTest, NotReady) {
  config_.time.start_timeout_s = 2;
  children_.on_wait = [&] { Announce("plant", children_.pids["hydro-plant"]); };
  EXPECT_EQ(StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run(), 1);
  EXPECT_THAT(report_.errors,
              Contains(HasSubstr("(time.start_timeout_s): hydro-pressure-ctrl, hydro-logger")));
}

class DriverLaunchTest : public StackLaunchTest {
 protected:
  DriverLaunchTest() {
    config_.time.start_timeout_s = 2;
    plan_.children = {{"driver", {"hydro-driver"}, false}, {"pressure_ctrl", {"hydro-pressure-ctrl"}, false}};
  }
};

// Tests that a driver which has not found its device has the time to say what is missing and what to do.
TEST_F(DriverLaunchTest, SaysWhatIsMissing) {
  const auto start = clock_.Now();
  children_.on_wait = [&] {
    if (clock_.Now() - start > 2700ms && children_.pids.contains("hydro-driver"))
      children_.End("hydro-driver", {2, 0});
  };
  EXPECT_EQ(StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run(), 2);
  EXPECT_THAT(report_.errors, Not(Contains(HasSubstr("not ready"))));
}

// Tests that a driver which says nothing for that long is named.
TEST_F(DriverLaunchTest, SaysNothing) {
  const auto start = clock_.Now();
  EXPECT_EQ(StackLaunch(bus_, clock_, children_, report_, config_, plan_, {}).Run(), 1);
  EXPECT_THAT(report_.errors,
              Contains(HasSubstr("(time.start_timeout_s): hydro-driver, hydro-pressure-ctrl")));
  EXPECT_GE(clock_.Now() - start, 3s);
}

class FaultAtTheEndTest : public StackLaunchTest, public ::testing::WithParamInterface<bool> {};

// Tests that a fault that is still active at the end makes the exit code 1; one that has ended does not.
TEST_P(FaultAtTheEndTest, Counts) {
  const auto raise = [&](bool active) {
    fault_t fault{};
    fault.session = 1101;
    fault.source = "plant";
    fault.code = "pressure_limit";
    fault.active = active;
    bus_.Publish("HYDRO_FAULT", fault);
  };
  const auto happens = [&] {
    raise(true);
    if (GetParam()) raise(false);
    children_.signals.push_back(SIGINT);
  };
  EXPECT_EQ(Run(1s, happens), GetParam() ? 0 : 1);
}
INSTANTIATE_TEST_SUITE_P(Ends, FaultAtTheEndTest, ::testing::Bool());

struct Sender {
  std::string role;
  int32_t pid;  // 0: it does not announce itself
  bool counts;
};

class SenderOfAFaultTest : public StackLaunchTest, public ::testing::WithParamInterface<Sender> {};

// Tests that a fault at the end counts when it is of a process of this launch, of a loop that this launch
// does not start, or of an unknown sender; and not when it is of another stack: of a plant or a loop beside
// those of this launch.
TEST_P(SenderOfAFaultTest, Counts) {
  const auto happens = [&] {
    if (GetParam().pid != 0) Announce(GetParam().role, GetParam().pid);
    fault_t fault{};
    fault.session = 1000 + GetParam().pid;
    fault.source = GetParam().role;
    fault.code = "other_stack";
    fault.active = true;
    bus_.Publish("HYDRO_FAULT", fault);
    children_.signals.push_back(SIGINT);
  };
  const int exit_code = Run(1s, happens);
  EXPECT_EQ(exit_code, GetParam().counts ? 1 : 0);
  EXPECT_EQ(report_.errors.empty(), !GetParam().counts);
}
INSTANTIATE_TEST_SUITE_P(Senders, SenderOfAFaultTest,
                         ::testing::Values(Sender{"plant", 101, true}, Sender{"pressure_ctrl", 102, true},
                                           Sender{"position_ctrl", 4711, true}, Sender{"plant", 0, true},
                                           Sender{"plant", 4711, false}, Sender{"driver", 4711, false},
                                           Sender{"pressure_ctrl", 4711, false}));

// Tests that nothing is started beside a process with one of its roles.
TEST_F(StackLaunchTest, RefusesASecondStack) {
  Announce("plant", 4711);
  StackLaunch launch(bus_, clock_, children_, report_, config_, plan_, {});
  Announce("plant", 4711);
  EXPECT_THROW(launch.Run(), InputError);
  EXPECT_TRUE(children_.pids.empty());
}

}  // namespace
}  // namespace hydro::launch
