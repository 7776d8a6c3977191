// Numbers and words as CSV, TOML and JSON have them.
#pragma once

#include <fstream>
#include <string>

namespace foreign_rig {

// As printf gives it; nothing where it is not a number, as in an empty cell.
std::string Text(double value, const char* format = "%.10g");
// JSON: null where it is not a number.
std::string Number(double value);
// TOML: a float keeps a point or an exponent.
std::string Float(double value);
std::string Quoted(const std::string& text);

// Throws std::runtime_error where it cannot be written.
std::ofstream Open(const std::string& file);

}  // namespace foreign_rig
