// A real recording in hundreds of damaged variants, read in every way that hydro-log and hydro-diagnose have.
#include <gmock/gmock.h>

#include <functional>
#include <random>

#include "base/bytes.h"
#include "base/read_files.h"
#include "runs/info.h"
#include "runs/log/repair.h"
#include "runs/measured/measured_run.h"
#include "runs/recorded/compare.h"
#include "runs/recorded/run_table.h"
#include "runs/tracking.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"
#include "tests/runs/log/log_fixture.h"
#include "tests/settings/small_texts.h"
#include "tests/tools/hydro_log/short_run.h"
#include "tools/hydro_log/hydro_log.h"
#include "tools/hydro_log/replay.h"

namespace hydro::hydro_log {
namespace {

using log::Completeness;
using testing::HasSubstr;

const std::string kConfig = ShortRun("0.5");

class DamageTest : public log::LogTest {
 protected:
  DamageTest() {
    const settings::StackConfig config =
        settings::ParseStackConfig(kConfig, "test.toml", settings::kModelText, "model.toml");
    log::LogWriter writer(Path("whole"), Opening::kTemporary);
    sim::Simulate(config, [&](const bus::RawMessage& m) {
      writer.Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
    });
    writer.Finish();
    bytes_ = log::ReadBytes(Path("whole"));
    events_ = log::ReadEvents(Path("whole"));
  }

  size_t Below(size_t limit) { return std::uniform_int_distribution<size_t>(0, limit - 1)(random_); }

  // Begins of all events, check events among them, and the end of the file.
  std::vector<size_t> Begins(const std::string& bytes) const {
    std::vector<size_t> begins = {0};
    const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
    while (begins.back() < bytes.size()) {
      const uint8_t* event = data + begins.back();
      begins.push_back(begins.back() + log::kLogHeaderSize + LoadBigEndian32(event + 20) +
                       LoadBigEndian32(event + 24));
    }
    return begins;
  }

  // Asserts that nothing reads a log of these bytes as another than the whole one without saying so.
  // `flipped`: bytes may be wrong where no checksum covers them yet.
  void ExpectHonest(const std::string& bytes, bool flipped);
  // Repairs it and asserts that every way of reading works on the result.
  void ExpectRepairable(const std::string& bytes);

