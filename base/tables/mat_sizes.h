// How much a MAT file claims to hold, against what is in it: asked before matio, which believes a file's
// dimensions, allocates.
#pragma once

#include <cstddef>
#include <string>

namespace hydro::tables {

// The most numbers that a file of so many bytes may hold. Compressed, many equal ones take hardly any room; a
// recording, with a time that increases, never takes so little.
size_t MostNumbers(size_t file_bytes);

// Throws InputError, naming the variable or the byte, unless everything that a file of version 5 speaks of is
// in it: each element, and in each as many numbers, cells and fields as its dimensions say, no deeper in each
// other than any reader needs.
void CheckMat5Sizes(const std::string& file);

// The same of version 7.3, which is HDF5 and stores nothing of numbers that nobody has written.
void CheckMat73Sizes(const std::string& file);

}  // namespace hydro::tables
