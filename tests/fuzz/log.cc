#include <spdlog/spdlog.h>

#include <string>

#include "hydro_log/replay.h"
#include "log/log_reader.h"
#include "log/repair.h"
#include "runs/compare.h"
#include "runs/info.h"
#include "runs/measured_run.h"
#include "runs/run_log.h"
#include "runs/run_table.h"
#include "runs/tracking.h"
#include "tables/table.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {
namespace {

int64_t CountEvents(const std::string& file) {
  log::LogReader reader(file);
  log::LogEvent event;
  int64_t count = 0;
  while (reader.Next(event)) ++count;
  return count;
}

void ReadAsARun(const std::string& file, const ScratchFolder& folder) {
  runs::RunLog log, strict;
  const bool accepted =
      Accepts([&] { log = runs::ReadRunLog(file, std::nullopt, runs::Undecodable::kLeftOut); });
  if (Accepts([&] { strict = runs::ReadRunLog(file); })) {
    Promise(accepted, "who leaves messages out takes what the strict take");
  }
  if (!accepted) return;
  Accepts([&] {
    const runs::LogInfo info = runs::Summarise(log, true);
    Promise(!runs::InfoText(info).empty() && !runs::InfoJson(info).empty(), "info says something");
    const runs::Tracking tracking = runs::TrackArm(log);
    Promise(!runs::SummaryText(tracking, info, true).empty(), "a summary says something");
    runs::SummaryJson(tracking, info);
  });
  Promise(!runs::FirstDifference(log.messages, "a", log.messages, "b").has_value(),
          "a log is identical to itself");
  Accepts([&] {
    const ::hydro::tables::Table table = runs::ExportRun(log);
    tables::WriteTable(table, folder.Path("export.csv"));
    Promise(tables::ReadTable(folder.Path("export.csv")).rows() == table.rows(), "an export can be read");
    runs::ImportRun(table, "fuzz", folder.Path("import.log"));
    CountEvents(folder.Path("import.log"));
  });
  Accepts([&] { hydro_log::Replay(log, hydro_log::ReplayedController::kPressure, 0); });
  Accepts([&] { hydro_log::Replay(log, hydro_log::ReplayedController::kPosition, 0); });
}

}  // namespace

void Log(const uint8_t* data, size_t size) {
  spdlog::set_level(spdlog::level::off);
  static const ScratchFolder folder;
  const std::string file = folder.Write("log", Text(data, size));
  const bool whole = Accepts([&] { CountEvents(file); });
  ReadAsARun(file, folder);
  Accepts([&] { runs::ReadMeasuredRun(file); });
  Accepts([&] {
    const std::string repaired = folder.Path("repaired");
    const log::RepairResult result = log::RepairLog(file, repaired);
    Promise(CountEvents(repaired) == result.kept_events, "a repaired log is whole");
    Promise(!log::Describe(result, file).empty(), "a repair is described");
    int64_t lost = 0;
    for (const log::LostBytes& bytes : result.lost) lost += bytes.end - bytes.begin;
    Promise(lost + result.kept_bytes == static_cast<int64_t>(size), "every byte is kept or lost");
    Promise(whole || !result.lost.empty(), "a damaged log loses something");
  });
}

}  // namespace hydro::fuzz
