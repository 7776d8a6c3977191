// What is exported from a run: sheets of columns, each with its unit and meaning. Every format writes the
// same sheets.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bus/definitions/message_definition.h"

namespace hydro::exports {

// A column's values are of one kind: whole numbers and truth values, numbers, texts, or lists of them.
using Values = std::variant<std::vector<int64_t>, std::vector<double>, std::vector<std::string>,
                            std::vector<std::vector<int64_t>>, std::vector<std::vector<double>>,
                            std::vector<std::vector<std::string>>>;

struct SheetColumn {
  definitions::Field field;
  Values values;
};

// The run's table, or the messages of a channel.
struct Sheet {
  std::string name;  // "table", or the channel without its suffix: "HYDRO_STATE"
  std::string description;
  std::string source;  // for the reader of an exported file: "run.lcmlog: HYDRO_STATE, sent by ..."
  std::string type;    // in ROS 2's notation
  std::string topic;
  bool is_table = false;
  bool every_tick = false;  // one row for each tick or sample, so it may be thinned; faults may not
  std::vector<SheetColumn> columns;
  std::vector<definitions::Constant> constants;
  // For each row. The table's own column time_s holds the same values.
  std::vector<double> time_s;      // [s] plant time to which it belongs; NaN: before the first state
  std::vector<int64_t> received;   // [us] when the recorder received it
  std::vector<int64_t> published;  // [us] when its sender sent it
  std::vector<int64_t> order;      // place in the log

  size_t rows() const { return time_s.size(); }
};

struct ExportedRun {
  std::string name;                // the log's stem
  std::vector<std::string> files;  // its log, or logs that continue one another
  std::vector<std::pair<std::string, std::string>>
      facts;                // what the log says about itself: program, version, host, ...
  std::string config_text;  // TOML
  std::string model_text;   // TOML
  std::vector<Sheet> sheets;
};

// An empty column for a field.
SheetColumn ColumnFor(const definitions::Field& field);

// Keeps the rows whose flag is set.
void KeepRows(const std::vector<bool>& keep, Sheet* sheet);

// The columns, preceded by the columns of times. Table formats have those, and messages carry them beside
// their contents: a channel's sheet begins with time_s and received_us.
std::vector<SheetColumn> WithTimes(const Sheet& sheet);

}  // namespace hydro::exports
