#include "scope/cut_out.h"

#include <map>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "runs/exports/sheet_units.h"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "scope/signals/cut_window.h"

namespace hydro::scope {
namespace {

struct Held {
  std::vector<uint8_t> data;
  int64_t utime = 0;
};

}  // namespace

CutSource CutSourceOf(const Run& run) {
  CutSource source;
  if (run.messages != nullptr) source.messages = run.messages->Take();
  source.log_file = run.log_file;
  source.name = run.name;
  source.suffix = run.suffix;
  source.session = run.session;
  return source;
}

void CutLog(const CutSource& source, double t0, double t1, const std::string& file) {
  CutWindow window(source.suffix, source.session, t0, t1);
  log::LogWriter writer(file, Opening::kTemporary,
                        "cut out of " + source.name + " by hydro-scope, " + ShortestNumber(t0) + " s to " +
                            ShortestNumber(t1) + " s");
  std::map<std::string, Held> held;
  const auto take = [&](std::string_view channel, const uint8_t* data, size_t size, int64_t utime) {
    if (window.HoldsAhead(channel)) held[std::string(channel)] = {{data, data + size}, utime};
    if (!window.Keeps(channel, data, static_cast<int>(size))) return;
    if (window.states() > 0) {
      for (const auto& [name, message] : held) {
        writer.Append(name, message.data.data(), message.data.size(), message.utime);
      }
      held.clear();
    }
    writer.Append(channel, data, size, utime);
  };
  if (source.messages) {
    source.messages->ForEach(
        [&](const MessageStore::Message& m) { take(m.channel, m.data, m.size, m.utime); });
  } else {
    log::LogReader reader(source.log_file, log::OnDamage::kStop);
    log::LogEvent event;
    while (reader.Next(event)) take(event.channel, event.data, static_cast<size_t>(event.size), event.utime);
  }
  if (window.states() == 0) {
    throw InputError("t0, t1: found no state from " + ShortestNumber(t0) + " s to " + ShortestNumber(t1) +
                     " s, allowed is a window that holds some");
  }
  writer.Finish();
}

void CutTable(const CutSource& source, double t0, double t1, bool si, const std::string& log_file,
              const std::string& table_file) {
  CutLog(source, t0, t1, log_file);
  const runs::RunLog log = runs::ReadRunLog(log_file, {.suffix = source.suffix}, runs::Undecodable::kLeftOut);
  tables::Table table = runs::ExportRun(log);
  const auto& descriptions = log.messages.Of<run_description_t>();
  const UnitSystem units =
      descriptions.empty() ? UnitSystem{} : runs::ModelUnits(descriptions.front(), log_file);
  exports::SetUnits(units, si, &table);
  tables::WriteCsv(table, table_file);
}

}  // namespace hydro::scope
