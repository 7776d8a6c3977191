// Which changes are refitted after a score test, and what remains of the refits.
#include "diagnose/search/refits.h"

#include <gmock/gmock.h>

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Change kLag = {"amp.lag", {}, ""}, kRelief = {"valve.relief", {}, ""}, kFriction = {"", {}, "T_s"};

Hypothesis Of(std::vector<Change> changes) {
  Hypothesis hypothesis;
  hypothesis.changes = std::move(changes);
  return hypothesis;
}

Fitted FitOf(std::vector<Change> changes, double sum, const std::string& failure = "") {
  Fitted fitted;
  fitted.hypothesis = Of(std::move(changes));
  fitted.sum = sum;
  fitted.failure = failure;
  return fitted;
}

// Tests that the order of changes does not matter, and that both must have all of them.
TEST(SameChanges, InAnyOrder) {
  EXPECT_TRUE(SameChanges(Of({kLag, kFriction}), Of({kFriction, kLag})));
  EXPECT_FALSE(SameChanges(Of({kLag, kFriction}), Of({kLag})));
  EXPECT_FALSE(SameChanges(Of({kLag}), Of({kRelief})));
  EXPECT_FALSE(SameChanges(Of({{"sensor.skew", {{"signal", "p1"}}, ""}}),
                           Of({{"sensor.skew", {{"signal", "p2"}}, ""}})));
}

// Tests that the best start of each set of changes stays, that failures go, and that the best set is first.
TEST(BestOfEach, KeepsTheBestStart) {
  const std::vector<Fitted> best =
      BestOfEach({FitOf({kLag}, 5), FitOf({kRelief}, 3), FitOf({kLag}, 2), FitOf({kLag}, 4),
                  FitOf({kFriction}, 0, "its simulation fails")});
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0].hypothesis.changes, std::vector<Change>{kLag});
  EXPECT_EQ(best[0].sum, 2);
  EXPECT_EQ(best[1].sum, 3);
}

Scanned Row(const Change& change, double expected, const std::string& failure = "") {
  Scanned row;
  row.change = change;
  row.start = Of({change});
  row.expected = expected;
  row.failure = failure;
  return row;
}

std::vector<double> Expected(const std::vector<Scanned>& pool) {
  std::vector<double> expected;
  for (const Scanned& row : pool) expected.push_back(row.expected);
  return expected;
}

// Tests that the best changes are picked, each from its best starting points, and that those are left out
// that failed or of which less than 15 % of the best is expected.
TEST(Pick, TakesTheMostPromising) {
  Fitted from;
  from.count = 1000;  // at least 30 must then be expected of a change
  std::vector<std::vector<Scanned>> scanned = {{Row(kRelief, 400), Row(kRelief, 260), Row(kRelief, 255)},
                                               {Row(kLag, 1000), Row(kLag, 900), Row(kLag, 800)},
                                               {Row(kFriction, 249)},
                                               {Row({"", {}, "b"}, 2000, "its simulation fails")}};
  std::vector<Scanned> pool;
  Pick(from, {.changes = 5, .starts = 2}, &scanned, &pool);
  EXPECT_THAT(Expected(pool), ElementsAre(1000, 900, 400, 260));

  pool.clear();
  Pick(from, {.changes = 1, .starts = 3}, &scanned, &pool);
  EXPECT_THAT(Expected(pool), ElementsAre(1000, 900, 800));
}

// Tests that nothing is picked that cannot gain a third of what a change must gain, and nothing twice.
TEST(Pick, LeavesOutWhatGainsTooLittleOrIsThere) {
  Fitted from;
  from.count = 1000;
  std::vector<std::vector<Scanned>> scanned = {{Row(kRelief, 29)}};
  std::vector<Scanned> pool;
  Pick(from, {.changes = 5, .starts = 2}, &scanned, &pool);
  EXPECT_THAT(pool, IsEmpty());

  scanned = {{Row(kRelief, 31)}};
  Pick(from, {.changes = 5, .starts = 2}, &scanned, &pool);
  Pick(from, {.changes = 5, .starts = 2}, &scanned, &pool);
  EXPECT_THAT(Expected(pool), ElementsAre(31));
}

}  // namespace
}  // namespace hydro::diagnose
