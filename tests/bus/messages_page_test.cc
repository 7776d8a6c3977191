#include "tests/bus/messages_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/input_error.h"

namespace hydro::bus {
namespace {

using testing::HasSubstr;

constexpr const char* kHead = "package hydro;\n\n// What the sensor\n// reads.\nstruct sensor_t\n{\n";

std::string ErrorOf(const std::string& text) {
  try {
    ParseLcm(text, "sensor.lcm");
    return "nothing";
  } catch (const InputError& error) {
    return error.what();
  }
}

// Tests that fields, their units, multi-line comments, arrays and constants are read.
TEST(MessagesPageTest, ReadsAnLcmFile) {
  const LcmStruct sensor = ParseLcm(std::string(kHead) +
                                        "  int32_t count;  // how many\n"
                                        "                  // there are\n\n"
                                        "  double p1[count]; // [psi] pressure of side 1\n"
                                        "  const int8_t BAD = -1; // broken\n}\n",
                                    "sensor.lcm");
  EXPECT_EQ(sensor.name, "sensor_t");
  EXPECT_EQ(sensor.comment, "What the sensor reads.");
  ASSERT_EQ(sensor.fields.size(), 3u);
  EXPECT_EQ(sensor.fields[0].type, "int32_t");
  EXPECT_EQ(sensor.fields[0].meaning, "how many there are");
  EXPECT_EQ(sensor.fields[1].type, "double[count]");
  EXPECT_EQ(sensor.fields[1].name, "p1");
  EXPECT_EQ(sensor.fields[1].unit, "psi");
  EXPECT_EQ(sensor.fields[1].meaning, "pressure of side 1");
  EXPECT_EQ(sensor.fields[2].name, "BAD = -1");
  EXPECT_TRUE(sensor.fields[2].constant);
}

// Tests that a number without a unit, a field without a comment and a line that is no field are refused,
// naming the place.
TEST(MessagesPageTest, RefusesWhatIsIncomplete) {
  const std::string head = kHead;
  EXPECT_THAT(ErrorOf(head + "  double p1; // pressure\n}\n"), HasSubstr("p1 has no unit"));
  EXPECT_THAT(ErrorOf(head + "  double p1[2]; // pressures\n}\n"), HasSubstr("p1 has no unit"));
  EXPECT_THAT(ErrorOf(head + "  int64_t tick;\n}\n"), HasSubstr("tick has no comment"));
  EXPECT_THAT(ErrorOf(head + "  int64_t one, two; // numbers\n}\n"),
              HasSubstr("sensor.lcm:7: found int64_t one, two;"));
  EXPECT_THAT(ErrorOf("package hydro;\nstruct sensor_t\n{\n}\n"),
              HasSubstr("a struct with a comment before it"));
}

}  // namespace
}  // namespace hydro::bus
