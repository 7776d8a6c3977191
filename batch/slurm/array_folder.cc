#include "batch/slurm/array_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <random>
#include <sstream>

#include "base/new_file.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "batch/store/case_store.h"
#include "batch/store/small_file.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

std::string PlainName(const std::string& text) {
  constexpr size_t kMost = 40;
  std::string name;
  for (const char c : text.substr(0, kMost)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
    name += plain && static_cast<unsigned char>(c) < 128 ? c : '_';
  }
  return name;
}

std::string ArrayScript(const ScriptRequest& request) {
  return "#!/bin/sh\n"
         "# Written by hydro-batch for sbatch: each job of the array runs the cases of its line in the file "
         "`cases`.\n"
         "program=" +
         ShellWord(request.program) +
         "\n"
         "study=" +
         ShellWord(request.study) +
         "\n"
         "array=" +
         ShellWord(request.array) + R"(
job=$SLURM_ARRAY_TASK_ID
# A full disk must not keep a job from saying so with its exit code.
log=$array/log/$job
if (: >>"$log") 2>/dev/null; then exec >>"$log" 2>&1; fi
cases=$(sed -n "$((job + 1))p" "$array/cases") && [ -n "$cases" ] || exit 3
echo "begin $(date +%s.%N) $(hostname) $SLURM_ARRAY_JOB_ID ${SLURM_RESTART_COUNT:-0}"
"$program" --worker "$study" --cases "$cases" --jobs "${SLURM_CPUS_PER_TASK:-1}"
code=$?
echo "end $(date +%s.%N) $code"
exit $code
)";
}

namespace {

namespace fs = std::filesystem;

// Returns nothing for a folder that a killed driver had only begun.
std::optional<ArrayRecord> ParseRecord(const std::string& text, int64_t number) {
  constexpr int64_t kMost = std::numeric_limits<int64_t>::max();
  try {
    const settings::TomlNode root = settings::ParseToml(text, "array");
    settings::SectionReader reader(root, "");
    ArrayRecord record;
    record.number = number;
    reader.Text("name", &record.name);
    reader.Integer("id", &record.id, 0, kMost);
    reader.Boolean("released", &record.released);
    reader.Integer("pass", &record.pass, 0, kMost);
    reader.Integer("end", &record.end, 0, kMost);
    reader.Integer("jobs", &record.jobs, 0, kMost);
    return record.name.empty() ? std::nullopt : std::optional(record);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string RecordText(const ArrayRecord& record) {
  return fmt::format("name = {}\nid = {}\nreleased = {}\npass = {}\nend = {}\njobs = {}\n",
                     settings::TomlString(record.name), record.id, record.released, record.pass, record.end,
                     record.jobs);
}

// Time and process number are not enough, because several hosts may make arrays for folders of the same name.
std::string RandomText() {
  std::random_device device;
  return fmt::format("{:08x}", device());
}

void WriteOrThrow(const std::string& path, const std::string& text) {
  try {
    WriteWholeFile(path, text);
  } catch (const std::exception& error) {
    throw StoreError(error.what());
  }
}

}  // namespace

ArrayFolders::ArrayFolders(std::string folder) : folder_(std::move(folder)) {}

std::string ArrayFolders::ArrayFolder(int64_t number) const {
  return fmt::format("{}/slurm/{:03}", folder_, number);
}

std::vector<ArrayRecord> ArrayFolders::Read() const {
  std::vector<ArrayRecord> records;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_ + "/slurm", failed)) {
    const auto number = ParseInteger(entry.path().filename().string());
    const auto text = ReadSmallFile(entry.path() / "array");
    const auto record = number && text ? ParseRecord(*text, *number) : std::nullopt;
    if (record) records.push_back(*record);
  }
  std::ranges::sort(records, {}, &ArrayRecord::number);
  return records;
}

ArrayRecord ArrayFolders::Make(const std::string& study, const std::vector<CaseRange>& cases,
                               int64_t pass) const {
  ArrayRecord record;
  std::error_code failed;
  fs::create_directories(folder_ + "/slurm", failed);
  while (!failed && !fs::create_directory(ArrayFolder(record.number), failed)) ++record.number;
  const std::string folder = ArrayFolder(record.number);
  if (!failed) fs::create_directory(folder + "/log", failed);
  if (failed) throw StoreError(folder + ": cannot be made: " + failed.message());
  std::string lines;
  for (const CaseRange& range : cases) lines += fmt::format("{}:{}\n", range.first, range.second);
  WriteOrThrow(folder + "/cases", lines);
  WriteOrThrow(folder + "/script", ArrayScript({.program = fs::read_symlink("/proc/self/exe"),
                                                .study = fs::absolute(folder_).lexically_normal(),
                                                .array = fs::absolute(folder).lexically_normal()}));
  record.name = fmt::format("hydro-{}-{}", PlainName(study), RandomText());
  record.pass = pass;
  record.end = cases.empty() ? 0 : cases.back().second;
  record.jobs = static_cast<int64_t>(cases.size());
  Write(record);
  return record;
}

void ArrayFolders::Write(const ArrayRecord& record) const {
  WriteOrThrow(ArrayFolder(record.number) + "/array", RecordText(record));
}

std::string ArrayFolders::LastComplaint(const ArrayRecord& record) const {
  std::error_code failed;
  std::string complaint;
  int looked_at = 0;
  for (const auto& entry : fs::directory_iterator(ArrayFolder(record.number) + "/log", failed)) {
    if (++looked_at > 500) break;
    std::istringstream text(ReadSmallFile(entry.path()).value_or(""));
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("hydro-batch: ")) complaint = line;
    }
  }
  return complaint;
}

std::optional<JobSpan> ParseJobSpan(const std::string& log) {
  JobSpan span;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, time;
    words >> word >> time;
    const auto number = ParseNumber(time);
    if (word == "begin" && number) span = {*number, 0};
    if (word == "end" && number && span.began > 0) span.ended = *number;
  }
  return span.ended > span.began && span.began > 0 ? std::optional(span) : std::nullopt;
}

std::optional<double> MeanWait_s(std::vector<JobSpan> jobs) {
  // Assigns the jobs to as many processors as there were simultaneous jobs. Each job except the first on its
  // processor begins after the end of another job. For the mean it does not matter which one.
  std::ranges::sort(jobs, {}, &JobSpan::began);
  std::vector<double> ends;
  ends.reserve(jobs.size());
  for (const JobSpan& job : jobs) ends.push_back(job.ended);
  std::ranges::sort(ends);
  size_t used = 0;
  double waited = 0;
  for (const JobSpan& job : jobs) {
    if (used < ends.size() && ends[used] <= job.began) waited += job.began - ends[used++];
  }
  return used == 0 ? std::nullopt : std::optional(waited / static_cast<double>(used));
}

std::vector<JobSpan> ReadJobSpans(const std::string& array_folder, int64_t jobs) {
  std::vector<JobSpan> spans;
  for (int64_t job = 0; job < std::min<int64_t>(jobs, 500); ++job) {
    const std::string log = ReadSmallFile(array_folder + "/log/" + std::to_string(job)).value_or("");
    if (const auto span = ParseJobSpan(log)) spans.push_back(*span);
  }
  return spans;
}

}  // namespace hydro::batch
