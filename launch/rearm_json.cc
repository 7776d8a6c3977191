#include "launch/rearm_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/text_file.h"

namespace hydro::launch {
namespace {

using Json = nlohmann::ordered_json;

Json ListOf(const OperatorResult& result) {
  Json list = Json::array();
  for (const auto& [joint, forecast] : result.forecasts) {
    const auto& f = forecast;  // a lambda cannot capture a structured binding
    Json json;
    if (!joint.empty()) json["joint"] = Printable(joint);
    json["text"] = Printable(f.text);
    const auto number = [&](double value) { return f.known ? Json(value) : Json(); };
    json["quantity"] = f.known ? Json(f.quantity) : Json();
    json["unit"] = f.known ? Json(f.unit) : Json();
    json["present"] = number(f.present);
    json["target"] = number(f.target);
    json["return_s"] = number(f.return_s);
    json["top_rate"] = number(f.top_rate);
    json["jumps"] = f.known ? Json(f.jumps) : Json();
    json["turns"] = Json::array();
    for (const tuning::ReferenceTurn& turn : f.turns)
      json["turns"].push_back({{"after_s", turn.after_s}, {"at", turn.at}});
    json["speed"] = f.known && std::isfinite(f.speed) ? Json(f.speed) : Json();
    json["lowest"] = number(f.lowest);
    json["highest"] = number(f.highest);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

std::string ForecastsJson(const OperatorResult& result) { return JsonText(ListOf(result)); }

std::string RearmJson(const OperatorResult& result) {
  Json json;
  json["rearmed"] = result.exit_code == 0;
  json["text"] = Printable(result.text);
  json["forecasts"] = ListOf(result);
  return JsonText(json);
}

}  // namespace hydro::launch
