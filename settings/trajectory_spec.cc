#include "settings/trajectory_spec.h"

#include <cmath>
#include <map>
#include <stdexcept>

#include "base/number_text.h"
#include "settings/csv_points.h"

namespace hydro::settings {
namespace {

using Kind = TrajectorySpec::Kind;

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

std::vector<std::string> KeysOfTrajectory(const std::string& kind) {
  const auto found = KeysOfKinds().find(kind);
  return found == KeysOfKinds().end() ? std::vector<std::string>{} : found->second;
}

TrajectorySpec ReadTrajectory(SectionReader& section, const std::string& config_file) {
  TrajectorySpec spec;
  section.Choice<Kind>("kind",
                       {{"steps", Kind::kSteps},
                        {"sine", Kind::kSine},
                        {"square", Kind::kSquare},
                        {"chirp", Kind::kChirp},
                        {"csv", Kind::kCsv},
                        {"planner", Kind::kPlanner}},
                       &spec.kind);
  if (spec.kind == Kind::kSteps) {
    section.Number("initial", &spec.initial);
    ReadPairs(section, "steps", &spec.steps);
    return spec;
  }
  if (spec.kind == Kind::kPlanner) {
    section.Number("initial", &spec.initial);
    section.Number("timeout_s", &spec.timeout_s, {.min = 0, .max = 1e6, .min_allowed = false});
    section.Number("delay_s", &spec.delay_s, {.min = 0, .max = 10});
    section.Number("max_speed", &spec.max_speed_rad_s,
                   {.min = 0, .min_allowed = false, .infinity_allowed = true});
    return spec;
  }
  if (spec.kind == Kind::kCsv) {
    ReadCsv(section, config_file, &spec);
    return spec;
  }
  section.Number("offset", &spec.offset);
  section.Number("amplitude", &spec.amplitude);
  section.Number("start_s", &spec.start_s);
  if (spec.kind == Kind::kChirp) {
    section.Number("first_frequency_hz", &spec.first_frequency_hz, kNotNegative);
    section.Number("last_frequency_hz", &spec.last_frequency_hz, kPositive);
    section.Number("duration_s", &spec.duration_s, kPositive);
  } else {
    section.Number("frequency_hz", &spec.frequency_hz, kPositive);
    if (spec.kind == Kind::kSine) section.Number("phase_rad", &spec.phase_rad);
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
  if (section == nullptr || spec.kind != Kind::kCsv) return;
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
    case Kind::kSteps:
      return trajectory::MakeSteps(spec.initial, spec.steps);
    case Kind::kSine:
      return trajectory::MakeSine(spec.offset, spec.amplitude, spec.frequency_hz, spec.start_s,
                                  spec.phase_rad);
    case Kind::kSquare:
      return trajectory::MakeSquare(spec.offset, spec.amplitude, spec.frequency_hz, spec.start_s);
    case Kind::kChirp:
      return trajectory::MakeChirp(spec.offset, spec.amplitude, spec.first_frequency_hz,
                                   spec.last_frequency_hz, spec.start_s, spec.duration_s);
    case Kind::kPlanner:  // a planner's points arrive while the stack runs
      return trajectory::MakeSteps(spec.initial, {});
    case Kind::kCsv:
      break;
  }
  return trajectory::MakePoints(spec.points, spec.interpolation);
}

}  // namespace hydro::settings
