#include "diagnose/report/per_run_section.h"

#include <cmath>

#include "base/number_text.h"
#include "diagnose/report/html_parts.h"
#include "page/typeset.h"

namespace hydro::diagnose {
namespace {

std::string Row(const Estimated& run) {
  const std::string cells = std::isnan(run.value)
                                ? "<td class=\"number\">-</td><td class=\"number\">cannot be simulated</td>"
                                : NumberCell(run.value) + IntervalCell(run);
  return "<tr>" + Cell(run.name) + cells + "</tr>\n";
}

std::string OneValue(const ValueByRun& value) {
  std::string rows;
  for (const Estimated& run : value.values) rows += Row(run);
  return "<h3>" + page::TypesetHtml(value.name) + "</h3>\n<p>It differs by " +
         ShortNumber(100 * value.Spread(), 2) +
         " % (standard deviation). With a value of its own for each run, windows that were not fitted are "
         "predicted with a typical gap of " +
         ShortNumber(value.after, 3) + " instead of " + ShortNumber(value.before, 3) + " noise units.</p>\n" +
         Table({"run", "#" + value.name + (value.unit.empty() ? "" : " (" + value.unit + ")"),
                "#95 % interval"},
               rows, "narrow");
}

}  // namespace

std::string PerRunSection(const Diagnosis& diagnosis) {
  std::string out;
  for (const ValueByRun& value : diagnosis.per_run) out += OneValue(value);
  return out;
}

}  // namespace hydro::diagnose
