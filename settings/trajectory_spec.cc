#include "settings/trajectory_spec.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/number_text.h"
#include "base/tables/csv_text.h"
#include "base/text_file.h"
#include "base/word_list.h"

namespace hydro::settings {
namespace {

using TrajectoryKind = TrajectorySpec::Kind;

const std::map<std::string, std::vector<std::string>>& KeysOfKinds() {
  static const std::map<std::string, std::vector<std::string>> keys = {
      {"steps", {"initial", "steps"}},
      {"sine", {"offset", "amplitude", "frequency_hz", "phase_rad", "start_s"}},
      {"square", {"offset", "amplitude", "frequency_hz", "start_s"}},
      {"chirp", {"offset", "amplitude", "first_frequency_hz", "last_frequency_hz", "duration_s", "start_s"}},
      {"csv", {"file", "column", "interpolation", "points"}},
      {"planner", {"initial", "timeout_s", "delay_s", "max_speed"}},
  };
  return keys;
}

// [[time_s, value], ...]
void ReadPairs(SectionReader& section, const std::string& key, std::vector<trajectory::Step>* pairs) {
  const TomlNode* node = section.Take(key);
  if (node == nullptr) return;
  const std::string allowed = "an array of [time_s, value]";
  if (!node->is(TomlNode::Kind::kArray)) throw section.Error(key, node->Shown(), allowed);
  for (const TomlNode& item : node->items) {
    const std::string name = section.path() + "." + key + "[" + std::to_string(pairs->size()) + "]";
    if (!item.is(TomlNode::Kind::kArray) || item.items.size() != 2) {
      const std::string found =
          item.is(TomlNode::Kind::kArray) ? std::to_string(item.items.size()) + " numbers" : item.Shown();
      throw KeyError(item.place, name, found, "a pair [time_s, value]");
    }
    double numbers[2];
    for (int i = 0; i < 2; ++i) {
      const TomlNode& number = item.items[i];
      if (!number.is_number() || !std::isfinite(number.AsDouble())) {
        throw KeyError(number.place, name, number.Shown(), "two finite numbers [time_s, value]");
      }
      numbers[i] = number.AsDouble();
    }
    if (!pairs->empty() && numbers[0] <= pairs->back().time) {
      throw KeyError(item.place, name, "time " + ShortestNumber(numbers[0]),
                     "a time above " + ShortestNumber(pairs->back().time) + ", that of the pair before");
    }
    pairs->push_back({numbers[0], numbers[1]});
  }
}

void ReadCsv(SectionReader& section, const std::string& config_file, TrajectorySpec* spec) {
  section.Text("file", &spec->file);
  section.Text("column", &spec->column);
  section.Choice<trajectory::Interpolation>("interpolation",
                                            {{"hold", trajectory::Interpolation::kHold},
                                             {"linear", trajectory::Interpolation::kLinear},
                                             {"cubic", trajectory::Interpolation::kCubic}},
                                            &spec->interpolation);
  ReadPairs(section, "points", &spec->points);
  if (section.Has("points")) {
    for (const char* key : {"file", "column"}) {
      if (section.Has(key))
        throw section.Error(key, "it beside points", "file and column, or points, not both");
    }
    if (spec->points.empty()) throw section.Error("points", "an empty array", "one point or more");
    return;
  }
  section.Require("file", "the path of a CSV file (kind \"csv\"), or points = [[time_s, value], ...]");
  section.Require("column", "the name of the value's column in the CSV file");
  if (section.Has("file") && section.Has("column")) {
    const std::string file = PathBeside(config_file, spec->file);
    try {
      spec->points = ReadCsvPoints(file, spec->column);
    } catch (const InputError& error) {
      throw InputError(std::string(error.what()) + " (" + section.path() + ".file in " + section.place() +
                       ")");
    }
  }
}

}  // namespace

using tables::CsvLayout;
using tables::CsvText;
using tables::FindLayout;
namespace {

size_t ColumnOf(const CsvText& text, const std::string& name) {
  std::vector<std::string> names;
  for (const std::string& column : text.names()) names.emplace_back(tables::Trimmed(column));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(text.Place() + ": found no column " + Quoted(name) + ", allowed " + QuotedList(names) +
                     DidYouMean(name, names));
  }
  if (std::find(found + 1, names.end(), name) != names.end()) {
    throw InputError(text.Place() + ": found two columns " + Quoted(name) + ", allowed one");
  }
  return static_cast<size_t>(found - names.begin());
}

// A file that was cut off inside its last number ends with a different number, which a machine would follow.
void CheckLastNumber(const CsvText& text, size_t time_column, size_t value_column) {
  const size_t last = text.names().size() - 1;
  if (!text.unended() || (last != time_column && last != value_column)) return;
  throw text.CellError(
      last, "a number before the end of a line: the file may be cut within it; look at it, and end the line");
}

double FiniteNumber(const CsvText& text, size_t column) {
  const std::optional<double> value = text.Number(column);
  if (!value.has_value() || !std::isfinite(*value)) throw text.CellError(column, "a finite number");
  return *value;
}

// Chooses the plain layout unless only the other layout (semicolons or tabs between cells, decimal commas)
// has the column of times.
CsvLayout LayoutOf(const std::string& text, const std::string& file, const std::string& column) {
  const CsvText plain(text, file);
  const auto is_time = [](const std::string& name) { return tables::Trimmed(name) == "time_s"; };
  if (std::any_of(plain.names().begin(), plain.names().end(), is_time)) return {};
  return FindLayout(text, file, {}, {.names = {"time_s", column}});
}

}  // namespace

