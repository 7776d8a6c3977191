#include "page/panel_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <ostream>

#include "page/curve_thinning.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Pixels.
constexpr double kTitleHeight = 22;
constexpr double kKeyRow = 19;
constexpr double kKeySample = 32;
constexpr double kKeyGap = 22;
constexpr double kLine = 15;  // from one line of a note to the next
constexpr double kAside = 7;  // from a point to its note
constexpr double kTextSize = 12;

constexpr char kRuleColour[] = "#555555";

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// gnuplot scales dashes with the line's width.
std::string DashType(const CurveStyle& style) {
  if (style.dash.empty()) return "1";
  std::string text = "(";
  for (const double length : style.dash) text += Number(length / (0.5 * style.width)) + ",";
  text.back() = ')';
  return text;
}

std::string SvgDash(const std::vector<double>& dash) {
  if (dash.empty()) return "";
  std::string text = " stroke-dasharray=\"";
  for (const double length : dash) text += Number(length) + ",";
  text.back() = '"';
  return text;
}

// Labelled and unlabelled ticks of a logarithmic axis; gnuplot's own may leave a short one without any.
std::string LogTicks(const char* axis, const AxisRange& range) {
  const double decades = std::log10(range.max / range.min);
  std::string text = std::string("set ") + axis + "tics (";
  for (int power = static_cast<int>(std::floor(std::log10(range.min)));
       power <= static_cast<int>(std::ceil(std::log10(range.max))); ++power) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < range.min * (1 - 1e-9) || value > range.max * (1 + 1e-9)) continue;
      const bool labelled = decades < 0.7   ? true
                            : decades < 2.6 ? digit == 1 || digit == 2 || digit == 5
                                            : digit == 1;
      text += labelled ? Number(value) : "\"\" " + Number(value) + " 1";
      text += ",";
    }
  }
  if (text.back() == '(') return "";
  text.back() = ')';
  return text + "\n";
}

Box TextBox(double left, double top, double width, double height) {
  return {left, top, left + width, top + height};
}

}  // namespace

std::string SvgText(const std::string& text, double x, double y, const TextStyle& style) {
  char place[160];
  if (style.upwards) {
    std::snprintf(place, sizeof place, "transform=\"translate(%.2f,%.2f) rotate(-90)\"", x, y);
  } else {
    std::snprintf(place, sizeof place, "x=\"%.2f\" y=\"%.2f\"", x, y);
  }
  return std::string("<text xml:space=\"preserve\" ") + place + " font-family=\"" + kFontFamily +
         "\" font-size=\"" + Number(style.size) + "\" fill=\"" + style.colour + "\" text-anchor=\"" +
         style.anchor + "\"" + (style.bold ? " font-weight=\"bold\"" : "") +
         (style.halo
              ? " stroke=\"#ffffff\" stroke-width=\"3.5\" stroke-linejoin=\"round\" paint-order=\"stroke\""
              : "") +
         ">" + TypesetSvg(text) + "</text>\n";
}

PanelDrawing::PanelDrawing(const Panel& panel, double left, double right) : panel_(&panel), left_(left) {
  double x = left;
  int row = 0;
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    styles_.push_back(StyleOf(panel.curves[i], static_cast<int>(i)));
    if (panel.curves[i].label.empty()) continue;
    const double width = kKeySample + 6 + TextWidth(panel.curves[i].label) * kTextSize;
    if (x > left && x + width > right) {
      x = left;
      ++row;
    }
    key_.push_back({i, x, row});
    x += width + kKeyGap;
  }
}

double PanelDrawing::head_height() const {
  return (panel_->title.empty() ? 0 : kTitleHeight) +
         (key_.empty() ? 0 : kKeyRow * (key_.back().row + 1) + 4);
}

void PanelDrawing::Fit(const Box& frame, const std::string& where) {
  geometry_ = FitPanel(*panel_, frame, where);
}

std::vector<size_t> PanelDrawing::Drawn(const Curve& curve) const {
  if (!curve.y_low.empty()) {
    std::vector<size_t> all(curve.x.size());
    std::iota(all.begin(), all.end(), size_t{0});
    return all;
  }
  const auto column = [this](double x) { return geometry_.Column(x); };
  if (curve.stroke == Stroke::kPoints) {
    return ThinPoints(curve.x, curve.y, column, [this](double y) { return geometry_.Row(y); });
  }
  return ThinLine(curve.x, curve.y, column);
}

