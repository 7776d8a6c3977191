#include "batch/report/study_numbers.h"
#include "batch/report/study_page.h"
#include "batch/report/study_pictures.h"
#include "batch/run/run_cases.h"
#include "batch/store/small_file.h"
#include "batch/study_folder.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// Tests quantiles of few values by hand.
TEST(QuantileTest, InterpolatesBetweenValues) {
  EXPECT_EQ(Quantile({1, 2, 4}, 0), 1);
  EXPECT_EQ(Quantile({1, 2, 4}, 0.5), 2);
  EXPECT_EQ(Quantile({1, 2, 4}, 0.75), 3);
  EXPECT_EQ(Quantile({1, 2, 4}, 1), 4);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
  EXPECT_EQ(Quantile({-1.6e308, 1.6e308}, 0), -1.6e308) << "their difference is no number";
  EXPECT_EQ(Quantile({-1.6e308, 1.6e308}, 0.5), 0);
}

// Tests which cases count as the worst: the largest, or the smallest where that is said; of equal ones the
// first.
TEST(WorstPlacesTest, KnowsWhichSideIsWorse) {
  Collected larger{.name = "x", .file = "", .pointer = "", .unit = ""}, smaller = larger;
  smaller.smaller_is_worse = true;
  NumberColumn column{&larger, {3, 9, 1, 9}, {0, 1, 2, 3}};
  EXPECT_THAT(WorstPlaces(column, 3), ElementsAre(1, 3, 0));
  column.of = &smaller;
  EXPECT_THAT(WorstPlaces(column, 2), ElementsAre(2, 0));
  EXPECT_THAT(WorstPlaces(column, 9), ElementsAre(2, 0, 1, 3));
}

TableRow Done(const Study& study, int64_t index, std::optional<Value> number) {
  TableRow row{index, CaseStatus::kDone, study.Values(index), {}};
  row.result.numbers = {std::move(number)};
  return row;
}

const char* const kTwoKeys = R"(
draws = 2
[[grid]]
key = "k"
values = [20, 10]
[[grid]]
key = "l"
values = [1, 2, 3]
[[step]]
run = ["true", "{case}"]
[collect]
x = "out.json:/x"
)";

// Tests that cases without a number count as the worst: the share of cases that are no worse is of all, and
// ends where they begin.
TEST(NoWorseTest, CasesWithoutTheNumberAreTheWorst) {
  const StudyFolder folder;
  const Study study = folder.Read(kTwoKeys);
  StudyNumbers numbers(study);
  for (int64_t i = 0; i < 9; ++i) numbers.Add(Done(study, i, static_cast<double>(i)));
  for (int64_t i = 9; i < 11; ++i) numbers.Add(Done(study, i, std::nullopt));
  const NumberColumn& column = numbers.columns()[0];
  EXPECT_EQ(column.all(), 11);
  EXPECT_EQ(NoWorse(column, column.values, 0.5), 5.0);
  EXPECT_EQ(NoWorse(column, column.values, 0.8), 8.0);
  EXPECT_EQ(NoWorse(column, column.values, 0.9), std::nullopt);
  const auto worst = WorstFigure(numbers);
  ASSERT_TRUE(worst);
  EXPECT_NEAR(worst->panels[0].curves[0].x.back(), 100 * 8.5 / 11, 1e-9);
  EXPECT_THAT(worst->caption, HasSubstr("2 of 11 have none"));
  EXPECT_THAT(DistributionsFigure(numbers)->caption, HasSubstr("count as worse"));
  EXPECT_THAT(SurfaceFigure(numbers)->caption, HasSubstr("2 cases have none and are left out"));
}

