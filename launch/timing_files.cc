#include "launch/timing_files.h"

#include "base/input_error.h"
#include "base/new_file.h"
#include "timing/report/timing_report.h"

namespace hydro::launch {
namespace {

constexpr char kEnding[] = ".json";

void WriteText(const std::string& name, const std::string& text) {
  NewFile file(name, Opening::kTemporary);
  file.Write(text.data(), text.size());
  file.Finish();
}

}  // namespace

TimingFiles::TimingFiles(const std::string& json) : json_(json) {
  if (!json.ends_with(kEnding) || json.size() == sizeof kEnding - 1) {
    throw InputError("--timing: found " + json + ", allowed is a name that ends in .json");
  }
  page_ = json.substr(0, json.size() - (sizeof kEnding - 1)) + ".html";
  // Opened and abandoned: only whether they can be opened matters.
  const NewFile json_file(json_, Opening::kTemporary);
  const NewFile page_file(page_, Opening::kTemporary);
}

void TimingFiles::Write(const std::vector<timing::TimedProcess>& processes, const std::string& source) const {
  WriteText(json_, timing::TimingJson(processes, source));
  WriteText(page_, timing::TimingPage(processes, source));
}

}  // namespace hydro::launch
