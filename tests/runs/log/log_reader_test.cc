#include "runs/log/log_reader.h"

#include <gmock/gmock.h>

#include "base/bytes.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class LogReaderTest : public LogTest {};

const std::vector<EventContents> kThreeEvents = {
    {"ONE", "first data", 1}, {"TWO", "second", 2}, {"THREE", "3rd", 3}};

size_t SizeOf(const EventContents& event) {
  return kLogHeaderSize + event.channel.size() + event.data.size();
}

// Tests that an empty file is a log without events.
TEST_F(LogReaderTest, EmptyFile) {
  WriteBytes(Path("log"), "");
  EXPECT_TRUE(ReadEvents(Path("log")).empty());
}

// Tests that a log without checksums cut at any byte of any event gives the events before it, then an error
// that names the place.
TEST_F(LogReaderTest, TruncatedAtEveryByte) {
  WritePlain(Path("log"), kThreeEvents);
  const std::string bytes = ReadBytes(Path("log"));
  size_t begin = 0;
  for (size_t k = 0; k < kThreeEvents.size(); ++k) {
    const size_t end = begin + SizeOf(kThreeEvents[k]);
    for (size_t size = begin + 1; size < end; ++size) {
      WriteBytes(Path("cut"), bytes.substr(0, size));
      LogReader reader(Path("cut"));
      LogEvent event;
      for (size_t before = 0; before < k; ++before) ASSERT_TRUE(reader.Next(event)) << size;
      try {
        reader.Next(event);
        FAIL() << "no error when cut at " << size;
      } catch (const LogError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr(Path("cut") + ": byte " + std::to_string(begin) +
                                                  ", event " + std::to_string(k) + ": found "),
                                        HasSubstr("hydro-log repair " + Path("cut"))));
      }
    }
    begin = end;
  }
}

struct Damage {
  const char* name;
  size_t offset;  // within the second event
  std::string bytes;
  const char* says;
};

// Tests that each damaged field of a header is an error that says what was found and what is allowed.
TEST_F(LogReaderTest, DamagedHeader) {
  const Damage damages[] = {
      {"sync word", 0, std::string(4, '\0'), "found sync word 0x00000000; allowed 0xeda1da01"},
      {"channel length 0", 20, std::string(4, '\0'), "found channel length 0; allowed 1 to 63"},
      {"channel length 64", 20, std::string("\0\0\0\x40", 4), "found channel length 64; allowed 1 to 63"},
      {"negative channel length", 20, "\xff\xff\xff\xff", "found channel length -1; allowed 1 to 63"},
      {"negative data length", 24, "\xff\xff\xff\xfe", "found data length -2; allowed 0 to 1073741824"},
      {"data beyond the file", 24, std::string("\0\x01\0\0", 4),
       "before the end of the file; the header announces 65539"},
      {"data a byte short", 24, std::string("\0\0\0\x05", 4),
       "found sync word 0x64eda1da; allowed 0xeda1da01"},
      {"zero byte in the channel", 29, std::string("\0", 1), "found a zero byte in the channel's name"},
  };
  WritePlain(Path("log"), kThreeEvents);
  const std::string bytes = ReadBytes(Path("log"));
  for (const Damage& damage : damages) {
    std::string damaged = bytes;
    damaged.replace(SizeOf(kThreeEvents[0]) + damage.offset, damage.bytes.size(), damage.bytes);
    WriteBytes(Path("damaged"), damaged);
    EXPECT_THAT(InputErrorOf([&] { ReadEvents(Path("damaged")); }), HasSubstr(damage.says)) << damage.name;
  }
}

// Tests that an event whose length is wrong is not handed out before the error.
TEST_F(LogReaderTest, DoesNotReturnAnEventOfWrongLength) {
  WritePlain(Path("log"), kThreeEvents);
  std::string bytes = ReadBytes(Path("log"));
  bytes[27] = static_cast<char>(bytes[27] - 1);
  WriteBytes(Path("log"), bytes);
  LogReader reader(Path("log"));
  LogEvent event;
  EXPECT_THROW(reader.Next(event), LogError);
}

// Tests that a file that is no log, and a missing file, are errors that name the file.
TEST_F(LogReaderTest, NotALog) {
  WriteBytes(Path("text"), "time_s,tick\n0,1\n");
  EXPECT_THAT(InputErrorOf([&] { ReadEvents(Path("text")); }),
              HasSubstr(Path("text") + ": found text, allowed an LCM event log; hydro-log import"));
  WriteBytes(Path("bytes"), std::string("\x01\x02\x03\x04\x05\x06", 6));
  EXPECT_THAT(InputErrorOf([&] { ReadEvents(Path("bytes")); }),
              HasSubstr(Path("bytes") + ": byte 0, event 0"));
  EXPECT_THAT(InputErrorOf([&] { ReadEvents(Path("none")); }),
              AllOf(HasSubstr(Path("none")), HasSubstr("No such file")));
  EXPECT_THAT(InputErrorOf([&] { ReadEvents(Path("")); }), HasSubstr("folder"));
}

// Tests that messages of another type, with bytes missing or with bytes too many, do not decode.
TEST_F(LogReaderTest, DecodesOnlyWholeMessages) {
  const runs::RunMessages run = SampleRun(1);
  std::vector<uint8_t> bytes(static_cast<size_t>(run.Of<state_t>()[0].getEncodedSize()) + 1);
  run.Of<state_t>()[0].encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  LogEvent event;
  event.data = bytes.data();
  state_t state;
  motor_command_t command;
  for (int size = 0; size <= static_cast<int>(bytes.size()); ++size) {
    event.size = size;
    EXPECT_EQ(DecodeAs(event, state), size == run.Of<state_t>()[0].getEncodedSize()) << size;
    EXPECT_FALSE(DecodeAs(event, command)) << size;
  }
}

// Tests that a string whose length is damaged does not decode, whatever the length.
TEST_F(LogReaderTest, DamagedStringLengths) {
  const runs::RunMessages run = SampleRun(1);
  const fault_t& fault = run.Of<fault_t>()[0];
  std::vector<uint8_t> bytes(static_cast<size_t>(fault.getEncodedSize()));
  LogEvent event;
  event.data = bytes.data();
  event.size = static_cast<int>(bytes.size());
  fault_t decoded;
  for (const uint32_t length : {0u, 0xffffffffu, 0x80000001u, 0x7fffffffu, 1000u, 13u, 15u}) {
    fault.encode(bytes.data(), 0, event.size);
    ASSERT_TRUE(DecodeAs(event, decoded));
    StoreBigEndian32(length, bytes.data() + 8 + 4 * 8);  // of `source`, 14 with its zero byte
    EXPECT_FALSE(DecodeAs(event, decoded)) << length;
  }
}

}  // namespace
}  // namespace hydro::log
