#include "batch/report/study_table.h"

#include <algorithm>

#include "base/new_file.h"
#include "base/parallel.h"
#include "batch/store/small_file.h"

namespace hydro::batch {
namespace {

std::string StatusText(CaseStatus status) {
  return status == CaseStatus::kDone ? "done" : status == CaseStatus::kFailed ? "failed" : "missing";
}

std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

// Writes lines to a file, a megabyte at a time.
class Lines {
 public:
  explicit Lines(const std::string& file) : file_(file, Opening::kTemporary) {}
  void Add(const std::string& text) {
    buffer_ += text;
    if (buffer_.size() > (1u << 20)) Flush();
  }
  void Finish() {
    Flush();
    file_.Finish();
  }

 private:
  void Flush() {
    if (!buffer_.empty()) file_.Write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  NewFile file_;
  std::string buffer_;
};

std::string CsvHeader(const Study& study) {
  std::string line = "case,status,attempts";
  for (const std::string& key : study.Keys()) line += "," + CsvCell(key);
  for (const Collected& each : study.collect) line += "," + CsvCell(each.name);
  return line + ",reason\n";
}

std::string CsvLine(const Study& study, const TableRow& row) {
  std::string line = std::to_string(row.index) + "," + StatusText(row.status) + "," +
                     (row.status == CaseStatus::kMissing ? "0" : std::to_string(row.result.attempts));
  for (const Value& value : row.values) line += "," + CsvCell(PlainText(value));
  for (size_t i = 0; i < study.collect.size(); ++i) {
    const bool there = i < row.result.numbers.size() && row.result.numbers[i];
    line += "," + (there ? CsvCell(PlainText(*row.result.numbers[i])) : "");
  }
  return line + "," + CsvCell(row.result.reason) + "\n";
}

std::string JsonHead(const Study& study) {
  std::string text = "{\n  \"name\": " + JsonString(study.name) +
                     ",\n  \"seed\": " + std::to_string(study.seed) +
                     ",\n  \"cases\": " + std::to_string(study.cases()) + ",\n  \"keys\": [";
  const std::vector<std::string> keys = study.Keys();
  for (size_t i = 0; i < keys.size(); ++i) text += (i == 0 ? "" : ", ") + JsonString(keys[i]);
  text += "],\n  \"numbers\": [";
  for (size_t i = 0; i < study.collect.size(); ++i) {
    text += std::string(i == 0 ? "" : ", ") + "{\"name\": " + JsonString(study.collect[i].name) +
            ", \"unit\": " + JsonString(study.collect[i].unit) + "}";
  }
  return text + "],\n  \"rows\": [\n";
}

std::string JsonLine(const Study& study, const std::vector<std::string>& keys, const TableRow& row) {
  std::string line = "    {\"case\": " + std::to_string(row.index) + ", \"status\": \"" +
                     StatusText(row.status) + "\", \"attempts\": " +
                     (row.status == CaseStatus::kMissing ? "0" : std::to_string(row.result.attempts)) +
                     ", \"values\": {";
  for (size_t i = 0; i < keys.size(); ++i)
    line += (i == 0 ? "" : ", ") + JsonString(keys[i]) + ": " + JsonText(row.values[i]);
  line += "}, \"numbers\": {";
  for (size_t i = 0; i < study.collect.size(); ++i) {
    const bool there = i < row.result.numbers.size() && row.result.numbers[i];
    line += (i == 0 ? "" : ", ") + JsonString(study.collect[i].name) + ": " +
            (there ? JsonText(*row.result.numbers[i]) : "null");
  }
  line += "}";
  if (row.status == CaseStatus::kFailed) line += ", \"reason\": " + JsonString(row.result.reason);
  return line + "}" + (row.index + 1 < study.cases() ? "," : "") + "\n";
}

TableRow ReadRow(const Study& study, const CaseStore& store, const ShardCases& there, int64_t index) {
  TableRow row;
  row.index = index;
  row.values = study.Values(index);
  const auto place = static_cast<size_t>(index % kShard);
  if (!there.done[place] && !there.failed[place]) return row;
  const bool failed = there.failed[place];
  const auto text = ReadSmallFile(store.CaseFolder(index, failed) + "/result.json");
  const auto result = text ? ParseResult(study, index, *text) : std::nullopt;
  if (!result) return row;
  row.status = failed ? CaseStatus::kFailed : CaseStatus::kDone;
  row.result = *result;
  return row;
}

}  // namespace

void ForEachRow(const Study& study, CaseStore* store, int jobs,
                const std::function<void(const TableRow&)>& use) {
  for (int64_t first = 0; first < study.cases(); first += kShard) {
    const ShardCases there = store->Shard(first / kShard);
    const auto count = static_cast<size_t>(std::min(kShard, study.cases() - first));
    std::vector<TableRow> rows(count);
    // One thread reads ten cases at a time, because one case costs less than starting a thread.
    ParallelFor((count + 9) / 10, jobs, [&](size_t ten) {
      for (size_t i = 10 * ten; i < std::min(count, 10 * ten + 10); ++i)
        rows[i] = ReadRow(study, *store, there, first + static_cast<int64_t>(i));
    });
    for (size_t i = 0; i < count; ++i) {
      const bool torn = rows[i].status == CaseStatus::kMissing && (there.done[i] || there.failed[i]);
      if (torn) store->Remove(rows[i].index, there.failed[i], 0);
      use(rows[i]);
    }
  }
}

TableCounts WriteTable(const Study& study, const std::string& folder, int jobs,
                       const std::function<void(const TableRow&)>& use) {
  CaseStore store(folder);
  Lines csv(folder + "/table.csv"), json(folder + "/table.json");
  csv.Add(CsvHeader(study));
  json.Add(JsonHead(study));
  const std::vector<std::string> keys = study.Keys();
  TableCounts counts;
  ForEachRow(study, &store, jobs, [&](const TableRow& row) {
    csv.Add(CsvLine(study, row));
    json.Add(JsonLine(study, keys, row));
    (row.status == CaseStatus::kDone     ? counts.done
     : row.status == CaseStatus::kFailed ? counts.failed
                                         : counts.missing) += 1;
    if (row.status == CaseStatus::kFailed && counts.first_failure.empty())
      counts.first_failure = "case " + std::to_string(row.index) + ": " + row.result.reason;
    use(row);
  });
  json.Add("  ]\n}\n");
  csv.Finish();
  json.Finish();
  return counts;
}

}  // namespace hydro::batch
