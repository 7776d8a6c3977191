#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "timing/report/histogram_plot.h"
#include "timing/report/timing_report.h"

namespace hydro::timing {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1c2733; --soft: #5d6b7a; --line: #d5dbe2; --paper: #ffffff; --bar: #3572a5;
  --c0: #3572a5; --c1: #c06c1f; --c2: #a33a4b; --bad: #a33a4b; }
@media (prefers-color-scheme: dark) { :root { --ink: #e3e9ef; --soft: #9aa8b6; --line: #3a4552; --paper: #151b22;
  --bar: #6ba4d6; --c0: #6ba4d6; --c1: #e0954d; --c2: #e0788a; --bad: #e0788a; } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); max-width: 1380px;
  margin: 2em auto; padding: 0 1.2em; }
h1 { font-size: 1.5em; margin-bottom: 0; } h2 { font-size: 1.15em; margin: 2em 0 .3em; }
p { color: var(--soft); margin: .2em 0 1em; max-width: 60em; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { font-weight: 600; } td:first-child, th:first-child { text-align: left; padding-left: 0; } .bad { color: var(--bad); font-weight: 600; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(340px, 1fr)); gap: 1em 1.6em; }
figure { margin: 0; } figcaption { font-size: .9em; } svg { width: 100%; height: auto; display: block; }
.grid { stroke: var(--line); stroke-width: .7; } .axis { stroke: var(--soft); fill: none; }
.tick, .label, .key { font-size: 10.5px; fill: var(--soft); } .bar { fill: var(--bar); }
.mark { stroke: var(--c1); stroke-width: .9; stroke-dasharray: 3 2; } .line { fill: none; stroke-width: 1.4; }
path.c0 { stroke: var(--c0); } path.c1 { stroke: var(--c1); } path.c2 { stroke: var(--c2); }
text.c0 { fill: var(--c0); } text.c1 { fill: var(--c1); } text.c2 { fill: var(--c2); }
)";

std::string CountCell(int64_t count) {
  return fmt::format("<td{}>{}</td>", count > 0 ? " class=\"bad\"" : "", count);
}

std::string TimeCells(const TimedProcess& process, const std::string& quantity, double p50, double p99,
                      double highest) {
  const auto found = process.histograms.find(quantity);
  if (found != process.histograms.end()) {
    p50 = 1e-3 * found->second.Percentile(50);
    p99 = 1e-3 * found->second.Percentile(99);
    highest = 1e-3 * static_cast<double>(found->second.highest);
  }
  if (!(highest > 0)) return "<td></td><td></td><td></td>";
  return fmt::format("<td>{:.1f}</td><td>{:.1f}</td><td>{:.1f}</td>", p50, p99, highest);
}

std::string Table(const std::vector<TimedProcess>& processes) {
  std::string html =
      "<div class=\"scroll\"><table><tr><th>process</th><th>host</th><th>cycles</th><th "
      "colspan=\"3\">period, us (p50, p99, max)</th>"
      "<th colspan=\"3\">latency, us (p50, p99, max)</th><th colspan=\"3\">round trip, us (p50, p99, "
      "max)</th>"
      "<th>missed</th><th>lost</th><th>most waiting</th></tr>\n";
  for (const TimedProcess& process : processes) {
    const loop_statistics_t& total = process.total;
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td>", EscapeHtml(process.role),
                        EscapeHtml(process.host), total.cycles);
    html += TimeCells(process, "period", total.period_p50_us, total.period_p99_us, total.period_max_us);
    html += TimeCells(process, "latency", total.latency_p50_us, total.latency_p99_us, total.latency_max_us);
    html += TimeCells(process, "round_trip", 0, 0, 0);
    html += CountCell(total.missed_deadlines) + CountCell(total.lost_messages);
    html += fmt::format("<td>{}</td></tr>\n", total.queue_depth);
  }
  return html + "</table></div>\n";
}

std::string Plot(const std::string& svg, const std::string& caption) {
  return svg.empty() ? ""
                     : "<figure>\n" + svg + "<figcaption>" + EscapeHtml(caption) + "</figcaption></figure>\n";
}

