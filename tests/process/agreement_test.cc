#include "process/agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process/remote_faults.h"

namespace hydro::process {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

configuration_t Announced(int64_t session, const std::string& text) {
  configuration_t announced{};
  announced.session = session;
  announced.text = text;
  return announced;
}

// Tests that keys, values and what is missing are named, and that a long list is cut.
TEST(AgreementTest, DescribesDifferences) {
  EXPECT_EQ(DescribeDifferences("a = 1\nb = 2\n", "a = 1\nb = 2\n"), "");
  EXPECT_EQ(DescribeDifferences("a = 1\nb = 2\n", "a = 3\nc = 4\n"),
            "a is 3 there, 1 here; b is not given there, 2 here; c is 4 there, not given here");
  std::string here, there;
  for (char key = 'a'; key < 'k'; ++key) {
    here += std::string(1, key) + " = 1\n";
    there += std::string(1, key) + " = 2\n";
  }
  EXPECT_THAT(DescribeDifferences(here, there), HasSubstr("; and 4 more"));
}

// Tests who is refused: who differs, until he agrees or has left; not who has said nothing.
TEST(AgreementTest, RefusesWhoDiffers) {
  Agreement agreement("a = 1\n");
  EXPECT_FALSE(agreement.Refuses(5));
  EXPECT_FALSE(agreement.Heard(5));
  EXPECT_TRUE(agreement.Observe(Announced(5, "a = 2\n")));
  EXPECT_FALSE(agreement.Observe(Announced(5, "a = 2\n")));  // no news
  EXPECT_TRUE(agreement.Heard(5));
  EXPECT_TRUE(agreement.Refuses(5));
  EXPECT_EQ(agreement.Differences(5), "a is 2 there, 1 here");
  EXPECT_FALSE(agreement.Observe(Announced(5, "a = 1\n")));
  EXPECT_FALSE(agreement.Refuses(5));
  agreement.Observe(Announced(6, "a = 3\n"));
  agreement.Forget(6);
  EXPECT_FALSE(agreement.any());
}

// Tests that a flood of made-up senders lets nobody through who differs and says so.
TEST(AgreementTest, SurvivesAFlood) {
  Agreement agreement("a = 1\n");
  for (int64_t session = 100; session < 6000; ++session) agreement.Observe(Announced(session, "a = 2\n"));
  EXPECT_TRUE(agreement.Observe(Announced(5, "a = 2\n")));
  EXPECT_TRUE(agreement.Refuses(5));
  EXPECT_TRUE(agreement.Heard(5));
}

// Tests that a fault lasts until its sender ends it, no longer lists it, leaves, is replaced or is silent.
TEST(RemoteFaultsTest, Ends) {
  const auto fault = [](int64_t session, const char* code, bool active) {
    fault_t f{};
    f.session = session;
    f.source = "pressure_ctrl";
    f.code = code;
    f.active = active;
    return f;
  };
  bus::Clock::TimePoint now{1h};
  RemoteFaults faults([](std::string_view, std::string_view code) { return code == "stale_state"; });
  EXPECT_FALSE(faults.any(now));
  faults.Observe(fault(1, "stale_state", true), now);
  EXPECT_TRUE(faults.any(now));
  EXPECT_EQ(faults.first().code, "stale_state");
  faults.Observe(fault(1, "stale_state", false), now);
  EXPECT_FALSE(faults.any(now));

  faults.Observe(fault(1, "stale_state", true), now);
  active_faults_t list{};
  list.session = 1;
  list.codes = "other stale_state";
  faults.Observe(list, now += 2s);
  EXPECT_TRUE(faults.any(now += 2s));
  list.codes = "not_stale_state";
  faults.Observe(list, now);
  EXPECT_FALSE(faults.any(now));

  faults.Observe(fault(1, "stale_state", true), now);
  faults.ForgetOthersOfRole("pressure_ctrl", 1);
  EXPECT_TRUE(faults.any(now));
  faults.ForgetOthersOfRole("pressure_ctrl", 2);
  EXPECT_FALSE(faults.any(now));

  faults.Observe(fault(1, "stale_state", true), now);
  faults.ForgetSession(1);
  EXPECT_FALSE(faults.any(now));
  faults.Observe(fault(1, "stale_state", true), now);
  EXPECT_FALSE(faults.any(now + 2501ms));
}

// Tests that a fault counts of which only its sender's list is heard, and that a flood of made-up ones never
// hides it.
TEST(RemoteFaultsTest, ListsCount) {
  RemoteFaults faults([](std::string_view role, std::string_view) { return role == "pressure_ctrl"; });
  bus::Clock::TimePoint now{1h};
  active_faults_t list{};
  list.role = "pressure_ctrl";
  list.codes = "stale_state";
  list.session = 1;
  for (int second = 0; second < 3; ++second) {
    active_faults_t made_up = list;
    faults.Observe(list, now);
    for (made_up.session = 100; made_up.session < 200; ++made_up.session) faults.Observe(made_up, now + 10ms);
    now += 1s;
    EXPECT_TRUE(faults.any(now));
  }
  faults.Observe(list, now += 1s);
  EXPECT_TRUE(faults.any(now += 2s));
  EXPECT_EQ(faults.first().session, 1);
  EXPECT_EQ(faults.first().code, "stale_state");
  list.codes = "";
  faults.Observe(list, now);
  EXPECT_FALSE(faults.any(now));
  list.role = "logger";
  list.codes = "stale_state";
  faults.Observe(list, now);
  EXPECT_FALSE(faults.any(now));
}

// Tests that one message that says otherwise does not undo that a process agrees: a configuration does not
// change while it lives.
TEST(AgreementTest, WhoHasAgreedStaysAgreed) {
  Agreement agreement("a = 1\n");
  configuration_t announced;
  announced.session = 7;
  announced.text = "a = 1\n";
  EXPECT_FALSE(agreement.Observe(announced));
  announced.text = "a = 2\n";
  EXPECT_FALSE(agreement.Observe(announced));
  EXPECT_FALSE(agreement.Refuses(7));
  announced.session = 8;
  EXPECT_TRUE(agreement.Observe(announced));
  announced.text = "a = 1\n";
  agreement.Observe(announced);
  EXPECT_FALSE(agreement.Refuses(8)) << "the first was changed on its way";
}

}  // namespace
}  // namespace hydro::process
