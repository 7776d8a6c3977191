#include <random>

#include "base/bytes.h"
#include "runs/log/log_reader.h"
#include "runs/log/repair.h"
#include "runs/recorded/compare.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

class LogMutationTest : public log::LogTest {
 protected:
  // Reads a log of these bytes in every possible way; anything but success or an InputError fails the test.
  void ReadEveryWay(const std::string& bytes) {
    log::WriteBytes(Path("log"), bytes);
    const auto attempt = [](auto work) {
      try {
        work();
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    };
    attempt([&] { log::ReadEvents(Path("log")); });
    attempt([&] {
      const runs::RunLog log = runs::ReadRunLog(Path("log"), {}, runs::Undecodable::kLeftOut);
      runs::FirstDifference(log.messages, "a", log.messages, "b");
      runs::ExportRun(log);
    });
    attempt([&] {
      log::RepairLog(Path("log"), Path("repaired"));
      log::ReadEvents(Path("repaired"));  // a repaired log is whole
      std::filesystem::remove(Path("repaired"));
    });
  }
};

// Tests that logs with a few bytes changed, removed, inserted or repeated never do worse than an InputError.
TEST_F(LogMutationTest, MutatedLogs) {
  log::WriteRun(Path("sample"), log::SampleRun(12));
  const std::string sample = log::ReadBytes(Path("sample"));
  std::mt19937_64 random(20240607);
  const auto below = [&random](size_t limit) {
    return std::uniform_int_distribution<size_t>(0, limit - 1)(random);
  };
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = sample;
    for (size_t mutations = 1 + below(4); mutations > 0 && !bytes.empty(); --mutations) {
      const size_t at = below(bytes.size());
      switch (below(5)) {
        case 0:
          bytes[at] = static_cast<char>(below(256));
          break;
        case 1:
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
          break;
        case 2:
          bytes.erase(at, 1 + below(200));
          break;
        case 3:
          bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(200)));
          break;
        default:
          bytes.resize(at + 1);
          break;
      }
    }
    ReadEveryWay(bytes);
  }
}

// Tests the same for random bytes, with and without sync words among them.
TEST_F(LogMutationTest, RandomBytes) {
  std::mt19937_64 random(42);
  const auto below = [&random](size_t limit) {
    return std::uniform_int_distribution<size_t>(0, limit - 1)(random);
  };
  for (int round = 0; round < 2000; ++round) {
    std::string bytes(1 + below(400), '\0');
    for (char& byte : bytes) byte = static_cast<char>(below(256));
    for (size_t syncs = below(6); syncs > 0; --syncs) {
      uint8_t header[log::kLogHeaderSize] = {};
      StoreBigEndian32(log::kLogSyncWord, header);
      StoreBigEndian32(static_cast<uint32_t>(below(70)), header + 20);
      StoreBigEndian32(static_cast<uint32_t>(below(300)), header + 24);
      bytes.insert(below(bytes.size()), reinterpret_cast<const char*>(header), sizeof header);
    }
    ReadEveryWay(bytes);
  }
}

}  // namespace
}  // namespace hydro::runs