// Tests that a surface's cell is the mean of the cases with its two values, with rising axes, whatever the
// order of the grid's values.
TEST(SurfaceTest, AveragesCells) {
  const StudyFolder folder;
  const Study study = folder.Read(kTwoKeys);
  StudyNumbers numbers(study);
  for (int64_t i = 0; i < study.cases() - 2; ++i) numbers.Add(Done(study, i, static_cast<double>(i)));
  numbers.Add(Done(study, 10, std::nullopt));
  const Surface& surface = numbers.surface();
  ASSERT_TRUE(surface.there());
  EXPECT_THAT(surface.x.centres, ElementsAre(10, 20));
  EXPECT_THAT(surface.y.centres, ElementsAre(1, 2, 3));
  // Case 0 and 1: k = 20, l = 1. Cases 6 and 7: k = 10, l = 1.
  EXPECT_THAT(surface.sums, ElementsAre(6 + 7, 0 + 1, 8 + 9, 2 + 3, 0, 4 + 5));
  EXPECT_THAT(surface.counts, ElementsAre(2, 2, 2, 2, 0, 2));
  EXPECT_THAT(SurfaceFigure(numbers)->caption, HasSubstr("x over k and l, the mean"));
}

// Tests that what is drawn is put into bins, whose ends take what lies beyond.
TEST(SurfaceTest, BinsWhatIsDrawn) {
  const StudyFolder folder;
  const Study study = folder.Read(R"(
draws = 1000
[[draw]]
key = "a"
distribution = "normal"
mean = 5
standard_deviation = 1
[[draw]]
key = "b"
distribution = "uniform"
min = 0
max = 1
[[step]]
run = ["true"]
[collect]
x = "out.json:/x"
)");
  StudyNumbers numbers(study);
  for (int64_t i = 0; i < study.cases(); ++i) numbers.Add(Done(study, i, int64_t{1}));
  const Surface& surface = numbers.surface();
  ASSERT_EQ(surface.x.centres.size(), 12u);
  EXPECT_EQ(surface.x.CellOf(-100), 0u);
  EXPECT_EQ(surface.x.CellOf(100), 11u);
  double all = 0;
  for (const double count : surface.counts) all += count;
  EXPECT_EQ(all, 1000);
}

// Tests that texts, failed cases and studies without a number have a page, too, and that nothing in it stands
// for another page or host.
TEST(StudyPageTest, ShowsWhatThereIs) {
  const StudyFolder folder;
  std::string text = kShellStudy;
  text.replace(text.find("printf"), 0, "[ {value:k} != 2 ] || { echo '<b>no</b>' >&2; exit 1; }; ");
  const Study study = folder.Read(text);
  PrepareStudy(study, folder / "out");
  RunCases(study, {.folder = folder / "out", .first = 0, .end = 5, .jobs = 2});
  FinishStudy(folder / "out", 1);
  const std::string page = ReadSmallFile(folder / "out/index.html").value_or("");
  EXPECT_THAT(page, HasSubstr("6 cases: 3 done, 2 failed, 1 missing. Seed 1."));
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;no&lt;/b&gt;"));
  EXPECT_THAT(page, HasSubstr("aria-label=\"How the cases spread\""));
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  for (const char* picture : {"distributions.svg", "surface.svg", "worst.svg"})
    EXPECT_THAT(ReadSmallFile(folder / ("out/" + std::string(picture))).value_or(""), HasSubstr("<svg"))
        << picture;
  fs::copy(folder / "out/index.html", folder / "before.html");
  FinishStudy(folder / "out", 2);
  EXPECT_EQ(ReadSmallFile(folder / "out/index.html"), ReadSmallFile(folder / "before.html"));

  const Study plain = folder.Read("[[step]]\nrun = [\"true\"]\n");
  PrepareStudy(plain, folder / "plain");
  RunCases(plain, {.folder = folder / "plain", .first = 0, .end = 1, .jobs = 1});
  FinishStudy(folder / "plain", 1);
  EXPECT_THAT(ReadSmallFile(folder / "plain/index.html").value_or(""), HasSubstr("1 cases: 1 done"));
  EXPECT_FALSE(fs::exists(folder / "plain/surface.svg"));
}

}  // namespace
}  // namespace hydro::batch
