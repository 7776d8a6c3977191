#include "experiments/report/experiment_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

#include "base/json_text.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "base/units.h"
#include "page/figure_svg.h"
#include "settings/command_line.h"

namespace hydro::experiments {

std::vector<RenderedPicture> RenderPictures(const std::string& name, const std::vector<Picture>& pictures) {
  std::set<std::string> suffixes;
  std::vector<RenderedPicture> rendered;
  for (const Picture& picture : pictures) {
    if (!suffixes.insert(picture.suffix).second) {
      throw std::logic_error(name + ": two pictures with the suffix '" + picture.suffix + "'");
    }
    const std::string id = name + picture.suffix;
    rendered.push_back({id, page::FigureFile(picture.figure, id), page::HtmlFigure(picture.figure, id)});
  }
  return rendered;
}

std::string ExperimentJson(const Experiment& experiment, const ExperimentResult& result,
                           const ExperimentOptions& options, bool real_time) {
  using Json = nlohmann::ordered_json;
  const Json numbers = Json::parse(result.numbers, nullptr, false);
  if (!numbers.is_object()) throw std::logic_error(experiment.name + ": its numbers are no JSON object");
  Json json;
  json["name"] = experiment.name;
  json["title"] = experiment.title;
  json["program_version"] = settings::ProgramVersion();
  json["options"] = {{"seed", options.seed}, {"noise", options.noise}, {"real_time", real_time}};
  if (experiment.draws_machines) json["options"]["machines"] = options.machines;
  if (!options.measured_run.empty()) json["options"]["run"] = options.measured_run;
  json["conditions"] = result.conditions;
  Json& comparisons = json["comparisons"] = Json::array();
  for (const Comparison& row : result.comparisons) {
    comparisons.push_back({{"quantity", row.quantity},
                           {"unit", row.unit},
                           {"paper", row.paper},
                           {"independent", row.expected},
                           {"here", row.here},
                           {"remark", row.remark}});
  }
  Json& findings = json["findings"] = Json::array();
  for (const Finding& finding : result.findings) {
    findings.push_back({{"number", finding.number},
                        {"paper", finding.paper},
                        {"evidence", finding.evidence},
                        {"treatment", finding.treatment}});
  }
  for (const auto& [key, value] : numbers.items()) {
    if (json.contains(key)) throw std::logic_error(experiment.name + ": the key '" + key + "' is taken");
    json[key] = value;
  }
  return hydro::JsonText(json, 2) + "\n";
}

void WriteExperimentFiles(const std::string& folder, const std::string& name, const std::string& json,
                          const tables::Table& table, const std::vector<RenderedPicture>& pictures) {
  for (const RenderedPicture& picture : pictures) {
    WriteWholeFile(folder + "/" + picture.name + ".svg", picture.svg);
  }
  tables::WriteTable(table, folder + "/" + name + ".csv");
  WriteWholeFile(folder + "/" + name + ".json", json);
}

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
