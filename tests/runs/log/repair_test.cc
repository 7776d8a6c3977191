#include "runs/log/repair.h"

#include <gmock/gmock.h>

#include <map>

#include "runs/log/log_reader.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

using testing::HasSubstr;

class RepairTest : public LogTest {
 protected:
  // Repairs a log of these bytes.
  std::vector<EventContents> Repaired(const std::string& bytes, RepairResult* result = nullptr) {
    WriteBytes(Path("damaged"), bytes);
    std::filesystem::remove(Path("repaired"));
    const RepairResult repaired = RepairLog(Path("damaged"), Path("repaired"));
    if (result != nullptr) *result = repaired;
    std::vector<EventContents> events = ReadEvents(Path("repaired"));
    EXPECT_EQ(static_cast<int64_t>(events.size()), repaired.kept_events);
    int64_t lost = 0;
    for (const LostBytes& place : repaired.lost) lost += place.end - place.begin;
    EXPECT_EQ(lost + repaired.kept_bytes + repaired.check_bytes, static_cast<int64_t>(bytes.size()));
    return events;
  }

  // A log of foreign messages, and the byte at which each begins, and its end.
  std::string Foreign(std::vector<EventContents>& events, std::vector<size_t>& begins) {
    events = {{"ONE", "first data", 1}, {"TWO", "second", 2}, {"THREE", "3rd", 3}, {"FOUR", "the fourth", 4}};
    WritePlain(Path("log"), events);
    begins = {0};
    for (const EventContents& event : events) {
      begins.push_back(begins.back() + kLogHeaderSize + event.channel.size() + event.data.size());
    }
    return ReadBytes(Path("log"));
  }
};

template <class Value>
std::vector<Value> Without(std::vector<Value> values, size_t index) {
  values.erase(values.begin() + static_cast<ptrdiff_t>(index));
  return values;
}

// Tests that a log cut at any byte of its last event loses that event alone.
TEST_F(RepairTest, TornTailAtEveryByte) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string bytes = Foreign(events, begins);
  for (size_t size = begins[3] + 1; size < begins[4]; ++size) {
    RepairResult result;
    EXPECT_EQ(Repaired(bytes.substr(0, size), &result), Without(events, 3)) << size;
    ASSERT_EQ(result.lost.size(), 1u);
    EXPECT_EQ(result.lost[0].begin, static_cast<int64_t>(begins[3]));
    EXPECT_EQ(result.lost[0].end, static_cast<int64_t>(size));
  }
}

// Tests that a log that was cut at any byte of an event, and to which a new logger appended, loses that event
// alone.
TEST_F(RepairTest, AppendedAfterATornTailAtEveryByte) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string bytes = Foreign(events, begins);
  for (size_t size = begins[3] + 1; size < begins[4]; ++size) {
    std::vector<EventContents> expected = Without(events, 3);
    expected.insert(expected.end(), events.begin(), events.end());
    EXPECT_EQ(Repaired(bytes.substr(0, size) + bytes), expected) << size;
  }
}

// Tests the same where the torn event's announced length ends inside messages of fixed size, which any bytes
// are.
TEST_F(RepairTest, AppendedAfterATornState) {
  WriteRun(Path("log"), SampleRun(3));
  const std::string bytes = PlainBytes(Path("log"));
  const std::vector<EventContents> events = ReadEvents(Path("log"));
  const size_t last = kLogHeaderSize + events.back().channel.size() + events.back().data.size();
  for (size_t cut = 1; cut < last; ++cut) {
    std::vector<EventContents> expected = Without(events, events.size() - 1);
    expected.insert(expected.end(), events.begin(), events.end());
    EXPECT_EQ(Repaired(bytes.substr(0, bytes.size() - cut) + bytes), expected) << cut;
  }
}

