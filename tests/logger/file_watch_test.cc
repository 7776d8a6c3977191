#include "base/file_watch.h"

#include <fstream>

#include "logger/event_queue.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::logger {
namespace {

using namespace std::chrono_literals;

class FileWatchTest : public log::LogTest {};

// Tests that a file that is there is not complained of, and that a deleted one is, once, a second later.
TEST_F(FileWatchTest, Deleted) {
  log::WriteBytes(Path("log"), "x");
  FileWatch watch;
  watch.Watch(Path("log"));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(watch.Look(start), std::nullopt);
  std::filesystem::remove(Path("log"));
  EXPECT_EQ(watch.Look(start + 900ms), std::nullopt);
  EXPECT_EQ(watch.Look(start + 1s).value_or("").find(Path("log")), 0u);
  EXPECT_EQ(watch.Look(start + 3s), std::nullopt);
}

// Tests that a replaced file and a folder that has gone are noticed, and that devices are left alone.
TEST_F(FileWatchTest, ReplacedOrMoved) {
  log::WriteBytes(Path("log"), "x");
  FileWatch watch;
  watch.Watch(Path("log"));
  std::filesystem::rename(Path("log"), Path("other"));
  log::WriteBytes(Path("log"), "x");
  EXPECT_NE(watch.LookNow().value_or("").find("another file"), std::string::npos);
  std::filesystem::create_directory(Path("folder"));
  log::WriteBytes(Path("folder/log"), "x");
  watch.Watch(Path("folder/log"));
  std::filesystem::rename(Path("folder"), Path("moved"));
  EXPECT_TRUE(watch.LookNow().has_value());
  watch.Watch("/dev/null");
  EXPECT_EQ(watch.LookNow(), std::nullopt);
}

// Tests that a file is noticed that another program has cut, wholly or in part, or overwritten, and that
// growing is none of these.
TEST_F(FileWatchTest, CutOrOverwritten) {
  const std::string recorded(300'000, 'x'), more(100'000, 'y');
  const auto after = [&](const auto& happens) {
    log::WriteBytes(Path("log"), recorded);
    std::FILE* const recorder = std::fopen(Path("log").c_str(), "r+b");
    std::fseek(recorder, 0, SEEK_END);
    FileWatch watch;
    watch.Watch(Path("log"));
    EXPECT_EQ(watch.LookNow(), std::nullopt);
    happens();
    std::fwrite(more.data(), 1, more.size(), recorder);
    std::fclose(recorder);
    return watch.LookNow().value_or("");
  };
  EXPECT_EQ(after([] {}), "");
  const std::string noticed =
      Path("log") + ": has been cut or overwritten by another program while it was being recorded";
  EXPECT_EQ(after([&] { std::filesystem::resize_file(Path("log"), 0); }), noticed);
  EXPECT_EQ(after([&] { std::filesystem::resize_file(Path("log"), 100); }), noticed);
  EXPECT_EQ(after([&] { std::ofstream(Path("log")) << std::string(300'000, 'z'); }), noticed);
}

// Tests the bounds of refused messages, by number and by size, in a second and in a run.
TEST(RefusedQuotaTest, Bounds) {
  RefusedQuota quota;
  bus::Clock::TimePoint now{1h};
  const auto admitted = [&](int count, size_t size) {
    int64_t sum = 0;
    for (int k = 0; k < count; ++k) sum += quota.Admit(size, now);
    return sum;
  };
  EXPECT_EQ(admitted(5000, 10), RefusedQuota::kMessagesPerSecond);
  EXPECT_EQ(quota.left_out(), 4000);
  now += 1s;
  EXPECT_EQ(admitted(100, 10 << 10), (RefusedQuota::kBytesPerSecond >> 10) / 10);
  int64_t rest = 0;
  for (int second = 0; second < 100; ++second) {
    now += 1s;
    rest += admitted(2000, 10);
  }
  EXPECT_EQ(rest + 1000 + 25, RefusedQuota::kMessages);
  EXPECT_NE(quota.Text().find("at most 1000 and 256 KiB a second are recorded, 20000 and 8 MiB in a run"),
            std::string::npos);
}

}  // namespace
}  // namespace hydro::logger
