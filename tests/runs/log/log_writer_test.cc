#include "runs/log/log_writer.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class LogWriterTest : public LogTest {};

// Tests that events come back as they were appended, empty data and the longest channel included.
TEST_F(LogWriterTest, EventsComeBack) {
  const std::vector<EventContents> events = {
      {"A", "", 0},
      {std::string(63, 'c'), "data", -5},
      {"B", std::string("\0\xed\xa1\xda\x01", 5), int64_t{1} << 62},
      {"big", std::string(3u << 20, 'x'), 1},  // larger than the buffer
      {"after", "y", 2}};
  WriteEvents(Path("log"), events);
  EXPECT_EQ(ReadEvents(Path("log")), events);
}

// Tests that events are numbered from 0 and that bytes() is the length of the file.
TEST_F(LogWriterTest, CountsEventsAndBytes) {
  LogWriter writer(Path("log"), Opening::kDirect);
  for (int k = 0; k < 50000; ++k) writer.Append("CHANNEL", "0123456789abcdef0123456789", 26, k);
  EXPECT_EQ(writer.events(), 50000);
  writer.Flush();
  EXPECT_EQ(static_cast<uintmax_t>(writer.bytes()), std::filesystem::file_size(Path("log")));
  LogReader reader(Path("log"));
  LogEvent event;
  for (int64_t k = 0; k < 50000; ++k) {
    ASSERT_TRUE(reader.Next(event));
    ASSERT_EQ(event.number, k);
    ASSERT_EQ(event.index, k);
  }
  EXPECT_FALSE(reader.Next(event));
}

// Tests that a recording holds what was flushed while its writer is still open.
TEST_F(LogWriterTest, FlushedEventsAreInTheFileAtOnce) {
  LogWriter writer(Path("log"), Opening::kDirect);
  writer.Append("A", "1", 1, 1);
  writer.Flush();
  writer.Append("A", "2", 1, 2);
  EXPECT_EQ(ReadEvents(Path("log")).size(), 1u);
}

// Tests that a log that must be complete gets its name only when it is finished.
TEST_F(LogWriterTest, TemporaryLogAppearsWhenFinished) {
  {
    LogWriter writer(Path("log"), Opening::kTemporary);
    writer.Append("A", "1", 1, 1);
    writer.Flush();
    EXPECT_FALSE(std::filesystem::exists(Path("log")));
    writer.Finish();
    EXPECT_TRUE(std::filesystem::exists(Path("log")));
  }
  EXPECT_EQ(ReadEvents(Path("log")).size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(Path("log.part")));
}

// Tests that nothing is left of an unfinished log, and that an older one under its name stays.
TEST_F(LogWriterTest, UnfinishedTemporaryLogLeavesNothing) {
  WriteEvents(Path("log"), {{"OLD", "1", 1}});
  {
    LogWriter writer(Path("log"), Opening::kTemporary);
    writer.Append("NEW", "1", 1, 1);
    writer.Flush();
  }
  EXPECT_EQ(ReadEvents(Path("log")).at(0).channel, "OLD");
  EXPECT_FALSE(std::filesystem::exists(Path("log.part")));
}

// Tests that two writers cannot write one file.
TEST_F(LogWriterTest, RefusesAFileThatIsBeingWritten) {
  const LogWriter writer(Path("log"), Opening::kDirect);
  const std::string error = InputErrorOf([&] { const LogWriter other(Path("log"), Opening::kDirect); });
  EXPECT_THAT(error, AllOf(HasSubstr(Path("log")), HasSubstr("being written")));
}

// Tests that a file that cannot be created is bad input that names the file and the system's reason.
TEST_F(LogWriterTest, CannotCreate) {
  const std::string error = InputErrorOf([&] { const LogWriter writer(Path("none/log"), Opening::kDirect); });
  EXPECT_THAT(error, AllOf(HasSubstr(Path("none/log")), HasSubstr("No such file or directory")));
}

// Tests that a full disk is an error that names the file, that the event is then not counted, and that
// earlier events stay.
TEST_F(LogWriterTest, DiskFull) {
  LogWriter writer("/dev/full", Opening::kDirect);
  writer.Append("A", "1", 1, 1);
  try {
    writer.Flush();
    FAIL() << "no WriteError";
  } catch (const WriteError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left on device")));
  }
  const std::string large(2u << 20, 'x');
  EXPECT_THROW(writer.Append("A", large.data(), large.size(), 2), WriteError);
  EXPECT_EQ(writer.events(), 1);
}

// Tests that a file that cannot grow further (as on a disk that fills up) ends with the last event that fits:
// what is in it can be read.
TEST_F(LogWriterTest, FullDiskLeavesWholeEvents) {
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  {
    LogWriter writer(Path("log"), Opening::kDirect);
    const std::vector<uint8_t> data(100, 7);
    for (int i = 0; i < 20; ++i) writer.Append("CHANNEL", data.data(), data.size(), i);
    rlimit small = before;
    small.rlim_cur = 1000;  // a check event, six events of 135 bytes and a piece
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    EXPECT_THROW(writer.Flush(), WriteError);
  }  // the destructor tries again
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(ReadEvents(Path("log")).size(), 6u);
}

// Tests that events that LCM could not have sent are refused.
TEST_F(LogWriterTest, RefusesImpossibleEvents) {
  LogWriter writer(Path("log"), Opening::kDirect);
  EXPECT_THROW(writer.Append("", "1", 1, 1), std::invalid_argument);
  EXPECT_THROW(writer.Append(std::string(64, 'c'), "1", 1, 1), std::invalid_argument);
  EXPECT_EQ(writer.events(), 0);
}

}  // namespace
}  // namespace hydro::log
