#include "bus/seal/bus_key.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

#include "base/bytes.h"
#include "base/descriptor.h"
#include "base/input_error.h"
#include "base/new_file.h"

namespace hydro::bus {
namespace {

static_assert(kSealTagSize >= static_cast<int>(crypto_generichash_BYTES_MIN));
static_assert(kBusKeySize >= crypto_generichash_KEYBYTES_MIN &&
              kBusKeySize <= crypto_generichash_KEYBYTES_MAX);

constexpr std::string_view kPurpose =
    "hydro message seal 1";  // separates this use of the key from all its other uses

const uint8_t* Bytes(std::string_view text) { return reinterpret_cast<const uint8_t*>(text.data()); }

constexpr size_t kLongest = 200;  // bytes of a key file, including white space
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;

// Text that holds a key and is wiped on destruction.
class SecretText {
 public:
  SecretText() = default;
  ~SecretText() { sodium_memzero(bytes_.data(), bytes_.size()); }
  SecretText(const SecretText&) = delete;
  SecretText& operator=(const SecretText&) = delete;
  char* data() { return bytes_.data(); }

 private:
  std::array<char, kLongest + 1> bytes_{};
};

void StartSodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium has no source of random numbers");
}

[[noreturn]] void Refuse(const std::string& file, const std::string& what) {
  throw InputError(file + ": bus.key_file: " + what);
}

[[noreturn]] void RefuseErrno(const std::string& file, const std::string& what, const std::string& cure) {
  Refuse(file, what + ": " + std::strerror(errno) + "; " + cure);
}

void CheckPermissions(const std::string& file, int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) RefuseErrno(file, "cannot be read", "a file with a key is needed");
  if (!S_ISREG(status.st_mode)) Refuse(file, "found something that is not a file, allowed a file with a key");
  if ((status.st_mode & kOthers) == 0) return;
  char mode[8];
  std::snprintf(mode, sizeof mode, "%04o", static_cast<unsigned>(status.st_mode & 07777U));
  Refuse(file, std::string("found permissions ") + mode + ", allowed the owner's alone; `chmod 600 " + file +
                   "` sets them (and take a new key if others may have read this one)");
}

size_t ReadAll(const std::string& file, int fd, char* text) {
  size_t size = 0;
  while (size <= kLongest) {
    const ssize_t count = read(fd, text + size, kLongest + 1 - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) RefuseErrno(file, "cannot be read", "a file with a key is needed");
    if (count == 0) break;
    size += static_cast<size_t>(count);
  }
  return size;
}

}  // namespace

std::array<uint8_t, kSealTagSize> SealTag(const std::array<uint8_t, kBusKeySize>& key,
                                          std::string_view channel, int64_t session, uint64_t counter,
                                          const void* message, int size) {
  // The lengths come first, so that no two different inputs give the same bytes.
  std::array<uint8_t, 32> numbers{};
  StoreBigEndian64(channel.size(), numbers.data());
  StoreBigEndian64(static_cast<uint64_t>(size), numbers.data() + 8);
  StoreBigEndian64(static_cast<uint64_t>(session), numbers.data() + 16);
  StoreBigEndian64(counter, numbers.data() + 24);

  std::array<uint8_t, kSealTagSize> tag{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), tag.size());
  crypto_generichash_update(&state, Bytes(kPurpose), kPurpose.size());
  crypto_generichash_update(&state, numbers.data(), numbers.size());
  crypto_generichash_update(&state, Bytes(channel), channel.size());
  crypto_generichash_update(&state, static_cast<const uint8_t*>(message), static_cast<size_t>(size));
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

void WriteSeal(const Seal& seal, uint8_t* out) {
  std::memcpy(out, kSealMagic.data(), kSealMagic.size());
  StoreBigEndian64(static_cast<uint64_t>(seal.session), out + 8);
  StoreBigEndian64(seal.counter, out + 16);
  std::memcpy(out + 24, seal.tag.data(), seal.tag.size());
}