// Tests that missing bytes in the middle, whatever part of an event is left, lose that event alone.
TEST_F(RepairTest, MiddleEventCutAtEveryByte) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string bytes = Foreign(events, begins);
  for (size_t size = begins[1] + 1; size < begins[2]; ++size) {
    EXPECT_EQ(Repaired(bytes.substr(0, size) + bytes.substr(begins[2])), Without(events, 1)) << size;
  }
}

// Tests that any other value of any byte of an event's sync word or lengths loses at most that event.
TEST_F(RepairTest, EveryDamagedByteOfAHeader) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string bytes = Foreign(events, begins);
  for (const size_t field : {0, 20, 24}) {
    for (size_t byte = field; byte < field + 4; ++byte) {
      for (int value = 0; value < 256; ++value) {
        std::string damaged = bytes;
        char& place = damaged[begins[1] + byte];
        if (place == static_cast<char>(value)) continue;
        place = static_cast<char>(value);
        // A channel or data length that is slightly too small, with what follows taken for damage: the
        // numbers of the events tell.
        EXPECT_EQ(Repaired(damaged), Without(events, 1)) << "byte " << byte << " value " << value;
      }
    }
  }
}

// Tests that bytes inserted between two events are lost and nothing else, although the event before them then
// does not end at another.
TEST_F(RepairTest, GarbageBetweenEvents) {
  WriteRun(Path("log"), SampleRun(3));
  const std::string bytes = PlainBytes(Path("log"));
  const std::vector<EventContents> events = ReadEvents(Path("log"));
  const size_t first = kLogHeaderSize + events[0].channel.size() + events[0].data.size();
  RepairResult result;
  EXPECT_EQ(Repaired(bytes.substr(0, first) + "garbage" + bytes.substr(first), &result), events);
  ASSERT_EQ(result.lost.size(), 1u);
  EXPECT_EQ(result.lost[0].end - result.lost[0].begin, 7);
}

// Tests that one of our messages that is damaged inside is left out where others of its channel are whole,
// and kept where none is: that is another version's log.
TEST_F(RepairTest, UndecodableMessages) {
  WriteRun(Path("log"), SampleRun(3));
  std::vector<EventContents> events = ReadEvents(Path("log"));
  const std::vector<EventContents> whole = events;
  events[1].data[0] = '?';  // the type's hash
  WritePlain(Path("log"), events);
  EXPECT_EQ(Repaired(ReadBytes(Path("log"))), Without(whole, 1));

  WriteEvents(Path("log"), events);  // recorded as it is: docs/troubleshooting.md sends users here
  EXPECT_EQ(Repaired(ReadBytes(Path("log"))), Without(whole, 1));

  for (EventContents& event : events) event.data[0] = '?';
  WritePlain(Path("log"), events);
  RepairResult result;
  EXPECT_EQ(Repaired(ReadBytes(Path("log")), &result), events);
  EXPECT_TRUE(result.lost.empty());
}

