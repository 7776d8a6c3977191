#include <cmath>

#include "batch/study/value.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"
#include "settings/model_file.h"
#include "tests/batch/study_folder.h"
#include "tests/settings/texts.h"

namespace hydro::batch {
namespace {

constexpr int kDraws = 20000;

struct Moments {
  double mean = 0, deviation = 0, min = HUGE_VAL, max = -HUGE_VAL;
};

template <class Transform>
Moments MomentsOf(const Draw& draw, const Transform& transform) {
  Moments moments;
  double squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = transform(*AsNumber(DrawnValue(draw, 7, i)));
    moments.mean += value / kDraws;
    squares += value * value / kDraws;
    moments.min = std::min(moments.min, value);
    moments.max = std::max(moments.max, value);
  }
  moments.deviation = std::sqrt(squares - moments.mean * moments.mean);
  return moments;
}

double Same(double value) { return value; }

// Tests each distribution's mean, deviation and bounds. Tolerances are six standard errors of 20,000 draws;
// the seed is fixed.
TEST(DrawTest, HasTheMomentsOfItsDistribution) {
  const double six = 6 / std::sqrt(kDraws);
  Draw uniform{.key = "a", .min = 2, .max = 5};
  const Moments of_uniform = MomentsOf(uniform, Same);
  EXPECT_NEAR(of_uniform.mean, 3.5, six * 3 / std::sqrt(12));
  EXPECT_NEAR(of_uniform.deviation, 3 / std::sqrt(12), six);
  EXPECT_GE(of_uniform.min, 2);
  EXPECT_LE(of_uniform.max, 5);

  Draw log_uniform{.key = "a", .distribution = Distribution::kLogUniform, .min = 1, .max = 100};
  EXPECT_NEAR(MomentsOf(log_uniform, [](double v) { return std::log10(v); }).mean, 1,
              six * 2 / std::sqrt(12));

  Draw normal{.key = "a", .distribution = Distribution::kNormal, .mean = -3, .standard_deviation = 2};
  EXPECT_NEAR(MomentsOf(normal, Same).mean, -3, six * 2);
  EXPECT_NEAR(MomentsOf(normal, Same).deviation, 2, six * 2);
  normal.min = -4;
  EXPECT_GE(MomentsOf(normal, Same).min, -4);

  Draw whole{.key = "a", .min = 1, .max = 3, .whole = true};
  EXPECT_NEAR(MomentsOf(whole, Same).mean, 2, six);
  EXPECT_EQ(MomentsOf(whole, Same).min, 1);
  EXPECT_EQ(MomentsOf(whole, Same).max, 3);

  Draw choice{.key = "a",
              .distribution = Distribution::kChoice,
              .choices = {int64_t{0}, int64_t{0}, int64_t{0}, int64_t{1}}};
  EXPECT_NEAR(MomentsOf(choice, Same).mean, 0.25, six);
}

// Tests that a range whose ends have no finite difference or ratio gives finite values between them, in grids
// and draws, that they increase, and that they fill the range.
TEST(DrawTest, RangesThatOverflow) {
  const StudyFolder folder;
  const std::string head = "draws = 200\n[[step]]\nrun = [\"true\"]\n";
  const struct {
    const char *from, *to, *scale, *distribution;
  } cases[] = {{"1e-300", "1e300", "log", "log_uniform"},
               {"4e-308", "1.7e308", "log", "log_uniform"},
               {"-1.7e308", "1.7e308", "linear", "uniform"},
               {"-1e308", "1.7976931348623157e308", "linear", "uniform"}};
  for (const auto& c : cases) {
    const double from = std::stod(c.from), to = std::stod(c.to);
    const Study grid =
        folder.Read("[[step]]\nrun = [\"true\"]\n[[grid]]\nkey = \"k\"\nfrom = " + std::string(c.from) +
                    "\nto = " + c.to + "\nsteps = 9\nscale = \"" + c.scale + "\"\n");
    double last = -HUGE_VAL;
    for (int64_t i = 0; i < 9; ++i) {
      const double value = *AsNumber(grid.Values(i)[0]);
      EXPECT_TRUE(std::isfinite(value) && value > last) << c.from << ", " << i << ": " << value;
      last = value;
    }
    EXPECT_NEAR(last / to, 1, 1e-11);
    const Study draws = folder.Read(head + "[[draw]]\nkey = \"k\"\ndistribution = \"" + c.distribution +
                                    "\"\nmin = " + c.from + "\nmax = " + c.to + "\n");
    int low = 0;
    for (int64_t i = 0; i < 200; ++i) {
      const double value = *AsNumber(draws.Values(i)[0]);
      ASSERT_TRUE(std::isfinite(value) && value >= from && value <= to) << c.from << ": " << value;
      low += value < Between(from, to, 0.5, std::string(c.scale) == "log") ? 1 : 0;
    }
    EXPECT_NEAR(low, 100, 43) << "six standard deviations of 200 throws of a coin";
  }
  EXPECT_EQ(Rounded(HUGE_VAL), HUGE_VAL);
  EXPECT_TRUE(std::isnan(Rounded(NAN)));
  EXPECT_EQ(Rounded(5e-324), 5e-324);
}

// Tests that draws that would not be numbers are refused with the key.
TEST(DrawTest, RefusesWhatIsNoNumber) {
  const StudyFolder folder;
  const auto error = [&](const std::string& draw) {
    return settings::InputErrorOf([&] {
      folder.Read("draws = 2\n[[step]]\nrun = [\"true\"]\n[[draw]]\nkey = \"k\"\ndistribution = " + draw);
    });
  };
  EXPECT_THAT(
      error("\"uniform\"\nmin = 0\nmax = 1e300\nwhole = true\n"),
      ::testing::HasSubstr("whole: found true from 0 to 1e+300, allowed bounds from -9007199254740992"));
  EXPECT_THAT(error("\"normal\"\nmean = 0\nstandard_deviation = 1e308\n"),
              ::testing::HasSubstr("standard_deviation: found 1e+308"));
  EXPECT_THAT(error("\"uniform\"\nmin = 0\nmax = inf\n"), ::testing::HasSubstr("max: found"));
  EXPECT_EQ(error("\"uniform\"\nmin = -9007199254740992\nmax = 9007199254740992\nwhole = true\n"), "");
}

// Tests that what a case gets for a key depends on seed, number and key, and on none of the study's other
// keys.
TEST(DrawTest, DependsOnSeedNumberAndKeyAlone) {
  const StudyFolder folder;
  const std::string draw = "[[draw]]\nkey = \"a\"\ndistribution = \"uniform\"\nmin = 0\nmax = 1\n";
  const std::string other = "[[draw]]\nkey = \"b\"\ndistribution = \"uniform\"\nmin = 0\nmax = 1\n";
  const std::string head = "draws = 10\n[[step]]\nrun = [\"true\"]\n";
  const Study one = folder.Read(head + draw), two = folder.Read(head + other + draw);
  for (int64_t i = 0; i < 10; ++i) {
    EXPECT_EQ(one.Values(i)[0], two.Values(i)[1]);
    EXPECT_NE(two.Values(i)[0], two.Values(i)[1]);
  }
  EXPECT_NE(one.Values(0)[0], folder.Read("seed = 2\n" + head + draw).Values(0)[0]);
}

// Tests that the same draws serve each combination of the grid where that is asked, and others where not.
TEST(DrawTest, SameDrawsForEachCombination) {
  const StudyFolder folder;
  const std::string study =
      "draws = 5\n[[step]]\nrun = [\"true\"]\n[[grid]]\nkey = \"k\"\nvalues = [1, 2]\n"
      "[[draw]]\nkey = \"a\"\ndistribution = \"uniform\"\nmin = 0\nmax = 1\n";
  const Study same = folder.Read("same_draws = true\n" + study), own = folder.Read(study);
  EXPECT_EQ(same.Values(3)[1], same.Values(8)[1]);
  EXPECT_NE(own.Values(3)[1], own.Values(8)[1]);
}

// Tests that a draw over the model's uncertainty gives each parameter what model::DrawnModel gives it.
TEST(DrawTest, DrawsTheModelsUncertainty) {
  const StudyFolder folder;
  const Study study = folder.Read("seed = 11\nmodel = \"" + std::string(HYDRO_CONFIG) +
                                  "/models/table1.toml\"\ndraws = 3\n[[step]]\nrun = [\"true\"]\n"
                                  "[[draw]]\nkey = \"model:*\"\ndistribution = \"uncertainty\"\n");
  const std::vector<std::string> keys = study.Keys();
  ASSERT_GT(keys.size(), 10u);
  const model::ModelDescription known = settings::ParseModel(study.model_text, "model.toml");
  for (int64_t i = 0; i < 3; ++i) {
    model::ModelDescription drawn = model::DrawnModel(known, 11, static_cast<uint64_t>(i));
    for (size_t k = 0; k < keys.size(); ++k) {
      const double value = model::BaseValue(drawn.parameters, model::BasePlace(keys[k].substr(6)));
      EXPECT_NEAR(*AsNumber(study.Values(i)[k]) / value, 1, 1e-11) << keys[k];  // 12 digits
    }
  }
}

}  // namespace
}  // namespace hydro::batch
