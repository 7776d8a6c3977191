// Converts messages to the form of ROS 2: a definition in its language, and the bytes as CDR. Foxglove,
// Lichtblick and PlotJuggler read both.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/definitions/encoded_values.h"
#include "bus/definitions/message_definition.h"

namespace hydro::definitions {

// "/hydro/motor_command" for HYDRO_MOTOR_COMMAND.
std::string RosTopic(std::string_view channel);

// "hydro_msgs/msg/MotorCommand" for motor_command_t.
std::string RosType(std::string_view type);

// The field's name in ROS 2: in lower case.
std::string RosField(std::string_view name);

// One line for each field, with its unit and meaning as a comment, and one for each constant.
std::string RosSchema(const std::vector<Field>& fields, const std::vector<Constant>& constants = {});

// Writes the values of fields as OMG's common data representation, version 1, little endian.
class CdrWriter {
 public:
  explicit CdrWriter(std::string* bytes);

  void Whole(FieldType type, int64_t value);
  void Number(FieldType type, double value);
  void Text(std::string_view value);
  void Length(size_t elements);  // before a list's elements

 private:
  template <class T>
  void Put(T value);
  std::string& bytes_;
};

void WriteCdr(const std::vector<Field>& fields, const std::vector<Value>& values, std::string* bytes);

}  // namespace hydro::definitions
