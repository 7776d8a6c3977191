#include "batch/run/run_cases.h"

#include <thread>

#include "batch/batch_command.h"
#include "batch/run/case_command.h"
#include "batch/status.h"
#include "batch/store/case_store.h"
#include "batch/store/small_file.h"
#include "batch/study_folder.h"
#include "tests/batch/study_folder.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

RunRequest All(const Study& study, const std::string& folder, int jobs = 2) {
  return {.folder = folder, .first = 0, .end = study.cases(), .jobs = jobs};
}

std::string TableOf(const std::string& folder) { return ReadSmallFile(folder + "/table.csv").value_or(""); }

// Tests a study from its file to its table.
TEST(RunCasesTest, RunsAStudy) {
  const StudyFolder folder;
  const Study study = folder.Read(kShellStudy);
  PrepareStudy(study, folder / "out");
  const RunOutcome outcome = RunCases(study, All(study, folder / "out"));
  EXPECT_EQ(outcome.progress.ran, 6);
  const TableCounts counts = FinishStudy(folder / "out", 2);
  EXPECT_EQ(counts.done, 6);
  EXPECT_EQ(TableOf(folder / "out"),
            "case,status,attempts,k,l,k_again,l_again,reason\n"
            "0,done,1,1,10.5,1,10.5,\n"
            "1,done,1,1,20.5,1,20.5,\n"
            "2,done,1,2,10.5,2,10.5,\n"
            "3,done,1,2,20.5,2,20.5,\n"
            "4,done,1,3,10.5,3,10.5,\n"
            "5,done,1,3,20.5,3,20.5,\n");
  EXPECT_EQ(ReadSmallFile(folder / "out/cases/000/000/003/result.json"),
            "{\n  \"case\": 3,\n  \"status\": \"done\",\n  \"attempts\": 1,\n  \"values\": {\"k\": 2, \"l\": "
            "20.5},\n"
            "  \"numbers\": {\"k_again\": 2, \"l_again\": 20.5}\n}\n");
}

// Tests that ranges, in any order and overlapping, give the same files as all at once.
TEST(RunCasesTest, RangesGiveTheSame) {
  const StudyFolder folder;
  const Study study = folder.Read(kShellStudy);
  for (const char* name : {"all", "parts"}) PrepareStudy(study, folder / name);
  RunCases(study, All(study, folder / "all", 1));
  int64_t ran = 0;
  for (const auto& [first, end] : {std::pair(4, 6), std::pair(1, 5), std::pair(0, 6)}) {
    ran += RunCases(study, {.folder = folder / "parts", .first = first, .end = end, .jobs = 3}).progress.ran;
  }
  EXPECT_EQ(ran, 6);
  FinishStudy(folder / "all", 1);
  FinishStudy(folder / "parts", 3);
  for (const char* file :
       {"table.csv", "table.json", "cases/000/000/000/result.json", "cases/000/000/005/result.json"}) {
    EXPECT_EQ(ReadSmallFile(folder / ("all/" + std::string(file))),
              ReadSmallFile(folder / ("parts/" + std::string(file))))
        << file;
  }
}

// Tests that a stopped study tells of missing cases, goes on, and repeats nothing.
TEST(RunCasesTest, GoesOnWhereItStopped) {
  const StudyFolder folder;
  // Each case adds a line to a file outside.
  std::string text = kShellStudy;
  text.replace(text.find("printf"), 0, "echo {case} >> " + (folder / "ran") + "; ");
  const Study study = folder.Read(text);
  PrepareStudy(study, folder / "out");
  RunRequest request = All(study, folder / "out", 1);
  int asked = 0;
  request.stop = [&] { return fs::exists(folder / "out/cases/000/000/002") || ++asked > 1000; };
  EXPECT_TRUE(RunCases(study, request).stopped || fs::exists(folder / "out/cases/000/000/005"));
  const TableCounts part = FinishStudy(folder / "out", 1);
  EXPECT_EQ(part.done + part.missing, 6);
  EXPECT_GE(part.missing, 1);
  EXPECT_THAT(TableOf(folder / "out"), HasSubstr("5,missing,0,3,20.5,,,\n"));
  RunCases(study, All(study, folder / "out"));
  EXPECT_EQ(FinishStudy(folder / "out", 1).done, 6);
  // What was running when it stopped may have run twice; what was stored has not.
  const std::string ran = ReadSmallFile(folder / "ran").value_or("");
  for (const char* line : {"0\n", "1\n", "2\n"}) EXPECT_EQ(ran.find(line), ran.rfind(line)) << ran;
}