  std::string bytes_;
  std::vector<log::EventContents> events_;
  std::mt19937_64 random_{20261123};
  int complete_ = 0, incomplete_ = 0, damaged_ = 0;  // variants
};

// Every way of reading a run, each throwing what its verb prints.
std::vector<std::function<void(const std::string&)>> WaysToRead() {
  return {[](const std::string& file) { runs::Summarise(runs::ReadRunLog(file), false); },
          [](const std::string& file) { runs::TrackArm(runs::ReadRunLog(file)); },
          [](const std::string& file) { runs::ExportRun(runs::ReadRunLog(file)); },
          [](const std::string& file) { Replay(runs::ReadRunLog(file), ReplayedController::kPressure, 0); },
          [](const std::string& file) { runs::ReadMeasuredRun(file); }};
}

void DamageTest::ExpectHonest(const std::string& bytes, bool flipped) {
  log::WriteBytes(Path("log"), bytes);
  log::LogReader reader(Path("log"), log::OnDamage::kStop);
  const log::LogVerdict verdict = reader.verdict();
  std::vector<log::EventContents> read;
  log::LogEvent event;
  while (reader.Next(event)) {
    read.push_back({std::string(event.channel),
                    std::string(reinterpret_cast<const char*>(event.data), static_cast<size_t>(event.size)),
                    event.utime});
  }
  // What can be read is the beginning of the whole log, but for what is said to be covered by no checksum.
  size_t sure = read.size();
  if (flipped && verdict.completeness == Completeness::kIncomplete) {
    sure -= static_cast<size_t>(verdict.unchecked_messages);
  }
  ASSERT_LE(sure, events_.size());
  EXPECT_TRUE(std::equal(read.begin(), read.begin() + static_cast<ptrdiff_t>(sure), events_.begin()));
  switch (verdict.completeness) {
    case Completeness::kComplete:
      ++complete_;
      EXPECT_EQ(read, events_);
      break;
    case Completeness::kIncomplete:
      ++incomplete_;
      EXPECT_THAT(verdict.where, HasSubstr("byte"));
      break;
    case Completeness::kDamaged:
      ++damaged_;
      EXPECT_THAT(verdict.where, HasSubstr("byte"));
      for (const auto& way : WaysToRead()) EXPECT_THROW(way(Path("log")), log::LogError);
      break;
    case Completeness::kWithoutChecksums:
      ADD_FAILURE() << "the checksums were overlooked";
  }
}

void DamageTest::ExpectRepairable(const std::string& bytes) {
  log::WriteBytes(Path("log"), bytes);
  ForgetRead(Path("repaired"));  // each repair stands for another process
  log::RepairLog(Path("log"), Path("repaired"));
  const runs::RunLog log = runs::ReadRunLog(Path("repaired"), {}, runs::Undecodable::kRefused);
  EXPECT_EQ(log.verdict.completeness, Completeness::kComplete);
  EXPECT_THAT(log.verdict.note, testing::StartsWith(bytes == bytes_ ? "" : "repaired from log"));
  std::filesystem::remove(Path("repaired"));
  if (log.messages.Of<state_t>().size() < 3 || log.messages.Of<motor_command_t>().size() < 3) return;
  EXPECT_FALSE(runs::SummaryText(runs::TrackArm(log), runs::Summarise(log, false), false).empty());
  EXPECT_GT(runs::ExportRun(log).rows(), 0u);
  EXPECT_EQ(runs::FirstDifference(log.messages, "a", log.messages, "b"), std::nullopt);
  if (log.messages.Of<run_description_t>().empty()) return;
  // Only where the log itself says that no checksum covers a message may it be another than was recorded.
  const bool sure = log.verdict.note.find("covered by no checksum") == std::string::npos;
  for (const ReplayedController controller : {ReplayedController::kPressure, ReplayedController::kPosition}) {
    if (controller == ReplayedController::kPosition && log.messages.Of<pressure_command_t>().size() < 3)
      continue;
    const ReplayResult result = Replay(log, controller, 0);
    EXPECT_TRUE(!sure || !result.difference) << *result.difference << log.verdict.note;
  }
}

// Tests that a log cut at any place is said to be incomplete, and gives what is before the cut.
TEST_F(DamageTest, Cut) {
  const std::vector<size_t> begins = Begins(bytes_);
  for (int k = 0; k < 150; ++k) ExpectHonest(bytes_.substr(0, 200 + Below(bytes_.size() - 200)), false);
  // At an event's end there is nothing torn that would give it away.
  for (int k = 0; k < 150; ++k) {
    const size_t end = begins[1 + Below(begins.size() - 2)];
    ExpectHonest(bytes_.substr(0, end), false);
  }
  EXPECT_EQ(complete_, 0);
  EXPECT_EQ(damaged_, 0);
  EXPECT_EQ(incomplete_, 300);
}

// Tests that a flipped bit, wherever it is, is found in a whole log.
TEST_F(DamageTest, FlippedBit) {
  for (int k = 0; k < 500; ++k) {
    std::string bytes = bytes_;
    bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8));
    ExpectHonest(bytes, true);
  }
  EXPECT_EQ(complete_, 0);
  // A bit of the last mark's header can make it no mark: then the log has no end.
  EXPECT_GT(damaged_, 490);
}

