#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/plot.h"
#include "page/typeset.h"
#include "runs/timing/timing_record.h"
#include "runs/timing/timing_report.h"

namespace hydro::timing {
namespace {

// The plots of the timing page.

struct TimeLine {
  std::string name;
  std::vector<double> values;  // as many as times
};

page::Figure SmallFigure(page::Panel panel, const std::string& caption) {
  return {.caption = caption, .panels = {std::move(panel)}, .width = 430, .panel_height = 150};
}

// Counts over values on logarithmic axes, with the percentiles marked. Values are first multiplied by
// `scale`. Empty when there are no values.
std::optional<page::Figure> HistogramFigure(const TimingHistogram& histogram, double scale,
                                            const std::string& x_label, const std::string& caption) {
  if (histogram.ranges.empty()) return std::nullopt;
  // A range ends where the next whole number begins.
  const auto begin = [&](const TimingHistogram::Range& range) {
    return scale * std::max(0.5, static_cast<double>(range.first) - 0.5);
  };
  const auto end = [&](const TimingHistogram::Range& range) {
    return scale * (static_cast<double>(range.last) + 0.5);
  };
  page::Curve bars;
  bars.stroke = page::Stroke::kBars;
  bars.colour = 0;
  double most = 1;
  for (const TimingHistogram::Range& range : histogram.ranges) {
    bars.x.insert(bars.x.end(), {begin(range), end(range)});
    bars.y.insert(bars.y.end(), {static_cast<double>(range.count), std::nan("")});
    most = std::max(most, static_cast<double>(range.count));
  }
  const double low = bars.x.front();
  page::Panel panel;
  panel.x = {.label = x_label, .logarithmic = true, .min = low / 1.1, .max = bars.x.back() * 1.1};
  panel.y = {.label = "count", .logarithmic = true, .min = 0.5, .max = most * 1.5};
  panel.curves = {bars};
  for (const auto& [percent, name] :
       {std::pair{50.0, "p50"}, {99.0, "p99"}, {99.9, "p99.9"}, {100.0, "max"}}) {
    panel.rules.push_back({name, true, std::max(scale * histogram.Percentile(percent), low)});
  }
  return SmallFigure(std::move(panel), caption);
}

// Values over time, one curve for each line. The scale is logarithmic when all values are above 0 and span
// more than a factor of 30. Empty when there are no values.
std::optional<page::Figure> TimeFigure(const std::vector<double>& times_s, const std::vector<TimeLine>& lines,
                                       const std::string& y_label, const std::string& caption) {
  page::Range values;
  for (const TimeLine& line : lines) values.Include(line.values);
  if (times_s.empty() || values.empty()) return std::nullopt;
  page::Panel panel;
  panel.x = {
      .label = "time, s", .min = std::min(0.0, times_s.front()), .max = std::max(times_s.back(), 1e-3)};
  panel.y.label = y_label;
  if (values.low > 0 && values.high > 30 * values.low) {
    panel.y.logarithmic = true;
  } else {
    panel.y.min = std::min(0.0, values.low);
    panel.y.max = values.high > 0 ? 1.1 * values.high : 1;
  }
  for (size_t i = 0; i < lines.size(); ++i) {
    const page::Stroke stroke = times_s.size() == 1 ? page::Stroke::kPoints : page::Stroke::kLine;
    panel.curves.push_back(page::Line(lines[i].name, times_s, lines[i].values, static_cast<int>(i), stroke));
  }
  return SmallFigure(std::move(panel), caption);
}

using page::EscapeMarkup;

// A table cell with its label, which a phone shows in place of the table's head.
std::string Cell(const std::string& label, const std::string& text, const char* look = "number") {
  return fmt::format("<td class=\"{}\" data-label=\"{}\">{}</td>", look, label, EscapeMarkup(text));
}

std::string CountCell(const char* label, int64_t count) {
  return Cell(label, std::to_string(count), count > 0 ? "number bad" : "number");
}

std::string TimeCells(const TimedProcess& process, const std::string& quantity, const std::string& label,
                      double p50, double p99, double highest) {
  const auto found = process.histograms.find(quantity);
  if (found != process.histograms.end()) {
    p50 = 1e-3 * found->second.Percentile(50);
    p99 = 1e-3 * found->second.Percentile(99);
    highest = 1e-3 * static_cast<double>(found->second.highest);
  }
  if (!(highest > 0)) return "<td></td><td></td><td></td>";
  return Cell(label + " p50, us", fmt::format("{:.1f}", p50)) +
         Cell(label + " p99, us", fmt::format("{:.1f}", p99)) +
         Cell(label + " max, us", fmt::format("{:.1f}", highest));
}

std::string TableHead() {
  std::string groups =
      "<th rowspan=\"2\">process</th><th rowspan=\"2\">host</th><th rowspan=\"2\" "
      "class=\"number\">cycles</th>";
  std::string percentiles;
  for (const char* quantity : {"period, us", "latency, us", "round trip, us"}) {
    groups += fmt::format("<th class=\"group\" colspan=\"3\">{}</th>", quantity);
    for (const char* name : {"p50", "p99", "max"})
      percentiles += fmt::format("<th class=\"number\">{}</th>", name);
  }
  for (const char* count : {"missed", "lost", "waiting"}) {
    groups += fmt::format("<th rowspan=\"2\" class=\"number\">{}</th>", count);
  }
  return "<thead><tr>" + groups + "</tr>\n<tr>" + percentiles + "</tr></thead>\n";
}

std::string Table(const std::vector<TimedProcess>& processes) {
  std::string html = "<div class=\"table\"><table class=\"stacks\">" + TableHead() + "<tbody>\n";
  for (const TimedProcess& process : processes) {
    const loop_statistics_t& total = process.total;
    html += "<tr>" + Cell("process", process.role, "") + Cell("host", process.host, "") +
            Cell("cycles", std::to_string(total.cycles));
    html +=
        TimeCells(process, "period", "period", total.period_p50_us, total.period_p99_us, total.period_max_us);
    html += TimeCells(process, "latency", "latency", total.latency_p50_us, total.latency_p99_us,
                      total.latency_max_us);
    html += TimeCells(process, "round_trip", "round trip", 0, 0, 0);
    html += CountCell("missed", total.missed_deadlines) + CountCell("lost", total.lost_messages) +
            Cell("waiting", std::to_string(total.queue_depth)) + "</tr>\n";
  }
  return html +
         "</tbody></table></div>\n<p class=\"meta\">missed: deadlines; lost: messages; waiting: the most "
         "messages "
         "that waited at a time.</p>\n";
}

std::string Plot(const std::optional<page::Figure>& figure, const TimedProcess& process) {
  return figure ? page::HtmlFigure(*figure, process.role) : "";
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
  const auto plot = [&](const std::vector<TimeLine>& lines, const char* y_label, const std::string& caption) {
    return Plot(TimeFigure(times, lines, y_label, caption), process);
  };
  using S = loop_statistics_t;
  return plot(
             {{"p50", of(&S::period_p50_us)}, {"p99", of(&S::period_p99_us)}, {"max", of(&S::period_max_us)}},
             "period, us", "Period, second by second.") +
         plot({{"p50", of(&S::latency_p50_us)},
               {"p99", of(&S::latency_p99_us)},
               {"max", of(&S::latency_max_us)}},
              "latency, us",
              std::string("Latency (") + MeaningOfLatency(process.role) + "), second by second.") +
         plot({{"missed", count(&S::missed_deadlines)},
               {"lost", count(&S::lost_messages)},
               {"waiting", count(&S::queue_depth)}},
              "count", "Missed deadlines, lost messages and the most messages that waited, each second.");
}

std::string Section(const TimedProcess& process, double begin_utime) {
  std::string html = fmt::format(
      "<h2>{} on {}</h2>\n<p class=\"meta\">{} cycles in {:.3f} s.{}</p>\n<div class=\"plots\">\n",
      EscapeMarkup(process.role), EscapeMarkup(process.host), process.total.cycles, process.total.interval_s,
      process.complete ? "" : " It ended without its last report.");
  const auto histogram = [&](const char* quantity, double scale, const char* label,
                             const std::string& caption) {
    const auto found = process.histograms.find(quantity);
    if (found != process.histograms.end()) {
      html += Plot(HistogramFigure(found->second, scale, label, caption), process);
    }
  };
  histogram("period", 1e-3, "period, us", "Period: time between two runs of the loop.");
  histogram("latency", 1e-3, "latency, us", std::string("Latency: ") + MeaningOfLatency(process.role) + ".");
  histogram(
      "round_trip", 1e-3, "round trip, us",
      "Round trip: from the sending of a state to the arrival of its command, on this process's own clock.");
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
  std::string body = fmt::format("<h1>Timing</h1>\n<p class=\"meta\">{}</p>\n", EscapeMarkup(source));
  body += processes.empty() ? "<p>No process reported how it kept time.</p>\n" : Table(processes);
  for (const TimedProcess& process : processes) body += Section(process, begin);
  return page::HtmlPage("Timing of " + source, body, true);
}

}  // namespace hydro::timing
