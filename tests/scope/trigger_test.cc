#include "scope/signals/trigger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "base/input_error.h"
#include "tests/scope/decoded_bins.h"
#include "tests/scope/made_run.h"

namespace hydro::scope {
namespace {

TriggerRequest Request() {
  TriggerRequest request;
  request.id = 9;
  request.channel = "p1";
  request.channels = {"p1"};
  request.level = 10;
  request.hysteresis = 2;
  request.span = 0.1;
  request.pixels = 1000;
  return request;
}

// Feeds p1 tick by tick and asks after each; returns what was captured.
std::vector<Trigger::Capture> Feed(Trigger* trigger, Run* run, const std::vector<double>& values) {
  std::vector<Trigger::Capture> captures;
  for (const double value : values) {
    AddTick(run, static_cast<int64_t>(run->ticks.end()), value);
    while (auto capture = trigger->Next(*run)) {
      if (capture->state != "armed") captures.push_back(std::move(*capture));
    }
  }
  return captures;
}

std::vector<double> Times(const std::vector<Trigger::Capture>& captures) {
  std::vector<double> times;
  for (const Trigger::Capture& capture : captures) times.push_back(capture.t);
  return times;
}

// Low for `low` ticks, then high for `high`, again and again.
std::vector<double> Square(int periods, int low, int high) {
  std::vector<double> values;
  for (int i = 0; i < periods; ++i) {
    values.insert(values.end(), static_cast<size_t>(low), 0.0);
    values.insert(values.end(), static_cast<size_t>(high), 20.0);
  }
  return values;
}

// Tests that a capture lies still: its edge is at the same place in each, and its time is exactly the
// sample's.
TEST(TriggerTest, StandsStillOnAnEdge) {
  auto run = MadeRun();
  Trigger trigger(Request(), run);
  const auto captures = Feed(&trigger, &run, Square(5, 150, 50));
  EXPECT_EQ(Times(captures), (std::vector<double>{0.15, 0.35, 0.55, 0.75}));
  for (const Trigger::Capture& capture : captures) {
    EXPECT_EQ(capture.state, "triggered");
    const DecodedBins bins = Decode(capture.bins);
    EXPECT_EQ(bins.flags, uint32_t{kTriggerCapture});
    EXPECT_EQ(bins.id, 9u);
    ASSERT_EQ(bins.bins, 101u);  // a bin for each tick of 0.1 s
    EXPECT_EQ(bins.max[0][24], 0);
    EXPECT_EQ(bins.min[0][25], 20);  // a quarter of the span lies before the edge
    EXPECT_NEAR(bins.t0 + 25.5 * bins.width, capture.t, 1e-9);
  }
}

// Tests that noise within the hysteresis makes no second trigger.
TEST(TriggerTest, HysteresisIgnoresNoise) {
  auto run = MadeRun();
  TriggerRequest request = Request();
  request.span = 0.004;
  request.pre = 0;
  std::vector<double> values(10, 0.0);
  for (int i = 0; i < 100; ++i) values.push_back(i % 2 == 0 ? 11 : 9);  // level 10, hysteresis 2
  {
    Trigger trigger(request, run);
    EXPECT_EQ(Feed(&trigger, &run, values).size(), 1u);
  }
  request.hysteresis = 0.5;
  auto other = MadeRun();
  Trigger trigger(request, other);
  EXPECT_GT(Feed(&trigger, &other, values).size(), 10u);
}

// Tests the edges.
TEST(TriggerTest, Edges) {
  const auto times = [](TriggerRequest::Edge edge) {
    auto run = MadeRun();
    TriggerRequest request = Request();
    request.edge = edge;
    request.span = 0.02;
    Trigger trigger(request, run);
    return Times(Feed(&trigger, &run, Square(3, 100, 100)));
  };
  EXPECT_EQ(times(TriggerRequest::Edge::kRising), (std::vector<double>{0.1, 0.3, 0.5}));
  EXPECT_EQ(times(TriggerRequest::Edge::kFalling), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(times(TriggerRequest::Edge::kEither), (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
}

// Tests that nothing triggers within the hold-off.
TEST(TriggerTest, HoldOff) {
  auto run = MadeRun();
  TriggerRequest request = Request();
  request.span = 0.01;
  request.holdoff = 0.5;
  Trigger trigger(request, run);
  EXPECT_EQ(Times(Feed(&trigger, &run, Square(15, 50, 50))), (std::vector<double>{0.05, 0.55, 1.05}));
}

// Tests that a single trigger stops until it is armed again.
TEST(TriggerTest, Single) {
  auto run = MadeRun();
  TriggerRequest request = Request();
  request.mode = TriggerRequest::Mode::kSingle;
  Trigger trigger(request, run);
  const auto first = Feed(&trigger, &run, Square(5, 150, 50));
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].state, "triggered");
  EXPECT_EQ(first[1].state, "stopped");
  EXPECT_EQ(first[1].bins, "");
  trigger.Arm();
  const auto second = Feed(&trigger, &run, Square(2, 150, 50));
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[0].t, 1.15);
}

// Tests that auto shows the signal also without a trigger, normal does not.
TEST(TriggerTest, Auto) {
  for (const auto mode : {TriggerRequest::Mode::kAuto, TriggerRequest::Mode::kNormal}) {
    auto run = MadeRun();
    TriggerRequest request = Request();
    request.mode = mode;
    Trigger trigger(request, run);
    const auto captures = Feed(&trigger, &run, std::vector<double>(2100, 1.0));
    EXPECT_EQ(captures.size(), mode == TriggerRequest::Mode::kAuto ? 4u : 0u);
    for (const auto& capture : captures) EXPECT_EQ(capture.state, "auto");
  }
}

// Tests that every sample is looked at: a spike of one sample triggers also a client that asks once in a
// while, which gets the newest capture and a count of the others.
TEST(TriggerTest, ASlowClientGetsTheNewest) {
  auto run = MadeRun();
  TriggerRequest request = Request();
  request.span = 0.02;
  Trigger trigger(request, run);
  EXPECT_EQ(trigger.Next(run)->state, "armed");
  for (int64_t tick = 0; tick < 1000; ++tick) AddTick(&run, tick, tick % 200 == 100 ? 20 : 0);
  const auto capture = trigger.Next(run);
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->t, 0.9);
  EXPECT_EQ(trigger.skipped(), 4u);
  EXPECT_FALSE(trigger.Next(run));
}

// Tests that faults and steps trigger, each only where it was asked for.
TEST(TriggerTest, OnEvents) {
  for (const auto on : {TriggerRequest::On::kFault, TriggerRequest::On::kStep}) {
    auto run = MadeRun();
    run.events.Add({0, 0, "fault", "", "", "before"});
    TriggerRequest request = Request();
    request.on = on;
    Trigger trigger(request, run);
    Feed(&trigger, &run, std::vector<double>(100, 0.0));
    run.events.Add({0, 0.08, "fault", "", "", ""});
    run.events.Add({0, 0.09, "step", "", "", ""});
    const auto captures = Feed(&trigger, &run, std::vector<double>(100, 0.0));
    ASSERT_EQ(captures.size(), 1u);
    EXPECT_EQ(captures[0].t, on == TriggerRequest::On::kFault ? 0.08 : 0.09);
  }
}

// Tests that missing samples neither trigger nor disturb.
TEST(TriggerTest, MissingSamplesAreNone) {
  auto run = MadeRun();
  TriggerRequest request = Request();
  request.span = 0.01;
  Trigger trigger(request, run);
  std::vector<double> values(20, 0.0);
  values.insert(values.end(), 20, std::numeric_limits<double>::quiet_NaN());
  values.insert(values.end(), 20, 20.0);
  EXPECT_EQ(Times(Feed(&trigger, &run, values)), (std::vector<double>{0.04}));
}

// Tests that what makes no sense is refused by name.
TEST(TriggerTest, RefusesNonsense) {
  const auto run = MadeRun();
  const auto refused = [&](auto change, const std::string& named) {
    TriggerRequest request = Request();
    change(request);
    try {
      Trigger(request, run);
      ADD_FAILURE() << named;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  };
  refused([](TriggerRequest& r) { r.channel = "nothing"; }, "\"nothing\"");
  refused([](TriggerRequest& r) { r.pre = 1.5; }, "pre: found 1.5");
  refused([](TriggerRequest& r) { r.holdoff = -1; }, "holdoff");
  refused([](TriggerRequest& r) { r.hysteresis = -1; }, "hysteresis");
  refused([](TriggerRequest& r) { r.level = std::nan(""); }, "level");
  refused([](TriggerRequest& r) { r.span = -1; }, "span");
}

}  // namespace
}  // namespace hydro::scope