void PanelDrawing::WriteData(std::ostream& script, size_t number) const {
  for (size_t i = 0; i < panel_->curves.size(); ++i) {
    const Curve& curve = panel_->curves[i];
    script << "$d" << number << '_' << i << " << EOD\n";
    for (const size_t k : Drawn(curve)) {
      if (!std::isfinite(geometry_.Column(curve.x[k])) || !std::isfinite(geometry_.Row(curve.y[k]))) {
        script << '\n';  // breaks the line
        continue;
      }
      script << Number(curve.x[k]) << ' ' << Number(curve.y[k]);
      if (!curve.y_low.empty()) script << ' ' << Number(curve.y_low[k]) << ' ' << Number(curve.y_high[k]);
      script << '\n';
    }
    script << "EOD\n";
  }
}

void PanelDrawing::WritePlot(std::ostream& script, size_t number, double width, double height) const {
  const Box& frame = geometry_.frame;
  script << "reset\nset encoding utf8\nset minussign\nunset key\nset clip two\nset errorbars small\n"
         << "set border 31 lw 1 lc rgb \"#000000\"\nset tics scale 0.5,0.25 nomirror\nset format '%h'\n"
         << "set grid xtics ytics mxtics mytics back lw 0.8 dt 1 lc rgb \"#d4d4d4\", lw 0.6 dt 1 lc rgb "
            "\"#e9e9e9\"\n"
         << "set lmargin at screen " << Number(frame.left / width) << "\nset rmargin at screen "
         << Number(frame.right / width) << "\nset tmargin at screen " << Number(1 - frame.top / height)
         << "\nset bmargin at screen " << Number(1 - frame.bottom / height) << "\n";
  const auto axis = [&script](const char* name, const AxisRange& range) {
    script << "set " << name << "range [" << Number(range.min) << ':' << Number(range.max) << "]\n";
    if (range.logarithmic) script << "set logscale " << name << "\n" << LogTicks(name, range);
  };
  axis("x", geometry_.x);
  axis("y", geometry_.y);
  for (const Rule& rule : panel_->rules) {
    if (!(rule.vertical ? geometry_.x : geometry_.y).Holds(rule.value)) continue;
    const std::string value = "first " + Number(rule.value);
    script << "set arrow from " << (rule.vertical ? value + ", graph 0" : "graph 0, " + value) << " to "
           << (rule.vertical ? value + ", graph 1" : "graph 1, " + value)
           << " nohead back lw 1 dt (8,6) lc rgb \"" << kRuleColour << "\"\n";
  }
  script << "plot ";
  // Comma-separated; NaN first, so that a panel without a drawable point still gets its axes.
  script << "NaN notitle";
  for (size_t i = 0; i < panel_->curves.size(); ++i) {
    const Curve& curve = panel_->curves[i];
    const CurveStyle& style = styles_[i];
    const std::string data = ", $d" + std::to_string(number) + "_" + std::to_string(i);
    const std::string colour = " lc rgb \"" + style.colour + "\" notitle";
    if (Drawn(curve).empty()) continue;
    if (!curve.y_low.empty()) {
      script << data << " using 1:2:3:4 with yerrorbars pt 0 ps 1 lw 1.1 dt 1" << colour;
    }
    if (style.width > 0) {
      script << data << " using 1:2 with " << (curve.stroke == Stroke::kSteps ? "steps" : "lines") << " lw "
             << Number(style.width) << " dt " << DashType(style) << colour;
    }
    if (style.marker != 0) {
      script << data << " using 1:2 with points pt " << style.marker << " ps "
             << Number(style.marker_radius / 4.5) << " lw 1" << colour;
    }
  }
  script << "\n";
}

std::string PanelDrawing::Key(const std::string& name) const {
  std::string out;
  for (const KeyEntry& entry : key_) {
    const CurveStyle& style = styles_[entry.curve];
    const double y = geometry_.frame.top - head_height() + (panel_->title.empty() ? 0 : kTitleHeight) +
                     kKeyRow * (entry.row + 0.5);
    char text[240];
    if (style.width > 0) {
      std::snprintf(text, sizeof text,
                    "<path d=\"M%.2f,%.2f h%g\" fill=\"none\" stroke=\"%s\" stroke-width=\"%g\"%s/>\n",
                    entry.x, y, kKeySample, style.colour.c_str(), style.width, SvgDash(style.dash).c_str());
      out += text;
    }
    if (style.marker != 0) {
      std::snprintf(
          text, sizeof text,
          "<use xlink:href=\"#%s-gpPt%d\" transform=\"translate(%.2f,%.2f) scale(3)\" color=\"%s\"/>\n",
          name.c_str(), style.marker - 1, entry.x + kKeySample / 2, y, style.colour.c_str());
      out += text;
    }
    out += SvgText(panel_->curves[entry.curve].label, entry.x + kKeySample + 6, y + 4, {});
  }
  return out;
}

