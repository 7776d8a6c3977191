#include "batch/slurm/array_driver.h"

#include "tests/batch/slurm/simulated_cluster.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

using ::testing::HasSubstr;

constexpr int64_t kCases = 23;

class ArrayDriverTest : public ::testing::Test {
 protected:
  DriveRequest Request() {
    DriveRequest request;
    request.folder = folder_ / "";
    request.name = "study";
    request.cases = kCases;
    request.cases_per_job = 2;
    request.case_s = [] { return 1.0; };
    request.stop = [this] { return wish_; };
    request.wait = [this](std::chrono::milliseconds) {
      EXPECT_LT(++ticks_, 10000) << "waits for ever";
      if (ticks_ >= 10000) throw DriverKilled{};
      cluster_.Tick();
      if (each_tick_) each_tick_();
    };
    request.progress = [this](const DriveProgress& now) { last_ = now; };
    request.say = [this](const std::string& line) { said_ += line + "\n"; };
    return request;
  }
  DriveEnd Drive() { return ArrayDriver(Request(), &cluster_).Run(); }

  void ExpectEachCaseRanOnce() {
    EXPECT_EQ(static_cast<int64_t>(cluster_.runs.size()), kCases);
    for (const auto& [index, count] : cluster_.runs) EXPECT_EQ(count, 1) << index;
  }

  StudyFolder folder_;
  SimulatedCluster cluster_{folder_ / ""};
  StopWish wish_ = StopWish::kNone;
  std::function<void()> each_tick_;
  DriveProgress last_;
  std::string said_;
  int ticks_ = 0;
};

// Tests that all cases are run once, failed ones too, in jobs of the size that was asked for.
TEST_F(ArrayDriverTest, RunsAll) {
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
  EXPECT_EQ(cluster_.jobs(), 12);
  EXPECT_EQ(last_.done, 21);
  EXPECT_EQ(last_.failed, 2);
  EXPECT_THAT(said_, HasSubstr("12 jobs with 2 cases each"));
}

