// Anybody on a network without a key can make up channels: what a log costs must grow with their number, and
// not with its square.
#include <gmock/gmock.h>

#include <functional>

#include "bus/channels.h"
#include "hydro/process_status_t.hpp"
#include "hydro/run_description_t.hpp"
#include "hydro/state_t.hpp"
#include "hydro/stop_t.hpp"
#include "runs/exports/export_runs.h"
#include "runs/exports/selection.h"
#include "runs/info.h"
#include "runs/limb_info.h"
#include "runs/recorded/channel_suffix.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/senders.h"
#include "scope/signals/log_run.h"
#include "tests/runs/count_comparisons.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using ::testing::HasSubstr;

template <class Message>
log::EventContents EventOf(const Message& message, const std::string& suffix) {
  std::string data(static_cast<size_t>(message.getEncodedSize()), '\0');
  message.encode(data.data(), 0, static_cast<int>(data.size()));
  return {bus::Channels(suffix).Of<Message>(), data, 0};
}

log::EventContents State(const std::string& suffix) { return EventOf(state_t{}, suffix); }
log::EventContents Status(const std::string& suffix) { return EventOf(process_status_t{}, suffix); }

// The part of a log that is made up, of so many channels.
using Flood = std::function<void(int channels, std::vector<log::EventContents>* events)>;

std::string Number(int i) { return std::to_string(1000000 + i); }

const std::pair<const char*, Flood> kFloods[] = {
    {"unknown channels",
     [](int channels, auto* events) {
       for (int i = 0; i < channels; ++i) events->push_back({"CHANNEL_" + Number(i), "x", 0});
     }},
    {"stacks with states",
     [](int channels, auto* events) {
       for (int i = 0; i < channels; ++i) events->push_back(State(Number(i)));
     }},
    {"joints",
     [](int channels, auto* events) {
       for (int i = 0; i < channels; ++i) events->push_back(State("_" + Number(i)));
     }},
    {"limbs without joints",
     [](int channels, auto* events) {
       for (int i = 0; i < channels; ++i) events->push_back(Status("_limb" + Number(i)));
       events->push_back(State("_limb1000000_hip"));
       events->push_back(State("_limb1000001_hip"));
     }},
    {"limbs with a joint each",
     [](int channels, auto* events) {
       for (int i = 0; i < channels / 2; ++i) {
         events->push_back(Status("_limb" + Number(i)));
         events->push_back(State("_limb" + Number(i) + "_hip"));
       }
     }},
    {"states of many senders",
     [](int channels, auto* events) {
       state_t state{};
       for (state.session = 1; state.session <= channels; ++state.session) {
         state.tick = state.sequence = state.session;
         events->push_back(EventOf(state, ""));
       }
     }},
    {"stops, programs and descriptions",
     [](int channels, auto* events) {
       events->push_back(State(""));
       for (int i = 0; i < channels; ++i) {
         stop_t stop{};
         stop.session = i + 1;
         stop.reason = stop.source = "made up " + Number(i);
         events->push_back(EventOf(stop, ""));
         process_status_t status{};
         status.role = status.host = status.version = Number(i);
         events->push_back(EventOf(status, ""));
         run_description_t description{};
         description.program = description.version = Number(i);
         events->push_back(EventOf(description, ""));
       }
     }},
    {"names with many parts",
     [](int channels, auto* events) {
       for (int i = 0; i < channels; ++i) events->push_back(State("_a_b_c_d_e_f_" + Number(i)));
     }},
};

class ManyChannelsTest : public log::LogTest {
 protected:
  std::string Write(int channels, const Flood& flood) {
    std::vector<log::EventContents> events;
    flood(channels, &events);
    log::WritePlain(Path("log"), events);
    ForgetRead(Path("log"));
    return Path("log");
  }

  // Comparisons that `work` takes on such a log. It may refuse the log.
  int64_t Cost(int channels, const Flood& flood, const std::function<void(const std::string&)>& work) {
    const std::string file = Write(channels, flood);
    const int64_t before = ComparisonCount();
    try {
      work(file);
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 5000u) << "not all of them are named";
    }
    return ComparisonCount() - before;
  }
};

// Tests everything that reads a log, on floods of each kind: twice the channels, twice the comparisons. A
// sorted list takes a little more, twice as many channels to the square four times as many.
TEST_F(ManyChannelsTest, TheCostGrowsWithTheirNumber) {
  const std::pair<const char*, std::function<void(const std::string&)>> works[] = {
      {"info",
       [](const std::string& file) {
         const LimbLog log = ReadLimbLog(file, {}, Undecodable::kLeftOut, log::OnDamage::kStop);
         if (log.whole()) {
           const LimbInfo info = SummariseLimb(log, false);
           EXPECT_FALSE(LimbInfoText(info).empty() || LimbSummaryJson(info).empty());
         } else {
           EXPECT_FALSE(InfoText(Summarise(log.limb, false)).empty());
         }
       }},
      {"one stack", [](const std::string& file) { ReadRunLog(file, {.suffix = "_limb1000000_hip"}); }},
      {"one joint", [](const std::string& file) { ReadRunLog(file, {.joint = "1000007"}); }},
      {"scope",
       [](const std::string& file) {
         std::string problem;
         scope::OpenLogRuns(file, "log", &problem);
       }},
      {"export",
       [](const std::string& file) {
         exports::Selection selection;
         selection.all = true;
         exports::ReadRuns({file}, {}, selection, false, [](const std::string&) {});
       }},
  };
  for (const auto& [kind, flood] : kFloods) {
    for (const auto& [name, work] : works) {
      constexpr int kChannels = 1100;  // above kMostJoints, so that both are no limb
      const int64_t once = Cost(kChannels, flood, work), twice = Cost(2 * kChannels, flood, work);
      EXPECT_GT(once, kChannels) << "comparisons are counted";
      EXPECT_LT(static_cast<double>(twice), 2.6 * static_cast<double>(once) + 1000)
          << name << ", " << kind << ": " << once << " and " << twice;
    }
  }
}

// Tests that more runs than anybody joins are not shown one by one.
TEST_F(ManyChannelsTest, MoreSendersThanAnyLogHas) {
  for (const size_t senders : {kMostRuns, kMostRuns + 1}) {
    const RunLog log = ReadRunLog(Write(static_cast<int>(senders), kFloods[5].second));
    EXPECT_EQ(RunsIn(log.messages).size(), senders > kMostRuns ? 0 : senders);
    EXPECT_THAT(InfoText(Summarise(log, false)),
                HasSubstr(senders > kMostRuns ? "there are more than 100" : "run 100 of 100, by sender "));
  }
}

// Tests that joints up to the limit are one limb, and that more are refused with the way to read one of them.
TEST_F(ManyChannelsTest, MoreJointsThanALimbHas) {
  const auto joints = [&](size_t count) { return Write(static_cast<int>(count), kFloods[2].second); };
  EXPECT_EQ(ReadLimbLog(joints(kMostJoints), {}).joints.size(), kMostJoints);
  const std::string error = log::InputErrorOf([&] { ReadLimbLog(joints(kMostJoints + 1), {}); });
  EXPECT_THAT(error, HasSubstr("'_1000019', ... (981 more); choose one of them with --suffix"));
  EXPECT_EQ(ReadRunLog(Path("log"), {.joint = "1000500"}).messages.Of<state_t>().size(), 1u);
}

}  // namespace
}  // namespace hydro::runs
