// The contents of the .lcm files at run time: the fields of the messages with type, unit and meaning.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::definitions {

enum class FieldType { kBoolean, kByte, kInt8, kInt16, kInt32, kInt64, kFloat, kDouble, kString };

struct Field {
  std::string name;
  FieldType type = FieldType::kDouble;
  std::string count = {};        // the field that holds the number of elements; empty: a single value
  std::string unit = {};         // "psi", from a comment that begins with "[psi]"; empty: none
  std::string description = {};  // the rest of the comment

  bool is_list() const { return !count.empty(); }
};

struct Constant {
  std::string name;
  FieldType type = FieldType::kInt8;
  std::string value;
  std::string description = {};
};

struct MessageDefinition {
  std::string type;         // "state_t"
  std::string channel;      // "HYDRO_STATE", without a stack's suffix
  std::string description;  // the comment before the struct
  std::vector<Field> fields;
  std::vector<Constant> constants;
  int64_t hash = 0;  // the first bytes of an encoded message
};

// Whether values of the type are integers; booleans count as integers.
bool IsWhole(FieldType type);

// The bytes that a value takes in LCM's encoding; 0 for strings.
int SizeOf(FieldType type);

// All messages of a stack, in the order of bus/messages.h.
const std::vector<MessageDefinition>& Definitions();

// The definition whose channel is the beginning of `channel`; the rest is the stack's suffix. Null: none.
const MessageDefinition* DefinitionOf(std::string_view channel);

// Reads the text of a message definition in the part of LCM's language that ours use: one struct of plain
// fields, lists whose length is an earlier field, and constants. The comment at a line's end belongs to its
// field, and continues in lines that hold nothing but a comment. `channel` and `hash` are left empty. Throws
// InputError that names `file` and the line: a struct within another, a list of fixed length and a list of
// lists are not allowed.
MessageDefinition ParseDefinition(std::string_view text, const std::string& file);

// The texts of lcmtypes/*.lcm, which the build compiles into the program.
struct DefinitionText {
  std::string_view file;  // "hydro_state_t.lcm"
  std::string_view text;
};

const std::vector<DefinitionText>& DefinitionTexts();

}  // namespace hydro::definitions
