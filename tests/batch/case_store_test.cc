#include "batch/store/case_store.h"

#include "batch/run/case_progress.h"
#include "batch/store/small_file.h"
#include "batch/store/study_lock.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Tests where a case lies: a thousand to a folder.
TEST(CaseStoreTest, ShardsCases) {
  EXPECT_EQ(CasePath(0), "000/000/000");
  EXPECT_EQ(CasePath(12'345), "000/012/345");
  EXPECT_EQ(CasePath(987'654'321), "987/654/321");
}

// Tests that a stored case is there with its files, counts once, and stays as the first stored it.
TEST(CaseStoreTest, StoresOnce) {
  const StudyFolder folder;
  CaseStore store(folder / ""), other(folder / "");
  const std::string kept = folder.Write("kept", "bytes");
  EXPECT_TRUE(store.Store(1234, false, "first", {{kept, "sub/run.log"}}, 0));
  EXPECT_FALSE(other.Store(1234, false, "second", {}, 0));
  EXPECT_EQ(ReadSmallFile(store.CaseFolder(1234, false) + "/result.json"), "first");
  EXPECT_EQ(ReadSmallFile(store.CaseFolder(1234, false) + "/sub/run.log"), "bytes");
  EXPECT_TRUE(store.IsDone(1234));
  EXPECT_FALSE(store.IsFailed(1234));
  EXPECT_EQ(CountCases(store, 0, 5000).done, 1);
  EXPECT_EQ(CountCases(store, 1235, 5000).done, 0);
  EXPECT_TRUE(fs::is_empty(folder / "staging"));
}

// Tests that a failed case counts as failed until it is done.
TEST(CaseStoreTest, DoneCountsMoreThanFailed) {
  const StudyFolder folder;
  CaseStore store(folder / "");
  store.Store(5, true, "{}", {}, 0);
  EXPECT_TRUE(store.IsFailed(5));
  EXPECT_TRUE(store.Shard(0).failed[5]);
  store.Store(5, false, "{}", {}, 0);
  EXPECT_FALSE(store.IsFailed(5));
  EXPECT_FALSE(store.Shard(0).failed[5]);
  EXPECT_TRUE(store.Shard(0).done[5]);
}

// Tests that nothing but whole cases counts: not what is being stored, nor other names.
TEST(CaseStoreTest, CountsWholeCasesOnly) {
  const StudyFolder folder;
  CaseStore store(folder / "");
  store.Store(0, false, "{}", {}, 0);
  for (const char* name : {"7", "0007", "x07", "007.part", "007.failed.old"})
    fs::create_directories(folder / ("cases/000/000/" + std::string(name)));
  const CaseCount count = CountCases(store, 0, 1000);
  EXPECT_EQ(count.done, 1);
  EXPECT_EQ(count.failed, 0);
}

// Tests that missing cases come in their order, each once, and failed ones only when asked for.
TEST(CaseStoreTest, FindsWhatIsMissing) {
  const StudyFolder folder;
  CaseStore store(folder / "");
  for (int64_t i = 990; i < 1010; ++i) {
    if (i != 995 && i != 1003) store.Store(i, i == 1005, "{}", {}, 0);
  }
  MissingCases missing(store, 990, 1010, false), failed_too(store, 990, 1010, true);
  EXPECT_EQ(missing.Next(), 995);
  EXPECT_EQ(missing.Next(), 1003);
  EXPECT_EQ(missing.Next(), std::nullopt);
  EXPECT_EQ(failed_too.Next(), 995);
  EXPECT_EQ(failed_too.Next(), 1003);
  EXPECT_EQ(failed_too.Next(), 1005);
  EXPECT_EQ(failed_too.Next(), std::nullopt);
}

// Tests that what a killed process left is swept, and what a running one has is not.
TEST(CaseStoreTest, SweepsWhatKilledProcessesLeft) {
  const StudyFolder folder;
  CaseStore store(folder / "");
  store.Store(0, false, "{}", {}, 0);
  Owner dead = ThisProcess();
  dead.started -= 1;  // an earlier process of this number
  Owner elsewhere = ThisProcess();
  elsewhere.host = "node17+1";
  for (const Owner& owner : {dead, elsewhere, ThisProcess()})
    fs::create_directories(folder / ("staging/" + OwnerText(owner) + ".0.0"));
  store.SweepStaging();
  EXPECT_FALSE(fs::exists(folder / ("staging/" + OwnerText(dead) + ".0.0")));
  EXPECT_TRUE(fs::exists(folder / ("staging/" + OwnerText(elsewhere) + ".0.0")));
  EXPECT_TRUE(fs::exists(folder / ("staging/" + OwnerText(ThisProcess()) + ".0.0")));
}

// Tests that a folder that cannot be written is told on one line, and leaves no half case.
TEST(CaseStoreTest, TellsWhatCannotBeWritten) {
  const StudyFolder folder;
  folder.Write("cases", "a file where a folder should be");
  CaseStore store(folder / "");
  EXPECT_THROW(store.Store(0, false, "{}", {}, 0), StoreError);
  EXPECT_THROW(store.Store(0, false, "{}", {{folder / "none", "x"}}, 0), StoreError);
  EXPECT_TRUE(fs::is_empty(folder / "staging"));
}

std::string LockRefusal(const std::string& folder) {
  try {
    const StudyLock lock(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string LockText(const std::string& host, long long started) {
  Owner owner = ThisProcess();
  if (!host.empty()) owner.host = host;
  owner.started = started == 0 ? owner.started : started;
  return OwnerText(owner) + ".0";
}

// Tests that one process at a time holds a folder, and that the refusal names it.
TEST(StudyLockTest, RefusesASecond) {
  const StudyFolder folder;
  {
    const StudyLock lock(folder / "");
    EXPECT_THAT(LockRefusal(folder / ""),
                HasSubstr("in use by hydro-batch, process " + std::to_string(getpid())));
  }
  EXPECT_EQ(LockRefusal(folder / ""), "");
  EXPECT_FALSE(fs::exists(folder / "lock"));
}

// Tests that the lock of a process that has ended is taken over, whoever has its number now.
TEST(StudyLockTest, TakesOverFromTheDead) {
  const StudyFolder folder;
  folder.Write("lock", LockText("", 1));
  EXPECT_EQ(LockRefusal(folder / ""), "");
}

// Tests that something of the lock's name that cannot be read is named, instead of being tried for ever.
TEST(StudyLockTest, NamesWhatIsNoLock) {
  const StudyFolder folder;
  fs::create_directories(folder / "lock");
  EXPECT_THAT(LockRefusal(folder / ""), HasSubstr("lock: found something that cannot be read"));
  EXPECT_TRUE(fs::is_directory(folder / "lock"));
}

// Tests that the lock of another host holds while that touches it, and no longer than a minute after.
TEST(StudyLockTest, BelievesAnotherHostWhileItIsHeard) {
  const StudyFolder folder;
  folder.Write("lock", LockText("node17+1", 1));
  EXPECT_THAT(LockRefusal(folder / ""), HasSubstr(" on node17 "));
  fs::last_write_time(folder / "lock", fs::file_time_type::clock::now() - std::chrono::seconds(90));
  EXPECT_EQ(LockRefusal(folder / ""), "");
}

// Tests that an owner's text is read back, with a host's name that has dashes and points.
TEST(OwnerTest, ReadsItsText) {
  const Owner owner{"node_17.cluster+12", "0a1b2c3d", 4711, 123456};
  const Owner read = ParseOwner(OwnerText(owner) + ".3.1");
  EXPECT_EQ(read.host, owner.host);
  EXPECT_EQ(read.boot, owner.boot);
  EXPECT_EQ(read.pid, owner.pid);
  EXPECT_EQ(read.started, owner.started);
  EXPECT_EQ(LifeOf(ThisProcess()), Life::kRuns);
  EXPECT_EQ(ParseOwner("rubbish").pid, 0);
}

}  // namespace
}  // namespace hydro::batch
