#include <spdlog/fmt/fmt.h>

#include "runs/timing/timing_report.h"

namespace hydro::timing {
namespace {

std::string HistogramLine(const char* name, const char* unit, const TimingHistogram& histogram,
                          double scale) {
  return fmt::format("  {:<12}{:>9}{:>11.1f}{:>11.1f}{:>11.1f}{:>11.1f}{:>12}\n", name, histogram.count,
                     scale * histogram.Percentile(50), scale * histogram.Percentile(99),
                     scale * histogram.Percentile(99.9), scale * static_cast<double>(histogram.highest),
                     unit);
}

// Share of the ticks. Late wake-ups on a desktop computer stay below it.
constexpr double kFewSkipped = 0.01;
constexpr int64_t kVeryFewSkipped = 10;

}  // namespace

bool ManySkipped(int64_t skipped, int64_t ticks) {
  return skipped >= kVeryFewSkipped &&
         static_cast<double>(skipped) >= kFewSkipped * static_cast<double>(ticks);
}

std::string SkippedTicksAdvice(int64_t skipped, int64_t ticks, const std::string& config) {
  if (!ManySkipped(skipped, ticks)) return "";
  const double share = static_cast<double>(skipped) / static_cast<double>(ticks);
  return fmt::format(
      "{} of {} ticks ({:.0f} %) were skipped, because this machine woke the process too late: what was "
      "recorded is not the loop at its rate. `hydro-launch doctor {}` measures how it wakes now, and "
      "examines "
      "its settings; other programs may have kept it busy; a lower plant.rate_hz asks less; with a simulated "
      "plant, --time lockstep skips "
      "nothing",
      skipped, ticks, 100 * share, config);
}

std::string TimingText(const std::vector<TimedProcess>& processes) {
  if (processes.empty()) return "no process reported how it kept time\n";
  std::string text;
  for (const TimedProcess& process : processes) {
    const loop_statistics_t& total = process.total;
    if (process.histograms.empty() && total.cycles == 0) {  // hydro-sim's loops only step
      text += fmt::format("{} on {}: no timing was measured: a simulation, or no cycle of this loop\n",
                          process.role, process.host);
      continue;
    }
    text += fmt::format(
        "{} on {}: {} cycles in {:.3f} s, {} deadlines missed, {} messages lost, at most {} waited{}\n",
        process.role, process.host, total.cycles, total.interval_s, total.missed_deadlines,
        total.lost_messages, total.queue_depth, process.complete ? "" : " (ended without a last report)");
    if (process.histograms.empty()) {
      text += fmt::format("  {:<12}{:>9}{:>11.1f}{:>11.1f}{:>11.1f}{:>11.1f}{:>12}\n", "period", "",
                          total.period_p50_us, total.period_p99_us, total.period_p999_us, total.period_max_us,
                          "us");
      text += fmt::format("  {:<12}{:>9}{:>11.1f}{:>11.1f}{:>11.1f}{:>11.1f}{:>12}\n", "latency", "",
                          total.latency_p50_us, total.latency_p99_us, total.latency_p999_us,
                          total.latency_max_us, "us");
      continue;
    }
    text += fmt::format("  {:<12}{:>9}{:>11}{:>11}{:>11}{:>11}\n", "", "count", "p50", "p99", "p99.9", "max");
    const auto line = [&](const char* quantity, const char* unit, double scale) {
      const auto found = process.histograms.find(quantity);
      if (found != process.histograms.end()) text += HistogramLine(quantity, unit, found->second, scale);
    };
    line("period", "us", 1e-3);
    line("latency", "us", 1e-3);
    line("round_trip", "us", 1e-3);
    line("queue_depth", "messages", 1);
    line("gap", "messages", 1);
    line("skipped", "ticks", 1);
  }
  return text;
}

}  // namespace hydro::timing
