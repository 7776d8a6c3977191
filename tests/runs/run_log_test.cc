#include "runs/recorded/run_log.h"

#include <gmock/gmock.h>

#include "runs/recorded/compare.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RunLogTest : public log::LogTest {};

// Tests that a run is read as it was written, on channels with and without suffix.
TEST_F(RunLogTest, ReadsARun) {
  const RunMessages run = log::SampleRun(23);
  for (const std::string suffix : {"", "_2"}) {
    log::WriteRun(Path("log"), run, suffix);
    const RunLog log = ReadRunLog(Path("log"));
    EXPECT_EQ(log.suffix, suffix);
    EXPECT_EQ(FirstDifference(run, "written", log.messages, "read"), std::nullopt);
    ASSERT_EQ(log.messages.Of<run_description_t>().size(), 1u);
    EXPECT_EQ(log.messages.Of<run_description_t>()[0].version, "1.2.3");
    EXPECT_EQ(log.last_utime, 22000);
    EXPECT_EQ(log.bytes, static_cast<int64_t>(std::filesystem::file_size(Path("log"))));
  }
}

// Tests that of a log with two stacks one must be chosen.
TEST_F(RunLogTest, SeveralSuffixes) {
  log::WriteRun(Path("one"), log::SampleRun(3));
  log::WriteRun(Path("two"), log::SampleRun(5), "_2");
  log::WriteBytes(Path("both"), log::ReadBytes(Path("one")) + log::ReadBytes(Path("two")));
  EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("both")); }),
              AllOf(HasSubstr(Path("both")), HasSubstr("'', '_2'"), HasSubstr("--suffix")));
  EXPECT_EQ(ReadRunLog(Path("both"), {.suffix = ""}).messages.Of<state_t>().size(), 3u);
  EXPECT_EQ(ReadRunLog(Path("both"), {.suffix = "_2"}).messages.Of<state_t>().size(), 5u);
  EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("both"), {.suffix = "_3"}); }),
              AllOf(HasSubstr("no channel with suffix '_3'"), HasSubstr("'', '_2'")));
}

// Tests that a stray packet on another stack's channel does not make a log unreadable: the stack that
// describes its run is read, or without any description the one of nearly all states.
TEST_F(RunLogTest, StraySuffix) {
  log::WriteRun(Path("log"), log::SampleRun(30));
  std::vector<log::EventContents> events = log::ReadEvents(Path("log"));
  log::EventContents stray = events[1];
  stray.channel += "_X";
  events.push_back(stray);
  for (const bool described : {true, false}) {
    if (!described) std::erase_if(events, [](const auto& event) { return event.channel == "HYDRO_RUN"; });
    log::WriteEvents(Path("log"), events);
    const RunLog log = ReadRunLog(Path("log"));
    EXPECT_EQ(log.suffix, "");
    EXPECT_THAT(log.other_suffixes, testing::ElementsAre("_X"));
    EXPECT_THAT(DescribeCaution(log), HasSubstr("read channels with suffix '', not those with '_X'"));
    EXPECT_EQ(ReadRunLog(Path("log"), {.suffix = "_X"}).messages.Of<state_t>().size(), 1u);
  }
}

// Tests that other programs' messages are counted and otherwise left alone.
TEST_F(RunLogTest, ForeignChannels) {
  log::WriteEvents(Path("log"), {{"CAMERA", "12345", 7}, {"CAMERA", "678", 9}, {"LIDAR", "", 8}});
  const RunLog log = ReadRunLog(Path("log"));
  EXPECT_EQ(log.events, 3);
  ASSERT_EQ(log.channels.size(), 2u);
  EXPECT_EQ(log.channels[0].channel, "CAMERA");
  EXPECT_EQ(log.channels[0].events, 2);
  EXPECT_EQ(log.channels[0].bytes, 8);
  EXPECT_EQ(log.channels[0].first_utime, 7);
  EXPECT_EQ(log.channels[0].last_utime, 9);
  EXPECT_TRUE(log.messages.Of<state_t>().empty());
}

// Tests that a message of another type or version, or a damaged one, is an error that names event and byte.
TEST_F(RunLogTest, UndecodableMessage) {
  log::WriteRun(Path("log"), log::SampleRun(3));
  std::vector<log::EventContents> events = log::ReadEvents(Path("log"));
  ASSERT_EQ(events[1].channel, "HYDRO_STATE");
  events[1].data.pop_back();
  log::WriteEvents(Path("short"), events);
  EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("short")); }),
              AllOf(HasSubstr("event 1 on HYDRO_STATE: found 119 bytes that are not a whole hydro.state_t"),
                    HasSubstr("hydro-log repair")));
  events[1].data[0] = '?';
  log::WriteEvents(Path("other"), events);
  EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("other")); }),
              AllOf(HasSubstr("event 1 on HYDRO_STATE: found type hash 0x3f"), HasSubstr("; allowed 0x")));
}

// Tests that it is an error on every channel of the stack.
TEST_F(RunLogTest, UndecodableMessageOnAnyChannel) {
  bus::ForEachMessage([&](const auto& row) {
    const std::string channel(row.channel);
    log::WriteEvents(Path("log"), {{channel, "nonsense", 1}});
    EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("log")); }),
                HasSubstr("event 0 on " + channel + ": "));
  });
}

// Tests that such messages are left out and counted by channel where that is asked for, and that nothing else
// is: not a foreign channel, not another stack's.
TEST_F(RunLogTest, UndecodableMessageLeftOut) {
  const RunMessages run = log::SampleRun(3);
  log::WriteRun(Path("log"), run);
  std::vector<log::EventContents> events = log::ReadEvents(Path("log"));
  const log::EventContents torn{"HYDRO_STATE", events[1].data.substr(0, 60), 1};
  events.insert(events.begin() + 1, {torn,
                                     {"HYDRO_STATE", "", 1},
                                     {"HYDRO_MOTOR_COMMAND", "another type of message", 1},
                                     {"HYDRO_REARM", "nonsense", 1},
                                     {"HYDRO_STATE_2", "another stack's", 1},
                                     {"CAMERA", "a picture", 1}});
  log::WriteEvents(Path("log"), events);
  const RunLog log = ReadRunLog(Path("log"), {.suffix = ""}, Undecodable::kLeftOut);
  EXPECT_EQ(FirstDifference(run, "written", log.messages, "read"), std::nullopt);
  EXPECT_EQ(log.messages.Of<state_t>().size(), run.Of<state_t>().size());
  for (const ChannelSummary& channel : log.channels) {
    const bool one = channel.channel == "HYDRO_MOTOR_COMMAND" || channel.channel == "HYDRO_REARM";
    EXPECT_EQ(channel.undecodable, channel.channel == "HYDRO_STATE" ? 2 : one ? 1 : 0) << channel.channel;
  }
  EXPECT_THAT(DescribeUndecodable(log),
              AllOf(HasSubstr(Path("log") + ": left out 4 messages"),
                    HasSubstr("(1 on HYDRO_MOTOR_COMMAND, 1 on HYDRO_REARM, 2 on HYDRO_STATE)"),
                    HasSubstr("event 1 on HYDRO_STATE: found 60 bytes that are not a whole hydro.state_t")));

  log::WriteBytes(Path("log"), log::ReadBytes(Path("log")) + "x");  // damage of the file is not a message
  EXPECT_THAT(log::InputErrorOf([&] { ReadRunLog(Path("log"), {.suffix = ""}, Undecodable::kLeftOut); }),
              HasSubstr("hydro-log repair"));
}

}  // namespace
}  // namespace hydro::runs
