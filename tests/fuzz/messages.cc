#include "bus/messages.h"

#include <array>
#include <vector>

#include "bus/seal/authenticator.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {
namespace {

template <class Message>
const bus::MessageType& TypeOf(const bus::MessageRow<Message>&) {
  return bus::TypeOf<Message>();
}

// What decodes is a message: its encoding decodes too, to the same bytes, except for what follows a zero byte
// in a string, which LCM's encoder leaves out.
void Decode(const bus::MessageType& type, const uint8_t* data, int size) {
  const std::shared_ptr<void> message = type.decode(data, size);
  const std::shared_ptr<void> into = type.create();
  Promise(type.decode_into(into.get(), data, size) == (message != nullptr), "both ways of decoding agree");
  if (message == nullptr) return;
  const int encoded_size = type.encoded_size(message.get());
  Promise(encoded_size <= size, "a message is no longer than its encoding");
  std::vector<uint8_t> bytes(static_cast<size_t>(encoded_size));
  const int written = type.encode(message.get(), bytes.data(), encoded_size);
  if (written != encoded_size) return;  // a zero byte in a string
  Promise(type.decode(bytes.data(), encoded_size) != nullptr, "an encoded message decodes");
}

// Nothing that the fuzzer makes up may pass for genuine.
void Authenticate(const uint8_t* data, int size) {
  static const bus::Channels channels;
  bus::Authenticator receiver(bus::BusKey({1, 2, 3}), bus::AuthenticatedChannels(channels));
  const auto opened = receiver.Open(channels.Of<motor_command_t>(), data, size, {});
  Promise(opened.verdict == bus::Authenticator::Verdict::kRefused, "what nobody sealed is refused");
  Promise(bus::SizeWithoutSeal(data, size) <= size && bus::SizeWithoutSeal(data, size) >= 0,
          "a seal is in the message");
}

}  // namespace

void Messages(const uint8_t* data, size_t size) {
  if (size == 0) return;
  static const auto kTypes =
      std::apply([](const auto&... row) { return std::array{&TypeOf(row)...}; }, bus::kMessages);
  const bus::MessageType& type = *kTypes[data[0] % kTypes.size()];
  // Begins with the type's own hash, or no input would get past it; the first bit can change that.
  std::vector<uint8_t> bytes;
  if (data[0] < 0x80) {
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<uint8_t>(static_cast<uint64_t>(type.hash) >> shift));
    }
  }
  bytes.insert(bytes.end(), data + 1, data + size);
  bytes.shrink_to_fit();
  Decode(type, bytes.data(), static_cast<int>(bytes.size()));
  Authenticate(bytes.data(), static_cast<int>(bytes.size()));
}

}  // namespace hydro::fuzz
