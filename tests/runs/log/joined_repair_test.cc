// Repair of logs that were cut, and to which others were joined: no whole event may be lost.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <utility>

#include "base/bytes.h"
#include "runs/log/repair.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::log {
namespace {

using testing::HasSubstr;
using testing::Not;

// The bytes of a log with its events, and where each begins and ends.
struct Log {
  struct Place {
    size_t begin, end;
    EventContents contents;
  };
  std::string bytes;
  std::vector<Place> messages;
  std::vector<std::pair<size_t, size_t>> checks;

  // Whether a cut after so many bytes may be another than those before: at every byte of the first messages,
  // and of a check and what is beside it. All others are alike: of them every 13th byte is enough, because no
  // message's size is a multiple of 13, so that each byte of a message has its turn.
  bool MayBeNew(size_t size) const {
    constexpr size_t kFirst = 400, kBeside = 80, kStep = 13;
    if (size <= kFirst || size % kStep == 0) return true;
    return std::ranges::any_of(checks, [size](const auto& check) {
      return size + kBeside >= check.first && size <= check.second + kBeside;
    });
  }
};

class JoinedRepairTest : public LogTest {
 protected:
  // A log of more than one block of checks, of a sender that has `session`. `plain`: without checks.
  Log MakeLog(int64_t session, bool plain = false) {
    std::vector<EventContents> events;
    for (int64_t k = 0; k < (plain ? 40 : 130); ++k) {
      // Mostly small messages of somebody else, so that cuts anywhere take no longer than they must.
      events.push_back({"E", std::to_string(session % 97) + "-" + std::to_string(k), k});
      if (k % 35 != 0) continue;
      state_t state{};
      state.session = session;
      state.tick = state.sequence = k;
      std::string data(static_cast<size_t>(state.getEncodedSize()), '\0');
      state.encode(data.data(), 0, static_cast<int>(data.size()));
      events.push_back({"HYDRO_STATE", data, k});
    }
    const std::string file = Path("one");
    plain ? WritePlain(file, events) : WriteEvents(file, events);
    Log log;
    log.bytes = ReadBytes(file);
    const auto* data = reinterpret_cast<const uint8_t*>(log.bytes.data());
    size_t next = 0;
    for (size_t begin = 0; begin < log.bytes.size();) {
      const size_t end =
          begin + kLogHeaderSize + LoadBigEndian32(data + begin + 20) + LoadBigEndian32(data + begin + 24);
      const bool check = log.bytes.compare(begin + kLogHeaderSize, kCheckChannel.size(), kCheckChannel) == 0;
      if (check) {
        log.checks.emplace_back(begin, end);
      } else {
        EXPECT_NE((end - begin) % 13, 0u) << "MayBeNew";
        log.messages.push_back({begin, end, events.at(next++)});
      }
      begin = end;
    }
    EXPECT_EQ(next, events.size());
    return log;
  }

  // Parts of logs, one behind the other, and the events that are whole in them.
  struct Parts {
    std::string bytes;
    std::vector<EventContents> expected;

    void Add(const Log& log, size_t begin, size_t end) {
      bytes += log.bytes.substr(begin, end - begin);
      for (const Log::Place& place : log.messages) {
        if (place.begin >= begin && place.end <= end) expected.push_back(place.contents);
      }
    }
  };

  // How many of the first expected events were kept, in order.
  static size_t Found(const std::vector<EventContents>& expected, const std::vector<EventContents>& kept) {
    size_t found = 0;
    for (const EventContents& event : kept) found += found < expected.size() && event == expected[found];
    return found;
  }

  RepairResult Repair(const std::string& bytes, std::vector<EventContents>* kept) {
    WriteBytes(Path("damaged"), bytes);
    std::filesystem::remove(Path("repaired"));
    const RepairResult result = RepairLog(Path("damaged"), Path("repaired"));
    *kept = ReadEvents(Path("repaired"));
    return result;
  }