// Tests that a failed case is retried, kept with its reason, and run again when asked.
TEST(RunCasesTest, KeepsFailedCases) {
  const StudyFolder folder;
  std::string text = "retries = 2\n" + kShellStudy;
  text.replace(text.find("printf"), 0,
               "echo {case} >> " + (folder / "ran") + "; [ {value:k} != 2 ] || [ -e " + (folder / "mended") +
                   " ] || { echo 'no twos here' >&2; exit 7; }; ");
  const Study study = folder.Read(text);
  PrepareStudy(study, folder / "out");
  EXPECT_EQ(RunCases(study, All(study, folder / "out")).progress.failed, 2);
  const TableCounts counts = FinishStudy(folder / "out", 1);
  EXPECT_EQ(counts.failed, 2);
  EXPECT_EQ(counts.first_failure, "case 2: step 1: sh ended with exit code 7: no twos here");
  EXPECT_THAT(TableOf(folder / "out"),
              HasSubstr("2,failed,3,2,10.5,,,step 1: sh ended with exit code 7: no twos here\n"));
  EXPECT_EQ(RunCases(study, All(study, folder / "out")).progress.ran, 0);
  folder.Write("mended", "");
  RunRequest again = All(study, folder / "out");
  again.failed_again = true;
  EXPECT_EQ(RunCases(study, again).progress.ran, 2);
  EXPECT_EQ(FinishStudy(folder / "out", 1).done, 6);
  EXPECT_FALSE(fs::exists(folder / "out/cases/000/000/002.failed"));
  EXPECT_THAT(TableOf(folder / "out"), HasSubstr("2,done,1,2,10.5,2,10.5,\n"));
}

std::string ReasonOf(const StudyFolder& folder, const std::string& study_text) {
  const Study study = folder.Read(study_text);
  fs::remove_all(folder / "out");
  PrepareStudy(study, folder / "out");
  RunCases(study, All(study, folder / "out"));
  return FinishStudy(folder / "out", 1).first_failure;
}

// Tests the reason of each way to fail; it names no path of this machine.
TEST(RunCasesTest, GivesReasons) {
  const StudyFolder folder;
  EXPECT_EQ(ReasonOf(folder, "timeout_s = 0.05\n[[step]]\nrun = [\"sleep\", \"30\"]\n"),
            "case 0: step 1: sleep: not done after 0.05 s");
  EXPECT_EQ(ReasonOf(folder, "[[step]]\nrun = [\"sh\", \"-c\", \"kill -9 $$\"]\n"),
            "case 0: step 1: sh was killed by signal 9 (SIGKILL)");
  EXPECT_THAT(ReasonOf(folder, "[[step]]\nrun = [\"inputs/none\"]\n"),
              HasSubstr("case 0: step 1: inputs/none: cannot be started"));
  EXPECT_EQ(ReasonOf(folder, "[[step]]\nrun = [\"true\"]\n[collect]\nx = \"out.json:/x\"\n"),
            "case 0: out.json: not written by any step; there are step1.err, step1.out");
  EXPECT_EQ(
      ReasonOf(folder,
               "[[step]]\nrun = [\"sh\", \"-c\", \"echo no > out.json\"]\n[collect]\nx = \"out.json:/x\"\n"),
      "case 0: out.json: found no JSON in it, allowed JSON, or TOML in a file .toml");
  EXPECT_EQ(
      ReasonOf(folder,
               "[[step]]\nrun = [\"sh\", \"-c\", \"echo [1] > out.json\"]\n[collect]\nx = \"out.json:/x\"\n"),
      "case 0: out.json:/x: found nothing there; the file has a list of 1");
  const std::string nested =
      "[[step]]\nrun = [\"sh\", \"-c\", \"echo '{\\\"a\\\": {\\\"b\\\": 1, \\\"c\\\": 2}}' > out.json\"]\n";
  EXPECT_EQ(ReasonOf(folder, nested + "[collect]\nx = \"out.json:/a/d/e\"\n"),
            "case 0: out.json:/a/d/e: found nothing there; /a has only b, c");
  EXPECT_EQ(ReasonOf(folder, nested + "[collect]\nx = \"out.json:/a~x\"\n"),
            "case 0: out.json:/a~x: found nothing there; the file has only a");
  EXPECT_EQ(ReasonOf(folder, "[[step]]\nrun = [\"sh\", \"-c\", \"echo {folder} >&2; exit 1\"]\n"),
            "case 0: step 1: sh ended with exit code 1: .");
  EXPECT_EQ(ReasonOf(folder, "keep = [\"run.log\"]\n[[step]]\nrun = [\"true\"]\n"),
            "case 0: run.log: not written, allowed a file that the study keeps");
  EXPECT_EQ(ReasonOf(folder, "[[step]]\nrun = [\"sh\", \"-c\", \"exit 3\"]\nexit_codes = [0, 3]\n"), "");
}