// Tests that an array holds no more jobs than Slurm allows, the controller no more than half of what it may
// have, and that a limit of jobs at once holds over several arrays.
TEST_F(ArrayDriverTest, KeepsLimits) {
  cluster_.limits.array_jobs = 4;
  cluster_.limits.all_jobs = 16;
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
  EXPECT_EQ(cluster_.submitted, 3);
}
TEST_F(ArrayDriverTest, KeepsJobsAtOnce) {
  cluster_.limits.array_jobs = 4;
  DriveRequest request = Request();
  request.at_once = 2;
  EXPECT_EQ(ArrayDriver(request, &cluster_).Run(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
  EXPECT_EQ(*std::ranges::max_element(cluster_.at_once_seen), 2);
}

// Tests that a driver killed before or after any of its calls to Slurm, and started again, loses no case and
// runs none twice.
TEST_F(ArrayDriverTest, KilledAnywhere) {
  int kills = 0;
  for (bool killed = true; killed; ++kills) {
    StudyFolder folder;
    SimulatedCluster cluster(folder / "");
    cluster.limits.array_jobs = 5;
    cluster.limits.all_jobs = 20;
    cluster.kill_at = kills;
    DriveRequest request = Request();
    request.folder = folder / "";
    request.wait = [&](std::chrono::milliseconds) { cluster.Tick(); };
    killed = false;
    try {
      ArrayDriver(request, &cluster).Run();
    } catch (const DriverKilled&) {
      killed = true;
    }
    for (int i = 0; i < kills % 3; ++i) cluster.Tick();
    cluster.kill_at = -1;
    EXPECT_EQ(ArrayDriver(request, &cluster).Run(), DriveEnd::kAllThere);
    for (int i = 0; i < 20; ++i) cluster.Tick();  // nothing is left that runs once the driver has gone
    EXPECT_EQ(static_cast<int64_t>(cluster.runs.size()), kCases);
    for (const auto& [index, count] : cluster.runs)
      EXPECT_EQ(count, 1) << index << ", killed at call " << kills;
  }
  EXPECT_GT(kills, 20);
}

// Tests that what a dead node had is submitted again, and only that.
TEST_F(ArrayDriverTest, DeadNode) {
  each_tick_ = [this] {
    if (ticks_ == 2) cluster_.LoseRunningJobs();
  };
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
  EXPECT_EQ(cluster_.submitted, 2);
  EXPECT_EQ(cluster_.jobs(), 12 + 3);
  EXPECT_THAT(said_, HasSubstr("6 of 23 cases are missing, and no job has them any more"));
}

// Tests that it gives up when not one more case gets there, three times in a row.
TEST_F(ArrayDriverTest, GivesUp) {
  cluster_.broken = true;
  EXPECT_EQ(Drive(), DriveEnd::kGaveUp);
  EXPECT_EQ(cluster_.submitted, 3);
  EXPECT_TRUE(cluster_.runs.empty());
}

// Tests that progress counts: with every third try of use it goes on to the end.
TEST_F(ArrayDriverTest, GoesOnWithProgress) {
  cluster_.limits.array_jobs = 1001;
  int lost = 0;
  each_tick_ = [&] {
    if (lost++ % 3 != 0) cluster_.LoseRunningJobs();
  };
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
  EXPECT_GT(cluster_.submitted, 3);
}

// Tests that Ctrl-C cancels the jobs and that a new driver runs what is missing; a closed terminal leaves
// them.
TEST_F(ArrayDriverTest, StopsAndGoesOn) {
  each_tick_ = [this] { wish_ = ticks_ >= 3 ? StopWish::kCancel : StopWish::kNone; };
  EXPECT_EQ(Drive(), DriveEnd::kCancelled);
  const size_t before = cluster_.runs.size();
  EXPECT_LT(before, static_cast<size_t>(kCases));
  for (int i = 0; i < 20; ++i) cluster_.Tick();
  EXPECT_EQ(cluster_.runs.size(), before);
  each_tick_ = nullptr;
  wish_ = StopWish::kNone;
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
}
TEST_F(ArrayDriverTest, LeavesJobs) {
  each_tick_ = [this] { wish_ = StopWish::kLeave; };
  EXPECT_EQ(Drive(), DriveEnd::kLeft);
  for (int i = 0; i < 20; ++i) cluster_.Tick();
  ExpectEachCaseRanOnce();
}

// Tests that an array that a new controller holds again is released, but not one that its user holds.
TEST_F(ArrayDriverTest, ForgottenRelease) {
  each_tick_ = [this] {
    if (ticks_ == 2) cluster_.ForgetReleases();
  };
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
}
TEST_F(ArrayDriverTest, HeldByItsUser) {
  each_tick_ = [this] {
    if (ticks_ == 2) cluster_.HoldAll();
    if (ticks_ == 50) wish_ = StopWish::kLeave;
  };
  EXPECT_EQ(Drive(), DriveEnd::kLeft);
  EXPECT_LT(cluster_.runs.size(), static_cast<size_t>(kCases));
}

// Tests that --detach submits and leaves.
TEST_F(ArrayDriverTest, Detaches) {
  DriveRequest request = Request();
  request.detach = true;
  EXPECT_EQ(ArrayDriver(request, &cluster_).Run(), DriveEnd::kLeft);
  EXPECT_EQ(ticks_, 0);
  for (int i = 0; i < 20; ++i) cluster_.Tick();
  ExpectEachCaseRanOnce();
}

// Tests that a refused array leaves nothing in the folder, and that a controller that does not answer is
// waited for.
TEST_F(ArrayDriverTest, RefusedAndSilent) {
  cluster_.refusal = "sbatch: no such partition";
  EXPECT_THROW(Drive(), ClusterError);
  EXPECT_TRUE(ArrayFolders(folder_ / "").Read().empty());
  cluster_.refusal.clear();
  each_tick_ = [this] { cluster_.answers = ticks_ % 4 == 0; };
  EXPECT_EQ(Drive(), DriveEnd::kAllThere);
  ExpectEachCaseRanOnce();
}

}  // namespace
}  // namespace hydro::batch
