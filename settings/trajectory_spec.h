// [reference] and [model.motion]: a trajectory as the configuration describes it, with its points from a
// CSV table.
#pragma once

#include <string>
#include <vector>

#include "base/input_error.h"
#include "model/trajectory/trajectory.h"
#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// Reads the columns time_s and `column` of a CSV file (csv_text.h). The cells may also be separated by
// semicolons or tabs, with decimal commas; other columns may hold anything. Throws InputError "FILE: line N,
// column NAME: ..." for cells that are not finite numbers, for rows whose length differs from that of the
// names, and for times that do not increase.
std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column);

// The same, from the file's text.
std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column);

// The keys that belong to a kind, e.g. "sine"; empty for an unknown kind.
std::vector<std::string> KeysOfTrajectory(const std::string& kind);

// Reads a trajectory's keys from `section` and the CSV file it names, relative to the folder of
// `config_file`. Throws InputError.
TrajectorySpec ReadTrajectory(SectionReader& section, const std::string& config_file);

// Throws InputError unless MakeTrajectory accepts `spec`.
std::unique_ptr<trajectory::Trajectory> CheckedTrajectory(const TrajectorySpec& spec,
                                                          const SectionReader& section);

// Replaces the file of a CSV trajectory by its points, so that the text is complete in itself.
void EmbedPoints(const TrajectorySpec& spec, TomlNode* section);

}  // namespace hydro::settings
