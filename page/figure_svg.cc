#include "page/figure_svg.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "page/html_page.h"
#include "page/panel_drawing.h"
#include "page/svg.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Pixels.
constexpr double kRight = 18;
constexpr double kTop = 8;
constexpr double kGap = 12;
constexpr double kEmptyHead = 6;  // above a frame with neither title nor key
constexpr double kCaptionLine = 18;
constexpr double kCaptionSize = 13;
constexpr double kCaptionLeft = 20;

struct Picture {
  double width = 0;
  double height = 0;
  std::string content;
};

double PanelHeight(const Figure& figure) {
  if (figure.panel_height > 0) return figure.panel_height;
  const size_t rows = (figure.panels.size() + figure.columns - 1) / figure.columns;
  return rows == 1 ? 360 : rows == 2 ? 250 : 205;
}

struct Column {
  double left = 0;
  double width = 0;
  double margin = 0;  // pixels to the left of its frames

  double frame_left() const { return left + margin; }
  double frame_right() const { return left + width - kRight; }
};

// The columns, each with the margin that its panels need.
std::vector<Column> LayOutColumns(const Figure& figure, const std::vector<PanelDrawing>& drawings) {
  const size_t count = std::min(figure.columns, figure.panels.size());
  double shares = 0;
  for (size_t i = 0; i < count; ++i) shares += figure.panels[i].width;
  std::vector<Column> columns(count);
  for (size_t i = 0; i < count; ++i) {
    columns[i].left = i == 0 ? 0 : columns[i - 1].left + columns[i - 1].width;
    columns[i].width = figure.width * figure.panels[i].width / shares;
  }
  for (size_t i = 0; i < drawings.size(); ++i) {
    double& margin = columns[i % count].margin;
    margin = std::max(margin, drawings[i].LeftMargin(PanelHeight(figure) * figure.panels[i].height));
  }
  return columns;
}

bool HasKey(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(),
                     [](const Curve& curve) { return !curve.label.empty(); }) ||
         std::any_of(panel.bands.begin(), panel.bands.end(),
                     [](const Band& band) { return !band.label.empty(); });
}

// Where the key of panel `i` ends: at the end of its frame, or of the frames beside it that have no key.
double KeyEnd(const Figure& figure, const std::vector<Column>& columns, size_t i) {
  size_t column = i % columns.size();
  while (column + 1 < columns.size() && i + 1 < figure.panels.size() && !HasKey(figure.panels[i + 1])) {
    ++column;
    ++i;
  }
  return columns[column].frame_right();
}

Picture DrawPanels(const Figure& figure, const std::string& name) {
  if (figure.panels.empty()) throw std::invalid_argument(name + ": a figure without panels");
  if (figure.columns == 0) throw std::invalid_argument(name + ": a figure without columns");
  std::vector<PanelDrawing> drawings;
  for (size_t i = 0; i < figure.panels.size(); ++i) {
    drawings.emplace_back(figure.panels[i], name + ", panel " + std::to_string(i + 1));
  }
  const std::vector<Column> columns = LayOutColumns(figure, drawings);
  Picture picture{figure.width, kTop, ""};
  for (size_t row = 0; row < drawings.size(); row += columns.size()) {
    const size_t end = std::min(row + columns.size(), drawings.size());
    double head = kEmptyHead;
    double frame_height = 0;
    double foot = 0;
    for (size_t i = row; i < end; ++i) {
      const Column& column = columns[i - row];
      head = std::max(head, drawings[i].HeadHeight(KeyEnd(figure, columns, i) - column.frame_left()));
      frame_height = std::max(frame_height, PanelHeight(figure) * figure.panels[i].height);
      foot = std::max(foot, drawings[i].FootHeight());
    }
    const double top = picture.height + head;
    for (size_t i = row; i < end; ++i) {
      const Column& column = columns[i - row];
      picture.content += drawings[i].Draw(
          {column.frame_left(), top, column.frame_right(), top + frame_height}, column.margin);
    }
    picture.height = top + frame_height + foot + (foot > kGap || end == drawings.size() ? kGap : 0);
  }
  picture.height = std::ceil(picture.height - kGap / 2);
  return picture;
}

Picture TakeDrawing(const std::string& drawing, const std::string& name) {
  const size_t tag = drawing.find("<svg");
  const size_t box = drawing.find("viewBox=\"0 0 ", tag);
  Picture picture;
  if (tag == std::string::npos || box == std::string::npos ||
      !(std::istringstream(drawing.substr(box + 13, 40)) >> picture.width >> picture.height) ||
      picture.width <= 0 || picture.height <= 0) {
    throw std::invalid_argument(name + ": the drawing is no <svg> with viewBox=\"0 0 WIDTH HEIGHT\"");
  }
  // A drawing without its own size takes the viewBox's.
  picture.content = fmt::format("<svg width=\"{:g}\" height=\"{:g}\">\n{}\n</svg>\n", picture.width,
                                picture.height, drawing.substr(tag));
  return picture;
}

Picture Draw(const Figure& figure, const std::string& name) {
  return figure.drawing.empty() ? DrawPanels(figure, name) : TakeDrawing(figure.drawing, name);
}

std::string Element(const Picture& picture, const std::string& about, std::string_view attributes,
                    std::string_view style) {
  // Wide pictures must not shrink to the width of a phone.
  constexpr double kWide = 600;
  return fmt::format(
      "<svg{} class=\"chart{}\" viewBox=\"0 0 {:g} {:g}\" width=\"{:g}\" height=\"{:g}\" role=\"img\" "
      "aria-label=\"{}\">\n{}<rect class=\"paper\" width=\"{:g}\" height=\"{:g}\"/>\n{}</svg>\n",
      attributes, picture.width > kWide ? " wide" : "", picture.width, picture.height, picture.width,
      picture.height, EscapeMarkup(about), style, picture.width, picture.height, picture.content);
}

// The description for screen readers.
std::string About(const Figure& figure, const std::string& name) {
  if (!figure.caption.empty()) return figure.caption.substr(0, figure.caption.find(". "));
  for (const Panel& panel : figure.panels) {
    if (!panel.title.empty()) return panel.title;
  }
  return name;
}

}  // namespace

std::string FigureElement(const Figure& figure, const std::string& name) {
  return Element(Draw(figure, name), About(figure, name), "", "");
}

std::string HtmlFigure(const Figure& figure, const std::string& name) {
  const std::string caption =
      figure.caption.empty() ? "" : "<figcaption>" + TypesetHtml(figure.caption) + "</figcaption>\n";
  return "<figure>\n<div class=\"picture\">\n" + FigureElement(figure, name) + "</div>\n" + caption +
         "</figure>\n";
}

std::string FigureFile(const Figure& figure, const std::string& name) {
  Picture picture = Draw(figure, name);
  const std::vector<std::string> caption =
      WrapText(figure.caption, (picture.width - 2 * kCaptionLeft) / kCaptionSize);
  double y = picture.height + 0.75 * kCaptionLine;
  for (const std::string& line : caption) {
    picture.content += SvgText(line, kCaptionLeft, y, {.look = "label"});
    y += kCaptionLine;
  }
  if (!caption.empty()) picture.height = std::ceil(y - 0.15 * kCaptionLine);
  // Converters of SVG files ignore the style sheet's "white-space" and would drop the blank after a
  // subscript.
  return Element(picture, About(figure, name), " xmlns=\"http://www.w3.org/2000/svg\" xml:space=\"preserve\"",
                 fmt::format("<style>{}</style>\n", ChartStyle()));
}

}  // namespace hydro::page
