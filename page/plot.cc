#include "page/plot.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "page/curve_style.h"
#include "page/gnuplot.h"
#include "page/panel_drawing.h"
#include "page/panel_geometry.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Pixels.
constexpr double kWidth = 860;
constexpr double kLeft = 80;
constexpr double kRight = 22;
constexpr double kTop = 12;
constexpr double kTickLabels = 22;
constexpr double kAxisLabel = 20;
constexpr double kGap = 14;
constexpr double kCaptionLine = 18;
constexpr double kCaptionSize = 13;

double PanelHeight(size_t panels) { return panels == 1 ? 360 : panels == 2 ? 250 : 205; }

void Replace(std::string& text, std::string_view from, std::string_view to) {
  for (size_t i = 0; (i = text.find(from, i)) != std::string::npos; i += to.size()) {
    text.replace(i, from.size(), to);
  }
}

// What gnuplot drew, with ids of its own, the report's fonts, and without its empty groups and tool tips.
std::string Tidy(const std::string& drawn, const std::string& name) {
  std::istringstream lines(drawn);
  std::string out;
  std::string group;  // an opening tag that may turn out to have nothing in it
  for (std::string line; std::getline(lines, line);) {
    if (!group.empty() && line == "</g>") {
      group.clear();
      continue;
    }
    out += group;
    group.clear();
    if (line.starts_with("<g fill=")) {
      group = line + "\n";
      continue;
    }
    if (line.starts_with("<desc>")) continue;
    if (const size_t title = line.find("<title>" + name + "_plot"); title != std::string::npos) {
      line.erase(title);
    }
    out += line + "\n";
  }
  for (const char* id : {"gpPt", "gpDot", "textbox", "greybox", "gnuplot_canvas"}) {
    Replace(out, std::string("id='") + id, "id='" + name + "-" + id);
    Replace(out, std::string("id=\"") + id, "id=\"" + name + "-" + id);
    Replace(out, std::string("'#") + id, "'#" + name + "-" + id);
  }
  Replace(out, " stroke-dasharray='2,4' class=\"gridline\"", "");  // whatever the script says
  Replace(out, "font-family=\"Helvetica\"", "font-family=\"" + std::string(kFontFamily) + "\"");
  return out;
}

std::string Caption(const std::vector<std::string>& lines, double left, double top) {
  std::string out;
  for (size_t i = 0; i < lines.size(); ++i) {
    out += SvgText(lines[i], left, top + kCaptionLine * (static_cast<double>(i) + 0.75),
                   {.size = kCaptionSize, .colour = "#333333"});
  }
  return out;
}

void CheckName(const std::string& name) {
  const bool good = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-';
  });
  if (!good)
    throw std::invalid_argument("a picture's name is letters, digits and hyphens, not '" + name + "'");
}

std::string WithCaption(const std::string& drawing, const std::string& caption, const std::string& name) {
  const size_t tag = drawing.find("<svg");
  const size_t box = drawing.find("viewBox=\"0 0 ", tag);
  double width = 0;
  double height = 0;
  if (tag == std::string::npos || box == std::string::npos ||
      !(std::istringstream(drawing.substr(box + 13, 40)) >> width >> height) || width <= 0 || height <= 0) {
    throw std::invalid_argument(name + ": the drawing is no <svg> with viewBox=\"0 0 WIDTH HEIGHT\"");
  }
  const std::vector<std::string> lines = WrapText(caption, (width - 40) / kCaptionSize);
  const double total =
      height + (lines.empty() ? 0 : kCaptionLine * (static_cast<double>(lines.size()) + 0.6));
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\""
      << width << "\" height=\"" << total << "\" viewBox=\"0 0 " << width << ' ' << total << "\">\n<title>"
      << EscapeMarkup(name) << "</title>\n<rect width=\"" << width << "\" height=\"" << total
      << "\" fill=\"#ffffff\"/>\n"
      // A drawing without a size of its own takes the viewBox's.
      << "<svg width=\"" << width << "\" height=\"" << height << "\">\n"
      << drawing.substr(tag) << "\n</svg>\n"
      << Caption(lines, 20, height) << "</svg>\n";
  return out.str();
}

}  // namespace

Curve Line(const std::string& label, const std::vector<double>& x, const std::vector<double>& y, int colour,
           Stroke stroke) {
  return {.label = label, .x = x, .y = y, .stroke = stroke, .colour = colour, .y_low = {}, .y_high = {}};
}

std::string RenderSvg(const Figure& figure, const std::string& name) {
  CheckName(name);
  std::string id = name;  // gnuplot's names have no hyphens
  std::replace(id.begin(), id.end(), '-', '_');
  if (!figure.drawing.empty()) return WithCaption(figure.drawing, figure.caption, name);
  if (figure.panels.empty()) throw std::invalid_argument(name + ": a figure without panels");

  std::vector<PanelDrawing> drawings;
  double top = kTop;
  for (size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    const std::string where = name + ", panel " + std::to_string(i + 1);
    PanelDrawing drawing(panel, kLeft, kWidth - kRight);
    const double frame_top = top + drawing.head_height();
    const double bottom = frame_top + PanelHeight(figure.panels.size()) * panel.height;
    drawing.Fit({kLeft, frame_top, kWidth - kRight, bottom}, where);
    drawings.push_back(std::move(drawing));
    top = bottom + kTickLabels + (panel.x.label.empty() ? 0 : kAxisLabel) + kGap;
  }
  const std::vector<std::string> caption = WrapText(figure.caption, (kWidth - 2 * kRight) / kCaptionSize);
  const double caption_top = top - kGap / 2;
  const double height = std::ceil(caption_top + kCaptionLine * (static_cast<double>(caption.size()) + 0.6));

  std::ostringstream script;
  script << "set encoding utf8\nset minussign\nset terminal svg size " << kWidth << ',' << height
         << " fixed enhanced background \"#ffffff\" font \"Helvetica,12\" name \"" << id
         << "\" linewidth 1 butt\n";
  for (size_t i = 0; i < drawings.size(); ++i) drawings[i].WriteData(script, i);
  script << "set multiplot\n";
  for (size_t i = 0; i < drawings.size(); ++i) drawings[i].WritePlot(script, i, kWidth, height);
  script << "unset multiplot\n";

  std::string svg = Tidy(RunGnuplot(script.str()), id);
  std::string overlay;
  for (PanelDrawing& drawing : drawings) overlay += drawing.Texts(id);
  overlay += Caption(caption, kRight, caption_top);
  const size_t end = svg.rfind("</svg>");
  if (end == std::string::npos) throw std::runtime_error(name + ": gnuplot drew nothing");
  svg.insert(end, overlay);
  return svg;
}

}  // namespace hydro::page