std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column) {
  CsvText rows(text, file, LayoutOf(text, file, column));
  const size_t time_column = ColumnOf(rows, "time_s");
  const size_t value_column = ColumnOf(rows, column);
  std::vector<trajectory::Step> points;
  while (rows.Next()) {
    const double time = FiniteNumber(rows, time_column);
    const double value = FiniteNumber(rows, value_column);
    CheckLastNumber(rows, time_column, value_column);
    if (!points.empty() && time <= points.back().time) {
      throw rows.CellError(time_column,
                           "above " + ShortestNumber(points.back().time) + ", the time of the row before");
    }
    points.push_back({time, value});
  }
  return points;
}

std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column) {
  return ParseCsvPoints(ReadTextFile(file), file, column);
}

std::vector<std::string> KeysOfTrajectory(const std::string& kind) {
  const auto found = KeysOfKinds().find(kind);
  return found == KeysOfKinds().end() ? std::vector<std::string>{} : found->second;
}

TrajectorySpec ReadTrajectory(SectionReader& section, const std::string& config_file) {
  TrajectorySpec spec;
  section.Choice<TrajectoryKind>("kind",
                                 {{"steps", TrajectoryKind::kSteps},
                                  {"sine", TrajectoryKind::kSine},
                                  {"square", TrajectoryKind::kSquare},
                                  {"chirp", TrajectoryKind::kChirp},
                                  {"csv", TrajectoryKind::kCsv},
                                  {"planner", TrajectoryKind::kPlanner}},
                                 &spec.kind);
  if (spec.kind == TrajectoryKind::kSteps) {
    section.Number("initial", &spec.initial);
    ReadPairs(section, "steps", &spec.steps);
    return spec;
  }
  if (spec.kind == TrajectoryKind::kPlanner) {
    section.Number("initial", &spec.initial);
    section.Number("timeout_s", &spec.timeout_s, {.min = 0, .max = 1e6, .min_allowed = false});
    section.Number("delay_s", &spec.delay_s, {.min = 0, .max = 10});
    section.Number("max_speed", &spec.max_speed_rad_s,
                   {.min = 0, .min_allowed = false, .infinity_allowed = true});
    return spec;
  }
  if (spec.kind == TrajectoryKind::kCsv) {
    ReadCsv(section, config_file, &spec);
    return spec;
  }
  section.Number("offset", &spec.offset);
  section.Number("amplitude", &spec.amplitude);
  section.Number("start_s", &spec.start_s);
  if (spec.kind == TrajectoryKind::kChirp) {
    section.Number("first_frequency_hz", &spec.first_frequency_hz, kNotNegative);
    section.Number("last_frequency_hz", &spec.last_frequency_hz, kPositive);
    section.Number("duration_s", &spec.duration_s, kPositive);
  } else {
    section.Number("frequency_hz", &spec.frequency_hz, kPositive);
    if (spec.kind == TrajectoryKind::kSine) section.Number("phase_rad", &spec.phase_rad);
  }
  return spec;
}

std::unique_ptr<trajectory::Trajectory> CheckedTrajectory(const TrajectorySpec& spec,
                                                          const SectionReader& section) {
  try {
    return MakeTrajectory(spec);
  } catch (const std::invalid_argument& error) {
    throw InputError(section.place() + ": " + section.path() + ": " + error.what());
  }
}

void EmbedPoints(const TrajectorySpec& spec, TomlNode* section) {
  if (section == nullptr || spec.kind != TrajectoryKind::kCsv) return;
  const TomlNode* file = section->Find("file");
  if (file == nullptr) return;  // already has its points
  TomlNode points = ArrayNode({});
  points.place = file->place;
  for (const trajectory::Step& point : spec.points) {
    points.items.push_back(ArrayNode({NumberNode(point.time), NumberNode(point.value)}));
  }
  section->Erase("file");
  section->Erase("column");
  section->members.push_back({"points", std::move(points)});
}

std::unique_ptr<trajectory::Trajectory> MakeTrajectory(const TrajectorySpec& spec) {
  switch (spec.kind) {
    case TrajectoryKind::kSteps:
      return trajectory::MakeSteps(spec.initial, spec.steps);
    case TrajectoryKind::kSine:
      return trajectory::MakeSine(spec.offset, spec.amplitude, spec.frequency_hz, spec.start_s,
                                  spec.phase_rad);
    case TrajectoryKind::kSquare:
      return trajectory::MakeSquare(spec.offset, spec.amplitude, spec.frequency_hz, spec.start_s);
    case TrajectoryKind::kChirp:
      return trajectory::MakeChirp(spec.offset, spec.amplitude, spec.first_frequency_hz,
                                   spec.last_frequency_hz, spec.start_s, spec.duration_s);
    case TrajectoryKind::kPlanner:  // a planner's points arrive while the stack runs
      return trajectory::MakeSteps(spec.initial, {});
    case TrajectoryKind::kCsv:
      break;
  }
  return trajectory::MakePoints(spec.points, spec.interpolation);
}

}  // namespace hydro::settings
