// Pieces of HTML that the sections of a report share.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"
#include "page/html_table.h"

namespace hydro::diagnose {

using page::Cell;
using page::NumberCell;
using page::Table;

// With two digits.
std::string ShortCell(double value);
std::string PercentCell(double part);
std::string IntervalCell(const Estimated& estimated);

// Nothing without content.
std::string Section(const std::string& heading, const std::string& content);

// Escaped text that keeps its line breaks.
std::string Lines(const std::string& text);

}  // namespace hydro::diagnose