  void CutAnywhere(const Log& cut, const Log& whole) {
    for (size_t size = 1; size <= cut.bytes.size(); ++size) {
      if (!cut.MayBeNew(size)) continue;
      Parts parts;
      parts.Add(cut, 0, size);
      parts.Add(whole, 0, whole.bytes.size());
      std::vector<EventContents> kept;
      const RepairResult result = Repair(parts.bytes, &kept);
      ASSERT_EQ(kept, parts.expected) << "cut after " << size << " bytes\n" << Describe(result, "log");
      // What is lost is the torn event, which is not called a changed one.
      ASSERT_LE(result.lost.size(), 1u) << size;
      ASSERT_THAT(Describe(result, "log"), Not(HasSubstr("another checksum"))) << size;
      // A sync word that was cut says nothing of a beginning, and neither does a single event of number 0.
      if (parts.expected.size() <= whole.messages.size() + 1) continue;
      ASSERT_EQ(result.joined_at, std::vector<int64_t>{static_cast<int64_t>(size)}) << size;
    }
  }
};

// Tests that of a log that was cut at any byte and a whole one behind it, everything is kept but the torn
// event, also what no check event covers, and that the torn event alone is called lost.
TEST_F(JoinedRepairTest, CutAndWhole) {
  CutAnywhere(MakeLog(0x1122334455667788), MakeLog(0x7a6b5c4d3e2f1a0b));
}

// Tests the same with the same log twice, and with parts that have no check events.
TEST_F(JoinedRepairTest, TheSameLogTwice) {
  const Log log = MakeLog(0x1122334455667788);
  CutAnywhere(log, log);
}
TEST_F(JoinedRepairTest, PlainAndPlain) { CutAnywhere(MakeLog(1, true), MakeLog(2, true)); }
TEST_F(JoinedRepairTest, PlainAndChecked) { CutAnywhere(MakeLog(1, true), MakeLog(2)); }
TEST_F(JoinedRepairTest, CheckedAndPlain) { CutAnywhere(MakeLog(1), MakeLog(2, true)); }

// Tests that heads and tails of two logs with checks in any order, cut anywhere, lose no whole event.
TEST_F(JoinedRepairTest, HeadsAndTails) {
  const Log logs[] = {MakeLog(0x1122334455667788), MakeLog(0x7a6b5c4d3e2f1a0b)};
  std::mt19937_64 random(33);
  for (int trial = 0; trial < 400; ++trial) {
    Parts parts;
    for (int part = 0; part < 4; ++part) {
      const Log& log = logs[random() % 2];
      const size_t cut = random() % log.bytes.size();
      random() % 2 == 0 ? parts.Add(log, 0, cut) : parts.Add(log, cut, log.bytes.size());
    }
    if (parts.expected.empty()) continue;
    std::vector<EventContents> kept;
    const RepairResult result = Repair(parts.bytes, &kept);
    ASSERT_EQ(Found(parts.expected, kept), parts.expected.size()) << trial << "\n" << Describe(result, "log");
    // A torn event before the rest of another may look whole.
    ASSERT_LE(kept.size() - parts.expected.size(), 3u) << trial;
  }
}

// Tests parts that are cut at both ends. Between two parts of one block of another log, an event with a
// number that is missing there may be a damaged one: hardly any is lost.
TEST_F(JoinedRepairTest, PartsFromAnywhere) {
  const Log logs[] = {MakeLog(0x1122334455667788), MakeLog(0x7a6b5c4d3e2f1a0b)};
  std::mt19937_64 random(33);
  size_t expected = 0, found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Parts parts;
    for (int part = 0; part < 4; ++part) {
      const Log& log = logs[random() % 2];
      const size_t a = random() % (log.bytes.size() + 1), b = random() % (log.bytes.size() + 1);
      parts.Add(log, std::min(a, b), std::max(a, b));
    }
    if (parts.expected.empty()) continue;
    std::vector<EventContents> kept;
    Repair(parts.bytes, &kept);
    expected += parts.expected.size();
    for (const EventContents& event : parts.expected) found += std::ranges::find(kept, event) != kept.end();
  }
  EXPECT_GT(static_cast<double>(found), 0.995 * static_cast<double>(expected)) << found << " of " << expected;
}

// Tests that two logs merged by time keep all of their messages, which stand before the wrong check events.
TEST_F(JoinedRepairTest, MergedByTime) {
  const Log a = MakeLog(0x1122334455667788), b = MakeLog(0x7a6b5c4d3e2f1a0b);
  Parts parts;
  size_t at[2] = {0, 0};
  const Log* logs[2] = {&a, &b};
  for (size_t turn = 0; at[0] < a.bytes.size() || at[1] < b.bytes.size(); ++turn) {
    const size_t which = turn % 2;
    if (at[which] == logs[which]->bytes.size()) continue;
    const auto* event = reinterpret_cast<const uint8_t*>(logs[which]->bytes.data()) + at[which];
    const size_t end = at[which] + kLogHeaderSize + LoadBigEndian32(event + 20) + LoadBigEndian32(event + 24);
    parts.Add(*logs[which], at[which], end);
    at[which] = end;
  }
  std::vector<EventContents> kept;
  const RepairResult result = Repair(parts.bytes, &kept);
  EXPECT_EQ(kept, parts.expected);
  EXPECT_TRUE(result.lost.empty());
  EXPECT_EQ(result.unvouched, 0);
}

// Tests that a torn event whose length reaches exactly to the end of an event behind it does not swallow
// what lies between.
TEST_F(JoinedRepairTest, ATornEventThatEndsWhereAnotherDoes) {
  const std::vector<EventContents> events = {{"A", "one", 1}, {"B", "two", 2}, {"C", "three", 3}};
  WritePlain(Path("log"), events);
  const std::string bytes = ReadBytes(Path("log"));
  const size_t first = kLogHeaderSize + 1 + 3, second = first + kLogHeaderSize + 1 + 3;
  // Number 1 as in the second event, after which number 2 follows.
  std::string torn = bytes.substr(first, kLogHeaderSize) + "T" + "beginning";
  torn[23] = 1;
  torn[27] = static_cast<char>(9 + second);
  std::vector<EventContents> kept;
  Repair(torn + bytes, &kept);
  EXPECT_EQ(kept, events);
  // The same bytes inside a message whose checksum is right are what was written.
  WriteEvents(Path("log"), {{"A", "one", 1}, {"T", "beginning" + bytes.substr(0, second), 2}, {"C", "3", 3}});
  Repair(ReadBytes(Path("log")) + "x", &kept);
  EXPECT_EQ(kept.size(), 3u);
}

}  // namespace
}  // namespace hydro::log
