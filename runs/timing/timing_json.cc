#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "runs/timing/timing_report.h"

namespace hydro::timing {
namespace {

using Json = nlohmann::ordered_json;

bool IsTime(const std::string& quantity) {
  return quantity == "period" || quantity == "latency" || quantity == "round_trip";
}

Json HistogramJson(const TimingHistogram& histogram, double scale) {
  Json json;
  json["count"] = histogram.count;
  json["min"] = scale * static_cast<double>(histogram.lowest);
  json["p50"] = scale * histogram.Percentile(50);
  json["p90"] = scale * histogram.Percentile(90);
  json["p99"] = scale * histogram.Percentile(99);
  json["p99_9"] = scale * histogram.Percentile(99.9);
  json["max"] = scale * static_cast<double>(histogram.highest);
  Json& buckets = json["buckets"] = Json::array();
  for (const TimingHistogram::Range& range : histogram.ranges) {
    buckets.push_back(
        {scale * static_cast<double>(range.first), scale * static_cast<double>(range.last), range.count});
  }
  return json;
}

Json ReportJson(const loop_statistics_t& report) {
  return {{"utime", report.utime},
          {"interval_s", report.interval_s},
          {"cycles", report.cycles},
          {"period_us",
           {{"p50", report.period_p50_us},
            {"p99", report.period_p99_us},
            {"p99_9", report.period_p999_us},
            {"max", report.period_max_us}}},
          {"latency_us",
           {{"p50", report.latency_p50_us},
            {"p99", report.latency_p99_us},
            {"p99_9", report.latency_p999_us},
            {"max", report.latency_max_us}}},
          {"missed_deadlines", report.missed_deadlines},
          {"lost_messages", report.lost_messages},
          {"queue_depth", report.queue_depth}};
}

}  // namespace

std::string TimingJson(const std::vector<TimedProcess>& processes, const std::string& source) {
  Json json;
  json["source"] = source;
  Json& list = json["processes"] = Json::array();
  for (const TimedProcess& process : processes) {
    Json one;
    one["role"] = process.role;
    one["host"] = process.host;
    one["session"] = process.session;
    one["complete"] = process.complete;
    one["latency_is"] = MeaningOfLatency(process.role);
    one["total"] = ReportJson(process.total);
    one["total"].erase("utime");
    Json& histograms = one["histograms"] = Json::object();
    for (const auto& [quantity, histogram] : process.histograms) {
      if (IsTime(quantity)) {
        histograms[quantity + "_us"] = HistogramJson(histogram, 1e-3);
      } else {
        histograms[quantity] = HistogramJson(histogram, 1);
      }
    }
    Json& seconds = one["reports"] = Json::array();
    for (const loop_statistics_t& report : process.reports) seconds.push_back(ReportJson(report));
    list.push_back(std::move(one));
  }
  return JsonText(json, 1) + "\n";
}

}  // namespace hydro::timing
