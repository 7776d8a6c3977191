// Writes exported runs to a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/exports/sheet.h"

namespace hydro::exports {

enum class Format { kCsv, kMat, kMat73, kHdf5, kMcap };

// How CSV shows a missing value. Some readers, Octave's csvread among them, read an empty cell as 0.
enum class Missing { kEmpty, kNan };

// "csv", "mat", "mat73", "hdf5", "mcap".
const char* NameOf(Format format);

// Whether the name ends in a slash and so is a folder's. The folder receives a CSV file for each table.
bool IsFolder(const std::string& file);

// The format of a file: the named one, or that of its ending (.csv, .mat, .h5, .hdf5, .mcap), or CSV for the
// standard output and a folder. Throws InputError for an unknown name, for an ending that no format has, and
// for an ending that contradicts the name.
Format FormatFor(const std::string& file, const std::optional<std::string>& name);

// Writes the runs, whole or not at all. Throws InputError when the file cannot be created or the format
// cannot hold the runs, WriteError when the disk is full.
void WriteExport(const std::vector<ExportedRun>& runs, Format format, const std::string& program,
                 const std::string& file, Missing missing = Missing::kEmpty);

// The writers that WriteExport() calls. With one run, the table's columns stand by themselves. Everything
// else stands in groups (HDF5), structs (MAT) or under topics (MCAP), which are named after the run where
// there are several, and after the channel.
void WriteCsvExport(const std::vector<ExportedRun>& runs, Missing missing, const std::string& file);
void WriteMatExport(const std::vector<ExportedRun>& runs, const std::string& file);
void WriteMat73Export(const std::vector<ExportedRun>& runs, const std::string& file);
void WriteHdf5Export(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file);
void WriteMcapExport(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file);

}  // namespace hydro::exports
