#include "bus/definitions/encoded_values.h"

#include <bit>
#include <cstring>

#include "base/bytes.h"
#include "bus/seal_trailer.h"

namespace hydro::definitions {
namespace {

// Reads an encoding from its beginning. After a value that is incomplete, every later one counts as
// incomplete too.
class Encoding {
 public:
  Encoding(const uint8_t* data, int size) : next_(data), left_(size) {}

  bool whole() const { return whole_; }
  int left() const { return left_; }

  int64_t Whole(FieldType type) {
    const int size = SizeOf(type);
    const uint8_t* const bytes = Take(size);
    if (bytes == nullptr) return 0;
    uint64_t value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | bytes[i];
    if (type == FieldType::kBoolean || type == FieldType::kByte) return static_cast<int64_t>(value);
    const int unused = 64 - 8 * size;
    return static_cast<int64_t>(value << unused) >> unused;
  }

  double Number(FieldType type) {
    if (type == FieldType::kDouble) return std::bit_cast<double>(Whole(FieldType::kInt64));
    return std::bit_cast<float>(static_cast<uint32_t>(Whole(FieldType::kInt32)));
  }

  // The length includes the zero byte at the text's end, which must be the only one: LCM could not send a
  // text with another one on.
  std::string Text() {
    const int64_t size = Whole(FieldType::kInt32);
    const uint8_t* const bytes = size > 0 ? Take(size) : nullptr;
    if (bytes == nullptr || std::memchr(bytes, 0, static_cast<size_t>(size)) != bytes + size - 1) {
      whole_ = false;
      return {};
    }
    return {reinterpret_cast<const char*>(bytes), static_cast<size_t>(size - 1)};
  }

 private:
  const uint8_t* Take(int64_t size) {
    if (size > left_) whole_ = false;
    if (!whole_) return nullptr;
    const uint8_t* const bytes = next_;
    next_ += size;
    left_ -= static_cast<int>(size);
    return bytes;
  }

  const uint8_t* next_;
  int left_;
  bool whole_ = true;
};

Value ReadOne(Encoding& from, FieldType type) {
  if (type == FieldType::kString) return from.Text();
  if (IsWhole(type)) return from.Whole(type);
  return from.Number(type);
}

template <class T>
std::vector<T> ReadList(Encoding& from, FieldType type, int64_t count) {
  std::vector<T> list;
  for (int64_t i = 0; i < count && from.whole(); ++i) list.push_back(std::get<T>(ReadOne(from, type)));
  return list;
}

// The value of the field with that name, which comes before the list.
int64_t CountOf(const std::vector<Field>& fields, const std::vector<Value>& values, const std::string& name) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (fields[i].name == name) return std::get<int64_t>(values[i]);
  }
  return -1;
}

}  // namespace

bool ReadValues(const MessageDefinition& definition, const uint8_t* data, int size,
                std::vector<Value>* values) {
  constexpr int kHashSize = 8;
  values->clear();
  if (size < kHashSize || static_cast<int64_t>(LoadBigEndian64(data)) != definition.hash) return false;
  Encoding from(data + kHashSize, size - kHashSize);
  for (const Field& field : definition.fields) {
    if (!field.is_list()) {
      values->push_back(ReadOne(from, field.type));
    } else {
      const int64_t count = CountOf(definition.fields, *values, field.count);
      if (count < 0) return false;
      if (field.type == FieldType::kString) {
        values->emplace_back(ReadList<std::string>(from, field.type, count));
      } else if (IsWhole(field.type)) {
        values->emplace_back(ReadList<int64_t>(from, field.type, count));
      } else {
        values->emplace_back(ReadList<double>(from, field.type, count));
      }
    }
    if (!from.whole()) return false;
  }
  return from.left() == 0 || size - from.left() == bus::SizeWithoutSeal(data, size);
}

}  // namespace hydro::definitions
