#include "scope/side_work.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>

#include "base/interruption.h"
#include "base/tables/table.h"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "tests/temporary_folder.h"

namespace hydro::scope {
namespace {

// Tests for which TMPDIR is a folder of their own.
class SideWorkTest : public ::testing::Test {
 protected:
  SideWorkTest() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~SideWorkTest() override { unsetenv("TMPDIR"); }

  static void MakeOld(const std::filesystem::path& folder) {
    const timespec times[2] = {{.tv_sec = 1'000'000'000, .tv_nsec = 0},
                               {.tv_sec = 1'000'000'000, .tv_nsec = 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, folder.c_str(), times, 0), 0);
  }

  // Begins that work, and ends it while it is being done. Without an interruption this would never return.
  static std::string EndOf(const std::function<void()>& read) {
    std::promise<void> begun;
    std::string end;
    {
      SideWork work([](const std::function<void()>& done) { done(); });
      work.Do([&]() -> std::function<void()> {
        begun.set_value();
        try {
          while (true) read();
        } catch (const Interrupted& error) {
          end = error.what();
        }
        return [] {};
      });
      begun.get_future().wait();
    }
    return end;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path temporary_ = folder_.path();
};

// Tests that the end of a scope does not wait for who reads a log or a table, however long that takes.
TEST_F(SideWorkTest, TheEndInterruptsReaders) {
  const std::string log = temporary_ / "log", table = temporary_ / "table.csv";
  {
    log::LogWriter writer(log, Opening::kTemporary);
    for (int i = 0; i < 100; ++i) writer.Append("CHANNEL", "x", 1, i);
    writer.Finish();
  }
  std::ofstream(table) << "time_s,a\n0,1\n1,2\n";
  EXPECT_EQ(EndOf([&] {
              log::LogReader reader(log);
              log::LogEvent event;
              while (reader.Next(event)) {
              }
            }),
            "ended before it was done");
  EXPECT_EQ(EndOf([&] { tables::ReadTable(table); }), "ended before it was done");
  EXPECT_NO_THROW(tables::ReadTable(table)) << "on a thread that nobody wants to end";
}

// Tests that a scope removes what a killed one has left, and nothing of one that lives, or that has only just
// begun.
TEST_F(SideWorkTest, FoldersOfTheKilledAreRemoved) {
  const auto post = [](const std::function<void()>& done) { done(); };
  const std::filesystem::path dead = temporary_ / "hydro-scope.dead",
                              fresh = temporary_ / "hydro-scope.fresh", foreign = temporary_ / "other.dead";
  for (const auto& folder : {dead, fresh, foreign}) {
    std::filesystem::create_directory(folder);
    std::ofstream(folder / "1.lcmlog") << "x";
  }
  std::string living;
  {
    const SideWork first(post);
    living = first.folder();
    MakeOld(living);
    MakeOld(dead);
    MakeOld(foreign);
    const SideWork second(post);
    EXPECT_FALSE(std::filesystem::exists(dead));
    EXPECT_TRUE(std::filesystem::exists(living));
    EXPECT_TRUE(std::filesystem::exists(fresh));
    EXPECT_TRUE(std::filesystem::exists(foreign));
    EXPECT_NE(second.folder(), living);
  }
  EXPECT_FALSE(std::filesystem::exists(living));
}

}  // namespace
}  // namespace hydro::scope