// Tests every bit of the first and the last check event and of the headers around them.
TEST_F(DamageTest, FlippedBitOfACheckEvent) {
  const std::vector<size_t> begins = Begins(bytes_);
  const auto flip_all = [&](size_t from, size_t to) {
    for (size_t at = from; at < to; ++at) {
      std::string bytes = bytes_;
      bytes[at] ^= static_cast<char>(1 << (at % 8));
      ExpectHonest(bytes, true);
    }
  };
  flip_all(0, begins[1] + 40);
  flip_all(begins[begins.size() - 2], bytes_.size());
  EXPECT_EQ(complete_, 0);
}

// Tests a flip and a cut together: the log is damaged, or incomplete with the flip where no checksum covers.
TEST_F(DamageTest, FlippedAndCut) {
  for (int k = 0; k < 300; ++k) {
    std::string bytes = bytes_.substr(0, 1000 + Below(bytes_.size() - 1000));
    bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8));
    ExpectHonest(bytes, true);
  }
  EXPECT_EQ(complete_, 0);
  EXPECT_GT(damaged_, 200);
}

// Tests that events removed, repeated or exchanged are found, although each that is left is whole.
TEST_F(DamageTest, EventsMoved) {
  const std::vector<size_t> begins = Begins(bytes_);
  for (int k = 0; k < 300; ++k) {
    const size_t first = Below(begins.size() - 2), last = first + 1 + Below(begins.size() - 2 - first);
    const std::string piece = bytes_.substr(begins[first], begins[last] - begins[first]);
    std::string bytes = bytes_;
    if (k % 3 == 0) {
      bytes.erase(begins[first], piece.size());
    } else if (k % 3 == 1) {
      bytes.insert(begins[last], piece);
    } else {
      bytes.erase(begins[first], piece.size());
      bytes.insert(begins[Below(first + 1)], piece);
      if (bytes == bytes_) continue;
    }
    ExpectHonest(bytes, true);
  }
  EXPECT_EQ(complete_, 0);
}

// Tests that a run for the gap finder carries what it lacks.
TEST_F(DamageTest, MeasuredRunHasACaution) {
  EXPECT_EQ(runs::ReadMeasuredRun(Path("whole")).caution, "");
  log::WriteBytes(Path("cut"), bytes_.substr(0, bytes_.size() / 2));
  EXPECT_THAT(runs::ReadMeasuredRun(Path("cut")).caution, HasSubstr("cut: incomplete: no mark of the end"));
}

// Tests that after a repair every way of reading works, and that nothing wrong was kept where a checksum
// could tell.
TEST_F(DamageTest, Repaired) {
  for (int k = 0; k < 150; ++k) {
    std::string bytes = bytes_;
    switch (Below(3)) {
      case 0:
        bytes.resize(1000 + Below(bytes.size() - 1000));
        break;
      case 1:
        bytes.erase(Below(bytes.size()), 1 + Below(5000));
        break;
      default:
        for (int flips = 0; flips < 3; ++flips)
          bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8));
    }
    ExpectRepairable(bytes);
  }
  ExpectRepairable(bytes_);
}

// Tests that one flipped bit costs one message, and that the rest is kept as it was.
TEST_F(DamageTest, RepairOfAFlippedBitLosesOneMessage) {
  for (int k = 0; k < 200; ++k) {
    std::string bytes = bytes_;
    bytes[Below(bytes.size())] ^= static_cast<char>(1 << Below(8));
    log::WriteBytes(Path("log"), bytes);
    ForgetRead(Path("repaired"));
    const log::RepairResult result = log::RepairLog(Path("log"), Path("repaired"));
    const std::vector<log::EventContents> kept = log::ReadEvents(Path("repaired"));
    EXPECT_GE(kept.size() + 1, events_.size());
    size_t matched = 0;
    for (const log::EventContents& event : events_)
      matched += matched < kept.size() && kept[matched] == event;
    EXPECT_EQ(matched, kept.size()) << "something else than what was written was kept";
    EXPECT_EQ(result.lost_messages, static_cast<int64_t>(events_.size() - kept.size()));
  }
}

}  // namespace
}  // namespace hydro::hydro_log
