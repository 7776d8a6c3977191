#include "batch/study/draw.h"

#include <cmath>

#include "model/terms/drawn_model.h"
#include "model/terms/parameter_info.h"
#include "settings/model_file.h"
#include "tests/batch/study_folder.h"

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

// Tests each distribution's mean, deviation and bounds. Tolerances are six standard errors of 20,000 draws; the seed is fixed.
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

// Tests that what a case gets for a key depends on seed, number and key, and on none of the study's other keys.
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
