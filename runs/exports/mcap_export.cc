// MCAP: a topic for the run's table and one for each channel, with ROS 2 definitions and CDR, in the order of
// the log.
#include <algorithm>
#include <tuple>

#include "bus/definitions/ros_message.h"
#include "runs/exports/mcap_file.h"
#include "runs/exports/output.h"
#include "runs/exports/write_export.h"

namespace hydro::exports {
namespace {

// A row's values, one after another.
class RowWriter {
 public:
  RowWriter(const Sheet& sheet, size_t row, std::string* bytes) : cdr_(bytes), row_(row) {
    for (const SheetColumn& column : sheet.columns) {
      type_ = column.field.type;
      std::visit([&](const auto& values) { Put(values[row_]); }, column.values);
    }
  }

 private:
  void Put(int64_t value) { cdr_.Whole(type_, value); }
  void Put(double value) { cdr_.Number(type_, value); }
  void Put(const std::string& value) { cdr_.Text(value); }
  template <class T>
  void Put(const std::vector<T>& list) {
    cdr_.Length(list.size());
    for (const T& element : list) Put(element);
  }

  definitions::CdrWriter cdr_;
  definitions::FieldType type_{};
  size_t row_;
};

std::string Schema(const Sheet& sheet) {
  std::vector<definitions::Field> fields;
  fields.reserve(sheet.columns.size());
  for (const SheetColumn& column : sheet.columns) fields.push_back(column.field);
  const std::string heading = sheet.description.empty() ? "" : "# " + sheet.description + "\n";
  return heading + definitions::RosSchema(fields, sheet.constants);
}

// The metadata of a channel: the source, and "unit.FIELD" for each field with a unit.
McapMap Metadata(const Sheet& sheet) {
  McapMap entries{{"source", sheet.source}, {"description", sheet.description}};
  for (const SheetColumn& column : sheet.columns) {
    if (!column.field.unit.empty())
      entries.emplace_back("unit." + definitions::RosField(column.field.name), column.field.unit);
  }
  return entries;
}

uint64_t Nanoseconds(int64_t microseconds) {
  return microseconds > 0 ? static_cast<uint64_t>(microseconds) * 1000 : 0;
}

struct Row {
  int64_t order;
  uint16_t channel;
  size_t row;
  const Sheet* sheet;
};

void WriteRows(std::vector<Row>& rows, McapFile* file) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return std::tie(a.order, a.channel, a.row) < std::tie(b.order, b.channel, b.row);
  });
  std::string bytes;
  for (const Row& row : rows) {
    const RowWriter write(*row.sheet, row.row, &bytes);
    McapMessage message;
    message.channel = row.channel;
    message.sequence = static_cast<uint32_t>(row.row);
    message.log_time = Nanoseconds(row.sheet->received[row.row]);
    message.publish_time = Nanoseconds(row.sheet->published[row.row]);
    message.data = bytes;
    file->AddMessage(message);
  }
}

}  // namespace

void WriteMcapExport(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file) {
  Output out(file, false);
  McapFile mcap(&out, program);
  std::vector<std::vector<Row>> rows(runs.size());
  for (size_t k = 0; k < runs.size(); ++k) {
    const ExportedRun& run = runs[k];
    const std::string prefix = runs.size() > 1 ? run.name : "";
    mcap.AddMetadata(prefix.empty() ? "hydro" : "hydro/" + prefix, {run.facts.begin(), run.facts.end()});
    const std::string folder = prefix.empty() ? "" : prefix + "/";
    if (!run.config_text.empty())
      mcap.AddAttachment(folder + "config.toml", "application/toml", run.config_text);
    if (!run.model_text.empty())
      mcap.AddAttachment(folder + "model.toml", "application/toml", run.model_text);
    for (const Sheet& sheet : run.sheets) {
      const uint16_t schema = mcap.AddSchema(sheet.type, "ros2msg", Schema(sheet));
      const std::string topic = prefix.empty() ? sheet.topic : "/" + prefix + sheet.topic;
      const uint16_t channel = mcap.AddChannel(schema, topic, "cdr", Metadata(sheet));
      for (size_t row = 0; row < sheet.rows(); ++row)
        rows[k].push_back({sheet.order[row], channel, row, &sheet});
    }
  }
  for (std::vector<Row>& of_run : rows) WriteRows(of_run, &mcap);
  mcap.Finish();
  out.Finish();
}

}  // namespace hydro::exports