std::string PanelDrawing::Labels() const {
  const Box& frame = geometry_.frame;
  LabelPlacement placement(frame);
  for (const Curve& curve : panel_->curves) {
    const std::vector<size_t> drawn = Drawn(curve);
    for (size_t k = 0; k < drawn.size(); ++k) {
      const size_t from = drawn[k];
      const size_t to = drawn[k + 1 < drawn.size() && curve.stroke != Stroke::kPoints ? k + 1 : k];
      placement.AddStroke(geometry_.Column(curve.x[from]), geometry_.Row(curve.y[from]),
                          geometry_.Column(curve.x[to]), geometry_.Row(curve.y[to]));
    }
  }
  for (const Rule& rule : panel_->rules) {
    const double at = rule.vertical ? geometry_.Column(rule.value) : geometry_.Row(rule.value);
    if (rule.vertical) placement.AddStroke(at, frame.top, at, frame.bottom);
    if (!rule.vertical) placement.AddStroke(frame.left, at, frame.right, at);
  }

  std::string out;
  const auto write = [&out](const std::vector<std::string>& lines, const Box& box, const char* colour) {
    for (size_t i = 0; i < lines.size(); ++i) {
      out += SvgText(lines[i], box.left, box.top + kLine * static_cast<double>(i) + 11.5,
                     {.size = kTextSize, .colour = colour, .halo = true});
    }
  };
  for (const Note& note : panel_->notes) {
    if (!geometry_.Holds(note.x, note.y)) continue;
    const double x = geometry_.Column(note.x);
    const double y = geometry_.Row(note.y);
    const std::vector<std::string> lines = WrapText(note.text, 0.4 * (frame.right - frame.left) / kTextSize);
    double w = 0;
    for (const std::string& line : lines) w = std::max(w, TextWidth(line) * kTextSize);
    const double h = kLine * static_cast<double>(lines.size());
    std::vector<Box> candidates;
    for (const double away : {kAside, 2.5 * kAside, 5 * kAside}) {
      for (const Box& box :
           {TextBox(x + away, y - h - away + 5, w, h), TextBox(x + away, y + away - 5, w, h),
            TextBox(x - away - w, y - h - away + 5, w, h), TextBox(x - away - w, y + away - 5, w, h),
            TextBox(x + away, y - h / 2, w, h), TextBox(x - away - w, y - h / 2, w, h),
            TextBox(x - w / 2, y - h - away, w, h), TextBox(x - w / 2, y + away, w, h)}) {
        candidates.push_back(box);
      }
    }
    char dot[120];
    std::snprintf(dot, sizeof dot, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3\" fill=\"#000000\"/>\n", x, y);
    out += dot;
    write(lines, placement.Place(candidates), "#000000");
  }
  for (const Rule& rule : panel_->rules) {
    if (rule.label.empty() || !(rule.vertical ? geometry_.x : geometry_.y).Holds(rule.value)) continue;
    const double w = TextWidth(rule.label) * kTextSize;
    std::vector<Box> candidates;
    for (int i = 0; i <= 10; ++i) {
      if (rule.vertical) {
        const double x = geometry_.Column(rule.value);
        const double y = frame.top + 4 + (frame.bottom - frame.top - kLine - 8) * i / 10;
        candidates.push_back(TextBox(x + 5, y, w, kLine));
        candidates.push_back(TextBox(x - 5 - w, y, w, kLine));
      } else {
        const double y = geometry_.Row(rule.value);
        const double x = frame.right - 6 - w - (frame.right - frame.left - w - 12) * i / 10;
        candidates.push_back(TextBox(x, y - kLine - 2, w, kLine));
        candidates.push_back(TextBox(x, y + 2, w, kLine));
      }
    }
    write({rule.label}, placement.Place(candidates), kRuleColour);
  }
  return out;
}

std::string PanelDrawing::Texts(const std::string& name) {
  const Box& frame = geometry_.frame;
  std::string out;
  if (!panel_->title.empty()) {
    out += SvgText(panel_->title, left_, frame.top - head_height() + 15, {.size = 13.5, .bold = true});
  }
  out += Key(name);
  if (!panel_->x.label.empty()) {
    out += SvgText(panel_->x.label, (frame.left + frame.right) / 2, frame.bottom + 37,
                   {.size = 13, .anchor = "middle"});
  }
  if (!panel_->y.label.empty()) {
    out += SvgText(panel_->y.label, 20, (frame.top + frame.bottom) / 2,
                   {.size = 13, .anchor = "middle", .upwards = true});
  }
  return out + Labels();
}

}  // namespace hydro::page
