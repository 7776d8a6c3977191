#include "bus/definitions/ros_message.h"

#include <gtest/gtest.h>

#include "bus/definitions/message_definition.h"

namespace hydro::definitions {
namespace {

// Tests names as ROS 2 has them.
TEST(RosMessageTest, Names) {
  EXPECT_EQ(RosTopic("HYDRO_MOTOR_COMMAND"), "/hydro/motor_command");
  EXPECT_EQ(RosTopic("HYDRO_RUN"), "/hydro/run");
  EXPECT_EQ(RosType("motor_command_t"), "hydro_msgs/msg/MotorCommand");
  EXPECT_EQ(RosField("p1_MPa"), "p1_mpa");
}

// Tests that a schema has each field with its unit and meaning, lists, and constants.
TEST(RosMessageTest, Schema) {
  const std::vector<Field> fields = {{"p1", FieldType::kDouble, "", "psi", "pressure"},
                                     {"n", FieldType::kInt32},
                                     {"names", FieldType::kString, "n"},
                                     {"on", FieldType::kBoolean, "", "", "or off"}};
  EXPECT_EQ(RosSchema(fields, {{"SAFE", FieldType::kInt8, "2", "zero volts"}}),
            "int8 SAFE=2  # zero volts\nfloat64 p1  # [psi] pressure\nint32 n\nstring[] names\nbool on  # or "
            "off\n");
}

// Tests CDR byte by byte: a header, each value at a multiple of its size from there, texts and lists with
// their lengths.
TEST(RosMessageTest, Cdr) {
  const std::vector<Field> fields = {{"on", FieldType::kBoolean},  {"n", FieldType::kInt16},
                                     {"text", FieldType::kString}, {"x", FieldType::kDouble},
                                     {"f", FieldType::kFloat},     {"list", FieldType::kInt8, "n"}};
  std::string bytes = "what was there before";
  WriteCdr(fields, {int64_t{7}, int64_t{-2}, std::string("ab"), 1.0, 1.0, std::vector<int64_t>{-1, 3}},
           &bytes);
  const char expected[] =
      "\0\1\0\0"              // CDR, little endian
      "\1\0\xfe\xff"          // true; a gap; -2
      "\3\0\0\0ab\0"          // three bytes with the zero
      "\0\0\0\0\0"            // a gap to a multiple of 8
      "\0\0\0\0\0\0\xf0\x3f"  // 1.0
      "\0\0\x80\x3f"          // 1.0f
      "\2\0\0\0\xff\3";
  EXPECT_EQ(bytes, std::string(expected, sizeof expected - 1));
}

}  // namespace
}  // namespace hydro::definitions
