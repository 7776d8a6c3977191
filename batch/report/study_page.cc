#include "batch/report/study_page.h"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>

#include "base/new_file.h"
#include "base/number_text.h"
#include "batch/report/study_pictures.h"
#include "page/figure_svg.h"
#include "page/html_page.h"
#include "page/typeset.h"

namespace hydro::batch {
namespace {

constexpr size_t kWorst = 10;
constexpr size_t kManyKeys = 7;  // with this many keys, the table needs a wide page

std::string Row(const std::string& cells) { return "<tr>" + cells + "</tr>\n"; }
std::string RightCell(const std::string& text) {
  return "<td class=\"number\">" + page::EscapeMarkup(text) + "</td>";
}

std::string ValuesText(const std::vector<Value>& values) {
  constexpr size_t kMost = 8;
  std::string text;
  for (size_t i = 0; i < values.size(); ++i) {
    if (i == kMost - 1 && values.size() > kMost) return text + ", ..., " + PlainText(values.back());
    text += (i == 0 ? "" : ", ") + PlainText(values[i]);
  }
  return text;
}

std::string DrawText(const Draw& draw) {
  switch (draw.distribution) {
    case Distribution::kUniform:
      return fmt::format("{}uniform, {} to {}", draw.whole ? "whole, " : "", ShortestNumber(draw.min),
                         ShortestNumber(draw.max));
    case Distribution::kLogUniform:
      return fmt::format("log-uniform, {} to {}", ShortestNumber(draw.min), ShortestNumber(draw.max));
    case Distribution::kNormal:
      return fmt::format("normal, mean {}, standard deviation {}", ShortestNumber(draw.mean),
                         ShortestNumber(draw.standard_deviation));
    case Distribution::kUncertainty:
      return fmt::format("as the model knows it: {}, {} %", ShortNumber(draw.mean),
                         ShortNumber(100 * draw.standard_deviation));
    case Distribution::kChoice:
      break;
  }
  return "one of " + ValuesText(draw.choices);
}

std::string FactorsTable(const Study& study) {
  std::string rows;
  const auto add = [&](const std::string& key, const std::string& how, const std::string& values) {
    rows += Row(page::Cell(key) + page::Cell(how) + page::Cell(values));
  };
  for (const GridFactor& factor : study.grid)
    add(factor.key, fmt::format("grid, {} values", factor.values.size()), ValuesText(factor.values));
  for (size_t i = 0; i < study.list.keys.size(); ++i) {
    std::vector<Value> values;
    for (const auto& row : study.list.rows) values.push_back(row[i]);
    add(study.list.keys[i], fmt::format("list, {} rows", values.size()), ValuesText(values));
  }
  for (const Draw& draw : study.draws)
    add(draw.key,
        fmt::format("{} draws{}", study.draw_count, study.same_draws ? ", the same everywhere" : ""),
        DrawText(draw));
  if (rows.empty()) return "";
  return "<h2>What varies</h2>\n" + page::Table({"key", "how", "values"}, rows);
}

std::string StepsText(const Study& study) {
  std::string text;
  for (const Step& step : study.steps) {
    for (size_t i = 0; i < step.argv.size(); ++i) {
      const bool plain = !step.argv[i].empty() && step.argv[i].find_first_of(" \t\n'\"") == std::string::npos;
      text += (i == 0 ? "" : " ") + (plain ? step.argv[i] : "'" + step.argv[i] + "'");
    }
    text += "\n";
  }
  std::string escaped;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = text.find('\n', begin);
    escaped += page::EscapeMarkup(text.substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  return "<h2>What runs in each case</h2>\n<pre>" + escaped + "</pre>\n";
}

std::string NumbersTable(const StudyNumbers& numbers, int64_t done) {
  std::string rows;
  for (const NumberColumn& column : numbers.columns()) {
    std::vector<double> sorted = column.values;
    std::ranges::sort(sorted);
    std::string cells = page::Cell(column.of->name) + page::Cell(column.of->unit) +
                        RightCell(std::to_string(sorted.size())) +
                        RightCell(std::to_string(done - static_cast<int64_t>(sorted.size())));
    double sum = 0;
    for (const double value : sorted) sum += value;
    for (const double part : {0.0, 0.05, 0.5, 0.95, 1.0}) cells += page::NumberCell(Quantile(sorted, part));
    rows += Row(cells + page::NumberCell(sum / static_cast<double>(sorted.size())));
  }
  const std::string note =
      numbers.any_without() ? "<p>From smallest to mean: of the cases that have the number.</p>\n" : "";
  return note + page::Table({"number", "unit", "#cases", "#no number", "#smallest", "#5 %", "#median",
                             "#95 %", "#largest", "#mean"},
                            rows);
}

std::string WorstRow(const Study& study, int64_t index, const std::string& number) {
  std::string cells = RightCell(std::to_string(index)) + number;
  for (const Value& value : study.Values(index)) {
    const auto known = AsNumber(value);
    cells += known && !std::holds_alternative<bool>(value) ? page::NumberCell(*known)
                                                           : RightCell(PlainText(value));
  }
  return Row(cells);
}

// A case without the number (one that never settles) is worse than any case with it.
std::string WorstTable(const Study& study, const StudyNumbers& numbers) {
  const NumberColumn* column = numbers.worst();
  if (column == nullptr) return "";
  std::vector<std::string> heads = {"#case", "#" + column->Label()};
  const std::vector<std::string> keys = study.Keys();
  for (const std::string& key : keys) heads.push_back("#" + key);
  const size_t without = std::min(column->without.size(), kWorst);
  std::string rows;
  for (size_t i = 0; i < without; ++i) rows += WorstRow(study, column->without[i], RightCell("none"));
  for (const size_t place : WorstPlaces(*column, kWorst - without)) {
    rows += WorstRow(study, column->cases[place], page::NumberCell(column->values[place]));
  }
  const std::string note =
      without == 0
          ? ""
          : fmt::format("<p>{} case{} done but {} no {}: {} first here; table.csv has all of them.</p>\n",
                        column->without_count, column->without_count == 1 ? " is" : "s are",
                        column->without_count == 1 ? "has" : "have", page::EscapeMarkup(column->of->name),
                        column->without_count == 1 ? "it stands" : "they stand");
  return note + page::Table(heads, rows, keys.size() > kManyKeys ? "small" : "narrow");
}

std::string FailuresSection(const TableCounts& counts, const StudyNumbers& numbers) {
  if (counts.failed == 0) return "";
  std::string rows;
  for (const StudyNumbers::Failure& failure : numbers.failures())
    rows +=
        Row(RightCell(std::to_string(failure.index)) + "<td>" + page::EscapeMarkup(failure.reason) + "</td>");
  const std::string more = counts.failed > static_cast<int64_t>(numbers.failures().size())
                               ? "<p>These are the first; table.csv has all of them.</p>\n"
                               : "";
  return "<h2>Failed cases</h2>\n" + page::Table({"#case", "reason"}, rows) + more;
}

std::string Summary(const Study& study, const TableCounts& counts) {
  const std::string text = fmt::format("{} cases: {} done, {} failed, {} missing. Seed {}.", study.cases(),
                                       counts.done, counts.failed, counts.missing, study.seed);
  const bool bad = counts.failed + counts.missing > 0;
  return "<p class=\"" + std::string(bad ? "failed" : "verdict") + "\">" + text + "</p>\n";
}

}  // namespace

std::string StudyPage(const Study& study, const TableCounts& counts, const StudyNumbers& numbers) {
  const auto figure = [](const std::optional<page::Figure>& each, const std::string& name) {
    return each ? page::HtmlFigure(*each, name) : "";
  };
  const std::string title = study.name;
  std::string body = "<h1>" + page::EscapeMarkup(title) + "</h1>\n" + Summary(study, counts) +
                     FailuresSection(counts, numbers) + FactorsTable(study) + StepsText(study);
  if (!numbers.columns().empty()) {
    body += "<h2>The numbers</h2>\n" + NumbersTable(numbers, counts.done) +
            figure(DistributionsFigure(numbers), "distributions");
    if (const auto surface = SurfaceFigure(numbers))
      body += "<h2>Over two keys</h2>\n" + figure(surface, "surface");
    if (numbers.worst() != nullptr)
      body +=
          "<h2>The worst cases</h2>\n" + figure(WorstFigure(numbers), "worst") + WorstTable(study, numbers);
  }
  return page::HtmlPage(title, body, study.Keys().size() > kManyKeys);
}

void WritePage(const Study& study, const std::string& folder, const TableCounts& counts,
               const StudyNumbers& numbers) {
  const auto write = [&](const std::optional<page::Figure>& figure, const std::string& name) {
    const std::string file = folder + "/" + name + ".svg";
    if (figure) {
      WriteWholeFile(file, page::FigureFile(*figure, name));
    } else {
      unlink(file.c_str());  // it belongs to an earlier, different report
    }
  };
  write(DistributionsFigure(numbers), "distributions");
  write(WorstFigure(numbers), "worst");
  write(SurfaceFigure(numbers), "surface");
  WriteWholeFile(folder + "/index.html", StudyPage(study, counts, numbers));
}

}  // namespace hydro::batch