bool ReadSeal(const void* data, int size, Seal* seal) {
  const int message_size = SizeWithoutSeal(data, size);
  if (message_size == size) return false;
  const uint8_t* const in = static_cast<const uint8_t*>(data) + message_size;
  seal->session = static_cast<int64_t>(LoadBigEndian64(in + 8));
  seal->counter = LoadBigEndian64(in + 16);
  std::memcpy(seal->tag.data(), in + 24, seal->tag.size());
  return true;
}

bool SameTag(const std::array<uint8_t, kSealTagSize>& a, const std::array<uint8_t, kSealTagSize>& b) {
  return sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

BusKey KeyForPort(const BusKey& key, int port) {
  StartSodium();
  const std::string context = "hydro bus key, port " + std::to_string(port);
  std::array<uint8_t, kBusKeySize> derived{};
  crypto_generichash(derived.data(), derived.size(), reinterpret_cast<const unsigned char*>(context.data()),
                     context.size(), key.bytes().data(), key.bytes().size());
  BusKey result(derived);
  sodium_memzero(derived.data(), derived.size());
  return result;
}

BusKey::~BusKey() { sodium_memzero(bytes_.data(), bytes_.size()); }

BusKey ReadBusKey(const std::string& file) {
  StartSodium();
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (opened.number() < 0) {
    // Replacing an existing key would lock the other hosts out.
    RefuseErrno(file, "cannot be read",
                errno == ENOENT ? "`hydro-launch CONFIG --make-key` makes one"
                : errno == EACCES
                    ? "whoever starts the stack must own it (chown), in a folder that may be entered"
                    : "a file with a key is needed");
  }
  CheckPermissions(file, opened.number());
  SecretText secret;
  const char* text = secret.data();
  size_t size = ReadAll(file, opened.number(), secret.data());
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (size > 0 && blank(text[size - 1])) --size;
  while (size > 0 && blank(*text)) ++text, --size;

  std::array<uint8_t, kBusKeySize> bytes{};
  size_t length = 0;
  const char* end = nullptr;
  const auto whole = [&](int result) { return result == 0 && length == bytes.size() && end == text + size; };
  const bool read = whole(sodium_hex2bin(bytes.data(), bytes.size(), text, size, nullptr, &length, &end)) ||
                    whole(sodium_base642bin(bytes.data(), bytes.size(), text, size, nullptr, &length, &end,
                                            sodium_base64_VARIANT_ORIGINAL)) ||
                    whole(sodium_base642bin(bytes.data(), bytes.size(), text, size, nullptr, &length, &end,
                                            sodium_base64_VARIANT_ORIGINAL_NO_PADDING));
  const bool zeros = sodium_is_zero(bytes.data(), bytes.size()) == 1;
  const BusKey key(bytes);
  sodium_memzero(bytes.data(), bytes.size());
  if (!read) {
    Refuse(file, "found " +
                     (size > kLongest ? "more than " + std::to_string(kLongest) : std::to_string(size)) +
                     " characters that are no key, allowed 32 bytes on one line, as 64 hexadecimal digits or "
                     "in base64");
  }
  if (zeros) {  // an obvious placeholder
    Refuse(file,
           "found a key of zeros only, allowed random bytes; `hydro-launch CONFIG --make-key` makes one");
  }
  return key;
}

void MakeBusKeyFile(const std::string& file) {
  StartSodium();
  std::array<uint8_t, kBusKeySize> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  SecretText text;
  sodium_bin2hex(text.data(), kLongest, bytes.data(), bytes.size());
  sodium_memzero(bytes.data(), bytes.size());
  constexpr size_t kSize = 2 * kBusKeySize + 1;
  text.data()[kSize - 1] = '\n';

  const Descriptor made(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (made.number() < 0) {
    RefuseErrno(file, "cannot be made",
                errno == EEXIST ? "remove it first if it is to be replaced"
                                : "a name in a folder that can be written is needed");
  }
  errno = ENOSPC;  // the reason of a short write
  if (write(made.number(), text.data(), kSize) != static_cast<ssize_t>(kSize) || fsync(made.number()) != 0) {
    const std::string why = std::strerror(errno);
    unlink(file.c_str());
    throw WriteError(file + ": bus.key_file: cannot be written: " + why + "; space for it is needed");
  }
}

}  // namespace hydro::bus
