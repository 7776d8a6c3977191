#include "launch/terminal_report.h"

namespace hydro::launch {

TerminalReport::TerminalReport(LabelledOutput& output, const settings::StackConfig& config,
                               const LaunchPlan& plan)
    : output_(output), config_(config) {
  if (!plan.timing_file.empty()) timing_files_.emplace(plan.timing_file);
  output_.AnnounceLabel(kLabel);
  for (const ChildSpec& child : plan.children) output_.AnnounceLabel(child.label);
}

std::string TerminalReport::WriteTiming(const timing::TimingRecord& record) {
  if (!timing_files_) return "";
  timing_files_->Write(record.Processes(), config_.file);
  return "timing in " + timing_files_->json() + " and " + timing_files_->page();
}

}  // namespace hydro::launch
