#include "plant/roll_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hydro::plant {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

process_status_t Status(const std::string& role, int64_t session, int8_t state) {
  process_status_t status;
  status.role = role;
  status.session = session;
  status.state = state;
  status.host = "rig";
  status.pid = 12;
  return status;
}

// Tests that a missing participant is known by role until it says that it is ready.
TEST(RollCallTest, NamesWhoIsMissing) {
  RollCall roll({"pressure_ctrl", "position_ctrl"});
  EXPECT_THAT(roll.Missing(), ElementsAre("pressure_ctrl", "position_ctrl"));
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  EXPECT_THAT(roll.Missing(), ElementsAre("position_ctrl"));
  roll.Observe(Status("position_ctrl", 2, process_status_t::RUNNING));
  EXPECT_THAT(roll.Missing(), IsEmpty());
  EXPECT_EQ(roll.left(), "");
}

// Tests that a participant that leaves is named, unless it belongs to another run and was never seen here.
TEST(RollCallTest, NamesWhoLeft) {
  RollCall roll({"pressure_ctrl"});
  roll.Observe(Status("pressure_ctrl", 9, process_status_t::DONE));
  EXPECT_EQ(roll.left(), "");
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::FAILED));
  EXPECT_THAT(roll.left(), HasSubstr("pressure_ctrl on rig (process 12)"));
  EXPECT_THAT(roll.Missing(), ElementsAre("pressure_ctrl"));
}

// Tests that participants with one session, as on a simulated clock, are told apart by role, and that loggers
// are known.
TEST(RollCallTest, TellsRolesApart) {
  RollCall roll({"pressure_ctrl", "position_ctrl"});
  roll.Observe(Status("pressure_ctrl", 0, process_status_t::READY));
  roll.Observe(Status("position_ctrl", 0, process_status_t::READY));
  roll.Observe(Status("logger", 5, process_status_t::READY));
  EXPECT_THAT(roll.Missing(), IsEmpty());
  EXPECT_THAT(roll.Loggers(), ElementsAre(5));
}

// Tests that of a flood of made-up loggers only as many as a stack could have are kept, and that the known
// ones are still heard.
TEST(RollCallTest, KeepsNoFlood) {
  RollCall roll({"pressure_ctrl"});
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::READY));
  for (int64_t session = 0; session < 10000; ++session) {
    roll.Observe(Status("logger", session, process_status_t::READY));
  }
  EXPECT_LE(roll.Loggers().size(), 256u);
  roll.Observe(Status("pressure_ctrl", 1, process_status_t::FAILED));
  EXPECT_THAT(roll.left(), HasSubstr("pressure_ctrl"));
}

}  // namespace
}  // namespace hydro::plant