// Tests that a description with a flipped bit that no checksum covers is left out where its sender's others
// tell otherwise, and that nothing is left out where they do not.
TEST_F(RepairTest, DamagedDescription) {
  WriteRun(Path("log"), SampleRun(20));
  const std::vector<EventContents> run = ReadEvents(Path("log"));
  const EventContents& good = run.front();
  ASSERT_EQ(good.channel, "HYDRO_RUN");
  EventContents damaged = good;
  damaged.data[damaged.data.find("Table 1")] ^= 0x20;
  EventContents later = good;
  later.data[15] ^= 1;  // of utime, the second field after the type's hash
  std::vector<EventContents> events = run;
  events.front() = damaged;

  // Three of one sender, of which two say the same.
  events.insert(events.end(), {good, later});
  WritePlain(Path("log"), events);
  EXPECT_EQ(Repaired(ReadBytes(Path("log"))), Without(events, 0));
  // Two, which contradict each other, and one alone.
  events.pop_back();
  WritePlain(Path("log"), events);
  EXPECT_EQ(Repaired(ReadBytes(Path("log"))), events);
  events.pop_back();
  WritePlain(Path("log"), events);
  EXPECT_EQ(Repaired(ReadBytes(Path("log"))), events);
  // Flipped since they were written, like their check event; a checksum covers one other alone.
  {
    LogWriter writer(Path("log"), Opening::kTemporary);
    for (const EventContents& event : {good, good, later}) {
      if (event == later) writer.Flush();
      writer.Append(event.channel, event.data.data(), event.data.size(), event.utime);
    }
    writer.Finish();
  }
  std::string bytes = ReadBytes(Path("log"));
  std::vector<size_t> names, checks;
  for (size_t at = bytes.find("Table 1"); at != std::string::npos; at = bytes.find("Table 1", at + 1))
    names.push_back(at);
  for (size_t at = bytes.find(kCheckChannel); at != std::string::npos; at = bytes.find(kCheckChannel, at + 1))
    checks.push_back(at + kCheckChannel.size());
  ASSERT_EQ(names.size(), 3u);
  ASSERT_EQ(checks.size(), 3u);
  for (const size_t at : {names[0], names[1], checks[1] + 20}) bytes[at] ^= 0x20;
  RepairResult result;
  EXPECT_EQ(Repaired(bytes, &result), std::vector<EventContents>{later});
  ASSERT_EQ(result.lost.size(), 3u);  // the check event, too
  EXPECT_EQ(result.lost.front().reason, "an event on HYDRO_RUN that differs from the others of its sender");
}

// Tests that a whole log loses nothing, and that one of no messages is whole as well.
TEST_F(RepairTest, WholeLog) {
  WriteRun(Path("log"), SampleRun(20));
  RepairResult result;
  EXPECT_EQ(Repaired(ReadBytes(Path("log")), &result), ReadEvents(Path("log")));
  EXPECT_TRUE(result.lost.empty());
  EXPECT_EQ(ReadBytes(Path("repaired")), ReadBytes(Path("log")));
  WriteEvents(Path("log"), {});
  EXPECT_TRUE(Repaired(ReadBytes(Path("log")), &result).empty());
  EXPECT_FALSE(result.mended());
}

// Tests that a log of which no message can be kept is not mended into one that looks like a run of nothing,
// in place neither.
TEST_F(RepairTest, NothingToKeep) {
  WriteRun(Path("log"), SampleRun(20));
  const std::string bytes = ReadBytes(Path("log"));
  LogReader reader(Path("log"));
  LogEvent first;
  ASSERT_TRUE(reader.Next(first));
  for (const std::string& damaged : {std::string(), bytes.substr(0, static_cast<size_t>(first.offset)),
                                     bytes.substr(0, static_cast<size_t>(first.offset) + 40)}) {
    WriteBytes(Path("damaged"), damaged);
    EXPECT_THAT(
        InputErrorOf([&] { RepairLog(Path("damaged"), Path("out")); }),
        HasSubstr("found no message that can be kept in " + std::to_string(damaged.size()) + " bytes"));
    EXPECT_THAT(InputErrorOf([&] { RepairInPlace(Path("damaged")); }),
                HasSubstr("found no message that can be kept"));
    EXPECT_EQ(ReadBytes(Path("damaged")), damaged);
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
    EXPECT_FALSE(std::filesystem::exists(Path("damaged.damaged")));
  }
}