// Tests that numbers of every kind are collected, from JSON and from TOML.
TEST(RunCasesTest, CollectsFromJsonAndToml) {
  const StudyFolder folder;
  const std::string text = R"(
[[step]]
run = ["sh", "-c",  '''echo '{"a": [1.25, null, true], "s": "tied, or so"}' > out.json; printf '[gains]\nc1 = 7\n' > gains.toml''']
[collect]
number = "out.json:/a/0"
nothing = "out.json:/a/1"
flag = "out.json:/a/2"
text = "out.json:/s"
gain = "gains.toml:/gains/c1"
code = "exit_codes.json:/1"
[[step]]
run = ["sh", "-c", "exit 4"]
exit_codes = [0, 4]
)";
  EXPECT_EQ(ReasonOf(folder, text), "");
  EXPECT_EQ(TableOf(folder / "out"),
            "case,status,attempts,number,nothing,flag,text,gain,code,reason\n0,done,1,1.25,,true,\"tied, or "
            "so\",7,4,\n");
}

// Tests that a result that a power cut left half written is run again, and never silently missing.
TEST(RunCasesTest, RunsTornResultsAgain) {
  const StudyFolder folder;
  const Study study = folder.Read(kShellStudy);
  PrepareStudy(study, folder / "out");
  RunCases(study, All(study, folder / "out"));
  std::ofstream(folder / "out/cases/000/000/001/result.json") << "";
  EXPECT_EQ(FinishStudy(folder / "out", 1).missing, 1);
  EXPECT_EQ(RunCases(study, All(study, folder / "out")).progress.ran, 1);
  EXPECT_EQ(FinishStudy(folder / "out", 1).done, 6);
}

// Tests that the folder of another study is refused, and one with foreign files.
TEST(PrepareTest, RefusesOtherFolders) {
  const StudyFolder folder;
  const Study study = folder.Read(kShellStudy);
  PrepareStudy(study, folder / "out");
  PrepareStudy(study, folder / "out");
  EXPECT_THROW(PrepareStudy(folder.Read("seed = 5\n" + kShellStudy), folder / "out"), InputError);
  fs::create_directories(folder / "other");
  folder.Write("other/thesis.tex", "mine");
  EXPECT_THROW(PrepareStudy(study, folder / "other"), InputError);
  EXPECT_THROW(OpenStudy(folder / "other"), InputError);
  EXPECT_FALSE(fs::exists(folder / "other/study.toml"));
}

// Tests that a folder whose study.toml its user has written is no folder of hydro-batch, whose page and table
// may be replaced, and that one of hydro-batch can be continued with the study in it.
TEST(PrepareTest, KeepsTheUsersFolder) {
  const StudyFolder folder;
  const Study own = folder.Read(kShellStudy);
  folder.Write("table.csv", "mine");
  EXPECT_THROW(PrepareStudy(own, folder / "."), InputError);
  EXPECT_THROW(OpenStudy(folder / "."), InputError);
  PrepareStudy(own, folder / "out");
  PrepareStudy(ReadStudy(folder / "out/study.toml"), folder / "out");
  RunCases(own, All(own, folder / "out"));
  folder.Write("out/study.toml", ReadSmallFile(folder / "out/study.toml").value() + "# another version\n");
  EXPECT_EQ(OpenStudy(folder / "out").cases(), 6);
}

// Tests that a study that reads what its end would replace is refused before anything is made.
TEST(PrepareTest, KeepsInputs) {
  const StudyFolder folder;
  fs::create_directories(folder / "out");
  folder.Write("out/table.csv", "k,l\n1,2\n");
  const std::string text =
      "[list]\nfile = \"out/table.csv\"\n[[step]]\nrun = [\"true\", \"{value:k}{value:l}\"]\n";
  const Study study = folder.Read(text);
  std::string said;
  try {
    PrepareStudy(study, folder / "out");
  } catch (const InputError& error) {
    said = error.what();
  }
  EXPECT_THAT(said, HasSubstr("out/table.csv: found the name of a file that is read"));
  EXPECT_FALSE(fs::exists(folder / "out/study.toml"));
}

