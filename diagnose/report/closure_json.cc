#include "diagnose/report/closure_json.h"

namespace hydro::diagnose {
namespace {

using Json = nlohmann::ordered_json;

// Of a curve the list itself; of a surface its rows.
Json Rows(const Closure& closure, const Json& list) {
  if (closure.knots.size() == 1) return list;
  const size_t columns = closure.knots[1].size();
  Json rows = Json::array();
  for (size_t i = 0; i < list.size(); i += columns) {
    Json row = Json::array();
    for (size_t k = i; k < i + columns; ++k) row.push_back(list[k]);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json One(const Closure& closure) {
  Json band = Json::array();
  for (size_t i = 0; i < closure.value.size(); ++i) band.push_back({closure.low[i], closure.high[i]});
  return {{"id", closure.id},
          {"against", closure.against},
          {"against_units", closure.against_units},
          {"unit", closure.unit},
          {"at", closure.knots.size() == 1 ? Json(closure.knots[0]) : Json(closure.knots)},
          {"value", Rows(closure, closure.value)},
          {"ci95", Rows(closure, band)},
          {"held_out", {{"before", closure.before}, {"after", closure.after}}},
          {"seconds", closure.seconds},
          {"on", closure.on_refit ? "refit" : "found"},
          {"resembles", closure.resembles}};
}

}  // namespace

Json ClosureJson(const Diagnosis& diagnosis) {
  if (diagnosis.closures.empty()) return nullptr;
  Json closure = One(diagnosis.closures.front());
  Json also = Json::array();
  for (size_t i = 1; i < diagnosis.closures.size(); ++i) also.push_back(One(diagnosis.closures[i]));
  if (!also.empty()) closure["also"] = std::move(also);
  return closure;
}

}  // namespace hydro::diagnose
