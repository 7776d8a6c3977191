// Pieces of HTML that the sections of a report share.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

std::string Cell(const std::string& text);
std::string NumberCell(double value);
// With two digits.
std::string ShortCell(double value);
std::string PercentCell(double part);
std::string IntervalCell(const Estimated& estimated);

// Columns whose names begin with '#' hold numbers.
std::string Table(const std::vector<std::string>& columns, const std::string& rows,
                  const std::string& style = "");

// Nothing without content.
std::string Section(const std::string& heading, const std::string& content);

// Escaped text that keeps its line breaks.
std::string Lines(const std::string& text);

}  // namespace hydro::diagnose
