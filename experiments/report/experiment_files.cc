#include "experiments/report/experiment_files.h"

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "base/json_text.h"
#include "base/new_file.h"
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

}  // namespace hydro::experiments
