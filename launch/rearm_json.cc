#include "launch/rearm_json.h"

#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

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
    const tuning::RearmMotion& motion = f.motion;
    const bool foreseen = f.known && motion.unforeseen.empty();
    const auto limit = [&](const std::string& name) {
      return foreseen && !name.empty() ? Json(Printable(name)) : Json();
    };
    json["reaches"] = foreseen ? Json(motion.reaches) : Json();
    json["reaches_after_s"] = foreseen ? Json(motion.seconds) : Json();
    json["ended_by"] = limit(motion.ended_by);
    json["held_by"] = limit(motion.held_by);
    json["unforeseen"] = foreseen ? Json() : Json(Printable(f.known ? motion.unforeseen : f.text));
    list.push_back(std::move(json));
  }
  return list;
}

// The parts between `separator`.
std::vector<std::string> Parts(const std::string& text, std::string_view separator) {
  std::vector<std::string> parts;
  size_t begin = 0;
  for (size_t at; (at = text.find(separator, begin)) != text.npos; begin = at + separator.size())
    parts.push_back(text.substr(begin, at - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

// A forecast is one text with its clauses between semicolons; how the reference moves follows a colon.
std::vector<std::string> Sentences(const std::string& text) {
  constexpr std::string_view kMoves = ": the reference ";
  std::vector<std::string> sentences;
  for (const std::string& clause : Parts(text, "; ")) {
    const size_t moves = clause.find(kMoves);
    sentences.push_back(clause.substr(0, moves));
    if (moves != clause.npos) sentences.push_back(clause.substr(moves + 2));
  }
  return sentences;
}

void AppendWrapped(const std::string& sentence, std::string line, std::string* text) {
  const std::string more(4, ' ');
  std::istringstream words(sentence);
  bool begun = false;
  for (std::string word; words >> word; begun = true) {
    if (begun && line.size() + 1 + word.size() > kTerminalColumns) {
      *text += line + "\n";
      line = more + word;
    } else {
      line += (begun ? " " : "") + word;
    }
  }
  *text += line + "\n";
}

}  // namespace

std::string TerminalText(const OperatorResult& result) {
  std::string text;
  std::string begin = "hydro-launch: ";
  for (std::string sentence : Sentences(Printable(result.text))) {
    // A joint's name begins a sentence as it is written.
    const bool joint = sentence.find(": ") < sentence.find(' ');
    if (!text.empty() && !sentence.empty() && !joint)
      sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
    AppendWrapped(sentence + ".", begin, &text);
    begin = "  ";
  }
  return text;
}

std::string ForecastsJson(const OperatorResult& result) { return JsonText(ListOf(result)); }

std::string RearmJson(const OperatorResult& result) {
  Json json;
  json["rearmed"] = result.exit_code == 0;
  json["text"] = Printable(result.text);
  json["forecasts"] = ListOf(result);
  return JsonText(json);
}

}  // namespace hydro::launch
