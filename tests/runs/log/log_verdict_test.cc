#include "runs/log/log_verdict.h"

#include <gmock/gmock.h>

#include "base/bytes.h"
#include "runs/log/log_check.h"
#include "runs/log/repair.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class LogVerdictTest : public LogTest {
 protected:
  LogVerdict VerdictOn(const std::string& bytes) {
    WriteBytes(Path("log"), bytes);
    return LogReader(Path("log"), OnDamage::kStop).verdict();
  }
  // A log of 1000 messages, of which each is 47 bytes long.
  std::string Sample() {
    LogWriter writer(Path("sample"), Opening::kTemporary);
    for (int k = 0; k < 1000; ++k) writer.Append("CHANNEL", "twelve bytes", 12, 1000000 + k);
    writer.Finish();
    return ReadBytes(Path("sample"));
  }
};

// Tests the bytes of the shortest log, field by field, as docs/logs.md has them.
TEST_F(LogVerdictTest, FormatByteByByte) {
  {
    LogWriter writer(Path("log"), Opening::kTemporary, "note");
    writer.Append("A", "x", 1, 7);
    writer.Finish("end");
  }
  const std::string bytes = ReadBytes(Path("log"));
  const auto* at = reinterpret_cast<const uint8_t*>(bytes.data());
  const size_t begin_size = 28 + 10 + 28 + 4 + 4, message_size = 28 + 1 + 1,
               end_size = 28 + 10 + 28 + 4 + 3 + 4;
  ASSERT_EQ(bytes.size(), begin_size + message_size + end_size);
  EXPECT_EQ(LoadBigEndian64(at + 4), 0u);   // the next message's number
  EXPECT_EQ(LoadBigEndian64(at + 12), 7u);  // its time
  EXPECT_EQ(bytes.substr(28, 10), "\nLOG_CHECK");
  EXPECT_EQ(bytes.substr(38, 8), "HYDROCHK");
  EXPECT_EQ(bytes.substr(46, 2), std::string("\1\0", 2));  // version, kind
  EXPECT_EQ(bytes.substr(38 + 28, 4), "note");
  EXPECT_EQ(LoadBigEndian32(at + begin_size - 4), Checksum(at, begin_size - 4));
  const uint8_t* end = at + begin_size + message_size;
  EXPECT_EQ(LoadBigEndian64(end + 4), 1u);
  EXPECT_EQ(end[38 + 9], 2);                                                        // kind
  EXPECT_EQ(end[38 + 11], 3);                                                       // length of the text
  EXPECT_EQ(LoadBigEndian32(end + 38 + 12), 1u);                                    // count
  EXPECT_EQ(LoadBigEndian64(end + 38 + 16), begin_size + message_size);             // offset
  EXPECT_EQ(LoadBigEndian32(end + 38 + 24), LoadBigEndian32(at + begin_size - 4));  // previous
  EXPECT_EQ(LoadBigEndian32(end + 38 + 28), Checksum(at + begin_size, message_size));
  EXPECT_EQ(LoadBigEndian32(end + end_size - 4), Checksum(end, end_size - 4));
}

// Tests the checksum against the known one of CRC-32, which other tools compute.
TEST_F(LogVerdictTest, ChecksumIsCrc32) {
  EXPECT_EQ(Checksum(reinterpret_cast<const uint8_t*>("123456789"), 9), 0xcbf43926u);
}

// Tests that a finished log is complete, with and without messages, and that its notes come back.
TEST_F(LogVerdictTest, Complete) {
  EXPECT_EQ(VerdictOn(Sample()).completeness, Completeness::kComplete);
  EXPECT_EQ(Caution(VerdictOn(Sample())), "");
  {
    LogWriter writer(Path("noted"), Opening::kTemporary, "from a table");
    writer.Remark("one was left out");
    writer.Finish("goes on elsewhere");
  }
  const LogVerdict verdict = VerdictOn(ReadBytes(Path("noted")));
  EXPECT_EQ(verdict.completeness, Completeness::kComplete);
  EXPECT_EQ(verdict.note, "from a table");
  EXPECT_THAT(verdict.remarks, ElementsAre("one was left out"));
  EXPECT_EQ(verdict.ending, "goes on elsewhere");
  EXPECT_TRUE(EndIsOpen(verdict));
  EXPECT_EQ(Caution(verdict), "from a table; goes on elsewhere");
}

// Tests that a log whose recorder is at work, or was killed, is incomplete, and all that was flushed is
// covered.
TEST_F(LogVerdictTest, BeingRecorded) {
  LogWriter writer(Path("log"), Opening::kDirect);
  EXPECT_EQ(LogReader(Path("log")).verdict().completeness, Completeness::kIncomplete);  // empty
  for (int k = 0; k < 5; ++k) writer.Append("A", "x", 1, k);
  writer.Flush();
  const LogVerdict verdict = LogReader(Path("log")).verdict();
  EXPECT_EQ(verdict.completeness, Completeness::kIncomplete);
  EXPECT_EQ(verdict.unchecked_messages, 0);
  EXPECT_TRUE(EndIsOpen(verdict));
}

