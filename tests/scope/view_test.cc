#include "scope/signals/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "base/input_error.h"
#include "tests/scope/decoded_bins.h"
#include "tests/scope/made_run.h"

namespace hydro::scope {
namespace {

using namespace std::chrono_literals;

View::TimePoint At(double seconds) {
  return View::TimePoint(
      std::chrono::duration_cast<View::TimePoint::duration>(std::chrono::duration<double>(seconds)));
}

ViewRequest Request(double span, uint32_t pixels) {
  ViewRequest request;
  request.id = 5;
  request.channels = {"p1"};
  request.span = span;
  request.pixels = pixels;
  return request;
}

// What a client knows after some frames: extremes by the bins' number.
class Client {
 public:
  void Hear(const std::string& frame) {
    const DecodedBins bins = Decode(frame);
    width_ = bins.width;
    for (uint32_t k = 0; k < bins.bins; ++k) {
      const auto number = std::llround((bins.t0 - offset_) / bins.width) + k;
      bins_[number] = {bins.min[0][k], bins.max[0][k]};
    }
    sent_ += bins.bins;
  }
  void set_offset(double offset) { offset_ = offset; }
  const auto& bins() const { return bins_; }
  uint64_t sent() const { return sent_; }

 private:
  double offset_ = 0;
  double width_ = 0;
  uint64_t sent_ = 0;
  std::map<int64_t, std::pair<double, double>> bins_;
};

// Tests that what a client has seen at the end is what it would get at once, to the last bit, however the
// samples were cut into frames; and that few bins are sent twice.
TEST(ViewTest, FramesAddUpToTheRun) {
  auto run = MadeRun(5000);
  View view(Request(2, 500), run);
  Client client;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int64_t tick = 0;
  int frames = 0;
  for (int turn = 1; turn <= 600; ++turn) {
    const auto more = static_cast<int64_t>(random() % 160);
    for (const int64_t end = tick + more; tick < end; ++tick) AddTick(&run, tick, normal(random));
    const std::string frame = view.Next(run, At(turn / 60.0));
    if (frame.empty()) continue;
    ++frames;
    client.Hear(frame);
  }
  EXPECT_GT(frames, 550);
  const BinGrid grid{0, 2.0 / 500, 0, static_cast<uint32_t>(client.bins().rbegin()->first + 1)};
  std::vector<double> min(grid.bins);
  std::vector<double> max(grid.bins);
  FillBins({&run.ticks, static_cast<size_t>(TickColumn::kP1), 0}, grid, min.data(), max.data());
  ASSERT_EQ(client.bins().size(), grid.bins);
  for (const auto& [number, extremes] : client.bins()) {
    EXPECT_EQ(extremes.first, min[static_cast<size_t>(number)]) << number;
    EXPECT_EQ(extremes.second, max[static_cast<size_t>(number)]) << number;
  }
  EXPECT_EQ(view.skipped_bins(), 0u);
  EXPECT_LT(client.sent(), 2 * client.bins().size());
}

// Tests that the first frame holds the last span, and that nothing is sent where nothing is new.
TEST(ViewTest, BeginsWithTheLastSpan) {
  auto run = MadeRun();
  for (int64_t tick = 0; tick <= 10000; ++tick) AddTick(&run, tick, static_cast<double>(tick));
  View view(Request(2, 100), run);
  const DecodedBins bins = Decode(view.Next(run, At(1)));
  EXPECT_EQ(bins.flags, uint32_t{kLastIncomplete});
  EXPECT_EQ(bins.id, 5u);
  EXPECT_NEAR(bins.t0, 8, bins.width);
  EXPECT_EQ(bins.max[0].back(), 10000);
  EXPECT_EQ(view.Next(run, At(2)), "");
}

// Tests that frames come no faster than was asked.
TEST(ViewTest, KeepsToItsRate) {
  auto run = MadeRun();
  ViewRequest request = Request(2, 100);
  request.fps = 10;
  View view(request, run);
  int frames = 0;
  for (int turn = 0; turn < 600; ++turn) {  // 10 s in turns of 1/60 s
    AddTick(&run, turn, turn);
    frames += view.Next(run, At(1 + turn / 60.0)).empty() ? 0 : 1;
  }
  EXPECT_GE(frames, 95);
  EXPECT_LE(frames, 101);
}

// Tests that a client that was stuck gets the newest span in one frame, and that what it missed is counted.
TEST(ViewTest, CountsWhatASlowClientMissed) {
  auto run = MadeRun();
  View view(Request(1, 100), run);
  AddTick(&run, 0, 0);
  EXPECT_NE(view.Next(run, At(0)), "");
  for (int64_t tick = 1; tick <= 10000; ++tick) AddTick(&run, tick, 0);
  const DecodedBins bins = Decode(view.Next(run, At(10)));
  EXPECT_LE(bins.bins, 102u);
  EXPECT_EQ(view.skipped_bins(), 1000u - 100);
  EXPECT_NEAR(static_cast<double>(view.skipped_frames()), 599, 1);
}

// Tests that bins narrower than a tick become one for each tick.
TEST(ViewTest, ZoomedInEachBinIsATick) {
  auto run = MadeRun();
  View view(Request(0.05, 1000), run);
  for (int64_t tick = 0; tick <= 1000; ++tick) AddTick(&run, tick, static_cast<double>(tick));
  const DecodedBins bins = Decode(view.Next(run, At(0)));
  EXPECT_EQ(bins.width, 0.001);
  for (uint32_t k = 0; k < bins.bins; ++k) {
    const double tick = std::round((bins.t0 + (k + 0.5) * bins.width) * 1000);
    EXPECT_EQ(bins.min[0][k], tick);
    EXPECT_EQ(bins.max[0][k], tick);
  }
}

// Tests that a run that begins anew is shown from its beginning.
TEST(ViewTest, FollowsARestart) {
  auto before = MadeRun();
  for (int64_t tick = 0; tick < 5000; ++tick) AddTick(&before, tick, 1);
  View view(Request(1, 100), before);
  EXPECT_NE(view.Next(before, At(0)), "");
  auto after = MadeRun();
  for (int64_t tick = 0; tick < 100; ++tick) AddTick(&after, tick, 2);
  const DecodedBins bins = Decode(view.Next(after, At(1)));
  EXPECT_EQ(bins.min[0].back(), 2);
  EXPECT_LT(bins.t0 + bins.width * bins.bins, 0.2);
}

// Tests that a ghost that begins anew, and so has fewer rows than were sent, is sent again.
TEST(ViewTest, SendsAGhostThatBeganAnew) {
  auto run = MadeRun();
  const double row[kGhostColumns] = {1};
  for (int64_t tick = 0; tick < 1000; ++tick) {
    AddTick(&run, tick, 1);
    run.ghost.Append(static_cast<double>(tick) / 1000, row);
  }
  ViewRequest request = Request(1, 100);
  request.channels = {"ghost.p1"};
  View view(request, run);
  EXPECT_NE(view.Next(run, At(0)), "");
  EXPECT_EQ(view.Next(run, At(1)), "");
  run.ghost = History(kGhostColumns);
  run.ghost.Append(0.5, row);
  EXPECT_NE(view.Next(run, At(2)), "");
}

// Tests that what makes no sense is refused by name.
TEST(ViewTest, RefusesNonsense) {
  const auto run = MadeRun();
  const auto refused = [&](auto change, const std::string& named) {
    ViewRequest request = Request(1, 100);
    change(request);
    try {
      View(request, run);
      ADD_FAILURE() << named;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  };
  refused([](ViewRequest& r) { r.channels = {"p3"}; }, "\"p3\"");
  refused([](ViewRequest& r) { r.channels.assign(65, "p1"); }, "65");
  refused([](ViewRequest& r) { r.span = 0; }, "span: found 0");
  refused([](ViewRequest& r) { r.span = std::nan(""); }, "span");
  refused([](ViewRequest& r) { r.pixels = 0; }, "pixels");
  refused([](ViewRequest& r) { r.pixels = 1000000; }, "pixels");
  refused([](ViewRequest& r) { r.fps = -1; }, "fps");
}

}  // namespace
}  // namespace hydro::scope
