// Closures in the diagnosis, and in words.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/closure/closure.h"

namespace hydro::diagnose {
namespace {

std::string BalanceOf(const Closure& closure) {
  const std::string balance = closure.id.substr(closure.id.find('.') + 1);
  if (balance == "pump_torque") return "the torque on the pump";
  if (balance == "arm_torque") return "the torque on the arm";
  return balance == "flow_1" ? "the flow into side 1" : "the flow into side 2";
}

}  // namespace

void AddClosures(ClosedModel closed, Diagnosis* diagnosis) {
  if (closed.closures.empty()) return;
  diagnosis->closures = std::move(closed.closures);
  diagnosis->model = std::move(closed.model);
}

std::string ClosureSentence(const std::vector<Closure>& closures) {
  if (closures.empty()) return "";
  // What rounds to nothing is no improvement.
  if (ShortNumber(closures.front().before, 3) == ShortNumber(closures.front().after, 3)) return "";
  std::vector<std::string> curves;
  curves.reserve(closures.size());
  for (const Closure& closure : closures) {
    curves.push_back((closure.against.size() == 2 ? "a surface over " : "a curve of ") +
                     Enumerated(closure.against) + " in " + BalanceOf(closure) + ", which " +
                     closure.resembles + ",");
  }
  const Closure& first = closures.front();
  const double taken = 1 - std::pow(first.after / first.before, 2);
  return std::string(" The model") + (first.on_refit ? " with its own values refitted" : "") + " and " +
         Enumerated(curves) + " predicts held-out runs over " + ShortNumber(first.seconds, 2) +
         " s better: " + ShortNumber(first.before, 3) + " to " + ShortNumber(first.after, 3) +
         " noise units, " + ShortNumber(100 * taken, 2) + " % of the squared gap.";
}

}  // namespace hydro::diagnose
