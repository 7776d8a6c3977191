#include "batch/run/case_runner.h"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "base/utf8.h"
#include "base/word_list.h"
#include "batch/run/case_command.h"
#include "batch/run/case_result.h"
#include "batch/store/small_file.h"
#include "process/process_end.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;

// The last line of a file that is not blank. The file may be long.
std::string LastLine(const std::string& path) {
  constexpr size_t kMost = 300;
  const std::string text = ReadSmallFile(path).value_or("");
  size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const size_t begin = text.find_last_of('\n', end);
  const size_t start = begin == std::string::npos ? 0 : begin + 1;
  const std::string line = Trimmed(text.substr(start, end + 1 - start));
  return Printable(line.size() > kMost ? std::string(FirstBytes(line, kMost)) + "..." : line);
}

// Makes the text the same on every machine.
std::string WithoutPath(std::string text, const std::string& path, const std::string& name) {
  for (size_t place = text.find(path); place != std::string::npos;
       place = text.find(path, place + name.size()))
    text.replace(place, path.size(), name);
  return text;
}

// Whether the reason is a full disk. The test is needed because the disk may have room again after a program
// has removed what it had written.
bool TellsOfFullDisk(const std::string& reason) {
  return reason.find(std::strerror(ENOSPC)) != std::string::npos ||
         reason.find(std::strerror(EDQUOT)) != std::string::npos;
}

bool IsFull(const std::string& folder) {
  struct statvfs disk = {};
  if (statvfs(folder.c_str(), &disk) != 0) return false;
  const bool bytes = disk.f_blocks > 0 && disk.f_bavail * disk.f_frsize < 65536;
  return bytes || (disk.f_files > 0 && disk.f_favail == 0);
}

// A user who cancels a job, or a machine that is switched off, ends this process and the case's process at
// the same time. The case's end may be seen first, but it is not a failure of the case.
bool MayBeStopped(const process::ProcessEnd& end) {
  static const bool in_job = std::getenv("SLURM_JOB_ID") != nullptr;
  return in_job || end.signal == SIGTERM || end.signal == SIGINT || end.signal == SIGHUP ||
         end.signal == SIGKILL;
}
constexpr std::chrono::milliseconds kStopFollows{300};

}  // namespace

CaseRunner::CaseRunner(const Study& study, const CaseInputs& case_inputs, std::string inputs,
                       std::string scratch)
    : study_(study),
      case_inputs_(case_inputs),
      keys_(study.Keys()),
      inputs_(std::move(inputs)),
      scratch_(std::move(scratch)),
      folder_(scratch_ + "/case") {
  for (const Step& step : study.steps) {
    const std::string& name = step.argv.front();
    programs_.push_back(name.find_first_of("/{") == std::string::npos ? ProgramPath(name) : "");
  }
  if (mkdir(scratch_.c_str(), 0700) != 0) ThrowCannotWrite(scratch_);
}

CaseRunner::~CaseRunner() {
  std::error_code ignored;
  fs::remove_all(scratch_, ignored);
}

void CaseRunner::Empty() const {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_, failed)) {
    if (unlink(entry.path().c_str()) != 0) fs::remove_all(entry.path(), failed);
  }
  if (mkdir(folder_.c_str(), 0700) != 0 && errno != EEXIST) ThrowCannotWrite(folder_);
}

void CaseRunner::Prepare(const std::vector<Value>& values) const {
  Empty();
  if (!study_.config_text.empty()) WriteSmallFile(folder_ + "/config.toml", case_inputs_.Config(values));
  if (!study_.model_text.empty()) WriteSmallFile(folder_ + "/model.toml", case_inputs_.Model(values));
  if (const std::string machine = case_inputs_.Machine(values); !machine.empty())
    WriteSmallFile(folder_ + "/machine.toml", machine);
  // With this link, commands and configurations name files in the same way wherever they run.
  if (symlink(inputs_.c_str(), (folder_ + "/inputs").c_str()) != 0) ThrowCannotWrite(folder_);
}

std::optional<std::string> CaseRunner::RunStep(size_t step, int64_t index, const std::vector<Value>& values,
                                               const ChildRequest& timing, const StopBell& bell) {
  ChildRequest request = timing;
  const std::string number = std::to_string(step + 1);
  request.argv = CaseCommand(study_.steps[step], keys_, values, {index, folder_, inputs_});
  const std::string name = fs::path(request.argv[0]).filename();
  request.argv[0] = programs_[step].empty() ? ProgramPath(request.argv[0]) : programs_[step];
  request.folder = folder_;
  request.out = folder_ + "/step" + number + ".out";
  request.err = folder_ + "/step" + number + ".err";
  ChildResult ended;
  try {
    ended = RunChild(request, bell);
  } catch (const process::StartError& error) {
    return "step " + number + ": " + error.what();
  }
  if (ended.end == ChildEnd::kStopped) return std::nullopt;
  std::string reason = "step " + number + ": ";
  if (ended.end == ChildEnd::kLate)
    return reason + name + ": not done after " + ShortestNumber(study_.timeout_s) + " s";
  const process::ProcessEnd end = process::EndOf(ended.wait_status);
  const std::vector<int>& good = study_.steps[step].exit_codes;
  exit_codes_.push_back(end.exit_code);
  if (end.signal == 0 && std::find(good.begin(), good.end(), end.exit_code) != good.end()) return "";
  if (MayBeStopped(end) && bell.RingsWithin(kStopFollows)) return std::nullopt;
  reason += process::DescribeEnd(name, end);
  const std::string line = LastLine(request.err);
  return line.empty() ? reason : reason + ": " + line;
}

std::optional<std::string> CaseRunner::Attempt(int64_t index, const std::vector<Value>& values,
                                               const StopBell& bell) {
  ChildRequest timing;
  if (study_.timeout_s > 0) {
    timing.deadline = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                                             std::chrono::duration<double>(study_.timeout_s));
  }
  exit_codes_.clear();
  try {
    Prepare(values);
    for (size_t step = 0; step < study_.steps.size(); ++step) {
      auto reason = RunStep(step, index, values, timing, bell);
      if (!reason || !reason->empty()) return reason;
    }
    result_.numbers = CollectNumbers(study_, folder_, exit_codes_);
    for (const std::string& file : study_.keep) {
      if (!fs::is_regular_file(folder_ + "/" + file))
        return file + ": not written, allowed a file that the study keeps";
    }
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void CaseRunner::CheckDisk(const std::string& reason) const {
  if (TellsOfFullDisk(reason) || IsFull(folder_))
    throw StoreError(scratch_ + ": the disk is full: " + reason);
}

std::optional<CaseResult> CaseRunner::Run(int64_t index, const StopBell& bell) {
  const std::vector<Value> values = study_.Values(index);
  for (int attempt = 1;; ++attempt) {
    result_ = {};
    result_.attempts = attempt;
    const auto reason = Attempt(index, values, bell);
    if (!reason) return std::nullopt;
    if (reason->empty()) return result_;
    CheckDisk(*reason);
    if (attempt <= study_.retries) continue;
    result_.failed = true;
    result_.numbers.assign(study_.collect.size(), std::nullopt);
    result_.reason = WithoutPath(WithoutPath(*reason, folder_, "."), inputs_, "inputs");
    return result_;
  }
}

std::vector<KeptFile> CaseRunner::Kept() const {
  std::vector<KeptFile> files;
  std::error_code ignored;
  for (const std::string& file : study_.keep) {
    const std::string path = folder_ + "/" + file;
    if (fs::is_regular_file(path, ignored)) files.push_back({path, file});
  }
  return files;
}

}  // namespace hydro::batch
