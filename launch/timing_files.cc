#include "launch/timing_files.h"

#include "base/input_error.h"
#include "base/new_file.h"
#include "runs/timing/timing_report.h"

namespace hydro::launch {
namespace {

constexpr char kEnding[] = ".json";

}  // namespace

TimingFiles::TimingFiles(const std::string& json) : json_(json) {
  if (!json.ends_with(kEnding) || json.size() == sizeof kEnding - 1) {
    throw InputError("--timing: found " + json + ", allowed is a name that ends in .json");
  }
  page_ = json.substr(0, json.size() - (sizeof kEnding - 1)) + ".html";
  CheckCanBeCreated(json_);
  CheckCanBeCreated(page_);
}

void TimingFiles::Write(const std::vector<timing::TimedProcess>& processes, const std::string& source) const {
  WriteWholeFile(json_, timing::TimingJson(processes, source), Existing::kKept);
  WriteWholeFile(page_, timing::TimingPage(processes, source), Existing::kKept);
}

}  // namespace hydro::launch
