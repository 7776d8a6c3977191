#include <lcm/lcm.h>

#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

class LiblcmTest : public LogTest {};

const std::vector<EventContents> kEvents = {{"ONE", "first data", 1000},
                                            {"TWO", std::string("\0\1\2", 3), 2000},
                                            {std::string(63, 'c'), "x", int64_t{1} << 50}};

// Tests that liblcm reads every event of a log that we write, with its number; the check events come between.
TEST_F(LiblcmTest, ReadsWhatWeWrite) {
  WriteEvents(Path("log"), kEvents);
  lcm_eventlog_t* log = lcm_eventlog_create(Path("log").c_str(), "r");
  ASSERT_NE(log, nullptr);
  for (size_t k = 0; k < kEvents.size(); ++k) {
    lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
    ASSERT_NE(event, nullptr) << k;
    while (std::string(event->channel) == kCheckChannel) {
      lcm_eventlog_free_event(event);
      event = lcm_eventlog_read_next_event(log);
      ASSERT_NE(event, nullptr) << k;
    }
    EXPECT_EQ(event->eventnum, static_cast<int64_t>(k));
    EXPECT_EQ(event->timestamp, kEvents[k].utime);
    EXPECT_EQ(std::string(event->channel, static_cast<size_t>(event->channellen)), kEvents[k].channel);
    EXPECT_EQ(std::string(static_cast<char*>(event->data), static_cast<size_t>(event->datalen)),
              kEvents[k].data);
    lcm_eventlog_free_event(event);
  }
  lcm_eventlog_event_t* end = lcm_eventlog_read_next_event(log);
  ASSERT_NE(end, nullptr);
  EXPECT_EQ(std::string(end->channel), kCheckChannel);
  lcm_eventlog_free_event(end);
  EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
  lcm_eventlog_destroy(log);
}

// Appends `events` to a log as lcm-logger does.
void WriteWithLiblcm(const std::string& file, const std::vector<EventContents>& events, const char* mode) {
  lcm_eventlog_t* log = lcm_eventlog_create(file.c_str(), mode);
  ASSERT_NE(log, nullptr);
  for (const EventContents& contents : events) {
    std::string channel = contents.channel;
    std::string data = contents.data;
    lcm_eventlog_event_t event{};
    event.timestamp = contents.utime;
    event.channel = channel.data();
    event.channellen = static_cast<int32_t>(channel.size());
    event.data = data.data();
    event.datalen = static_cast<int32_t>(data.size());
    ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
  }
  lcm_eventlog_destroy(log);
}

// Tests that we read every event of a log that liblcm wrote, and that both write the same bytes but for
// our check events.
TEST_F(LiblcmTest, WeReadWhatItWrites) {
  WriteWithLiblcm(Path("theirs"), kEvents, "w");
  EXPECT_EQ(ReadEvents(Path("theirs")), kEvents);
  WriteEvents(Path("ours"), kEvents);
  EXPECT_EQ(PlainBytes(Path("ours")), ReadBytes(Path("theirs")));
}

// Tests that a log to which liblcm appended is read to its end.
TEST_F(LiblcmTest, WeReadWhatItAppended) {
  WriteWithLiblcm(Path("log"), kEvents, "w");
  WriteWithLiblcm(Path("log"), kEvents, "a");
  EXPECT_EQ(ReadEvents(Path("log")).size(), 2 * kEvents.size());
}

}  // namespace
}  // namespace hydro::log
