#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>

#include "base/read_files.h"
#include "base/tables/table.h"
#include "base/text_file.h"
#include "base/utf8.h"
#include "runs/info.h"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "runs/log/repair.h"
#include "runs/measured/measured_run.h"
#include "runs/recorded/compare.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "runs/tracking.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/targets.h"
#include "tools/hydro_log/replay.h"

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
  const bool accepted = Accepts([&] { log = runs::ReadRunLog(file, {}, runs::Undecodable::kLeftOut); });
  if (Accepts([&] { strict = runs::ReadRunLog(file); })) {
    Promise(accepted, "who leaves messages out takes what the strict take");
  }
  if (!accepted) return;
  Accepts([&] {
    const runs::LogInfo info = runs::Summarise(log, true);
    Promise(!runs::InfoText(info).empty() && IsUtf8(runs::InfoJson(info)), "info says something in UTF-8");
    const runs::Tracking tracking = runs::TrackArm(log);
    Promise(!runs::SummaryText(tracking, info, true).empty(), "a summary says something");
    Promise(IsUtf8(runs::SummaryJson(tracking, info)), "a summary's JSON is UTF-8");
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

// The bytes as the data of messages in a log with checksums, of which one byte is then changed: whatever it
// is, the log is not called complete, and what is read of it is its beginning.
void ChangeOneByte(const uint8_t* data, size_t size, const ScratchFolder& folder) {
  if (size < 8) return;
  const std::string file = folder.Path("checked");
  {
    ForgetRead(file);  // each input stands for another process
    log::LogWriter writer(file, Opening::kTemporary);
    for (size_t at = 0; at < size; at += 50)
      writer.Append("FUZZ", data + at, std::min<size_t>(50, size - at), 0);
    writer.Finish();
  }
  const int64_t messages = CountEvents(file);
  std::string bytes = ReadTextFile(file);
  const size_t place =
      (static_cast<size_t>(data[0]) << 16 | static_cast<size_t>(data[1]) << 8 | data[2]) % bytes.size();
  const char change = static_cast<char>(data[3] == 0 ? 1 : data[3]);
  bytes[place] = static_cast<char>(bytes[place] ^ change);
  const std::string changed = folder.Write("changed", bytes);
  try {
    log::LogReader reader(changed, log::OnDamage::kStop);
    Promise(reader.verdict().completeness != log::Completeness::kComplete &&
                reader.verdict().completeness != log::Completeness::kWithoutChecksums,
            "a changed byte is noticed");
    log::LogEvent event;
    int64_t count = 0;
    while (reader.Next(event)) ++count;
    // The mark of the end, its channel changed, is one message more.
    Promise(count <= messages + 1, "no more is read than was written");
  } catch (const InputError&) {
  }
}

}  // namespace

void Log(const uint8_t* data, size_t size) {
  spdlog::set_level(spdlog::level::off);
  static const ScratchFolder folder;
  const std::string file = folder.Write("log", Text(data, size));
  const bool whole = Accepts([&] { CountEvents(file); });
  ChangeOneByte(data, size, folder);
  ReadAsARun(file, folder);
  Accepts([&] { runs::ReadMeasuredRun(file); });
  Accepts([&] {
    const std::string repaired = folder.Path("repaired");
    ForgetRead(repaired);
    const log::RepairResult result = log::RepairLog(file, repaired);
    Promise(CountEvents(repaired) == result.kept_events, "a repaired log is whole");
    Promise(!log::Describe(result, file).empty(), "a repair is described");
    int64_t lost = 0;
    for (const log::LostBytes& bytes : result.lost) lost += bytes.end - bytes.begin;
    Promise(lost + result.kept_bytes + result.check_bytes == static_cast<int64_t>(size),
            "every byte is kept or lost");
    Promise(whole || result.mended(), "a damaged log is mended");
    const log::LogVerdict verdict = log::LogReader(repaired).verdict();
    Promise(verdict.completeness == log::Completeness::kComplete, "a repaired log is complete");
    Promise(!result.mended() || !verdict.note.empty(), "a repaired log says so");
  });
}

}  // namespace hydro::fuzz
