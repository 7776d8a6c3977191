// What the simulator says of a log: true of whole, cut, changed and false ones.
#include <gmock/gmock.h>

#include <string>

#include "runs/log/log_writer.h"
#include "sim/torture/invariants/records.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::torture {
namespace {

using ::testing::HasSubstr;

class LogRecordTest : public log::LogTest {
 protected:
  LogRecordTest() { record_.file = Path("log"); }

  void Handle(int k) {
    const std::string text = "message " + std::to_string(k);
    record_.Handle("A", reinterpret_cast<const uint8_t*>(text.data()), text.size());
  }
  // Writes the messages 0 to 99 but for `left_out`.
  void Write(int left_out, const std::string& remark = "") {
    log::LogWriter writer(record_.file, Opening::kTemporary);
    for (int k = 0; k < 100; ++k) {
      const std::string text = "message " + std::to_string(k);
      if (k != left_out) writer.Append("A", text.data(), text.size(), k);
    }
    if (!remark.empty()) writer.Remark(remark);
    writer.Finish();
  }

  LogRecord record_;
};

TEST_F(LogRecordTest, AWholeLog) {
  for (int k = 0; k < 100; ++k) Handle(k);
  Write(-1);
  EXPECT_EQ(WrongWith(record_), "");
}

// Tests that what lacks must be said, with the right number.
TEST_F(LogRecordTest, AMissingMessage) {
  for (int k = 0; k < 100; ++k) Handle(k);
  Write(50);
  EXPECT_THAT(WrongWith(record_), HasSubstr("complete and lacks 1 of 100 messages; it says 0"));
  Write(50, "1 messages are not in the log: the disk was slower than the bus");
  EXPECT_EQ(WrongWith(record_), "");
  Write(50, "2 messages are not in the log: the disk was slower than the bus");
  EXPECT_THAT(WrongWith(record_), HasSubstr("it says 2"));
}

TEST_F(LogRecordTest, AMessageThatNeverCame) {
  for (int k = 1; k < 100; ++k) Handle(k);
  Write(-1);
  EXPECT_THAT(WrongWith(record_), HasSubstr("has not received"));
}

// Tests that a log that was cut or changed has to say so, and one to which nothing has happened has to be
// complete.
TEST_F(LogRecordTest, Damage) {
  for (int k = 0; k < 100; ++k) Handle(k);
  Write(-1);
  record_.killed = true;
  EXPECT_THAT(WrongWith(record_), HasSubstr("its logger was killed"));
  record_.killed = false;
  record_.lied = true;
  EXPECT_THAT(WrongWith(record_), HasSubstr("a bit of it was changed"));
  record_.lied = false;
  const std::string bytes = log::ReadBytes(record_.file);
  log::WriteBytes(record_.file, bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(WrongWith(record_), HasSubstr("nothing has happened to it"));
  record_.killed = true;
  EXPECT_EQ(WrongWith(record_), "");
}

}  // namespace
}  // namespace hydro::torture
