#include "scope/cut_out.h"

#include <map>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/units.h"
#include "log/log_reader.h"
#include "log/log_writer.h"
#include "runs/run_log.h"
#include "runs/run_table.h"
#include "scope/signals/cut_window.h"

namespace hydro::scope {
namespace {

// The columns of pressures, which alone have another unit in SI.
void ToSi(tables::Table* table) {
  constexpr std::string_view kPaper = "_psi";
  const auto si = FindSiUnit("psi", 1000);
  if (!si) return;
  for (tables::Column& column : table->columns) {
    if (!column.name.ends_with(kPaper)) continue;
    column.name.replace(column.name.size() - kPaper.size() + 1, std::string::npos, si->to);
    for (double& value : column.values) value *= si->factor;
  }
}

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
  tables::Table table =
      runs::ExportRun(runs::ReadRunLog(log_file, source.suffix, runs::Undecodable::kLeftOut));
  if (si) ToSi(&table);
  tables::WriteCsv(table, table_file);
}

}  // namespace hydro::scope
