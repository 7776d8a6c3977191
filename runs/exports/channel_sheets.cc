#include "runs/exports/channel_sheets.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bus/definitions/encoded_values.h"
#include "bus/definitions/ros_message.h"
#include "bus/messages.h"
#include "hydro/state_t.hpp"
#include "runs/exports/selection.h"
#include "runs/exports/sheet_units.h"
#include "runs/log/log_reader.h"
#include "runs/recorded/run_table.h"

namespace hydro::exports {
namespace {

// The plant time at which a message of a log belongs.

// Plant time by tick. A log may hold several plants one after another, each with its own ticks. A message
// belongs to the plant whose state came last.
class RowTimes {
 public:
  // Takes the states, in the order of the log.
  void Add(const state_t& state);

  // What a row keeps until all states are known. This is needed because a command may be recorded before the
  // state that it answers.
  struct Mark {
    size_t plant = 0;
    std::optional<int64_t> tick;
    double latest = 0;  // s, time of the last state before the message; NaN: none
  };
  Mark Here(std::optional<int64_t> tick) const;

  // The time of the tick's state or, without a tick or where the log lacks that state, the time of the last
  // state before the message. Call it after the last Add().
  double At(const Mark& mark);

 private:
  struct Plant {
    int64_t session = 0;
    std::vector<std::pair<int64_t, double>> ticks;  // tick, s
    bool sorted = false;
  };
  std::vector<Plant> plants_;
  double latest_ = 0;
};

void RowTimes::Add(const state_t& state) {
  if (plants_.empty() || plants_.back().session != state.session)
    plants_.push_back({state.session, {}, false});
  plants_.back().ticks.emplace_back(state.tick, state.time);
  plants_.back().sorted = false;
  latest_ = state.time;
}

RowTimes::Mark RowTimes::Here(std::optional<int64_t> tick) const {
  // A message before the first state may have a tick of the first plant.
  if (plants_.empty()) return {0, tick, std::numeric_limits<double>::quiet_NaN()};
  return {plants_.size() - 1, tick, latest_};
}

double RowTimes::At(const Mark& mark) {
  if (!mark.tick || mark.plant >= plants_.size()) return mark.latest;
  Plant& plant = plants_[mark.plant];
  const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
  if (!plant.sorted && !std::is_sorted(plant.ticks.begin(), plant.ticks.end(), before)) {
    std::stable_sort(plant.ticks.begin(), plant.ticks.end(), before);
  }
  plant.sorted = true;
  const auto found =
      std::lower_bound(plant.ticks.begin(), plant.ticks.end(), std::pair(*mark.tick, 0.0), before);
  return found != plant.ticks.end() && found->first == *mark.tick ? found->second : mark.latest;
}

using definitions::MessageDefinition;
using definitions::Value;

// A sheet while its log is being read.
struct OpenSheet {
  const MessageDefinition* definition = nullptr;
  std::string channel;
  int tick = -1;  // places of the fields; -1: there is none
  int utime = -1;
  Sheet sheet;
  std::vector<RowTimes::Mark> marks;
};

int PlaceOf(const MessageDefinition& definition, const char* name) {
  const auto found = std::find_if(definition.fields.begin(), definition.fields.end(),
                                  [&](const definitions::Field& field) { return field.name == name; });
  return found == definition.fields.end() ? -1 : static_cast<int>(found - definition.fields.begin());
}

bool ForEveryTick(const std::string& channel) {
  return bus::AnyMessage([&](const auto& row) {
    return row.channel == channel &&
           (row.rate == bus::Rate::kTick || row.rate == bus::Rate::kPressureInterval ||
            row.rate == bus::Rate::kPositionInterval);
  });
}

OpenSheet Open(const std::string& name, const std::string& suffix, const std::vector<std::string>& files) {
  OpenSheet open;
  open.definition = definitions::DefinitionOf(name);
  open.channel = name + suffix;
  open.tick = PlaceOf(*open.definition, "tick");
  open.utime = PlaceOf(*open.definition, "utime");
  Sheet& sheet = open.sheet;
  sheet.name = name;
  sheet.description = open.definition->description;
  sheet.source = "channel " + open.channel + " of " +
                 std::filesystem::path(files.front()).filename().string() +
                 (files.size() > 1 ? " and its continuations" : "");
  sheet.type = definitions::RosType(open.definition->type);
  sheet.topic = definitions::RosTopic(name);
  sheet.every_tick = ForEveryTick(name);
  sheet.constants = open.definition->constants;
  for (const definitions::Field& field : open.definition->fields) sheet.columns.push_back(ColumnFor(field));
  return open;
}

void Append(Value& value, Values* values) {
  std::visit(
      [&](auto& list) {
        using Element = typename std::remove_reference_t<decltype(list)>::value_type;
        list.push_back(std::move(std::get<Element>(value)));
      },
      *values);
}

void AppendRow(const log::LogEvent& event, std::vector<Value>& values, int64_t order, const RowTimes& times,
               OpenSheet* open) {
  Sheet& sheet = open->sheet;
  std::optional<int64_t> tick;
  if (open->tick >= 0) tick = std::get<int64_t>(values[static_cast<size_t>(open->tick)]);
  open->marks.push_back(times.Here(tick));
  sheet.received.push_back(event.utime);
  sheet.published.push_back(open->utime >= 0 ? std::get<int64_t>(values[static_cast<size_t>(open->utime)])
                                             : event.utime);
  sheet.order.push_back(order);
  for (size_t i = 0; i < values.size(); ++i) Append(values[i], &sheet.columns[i].values);
}

// What the columns of the run's table mean, in their order.
constexpr const char* kMeanings[] = {
    "plant time of the tick",
    "plant tick, 0 at the start of the run",
    "amplifier voltage that acts from this tick until the next, positive drives theta positive",
    "reference of p2 - p1 that is in force for the pressure loop at this tick; NaN: none",
    "where the arm is to be: the last reference up to this tick; NaN: none",
    "theta of eq. (4); positive moves oil from side 1 to side 2; NaN: not measured",
    "d theta/dt; NaN: not measured",
    "alpha of eq. (15), 0 at mid-stroke, positive enlarges side 2; NaN: not measured",
    "d alpha/dt; NaN: not measured",
    "pressure of side 1, eq. (13); NaN: not measured",
    "pressure of side 2, eq. (14); NaN: not measured"};
static_assert(std::size(kMeanings) == runs::kRunColumns.size());

}  // namespace

std::vector<Sheet> ReadChannels(const std::vector<std::string>& files, const std::string& suffix,
                                const std::vector<std::string>& channels) {
  std::vector<OpenSheet> open;
  open.reserve(channels.size());
  for (const std::string& name : channels) open.push_back(Open(name, suffix, files));
  RowTimes times;
  const std::string states = std::string(bus::RowOf<state_t>().channel) + suffix;
  std::vector<Value> values;
  int64_t order = 0;
  for (const std::string& file : files) {
    log::LogReader reader(file);
    log::LogEvent event;
    for (; reader.Next(event); ++order) {
      if (state_t state; event.channel == states && log::DecodeAs(event, state)) times.Add(state);
      const auto sheet = std::find_if(open.begin(), open.end(),
                                      [&](const OpenSheet& one) { return event.channel == one.channel; });
      if (sheet == open.end()) continue;
      if (!definitions::ReadValues(*sheet->definition, event.data, event.size, &values)) continue;
      AppendRow(event, values, order, times, &*sheet);
    }
  }
  std::vector<Sheet> sheets;
  sheets.reserve(open.size());
  for (OpenSheet& one : open) {
    one.sheet.time_s.reserve(one.marks.size());
    for (const RowTimes::Mark& mark : one.marks) one.sheet.time_s.push_back(times.At(mark));
    sheets.push_back(std::move(one.sheet));
  }
  return sheets;
}

Sheet TableSheet(const runs::RunLog& log) {
  tables::Table table = runs::ExportRun(log);
  Sheet sheet;
  sheet.name = kTableName;
  sheet.description = "The run, one row per plant tick.";
  sheet.source = "the loops' messages of " + std::filesystem::path(log.file).filename().string();
  sheet.type = "hydro_msgs/msg/Table";
  sheet.topic = "/hydro/table";
  sheet.is_table = sheet.every_tick = true;
  sheet.time_s = table.Find("time_s")->values;
  sheet.columns.reserve(table.columns.size());
  for (size_t i = 0; i < table.columns.size(); ++i) {
    tables::Column& column = table.columns[i];
    const definitions::Field field{column.name, definitions::FieldType::kDouble, "", PaperUnit(column.name),
                                   kMeanings[i]};
    sheet.columns.push_back({field, std::move(column.values)});
  }
  sheet.received.resize(sheet.rows());
  sheet.published.resize(sheet.rows());
  sheet.order.resize(sheet.rows());
  return sheet;
}

void SetTimesOf(const Sheet& states, Sheet* table) {
  const auto column = [](const Sheet& sheet, const char* name) -> const Values& {
    return std::find_if(sheet.columns.begin(), sheet.columns.end(),
                        [&](const SheetColumn& one) { return one.field.name == name; })
        ->values;
  };
  std::unordered_map<int64_t, size_t> rows;  // by tick; the first of a state that was repeated
  const auto& ticks = std::get<std::vector<int64_t>>(column(states, "tick"));
  rows.reserve(ticks.size());
  for (size_t row = 0; row < ticks.size(); ++row) rows.emplace(ticks[row], row);
  const auto& wanted = std::get<std::vector<double>>(column(*table, "tick"));
  for (size_t row = 0; row < wanted.size(); ++row) {
    const auto found = rows.find(static_cast<int64_t>(wanted[row]));
    if (found == rows.end()) continue;
    table->received[row] = states.received[found->second];
    table->published[row] = states.published[found->second];
    table->order[row] = states.order[found->second];
  }
}

}  // namespace hydro::exports