// Tests that --jobs has one range, and that its default is within it.
TEST(BatchCommandTest, RangeOfJobs) {
  for (const int64_t jobs : {int64_t{-1}, int64_t{0}, int64_t{4097}, int64_t{99'999'999'999}}) {
    BatchOptions options;
    EXPECT_GE(options.jobs, 1);
    options.jobs = jobs;
    std::string said;
    try {
      batch::Run(options);
    } catch (const InputError& error) {
      said = error.what();
    }
    EXPECT_EQ(said, "--jobs: found " + std::to_string(jobs) + ", allowed 1 to 4096");
  }
}

// Tests that the report's wishes may change, and hold from then on.
TEST(PrepareTest, TakesOtherWishesOfTheReport) {
  const StudyFolder folder;
  PrepareStudy(folder.Read(kShellStudy), folder / "out");
  PrepareStudy(folder.Read(kShellStudy + "[report]\nworst = \"l_again\"\n"), folder / "out");
  EXPECT_EQ(OpenStudy(folder / "out").report.worst, "l_again");
}

// Tests that the status is told from the folder alone.
TEST(StatusTest, ReadsTheFolder) {
  const StudyFolder folder;
  const Study study = folder.Read(kShellStudy);
  PrepareStudy(study, folder / "out");
  EXPECT_THAT(StatusText(ReadStatus(folder / "out")),
              HasSubstr("shell: 6 cases: 0 done, 0 failed, 6 missing (0 %)\nnobody runs it"));
  RunCases(study, {.folder = folder / "out", .first = 0, .end = 3, .jobs = 1});
  const StudyStatus status = ReadStatus(folder / "out");
  EXPECT_EQ(status.done, 3);
  EXPECT_EQ(status.active, 1);
  EXPECT_GT(status.rate, 0);
  EXPECT_THAT(StatusText(status), HasSubstr("shell: 6 cases: 3 done, 0 failed, 3 missing (50 %)"));
  EXPECT_EQ(DurationText(59.4), "59 s");
  EXPECT_EQ(DurationText(3725), "1 h 2 min");
  EXPECT_EQ(DurationText(200000), "2 days 7 h");
}

// Tests placeholders, that braces of a command's own stay, and that an unknown name is refused.
TEST(CaseCommandTest, FillsPlaceholders) {
  const Step step{.argv = {"x{case}", "{value:position.c1}", "{folder}/{inputs}", "{\"a\": {value:k}}",
                           "${HOME} {}", "{ case }"}};
  EXPECT_THAT(CaseCommand(step, {"position.c1", "k"}, {2.5, int64_t{7}}, {3, "/f", "/i"}),
              testing::ElementsAre("x3", "2.5", "/f//i", "{\"a\": 7}", "${HOME} {}", "{ case }"));
  EXPECT_THROW(CaseCommand({.argv = {"{value:j}"}}, {"k"}, {1.0}, {}), InputError);
  EXPECT_THROW(ProgramPath("hydro-nonsense"), InputError);
}

bool Runs(const std::string& pid) {
  const std::string stat = ReadSmallFile("/proc/" + pid + "/stat").value_or("");
  return !stat.empty() && stat.find(") Z ") == std::string::npos;
}

// Tests that a bell that rings ends a running child with all its group.
TEST(ChildTest, EndsWithTheBell) {
  const StudyFolder folder;
  const StopBell bell;
  std::string pid;
  std::thread ringer([&] {
    while (pid.empty()) pid = ReadSmallFile(folder / "pid").value_or("");
    EXPECT_TRUE(Runs(pid));
    bell.Ring();
  });
  const ChildResult result =
      RunChild({.argv = {ProgramPath("sh"), "-c", "sleep 1000 & printf %s $! > new; mv new pid; wait"},
                .folder = folder / "",
                .out = folder / "o",
                .err = folder / "e"},
               bell);
  ringer.join();
  EXPECT_EQ(result.end, ChildEnd::kStopped);
  while (Runs(pid)) std::this_thread::yield();
}

}  // namespace
}  // namespace hydro::batch