std::vector<double> Values(const TimedProcess& process,
                           const std::function<double(const loop_statistics_t&)>& value) {
  std::vector<double> values;
  for (const loop_statistics_t& report : process.reports) values.push_back(value(report));
  return values;
}

std::string OverTime(const TimedProcess& process, double begin_utime) {
  const auto times = Values(process, [&](const loop_statistics_t& r) {
    return 1e-6 * (static_cast<double>(r.utime) - begin_utime);
  });
  const auto of = [&](double loop_statistics_t::*member) {
    return Values(process, [&](const loop_statistics_t& r) { return r.*member; });
  };
  const auto count = [&](int64_t loop_statistics_t::*member) {
    return Values(process, [&](const loop_statistics_t& r) { return static_cast<double>(r.*member); });
  };
  using S = loop_statistics_t;
  return Plot(TimeSvg(times,
                      {{"p50", of(&S::period_p50_us)},
                       {"p99", of(&S::period_p99_us)},
                       {"max", of(&S::period_max_us)}},
                      "period, us"),
              "Period, second by second.") +
         Plot(TimeSvg(times,
                      {{"p50", of(&S::latency_p50_us)},
                       {"p99", of(&S::latency_p99_us)},
                       {"max", of(&S::latency_max_us)}},
                      "latency, us"),
              std::string("Latency (") + MeaningOfLatency(process.role) + "), second by second.") +
         Plot(TimeSvg(times,
                      {{"missed", count(&S::missed_deadlines)},
                       {"lost", count(&S::lost_messages)},
                       {"waiting", count(&S::queue_depth)}},
                      "count"),
              "Missed deadlines, lost messages and the most messages that waited, each second.");
}

std::string Section(const TimedProcess& process, double begin_utime) {
  std::string html =
      fmt::format("<h2>{} on {}</h2>\n<p>{} cycles in {:.3f} s.{}</p>\n<div class=\"plots\">\n",
                  EscapeHtml(process.role), EscapeHtml(process.host), process.total.cycles,
                  process.total.interval_s, process.complete ? "" : " It ended without its last report.");
  const auto histogram = [&](const char* quantity, double scale, const char* label,
                             const std::string& caption) {
    const auto found = process.histograms.find(quantity);
    if (found != process.histograms.end()) html += Plot(HistogramSvg(found->second, scale, label), caption);
  };
  histogram("period", 1e-3, "period, us", "Period: time between two runs of the loop.");
  histogram("latency", 1e-3, "latency, us", std::string("Latency: ") + MeaningOfLatency(process.role) + ".");
  histogram("round_trip", 1e-3, "round trip, us",
            "Round trip: a state sent to its command's arrival, on this process's own clock.");
  histogram("queue_depth", 1, "messages",
            process.role == "logger" ? "Queue depth: messages that waited to be written."
                                     : "Queue depth: messages handled in one go.");
  histogram("gap", 1, "messages in a row", "Gaps: messages missing in a row.");
  histogram("skipped", 1, "deadlines in a row", "Skipped: deadlines missed in a row.");
  return html + OverTime(process, begin_utime) + "</div>\n";
}

}  // namespace

std::string TimingPage(const std::vector<TimedProcess>& processes, const std::string& source) {
  double begin = std::numeric_limits<double>::infinity();
  for (const TimedProcess& process : processes) {
    for (const loop_statistics_t& report : process.reports) {
      begin = std::min(begin, static_cast<double>(report.utime) - 1e6 * report.interval_s);
    }
  }
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Timing of "
      "{0}</title><style>{1}</style></head><body>\n<h1>Timing</h1>\n<p>{0}</p>\n",
      EscapeHtml(source), kStyle);
  if (processes.empty()) html += "<p>No process reported how it kept time.</p>\n";
  if (!processes.empty()) html += Table(processes);
  for (const TimedProcess& process : processes) html += Section(process, begin);
  return html + "</body></html>\n";
}

}  // namespace hydro::timing
