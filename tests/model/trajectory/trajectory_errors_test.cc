#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <stdexcept>

#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Refused {
  std::string says;
  std::function<std::unique_ptr<Trajectory>()> make;
};

// ctest names each case by this.
void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.says; }

class TrajectoryErrorsTest : public ::testing::TestWithParam<Refused> {};

// Tests that each malformed specification is refused with what was found and where.
TEST_P(TrajectoryErrorsTest, SaysWhatWasFound) {
  try {
    GetParam().make();
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().says));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("found "));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("allowed: "));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, TrajectoryErrorsTest,
    ::testing::Values(Refused{"initial: found nan", [] { return MakeSteps(kNan, {}); }},
                      Refused{"step 2 time: found 1, allowed: above 1",
                              [] {
                                return MakeSteps(0, {{1, 0}, {1, 2}});
                              }},
                      Refused{"step 2 time: found 0.5, allowed: above 1",
                              [] {
                                return MakeSteps(0, {{1, 0}, {0.5, 2}});
                              }},
                      Refused{"step 1 value: found inf",
                              [] {
                                return MakeSteps(0, {{1, kInfinite}});
                              }},
                      Refused{"step 1 time: found nan",
                              [] {
                                return MakeSteps(0, {{kNan, 0}});
                              }},
                      Refused{"frequency: found 0", [] { return MakeSine(0, 1, 0, 0, 0); }},
                      Refused{"frequency: found -1", [] { return MakeSine(0, 1, -1, 0, 0); }},
                      Refused{"amplitude: found nan", [] { return MakeSine(0, kNan, 1, 0, 0); }},
                      Refused{"phase: found inf", [] { return MakeSine(0, 1, 1, 0, kInfinite); }},
                      Refused{"offset: found nan", [] { return MakeSine(kNan, 1, 1, 0, 0); }},
                      Refused{"start: found nan", [] { return MakeSine(0, 1, 1, kNan, 0); }},
                      Refused{"offset + amplitude: found inf",
                              [] { return MakeSine(1e308, 1e308, 1, 0, 0); }},
                      Refused{"rate: found inf", [] { return MakeSine(0, 1e300, 1e300, 0, 0); }},
                      Refused{"frequency: found inf", [] { return MakeSquare(0, 1, kInfinite, 0); }},
                      Refused{"amplitude: found -inf", [] { return MakeSquare(0, -kInfinite, 1, 0); }},
                      Refused{"duration: found 0", [] { return MakeChirp(0, 1, 1, 2, 0, 0); }},
                      Refused{"duration: found nan", [] { return MakeChirp(0, 1, 1, 2, 0, kNan); }},
                      Refused{"first frequency: found -1", [] { return MakeChirp(0, 1, -1, 2, 0, 1); }},
                      Refused{"last frequency: found 0", [] { return MakeChirp(0, 1, 1, 0, 0, 1); }},
                      Refused{"points: found none", [] { return MakePoints({}, Interpolation::kLinear); }},
                      Refused{"point 3 time: found 1, allowed: above 2",
                              [] {
                                return MakePoints({{0, 0}, {2, 0}, {1, 0}}, Interpolation::kHold);
                              }},
                      Refused{"point 2 value: found nan",
                              [] {
                                return MakePoints({{0, 0}, {2, kNan}}, Interpolation::kCubic);
                              }},
                      Refused{"point 2: found a rate", [] {
                                return MakePoints({{0, -1e308}, {1e-10, 1e308}}, Interpolation::kLinear);
                              }}));

}  // namespace
}  // namespace hydro::trajectory
