#include "experiments/report/comparison_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/number_text.h"
#include "base/units.h"

namespace hydro::experiments {
namespace {

constexpr size_t kLineWidth = 108;

std::optional<SiUnit> SiUnitOf(const Comparison& row) {
  // NaN compares false, so a missing value does not decide anything.
  const bool expected = std::abs(row.expected) > std::abs(row.here) || std::isnan(row.here);
  return FindSiUnit(row.unit, expected ? row.expected : row.here);
}

// "about 7300" in in-lbf -> "about 824.8". Texts with more than one number, or with words after it, keep
// their numbers and get the original unit appended.
std::string PaperInSi(const std::string& text, const SiUnit& unit) {
  const size_t begin = text.find_first_of("0123456789.");
  if (begin == std::string::npos) return text;
  const std::optional<double> value = ParseNumber(std::string_view(text).substr(begin));
  if (!value.has_value()) return text + " " + unit.from;
  return text.substr(0, begin) + ShortNumber(*value * unit.factor);
}

// Width on a terminal in characters (UTF-8).
size_t Width(const std::string& text) {
  return static_cast<size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string Padded(const std::string& text, size_t width, bool right) {
  const std::string blanks(width > Width(text) ? width - Width(text) : 0, ' ');
  return right ? blanks + text : text + blanks;
}

std::string Indented(const std::string& text, size_t indent) {
  std::string out;
  size_t column = 0;
  for (size_t i = 0; i < text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", i), text.size());
    const std::string word = text.substr(i, end - i);
    i = end + 1;
    if (word.empty()) continue;
    if (column == 0 || column + 1 + Width(word) > kLineWidth) {
      if (column > 0) out += "\n";
      out += std::string(indent, ' ') + word;
      column = indent + Width(word);
    } else {
      out += " " + word;
      column += 1 + Width(word);
    }
  }
  return column == 0 ? "" : out + "\n";
}

}  // namespace

std::string ShownNumber(double value) { return ShortNumber(value, 5); }

std::vector<Comparison> InSi(const std::vector<Comparison>& comparisons) {
  std::vector<Comparison> converted = comparisons;
  for (Comparison& row : converted) {
    const std::optional<SiUnit> unit = SiUnitOf(row);
    if (!unit.has_value()) continue;
    row.paper = PaperInSi(row.paper, *unit);
    row.expected *= unit->factor;
    row.here *= unit->factor;
    row.unit = unit->to;
  }
  return converted;
}

std::string ComparisonsText(const std::vector<Comparison>& comparisons, bool si) {
  if (comparisons.empty()) return "";
  std::vector<std::array<std::string, 6>> rows = {{"quantity", "paper", "independent", "here", "unit", ""}};
  for (const Comparison& row : si ? InSi(comparisons) : comparisons) {
    rows.push_back({row.quantity, row.paper.empty() ? "-" : row.paper, ShownNumber(row.expected),
                    ShownNumber(row.here), row.unit, row.remark});
  }
  std::array<size_t, 5> widths{};
  for (const auto& row : rows) {
    for (size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = "  ";
    for (size_t i = 0; i < widths.size(); ++i) {
      line += Padded(row[i], widths[i], i >= 1 && i <= 3) + "  ";
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n" + Indented(row[5], 6);
  }
  return out;
}

std::string SummaryText(const Experiment& experiment, const ExperimentResult& result, bool si) {
  std::string out = experiment.name + ": " + experiment.title + "\n";
  out += Indented(result.conditions, 2);
  out += ComparisonsText(result.comparisons, si);
  out += Indented(result.explanation, 2);
  for (const Finding& finding : result.findings) {
    out += Indented("finding " + std::to_string(finding.number) + ": " + finding.paper, 2);
    out += Indented(finding.evidence, 6);
    out += Indented(finding.treatment, 6);
  }
  return out;
}

}  // namespace hydro::experiments
