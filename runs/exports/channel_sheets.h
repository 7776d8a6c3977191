// Reads the messages of chosen channels into sheets.
#pragma once

#include <string>
#include <vector>

#include "runs/exports/sheet.h"

namespace hydro::exports {

// Reads logs that continue one another. Makes a sheet for each of the channels (without suffix), with a row
// for each message, in the order of the log. Messages that cannot be decoded are left out, as in
// ReadRunLog(). Throws log::LogError where a log is damaged.
std::vector<Sheet> ReadChannels(const std::vector<std::string>& files, const std::string& suffix,
                                const std::vector<std::string>& channels);

}  // namespace hydro::exports