// Tests that a log of lcm-logger, or of a version without checksums, is read as before and called what it is.
TEST_F(LogVerdictTest, WithoutChecksums) {
  WritePlain(Path("plain"), {{"A", "x", 1}, {"B", "y", 2}});
  const LogVerdict verdict = VerdictOn(ReadBytes(Path("plain")));
  EXPECT_EQ(verdict.completeness, Completeness::kWithoutChecksums);
  EXPECT_EQ(Caution(verdict), "");
  EXPECT_FALSE(EndIsOpen(verdict));
}

// Tests that files joined with cat are complete when each is, and damaged where one is cut.
TEST_F(LogVerdictTest, JoinedLogs) {
  const std::string one = Sample();
  EXPECT_EQ(VerdictOn(one + one).completeness, Completeness::kComplete);
  EXPECT_EQ(ReadEvents(Path("log")).size(), 2000u);
  const LogVerdict verdict = VerdictOn(one.substr(0, 70 + 10 * 47) + one);
  EXPECT_EQ(verdict.completeness, Completeness::kDamaged);
  EXPECT_THAT(verdict.where, HasSubstr("before the one before it has ended"));
}

// Tests that what is appended to a finished log is noticed.
TEST_F(LogVerdictTest, AppendedTo) {
  WritePlain(Path("plain"), {{"A", "x", 1}});
  const LogVerdict verdict = VerdictOn(Sample() + ReadBytes(Path("plain")));
  EXPECT_EQ(verdict.completeness, Completeness::kDamaged);
  EXPECT_THAT(verdict.where, HasSubstr("event 1000: found an event after the mark of the end"));
}

// Tests that removed messages are named with the times between which they are missing, in one block and
// across several.
TEST_F(LogVerdictTest, RemovedMessages) {
  std::string bytes = Sample();
  const size_t first = 70;
  bytes.erase(first + 50 * 47, 3 * 47);
  EXPECT_THAT(VerdictOn(bytes).where,
              AllOf(HasSubstr("byte " + std::to_string(first + 50 * 47) + ", event 50"),
                    HasSubstr("(1 s) and byte"), HasSubstr("(1.000127 s) 3 messages are missing")));
  bytes = Sample();
  bytes.erase(first + 50 * 47, 300 * 47);  // not at an event's begin after two check events
  EXPECT_EQ(VerdictOn(bytes).completeness, Completeness::kDamaged);
}

// Tests that whole blocks with their check events, removed, leave a gap in the chain that is measured.
TEST_F(LogVerdictTest, RemovedBlock) {
  const std::string bytes = Sample();
  const size_t block = 128 * 47 + 28 + 10 + 28 + 4 * 128 + 4, first = 70;
  const LogVerdict verdict = VerdictOn(bytes.substr(0, first + block) + bytes.substr(first + 2 * block));
  EXPECT_EQ(verdict.completeness, Completeness::kDamaged);
  EXPECT_THAT(verdict.where, HasSubstr(std::to_string(block) + " bytes are missing"));
}

// Tests that nobody on a bus can put a check event into a log.
TEST_F(LogVerdictTest, ForgedChecksAreLeftOut) {
  LogWriter writer(Path("log"), Opening::kTemporary);
  writer.Append("A", "x", 1, 1);
  writer.Append(kCheckChannel, "HYDROCHK and more", 17, 1);
  writer.Append("HARMLESS", "HYDROCHK0123456789012345678901234567890", 39, 1);
  writer.Finish();
  EXPECT_EQ(writer.events(), 2);
  EXPECT_EQ(VerdictOn(ReadBytes(Path("log"))).completeness, Completeness::kComplete);
  EXPECT_EQ(ReadEvents(Path("log")).size(), 2u);
}

// Tests that a log whose checksums are of a later version is refused, not misread.
TEST_F(LogVerdictTest, LaterVersion) {
  std::string bytes = Sample();
  bytes[28 + 10 + 8] = 2;
  uint8_t checksum[4];
  StoreBigEndian32(Checksum(reinterpret_cast<const uint8_t*>(bytes.data()), 66), checksum);
  bytes.replace(66, 4, reinterpret_cast<const char*>(checksum), 4);
  WriteBytes(Path("log"), bytes);
  EXPECT_THAT(InputErrorOf([&] { LogReader(Path("log")); }), HasSubstr("a newer one is needed"));
}

// Tests that a repaired log says so and what it lacks, also after a second repair, and that one without
// checksums gets them.
TEST_F(LogVerdictTest, RepairedLogsSaySo) {
  std::string bytes = Sample();
  bytes[5000] ^= 1;
  WriteBytes(Path("log"), bytes);
  RepairInPlace(Path("log"));
  EXPECT_EQ(LogReader(Path("log")).verdict().note,
            "repaired from log.damaged, which was damaged, 1 message lost, 47 bytes at 1 place left out");
  std::filesystem::remove(Path("log.damaged"));
  WriteBytes(Path("log"), ReadBytes(Path("log")).substr(0, 20000));
  RepairInPlace(Path("log"));
  const LogVerdict twice = LogReader(Path("log")).verdict();
  EXPECT_THAT(twice.note, AllOf(HasSubstr("which was damaged"), HasSubstr("which was incomplete")));
  EXPECT_EQ(twice.ending, "the original had no mark of the end");
  EXPECT_TRUE(EndIsOpen(twice));

  WritePlain(Path("plain"), {{"A", "x", 1}});
  RepairLog(Path("plain"), Path("checked"));
  EXPECT_EQ(LogReader(Path("checked")).verdict().ending, "the original had no checksums");
}

}  // namespace
}  // namespace hydro::log
