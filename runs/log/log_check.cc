#include "runs/log/log_check.h"

#include <libdeflate.h>

#include <cstring>
#include <string>

#include "base/bytes.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {

// The data: magic 8 | version u8 | kind u8 | length of text u16 | count u32 | offset u64 | previous u32
// | checksums, u32 each | text | checksum u32
constexpr size_t kVersionAt = 8;
constexpr size_t kKindAt = 9;
constexpr size_t kTextSizeAt = 10;
constexpr size_t kCountAt = 12;
constexpr size_t kOffsetAt = 16;
constexpr size_t kPreviousAt = 24;
constexpr size_t kChecksumsAt = 28;

}  // namespace

uint32_t Checksum(const uint8_t* bytes, size_t size) {
  return static_cast<uint32_t>(libdeflate_crc32(0, bytes, size));
}

uint32_t ChecksumOf(const LogEvent& event) {
  const size_t before_data = kLogHeaderSize + event.channel.size();
  return Checksum(event.data - before_data, before_data + static_cast<size_t>(event.size));
}

uint32_t LogCheck::ChecksumAt(size_t k) const { return LoadBigEndian32(checksums + 4 * k); }

bool IsDisguisedCheck(const LogEvent& event) {
  return !IsCheck(event) && event.size >= static_cast<int>(CheckDataSize(0, 0)) &&
         std::memcmp(event.data, kCheckMagic.data(), kCheckMagic.size()) == 0;
}

size_t CheckDataSize(size_t count, size_t text_size) { return kChecksumsAt + 4 * count + text_size + 4; }

std::optional<LogCheck> ParseCheck(const LogEvent& event) {
  const size_t size = static_cast<size_t>(event.size);
  if (size < CheckDataSize(0, 0) || std::memcmp(event.data, kCheckMagic.data(), kCheckMagic.size()) != 0) {
    return std::nullopt;
  }
  LogCheck check;
  const size_t before_data = kLogHeaderSize + event.channel.size();
  check.checksum = LoadBigEndian32(event.data + size - 4);
  check.sound = Checksum(event.data - before_data, before_data + size - 4) == check.checksum;
  if (check.sound && event.data[kVersionAt] > kCheckVersion) {
    throw InputError("found checksums of version " + std::to_string(event.data[kVersionAt]) +
                     "; this program knows version " + std::to_string(kCheckVersion) +
                     ": a newer one is needed");
  }
  const size_t text_size = static_cast<size_t>(event.data[kTextSizeAt]) << 8 | event.data[kTextSizeAt + 1];
  check.count = LoadBigEndian32(event.data + kCountAt);
  if (check.count > size || CheckDataSize(check.count, text_size) != size ||
      event.data[kKindAt] > static_cast<uint8_t>(CheckKind::kEnd)) {
    return std::nullopt;
  }
  check.kind = static_cast<CheckKind>(event.data[kKindAt]);
  check.offset = static_cast<int64_t>(LoadBigEndian64(event.data + kOffsetAt));
  check.previous = LoadBigEndian32(event.data + kPreviousAt);
  check.checksums = event.data + kChecksumsAt;
  check.text = {reinterpret_cast<const char*>(check.checksums + 4 * check.count), text_size};
  return check;
}

uint32_t WriteCheckData(const LogCheck& check, uint8_t* event, uint8_t* data) {
  std::memcpy(data, kCheckMagic.data(), kCheckMagic.size());
  data[kVersionAt] = kCheckVersion;
  data[kKindAt] = static_cast<uint8_t>(check.kind);
  data[kTextSizeAt] = static_cast<uint8_t>(check.text.size() >> 8);
  data[kTextSizeAt + 1] = static_cast<uint8_t>(check.text.size());
  StoreBigEndian32(static_cast<uint32_t>(check.count), data + kCountAt);
  StoreBigEndian64(static_cast<uint64_t>(check.offset), data + kOffsetAt);
  StoreBigEndian32(check.previous, data + kPreviousAt);
  if (check.count > 0) std::memcpy(data + kChecksumsAt, check.checksums, 4 * check.count);
  uint8_t* text = data + kChecksumsAt + 4 * check.count;
  if (!check.text.empty()) std::memcpy(text, check.text.data(), check.text.size());
  uint8_t* end = text + check.text.size();
  const uint32_t checksum = Checksum(event, static_cast<size_t>(end - event));
  StoreBigEndian32(checksum, end);
  return checksum;
}

}  // namespace hydro::log
