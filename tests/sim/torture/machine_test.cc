#include "sim/torture/machines/machine.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace hydro::torture {
namespace {

using std::chrono::nanoseconds;

TEST(MachineTest, ShowsWhatItWasSetTo) {
  TrueTime now = 0;
  const Machine machine("rig", &now, 12.5, 1000);
  EXPECT_EQ(machine.Now().time_since_epoch(), nanoseconds(12'500'000'000));
  EXPECT_EQ(machine.Utime(), 1'000'000'000);
  now = 2'000;
  EXPECT_EQ(machine.Utime(), 1'000'000'002);
  EXPECT_FALSE(machine.simulated());  // so that applications do all that they do in real time
}

// Tests that a process which waits until a time of its own clock is woken at the first moment that this clock
// shows that time, however the clock drifts.
TEST(MachineTest, TellsTheFirstTrueTimeOfALocalTime) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    TrueTime now = 0;
    Machine machine("rig", &now, random.Between(0, 1e5), 0);
    now = static_cast<TrueTime>(random.Index(10'000'000'000));
    machine.SetDrift(static_cast<int64_t>(random.Between(-2e7, 2e7)));
    const auto wanted = machine.Now() + nanoseconds(random.Index(5'000'000'000));
    now = machine.TrueTimeOf(wanted);
    EXPECT_GE(machine.Now(), wanted);
    now -= 1;
    EXPECT_LT(machine.Now(), wanted);
  }
}

TEST(MachineTest, DoesNotCountSleep) {
  TrueTime now = 1'000'000'000;
  Machine machine("rig", &now, 0, 0);
  now += 3'000'000'000;
  machine.Slept(2'000'000'000);
  EXPECT_EQ(machine.Now().time_since_epoch(), nanoseconds(2'000'000'000));
  EXPECT_EQ(machine.Suspended(), nanoseconds(2'000'000'000));
  EXPECT_EQ(machine.Utime(), 4'000'000);  // the wall clock goes on
}

TEST(MachineTest, ItsWallClockJumpsAlone) {
  TrueTime now = 0;
  Machine machine("rig", &now, 5, 100);
  machine.JumpUtc(-7'000'000'000);
  EXPECT_EQ(machine.Utime(), 93'000'000);
  EXPECT_EQ(machine.Now().time_since_epoch(), nanoseconds(5'000'000'000));
}

}  // namespace
}  // namespace hydro::torture
