// Compares how much a MAT file claims to hold with what is in it. This comes before matio allocates memory,
// because matio believes a file's dimensions.
#pragma once

#include <cstddef>
#include <string>

namespace hydro::tables {

// The largest number of numbers that a file of this many bytes may hold. Many equal numbers take hardly any
// room when compressed; a recording, whose time increases, never takes so little.
size_t MostNumbers(size_t file_bytes);

// Throws InputError, naming the variable or the byte, unless a file of version 5 contains everything that it
// declares: each element, and in each element as many numbers, cells and fields as its dimensions state,
// nested no deeper than any reader needs.
void CheckMat5Sizes(const std::string& file);

// Does the same for version 7.3, which is HDF5 and stores nothing for numbers that were never written.
void CheckMat73Sizes(const std::string& file);

}  // namespace hydro::tables
