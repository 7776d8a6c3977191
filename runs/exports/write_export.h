// Exported runs as a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/exports/sheet.h"

namespace hydro::exports {

enum class Format { kCsv, kMat, kMat73, kHdf5, kMcap };

// How CSV shows a missing value: some readers, Octave's csvread among them, take an empty cell for 0.
enum class Missing { kEmpty, kNan };

// "csv", "mat", "mat73", "hdf5", "mcap".
const char* NameOf(Format format);

// Whether the name is a folder's, which ends in a slash: it takes a file of CSV for each table.
bool IsFolder(const std::string& file);

// The format of a file: that named, or that of its ending (.csv, .mat, .h5, .hdf5, .mcap), or CSV for the standard output and a folder. Throws InputError for an
// unknown name, an ending that tells nothing, and one that tells another format than the name.
Format FormatFor(const std::string& file, const std::optional<std::string>& name);

// Writes the runs, whole or not at all. Throws InputError when the file cannot be created or the format cannot hold the runs,
// WriteError when the disk is full.
void WriteExport(const std::vector<ExportedRun>& runs, Format format, const std::string& program,
                 const std::string& file, Missing missing = Missing::kEmpty);

// What WriteExport() calls. Of one run the table's columns stand by themselves; what else there is stands in groups (HDF5), structs (MAT) or under
// topics (MCAP): of a run by its name where there are several, of a channel by the channel's name.
void WriteCsvExport(const std::vector<ExportedRun>& runs, Missing missing, const std::string& file);
void WriteMatExport(const std::vector<ExportedRun>& runs, const std::string& file);
void WriteMat73Export(const std::vector<ExportedRun>& runs, const std::string& file);
void WriteHdf5Export(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file);
void WriteMcapExport(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file);

}  // namespace hydro::exports
