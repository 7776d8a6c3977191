// [reference] and [model.motion]: a trajectory as the configuration describes it.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

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
