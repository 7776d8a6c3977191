#include "launch/logic/stop_sequence.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <vector>

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

class FakeChild : public Stoppable {
 public:
  explicit FakeChild(bool last = false) : last_(last) {}
  bool running() const override { return running_; }
  bool last() const override { return last_; }
  void Signal(int signal_number) override { signals.push_back(signal_number); }
  void End() { running_ = false; }

  std::vector<int> signals;

 private:
  bool last_;
  bool running_ = true;
};

class StopSequenceTest : public ::testing::Test {
 protected:
  StopSequenceTest() {
    for (FakeChild* child : {&logger_, &plant_, &loop_}) stop_.Add(child);
  }

  using Signals = std::vector<int>;
  const StopSequence::TimePoint start_{100s};
  FakeChild logger_{true}, plant_, loop_;
  StopSequence stop_{{.child = 3s, .last = 10s, .before_last = 500ms}};
};

// Tests that nothing happens before a stop begins, and nothing is due.
TEST_F(StopSequenceTest, NothingBeforeItBegins) {
  stop_.TakeSteps(start_ + 1h);
  EXPECT_TRUE(plant_.signals.empty());
  EXPECT_EQ(stop_.NextStep(), StopSequence::TimePoint::max());
  EXPECT_FALSE(stop_.begun());
  EXPECT_EQ(stop_.running(), 3);
  EXPECT_EQ(stop_.running_first(), 2);
}

// Tests that SIGTERM waits for its time, that a later call can bring it forward only, and that each child
// gets it once.
TEST_F(StopSequenceTest, SigtermWhenItIsDue) {
  stop_.Begin(start_ + 3s);
  stop_.Begin(start_ + 4s);
  EXPECT_EQ(stop_.NextStep(), start_ + 3s);
  stop_.TakeSteps(start_ + 2999ms);
  EXPECT_TRUE(plant_.signals.empty());
  stop_.Begin(start_ + 1s);
  stop_.TakeSteps(start_ + 3s);
  stop_.TakeSteps(start_ + 3s);
  EXPECT_EQ(plant_.signals, Signals{SIGTERM});
  EXPECT_EQ(loop_.signals, Signals{SIGTERM});
  EXPECT_TRUE(logger_.signals.empty());
  EXPECT_TRUE(stop_.terminated(&plant_));
  EXPECT_FALSE(stop_.terminated(&logger_));
}

// Tests that the last ones are stopped when the others have ended, and some time later.
TEST_F(StopSequenceTest, LastOnesLast) {
  stop_.Begin(start_);
  stop_.TakeSteps(start_);
  plant_.End();
  stop_.TakeSteps(start_ + 1s);
  EXPECT_TRUE(logger_.signals.empty());
  loop_.End();
  stop_.TakeSteps(start_ + 2s);
  EXPECT_TRUE(logger_.signals.empty());
  EXPECT_EQ(stop_.NextStep(), start_ + 2500ms);
  stop_.TakeSteps(start_ + 2500ms);
  EXPECT_EQ(logger_.signals, Signals{SIGTERM});
}

// Tests that a child that does not end is killed after its grace, once, and that the others wait for it no
// longer.
TEST_F(StopSequenceTest, SigkillAfterTheGrace) {
  stop_.Begin(start_);
  stop_.TakeSteps(start_);
  loop_.End();
  EXPECT_EQ(stop_.NextStep(), start_ + 3s);
  stop_.TakeSteps(start_ + 2999ms);
  EXPECT_FALSE(stop_.hung(&plant_));
  stop_.TakeSteps(start_ + 3s);
  stop_.TakeSteps(start_ + 9s);
  EXPECT_EQ(plant_.signals, (Signals{SIGTERM, SIGKILL}));
  EXPECT_TRUE(stop_.hung(&plant_));
  EXPECT_FALSE(stop_.hung(&loop_));
  plant_.End();
  stop_.TakeSteps(start_ + 10s);
  stop_.TakeSteps(start_ + 10500ms);
  EXPECT_EQ(stop_.NextStep(), start_ + 20500ms);
  stop_.TakeSteps(start_ + 20499ms);
  EXPECT_EQ(logger_.signals, Signals{SIGTERM});
  stop_.TakeSteps(start_ + 20500ms);
  EXPECT_EQ(logger_.signals, (Signals{SIGTERM, SIGKILL}));
}

}  // namespace
}  // namespace hydro::launch
