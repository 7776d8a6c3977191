#include "runs/exports/channel_sheets.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "bus/definitions/encoded_values.h"
#include "bus/definitions/ros_message.h"
#include "bus/messages.h"
#include "runs/exports/row_times.h"
#include "runs/log/log_reader.h"

namespace hydro::exports {
namespace {

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

}  // namespace hydro::exports