// Tests that a file without any event is bad input, that the error says what the file is and who reads it,
// and that nothing is written then.
TEST_F(RepairTest, NoEventAtAll) {
  const std::pair<const char*, const char*> files[] = {
      {"bytes", "found no event in 6 bytes"},
      {"run.csv", "run.csv: found text, allowed an LCM event log; hydro-log import run.csv -o RUN.lcmlog"},
      {"notes", "found text, allowed an LCM event log; hydro-log import makes one of a table"},
      {"rig.toml", "found a model ([parameters]), allowed an LCM event log"}};
  const std::map<std::string, std::string> contents = {{"bytes", {"\1\2\3\4\5\6", 6}},
                                                       {"run.csv", "time_s,tick\n0,0\n"},
                                                       {"notes", "this is not a log"},
                                                       {"rig.toml", "[parameters]\nk_1 = 4.0\n"}};
  std::filesystem::current_path(std::filesystem::path(Path("x")).parent_path());
  for (const auto& [file, error] : files) {
    const std::string name = file;
    WriteBytes(name, contents.at(name));
    EXPECT_THAT(InputErrorOf([&] { RepairLog(name, "out"); }), HasSubstr(error));
    EXPECT_THAT(InputErrorOf([&] { RepairInPlace(name); }), HasSubstr(error));
    EXPECT_EQ(ReadBytes(name), contents.at(name));
    EXPECT_FALSE(std::filesystem::exists("out"));
    EXPECT_FALSE(std::filesystem::exists(name + ".damaged"));
  }
  std::filesystem::current_path("/");
}

// Tests that what a repair says names the file that it is about: the new log, or the one as it was found.
TEST_F(RepairTest, NamesTheRightFile) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string torn = Foreign(events, begins).substr(0, begins[4] - 1);
  WriteBytes(Path("log"), torn);
  const std::string beside = Describe(RepairLog(Path("log"), Path("new")), Path("log"));
  EXPECT_THAT(beside, testing::StartsWith(Path("new") + ": kept 3 messages, "));
  EXPECT_THAT(beside, HasSubstr(", of " + Path("log") + "\n"));
  EXPECT_THAT(beside, HasSubstr("\n" + Path("log") + ": lost bytes "));
  EXPECT_THAT(LogReader(Path("new")).verdict().note, testing::StartsWith("repaired from log, which was"));

  const std::string in_place = Describe(RepairInPlace(Path("log")), Path("log"));
  EXPECT_THAT(in_place, testing::StartsWith(Path("log") + ": kept 3 messages, "));
  EXPECT_THAT(in_place, HasSubstr("\n" + Path("log.damaged") + ": lost bytes "));
  EXPECT_THAT(LogReader(Path("log")).verdict().note, testing::StartsWith("repaired from log.damaged, which"));
}

// Tests that repair in place keeps the damaged log beside the new one under a name that it tells, and any
// older one.
TEST_F(RepairTest, InPlace) {
  std::vector<EventContents> events;
  std::vector<size_t> begins;
  const std::string torn = Foreign(events, begins).substr(0, begins[4] - 1);
  WriteBytes(Path("log"), torn);
  EXPECT_EQ(RepairInPlace(Path("log")).damaged, Path("log.damaged"));
  EXPECT_EQ(ReadEvents(Path("log")), Without(events, 3));
  EXPECT_EQ(ReadBytes(Path("log.damaged")), torn);

  EXPECT_TRUE(RepairInPlace(Path("log")).lost.empty());  // whole now: left alone
  const std::string shorter = torn.substr(0, torn.size() - 1);
  WriteBytes(Path("log"), shorter);
  const RepairResult again = RepairInPlace(Path("log"));
  EXPECT_EQ(again.damaged, Path("log.damaged1"));
  EXPECT_THAT(Describe(again, Path("log")),
              HasSubstr(": as it was found it is now " + Path("log.damaged1") + "\n"));
  EXPECT_EQ(ReadEvents(Path("log")), Without(events, 3));
  EXPECT_EQ(ReadBytes(Path("log.damaged")), torn);
  EXPECT_EQ(ReadBytes(Path("log.damaged1")), shorter);
}

// Tests that a log that is being recorded is not replaced under its recorder.
TEST_F(RepairTest, NotWhileRecording) {
  LogWriter writer(Path("log"), Opening::kDirect);
  writer.Append("A", "1", 1, 1);
  writer.Flush();
  EXPECT_THAT(InputErrorOf([&] { RepairInPlace(Path("log")); }), HasSubstr("being written"));
}

}  // namespace
}  // namespace hydro::log
