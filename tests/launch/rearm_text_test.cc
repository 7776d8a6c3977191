#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/word_list.h"
#include "launch/rearm_json.h"

namespace hydro::launch {
namespace {

using ::testing::ElementsAre;

// Tests that what a re-arm says fits a terminal: a short sentence a line, and nothing of it is left out.
TEST(RearmText, ASentenceALine) {
  OperatorResult result{
      0,
      "re-armed: ended pressure_limit, controller_fault; the arm is at 0.1565 rad and moves at "
      "-0.5 rad/s, the other way, in which it goes on at first; its reference comes back to "
      "0.3 rad: the reference moves by +0.1435 rad in 0.5 s, at up to 0.35 rad/s, by way of "
      "0.1 rad (the other direction) after 0.1 s, and jumps by +0.01 rad after 0.2 s and 3 more "
      "times; the arm follows as far as its load and limits.arm_torque 500 in-lbf let it; zero "
      "volts again beyond limits.pressure 2000 psi, limits.arm_angle 0.8 rad"};
  EXPECT_THAT(
      TextLines(TerminalText(result)),
      ElementsAre(
          "hydro-launch: re-armed: ended pressure_limit, controller_fault.",
          "  The arm is at 0.1565 rad and moves at -0.5 rad/s, the other way, in which it goes on at first.",
          "  Its reference comes back to 0.3 rad.",
          "  The reference moves by +0.1435 rad in 0.5 s, at up to 0.35 rad/s, by way of 0.1 rad (the other",
          "    direction) after 0.1 s, and jumps by +0.01 rad after 0.2 s and 3 more times.",
          "  The arm follows as far as its load and limits.arm_torque 500 in-lbf let it.",
          "  Zero volts again beyond limits.pressure 2000 psi, limits.arm_angle 0.8 rad."));
}

// Tests joints, whose names stay as they are, and characters that would move a cursor.
TEST(RearmText, JointsAndForeignCharacters) {
  const OperatorResult result{
      0, "re-armed: hip: ended a\x1b[2J; knee: no fault is latched; hip: the arm is at 0 rad"};
  EXPECT_EQ(TerminalText(result),
            "hydro-launch: re-armed: hip: ended a\\x1b[2J.\n  knee: no fault is latched.\n  hip: the arm is "
            "at 0 rad.\n");
  const std::string x(1000, 'x'), y(99, 'y');  // nothing is cut
  EXPECT_THAT(TextLines(TerminalText({0, x + " " + y})), ElementsAre("hydro-launch: " + x, "    " + y + "."));
}

}  // namespace
}  // namespace hydro::launch
