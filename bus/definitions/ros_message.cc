#include "bus/definitions/ros_message.h"

#include <cctype>
#include <cstring>

namespace hydro::definitions {
namespace {

constexpr size_t kHeaderSize = 4;

const char* RosName(FieldType type) {
  switch (type) {
    case FieldType::kBoolean:
      return "bool";
    case FieldType::kByte:
      return "uint8";
    case FieldType::kInt8:
      return "int8";
    case FieldType::kInt16:
      return "int16";
    case FieldType::kInt32:
      return "int32";
    case FieldType::kInt64:
      return "int64";
    case FieldType::kFloat:
      return "float32";
    case FieldType::kDouble:
      return "float64";
    case FieldType::kString:
      break;
  }
  return "string";
}

std::string Comment(const std::string& unit, const std::string& description) {
  const std::string text = unit.empty() ? description : "[" + unit + "] " + description;
  return text.empty() ? "\n" : "  # " + text + "\n";
}

class ListWriter {
 public:
  ListWriter(FieldType type, CdrWriter* cdr) : type_(type), cdr_(*cdr) {}

  void operator()(int64_t value) { cdr_.Whole(type_, value); }
  void operator()(double value) { cdr_.Number(type_, value); }
  void operator()(const std::string& value) { cdr_.Text(value); }
  template <class T>
  void operator()(const std::vector<T>& list) {
    cdr_.Length(list.size());
    for (const T& element : list) (*this)(element);
  }

 private:
  FieldType type_;
  CdrWriter& cdr_;
};

}  // namespace

std::string RosTopic(std::string_view channel) {
  std::string topic = "/";
  bool first = true;
  for (const char c : channel) {
    topic += c == '_' && first ? '/' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    first = first && c != '_';
  }
  return topic;
}

std::string RosType(std::string_view type) {
  if (type.ends_with("_t")) type.remove_suffix(2);
  std::string name = "hydro_msgs/msg/";
  bool begins = true;
  for (const char c : type) {
    if (c != '_') name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return name;
}

std::string RosField(std::string_view name) {
  std::string small;
  for (const char c : name) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

std::string RosSchema(const std::vector<Field>& fields, const std::vector<Constant>& constants) {
  std::string text;
  for (const Constant& constant : constants) {
    text += std::string(RosName(constant.type)) + " " + constant.name + "=" + constant.value +
            Comment("", constant.description);
  }
  for (const Field& field : fields) {
    text += std::string(RosName(field.type)) + (field.is_list() ? "[] " : " ") + RosField(field.name) +
            Comment(field.unit, field.description);
  }
  return text;
}

CdrWriter::CdrWriter(std::string* bytes) : bytes_(*bytes) { bytes_.assign("\0\1\0\0", kHeaderSize); }

// Each value is aligned to a multiple of its size, counted from the header's end.
template <class T>
void CdrWriter::Put(T value) {
  while ((bytes_.size() - kHeaderSize) % sizeof value != 0) bytes_.push_back('\0');
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);  // little endian, as on every machine on which this runs
  bytes_.append(raw, sizeof value);
}

void CdrWriter::Whole(FieldType type, int64_t value) {
  switch (SizeOf(type)) {
    case 1:
      return Put(static_cast<int8_t>(type == FieldType::kBoolean ? (value != 0 ? 1 : 0) : value));
    case 2:
      return Put(static_cast<int16_t>(value));
    case 4:
      return Put(static_cast<int32_t>(value));
    default:
      return Put(value);
  }
}

void CdrWriter::Number(FieldType type, double value) {
  type == FieldType::kFloat ? Put(static_cast<float>(value)) : Put(value);
}

void CdrWriter::Text(std::string_view value) {
  Put(static_cast<uint32_t>(value.size() + 1));
  bytes_.append(value);
  bytes_.push_back('\0');
}

void CdrWriter::Length(size_t elements) { Put(static_cast<uint32_t>(elements)); }

void WriteCdr(const std::vector<Field>& fields, const std::vector<Value>& values, std::string* bytes) {
  CdrWriter cdr(bytes);
  for (size_t i = 0; i < fields.size(); ++i) std::visit(ListWriter(fields[i].type, &cdr), values[i]);
}

}  // namespace hydro::definitions
