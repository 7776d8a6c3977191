#include "batch/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <vector>

#include "base/number_text.h"
#include "base/text_file.h"
#include "batch/run/case_progress.h"
#include "batch/store/case_store.h"
#include "batch/store/small_file.h"
#include "batch/store/study_lock.h"
#include "batch/study_folder.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;

constexpr double kWindow = 60;  // s

// Adds the times, in seconds since 1970, at which the cases in a file of times ended. The last line may be
// only half written.
void AddEnds(const std::string& text, std::vector<double>* ends) {
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = text.find('\n', begin);
    if (end == std::string::npos) return;
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    const size_t last = line.rfind(','), before = line.rfind(',', last - 1);
    if (last == std::string_view::npos || before == std::string_view::npos) continue;
    const auto began = ParseNumber(line.substr(before + 1, last - before - 1));
    const auto seconds = ParseNumber(line.substr(last + 1));
    if (began && seconds) ends->push_back(*began + *seconds);
  }
}

void AddTimes(const std::string& folder, StudyStatus* status) {
  std::vector<double> ends;
  const double now = WallClock();
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder + "/times", failed)) {
    const size_t before = ends.size();
    AddEnds(ReadSmallFile(entry.path()).value_or(""), &ends);
    if (ends.size() > before &&
        *std::max_element(ends.begin() + static_cast<long>(before), ends.end()) > now - kWindow)
      ++status->active;
  }
  if (ends.empty()) return;
  const double last = *std::ranges::max_element(ends);
  status->last_case_s = std::max(0.0, now - last);
  const auto recent = std::ranges::count_if(ends, [&](double end) { return end > last - kWindow; });
  const double first = *std::ranges::min_element(ends);
  const double span = std::min(kWindow, last - first);
  if (span > 0) status->rate = static_cast<double>(recent) / span;
}

}  // namespace

std::string DurationText(double seconds) {
  const int64_t whole = std::llround(std::max(0.0, seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  if (whole < 48 * 3600) return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
  return fmt::format("{} days {} h", whole / 86400, whole / 3600 % 24);
}

StudyStatus ReadStatus(const std::string& folder) {
  const Study study = OpenStudy(folder);
  StudyStatus status;
  status.name = study.name;
  status.cases = study.cases();
  const CaseCount count = CountCases(CaseStore(folder), 0, status.cases);
  status.done = count.done;
  status.failed = count.failed;
  LockHolder holder;
  if (StudyLock::Holder(folder, &holder) && !holder.gone)
    status.driver = fmt::format("process {} on {}", holder.pid, holder.host);
  AddTimes(folder, &status);
  return status;
}

std::string StatusText(const StudyStatus& status) {
  const double percent = std::floor(1000 * static_cast<double>(status.done + status.failed) /
                                    static_cast<double>(status.cases)) /
                         10;
  std::string text = fmt::format("{}: {} cases: {} done, {} failed, {} missing ({:.3g} %)\n", status.name,
                                 status.cases, status.done, status.failed, status.missing(), percent);
  if (!status.driver.empty()) text += fmt::format("driven by {}\n", status.driver);
  const bool runs = !status.driver.empty() || status.active > 0;
  if (status.missing() == 0) return text;
  if (!runs) return text + "nobody runs it; hydro-batch with the same --out goes on\n";
  if (status.last_case_s < 0) return text + "no case has ended yet\n";
  text += fmt::format("{} process{} ran cases within the last minute, the last case ended {} ago",
                      status.active, status.active == 1 ? "" : "es", DurationText(status.last_case_s));
  if (status.rate > 0) {
    text += fmt::format("; {:.3g} cases/s, about {} left", status.rate,
                        DurationText(static_cast<double>(status.missing()) / status.rate));
  }
  return text + "\n";
}

constexpr double kPeriod = 60;  // s

Progress::Progress(std::FILE* out, bool terminal, int64_t total, int64_t there)
    : out_(out), terminal_(terminal), total_(total), there_(there), line_(out) {}

std::string ProgressText(const RunProgress& progress, int64_t total, int64_t there) {
  std::string text = fmt::format("{} of {} cases", there + progress.ran, total);
  if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
  if (progress.ran == 0 || progress.elapsed_s <= 0) return text;
  const double each = progress.elapsed_s / static_cast<double>(progress.ran);
  return text + ", " + DurationText(each * static_cast<double>(progress.to_run - progress.ran)) + " left";
}

void Progress::Say(const std::string& text) {
  line_.Wipe();
  std::fprintf(out_, "hydro-batch: %s\n", Printable(text).c_str());
  std::fflush(out_);
}

void Progress::Show(const RunProgress& progress, const std::string& more) {
  const std::string text = ProgressText(progress, total_, there_) + more;
  if (terminal_) {
    line_.Draw(static_cast<double>(there_ + progress.ran) / static_cast<double>(total_), text);
  } else if (progress.elapsed_s - told_s_ >= kPeriod) {
    told_s_ = progress.elapsed_s;
    std::fprintf(out_, "%s\n", text.c_str());
    std::fflush(out_);
  }
}

}  // namespace hydro::batch
