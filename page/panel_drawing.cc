#include "page/panel_drawing.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "page/curves.h"
#include "page/panel_geometry.h"
#include "page/svg.h"
#include "page/typeset.h"

namespace hydro::page {
namespace {

// Pixels.
constexpr double kTitleHeight = 22;
constexpr double kKeyRow = 19;
constexpr double kKeySample = 28;
constexpr double kKeyGap = 22;
constexpr double kTickLabels = 20;
constexpr double kAxisLabel = 20;
constexpr double kNoteLine = 15;  // between the lines of a note
constexpr double kAside = 7;      // from a point to its note
constexpr double kTextSize = 12;
// The width of a reader's own sans-serif font relative to the font that TextWidth knows. Labels beside an
// axis must not leave the picture.
constexpr double kWidestFont = 1.12;
constexpr double kLabelSize = 13;
constexpr double kMinBarWidth = 0.8;

// Space between the numbers along an axis.
constexpr double kTickRoomX = 58;
constexpr double kTickRoomY = 27;

// Even a tall panel needs no more than ten numbers.
double TickRoomY(double frame_height) { return std::max(kTickRoomY, frame_height / 10); }

std::vector<Tick> AxisTicks(const Axis& axis, const AxisRange& range, double pixels, double label_pixels) {
  return axis.ticks.empty() ? Ticks(range, pixels, label_pixels) : axis.ticks;
}

Box TextBox(double left, double top, double width, double height) {
  return {left, top, left + width, top + height};
}

std::string At(double x, double y) { return "M" + Pixels(x) + " " + Pixels(y); }

}  // namespace

PanelDrawing::PanelDrawing(const Panel& panel, const std::string& where) : panel_(&panel), where_(where) {
  for (size_t i = 0; i < panel.curves.size(); ++i) {
    styles_.push_back(StyleOf(panel.curves[i], static_cast<int>(i)));
  }
  geometry_ = FitPanel(panel, {0, 0, 100, 100}, where);
}

double PanelDrawing::LeftMargin(double frame_height) const {
  double widest = 0;
  if (panel_->y.numbers) {
    for (const Tick& tick : AxisTicks(panel_->y, geometry_.y, frame_height, TickRoomY(frame_height))) {
      widest = std::max(widest, TextWidth(tick.text) * kTextSize);
    }
  }
  return 8 + (panel_->y.label.empty() ? 0 : kAxisLabel) + kWidestFont * widest + 7;
}

double PanelDrawing::FootHeight() const {
  return (panel_->x.numbers ? kTickLabels : 4) + (panel_->x.label.empty() ? 0 : kAxisLabel);
}

double PanelDrawing::HeadHeight(double key_width) {
  key_.clear();
  double x = 0;
  int row = 0;
  const auto add = [&](const std::string& label, const CurveStyle* style, bool bars) {
    if (label.empty()) return;
    const double width = kKeySample + 6 + TextWidth(label) * kTextSize;
    if (x > 0 && x + width > key_width) {
      x = 0;
      ++row;
    }
    key_.push_back({label, style, bars, x, row});
    x += width + kKeyGap;
  };
  for (size_t i = 0; i < panel_->curves.size(); ++i) {
    add(panel_->curves[i].label, &styles_[i], panel_->curves[i].stroke == Stroke::kBars);
  }
  for (const Band& band : panel_->bands) add(band.label, nullptr, false);
  head_height_ = (panel_->title.empty() ? 0 : kTitleHeight) + (key_.empty() ? 0 : kKeyRow * (row + 1) + 4);
  return head_height_;
}

std::string PanelDrawing::Draw(const Box& frame, double left_margin) {
  geometry_ = FitPanel(*panel_, frame, where_);
  std::string out = SvgClipped(frame, Bands()) + Axes();
  // Rules lie above bars and below lines.
  const auto is_bars = [this](size_t i) { return panel_->curves[i].stroke == Stroke::kBars; };
  for (size_t i = 0; i < panel_->curves.size(); ++i) out += is_bars(i) ? CurveElements(i) : "";
  out += SvgClipped(frame, Rules());
  for (size_t i = 0; i < panel_->curves.size(); ++i) out += is_bars(i) ? "" : CurveElements(i);
  out += SvgRectangle("frame", frame);
  if (!panel_->title.empty()) {
    out += SvgText(panel_->title, frame.left, frame.top - head_height_ + 15, {.look = "title"});
  }
  out += Key();
  if (!panel_->x.label.empty()) {
    out += SvgText(panel_->x.label, (frame.left + frame.right) / 2,
                   frame.bottom + (panel_->x.numbers ? 36 : 18), {.look = "label", .anchor = "middle"});
  }
  if (!panel_->y.label.empty()) {
    const double height = frame.bottom - frame.top;
    const bool fits = TextWidth(panel_->y.label) * kLabelSize <= height + 6;
    out += SvgText(panel_->y.label, frame.left - left_margin + 17, (frame.top + frame.bottom) / 2,
                   {.look = fits ? "label" : "", .anchor = "middle", .upwards = true});
  }
  return out + Labels();
}

std::string PanelDrawing::Bands() const {
  std::string out;
  const Box& frame = geometry_.frame;
  for (const Band& band : panel_->bands) {
    const AxisRange& range = band.vertical ? geometry_.x : geometry_.y;
    if (band.to < range.min || band.from > range.max) continue;
    const double from = std::max(band.from, range.min);
    const double to = std::min(band.to, range.max);
    Box box = frame;
    if (band.vertical) {
      box.left = geometry_.Column(from);
      box.right = std::max(geometry_.Column(to), box.left + 1);  // a thinner one would be invisible
    } else {
      box.top = geometry_.Row(to);
      box.bottom = geometry_.Row(from);
    }
    out += SvgRectangle(band.vertical ? "span" : "band", box);
  }
  return out;
}

std::string PanelDrawing::Axes() const {
  const Box& frame = geometry_.frame;
  const double width = frame.right - frame.left;
  const double height = frame.bottom - frame.top;
  std::string grid, fine_grid, marks, zero, texts;
  for (const Tick& tick : AxisTicks(panel_->x, geometry_.x, width, kTickRoomX)) {
    const double x = geometry_.Column(tick.value);
    (tick.text.empty() ? fine_grid : grid) += At(x, frame.top) + "V" + Pixels(frame.bottom);
    if (tick.text.empty() || !panel_->x.numbers) continue;
    marks += At(x, frame.bottom) + "v4";
    texts += SvgText(tick.text, x, frame.bottom + 17, {.anchor = "middle"});
  }
  for (const Tick& tick : AxisTicks(panel_->y, geometry_.y, height, TickRoomY(height))) {
    const double y = geometry_.Row(tick.value);
    const bool is_zero = panel_->y.ticks.empty() && !geometry_.y.logarithmic && tick.value == 0;
    (is_zero ? zero : tick.text.empty() ? fine_grid : grid) += At(frame.left, y) + "H" + Pixels(frame.right);
    if (tick.text.empty() || !panel_->y.numbers) continue;
    marks += At(frame.left, y) + "h-4";
    texts += SvgText(tick.text, frame.left - 7, y + 4, {.anchor = "end"});
  }
  std::string out;
  for (const auto& [look, data] :
       {std::pair{"fine grid", fine_grid}, {"grid", grid}, {"zero", zero}, {"frame", marks}}) {
    if (!data.empty()) out += SvgPath(look, data);
  }
  return out + texts;
}

std::string PanelDrawing::Rules() const {
  std::string data;
  const Box& frame = geometry_.frame;
  for (const Rule& rule : panel_->rules) {
    if (!(rule.vertical ? geometry_.x : geometry_.y).Holds(rule.value)) continue;
    data += rule.vertical ? At(geometry_.Column(rule.value), frame.top) + "V" + Pixels(frame.bottom)
                          : At(frame.left, geometry_.Row(rule.value)) + "H" + Pixels(frame.right);
  }
  return data.empty() ? "" : SvgPath("rule", data);
}

std::vector<size_t> PanelDrawing::Drawn(const Curve& curve) const {
  if (!curve.y_low.empty() || curve.stroke == Stroke::kBars) {
    std::vector<size_t> all(curve.x.size());
    std::iota(all.begin(), all.end(), size_t{0});
    return all;
  }
  const auto column = [this](double x) { return 2 * geometry_.Column(x); };
  if (curve.stroke == Stroke::kPoints) {
    return ThinPoints(curve.x, curve.y, column, [this](double y) { return 2 * geometry_.Row(y); });
  }
  return ThinLine(curve.x, curve.y, column);
}

std::string PanelDrawing::LineData(const Curve& curve) const {
  std::string data;
  bool pen_up = true;
  double bar_left = 0;
  double bar_top = 0;
  const double bottom = geometry_.frame.bottom;
  for (const size_t i : Drawn(curve)) {
    const double x = geometry_.Column(curve.x[i]);
    const double y = geometry_.Row(curve.y[i]);
    if (curve.stroke == Stroke::kBars) {
      if (!pen_up && std::isfinite(x)) {
        data += At(bar_left, bottom) + "V" + Pixels(bar_top) + "H" +
                Pixels(std::max(x, bar_left + kMinBarWidth)) + "V" + Pixels(bottom) + "z";
      }
      bar_left = x;
      bar_top = y;
    }
    const bool shown = std::isfinite(x) && std::isfinite(y);
    if (shown && curve.stroke != Stroke::kBars) {
      if (pen_up) {
        data += At(x, y);
      } else if (curve.stroke == Stroke::kSteps) {
        data += "H" + Pixels(x) + "V" + Pixels(y);
      } else {
        data += "L" + Pixels(x) + " " + Pixels(y);
      }
    }
    pen_up = !shown;
  }
  return data;
}

std::string PanelDrawing::CurveElements(size_t number) const {
  const Curve& curve = panel_->curves[number];
  const CurveStyle& style = styles_[number];
  std::string cut_off;  // at the frame
  if (!curve.y_low.empty()) {
    std::string bars;
    for (size_t i = 0; i < curve.x.size(); ++i) {
      const double x = geometry_.Column(curve.x[i]);
      double low = geometry_.Row(curve.y_low[i]);
      const double high = geometry_.Row(curve.y_high[i]);
      if (!std::isfinite(low) && curve.y_low[i] <= 0) low = geometry_.frame.bottom;  // on a logarithmic axis
      if (!std::isfinite(x) || !std::isfinite(low) || !std::isfinite(high)) continue;
      bars += At(x - 3, low) + "h6m-3 0V" + Pixels(high) + "m-3 0h6";
    }
    if (!bars.empty()) cut_off += SvgPath("line " + style.colour, bars, " stroke-width=\"1.1\"");
  }
  if (style.width > 0) {
    const std::string data = LineData(curve);
    if (!data.empty() && curve.stroke == Stroke::kBars) cut_off += SvgPath("bars " + style.colour, data);
    if (!data.empty() && curve.stroke != Stroke::kBars)
      cut_off += SvgPath("line " + style.colour, data, LineAttributes(style));
  }
  std::vector<std::string> points;
  if (style.marker != Marker::kNone) {
    for (const size_t i : Drawn(curve)) {
      if (geometry_.Holds(curve.x[i], curve.y[i])) {
        points.push_back(At(geometry_.Column(curve.x[i]), geometry_.Row(curve.y[i])));
      }
    }
  }
  return SvgClipped(geometry_.frame, cut_off) + MarkerElement(style, points);
}

std::string PanelDrawing::Key() const {
  const Box& frame = geometry_.frame;
  std::string out;
  for (const KeyEntry& entry : key_) {
    const double x = frame.left + entry.x;
    const double y =
        frame.top - head_height_ + (panel_->title.empty() ? 0 : kTitleHeight) + kKeyRow * (entry.row + 0.5);
    if (entry.style == nullptr) {
      const bool span = std::any_of(panel_->bands.begin(), panel_->bands.end(), [&](const Band& band) {
        return band.label == entry.label && band.vertical;
      });
      out += SvgRectangle(span ? "span" : "band", TextBox(x, y - 5, kKeySample, 10));
    } else if (entry.bars) {
      out += SvgRectangle("bars " + entry.style->colour, TextBox(x, y - 5, kKeySample, 10));
    } else {
      if (entry.style->width > 0) {
        out += SvgPath("line " + entry.style->colour, At(x, y) + "h" + Pixels(kKeySample),
                       LineAttributes(*entry.style));
      }
      if (entry.style->marker != Marker::kNone) {
        CurveStyle shown = *entry.style;  // large enough to see, and not faint
        shown.marker_radius = std::max(shown.marker_radius, 3.2);
        shown.colour = shown.colour.substr(0, shown.colour.find(' '));
        out += MarkerElement(shown, {At(x + kKeySample / 2, y)});
      }
    }
    out += SvgText(entry.label, x + kKeySample + 6, y + 4);
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
      const double x = geometry_.Column(curve.x[from]);
      const double y = geometry_.Row(curve.y[from]);
      placement.AddStroke(x, y, geometry_.Column(curve.x[to]), geometry_.Row(curve.y[to]));
      if (curve.stroke == Stroke::kBars) placement.AddStroke(x, y, x, frame.bottom);
    }
  }
  for (const Rule& rule : panel_->rules) {
    const double at = rule.vertical ? geometry_.Column(rule.value) : geometry_.Row(rule.value);
    if (rule.vertical) placement.AddStroke(at, frame.top, at, frame.bottom);
    if (!rule.vertical) placement.AddStroke(frame.left, at, frame.right, at);
  }
  std::string out;
  for (const Note& note : panel_->notes) out += NoteElements(note, placement);
  for (const Rule& rule : panel_->rules) out += RuleLabel(rule, placement);
  return out;
}

std::string PanelDrawing::NoteElements(const Note& note, LabelPlacement& placement) const {
  if (!geometry_.Holds(note.x, note.y)) return "";
  const Box& frame = geometry_.frame;
  const double x = geometry_.Column(note.x);
  const double y = geometry_.Row(note.y);
  const std::vector<std::string> lines = WrapText(note.text, 0.4 * (frame.right - frame.left) / kTextSize);
  double w = 0;
  for (const std::string& line : lines) w = std::max(w, TextWidth(line) * kTextSize);
  const double h = kNoteLine * static_cast<double>(lines.size());
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
  const Box box = placement.Place(candidates);
  std::string out = MarkerElement({"ink", 0, {}, Marker::kDisc, 3}, {At(x, y)});
  for (size_t i = 0; i < lines.size(); ++i) {
    out += SvgText(lines[i], box.left, box.top + kNoteLine * static_cast<double>(i) + 11.5, {.look = "halo"});
  }
  return out;
}

std::string PanelDrawing::RuleLabel(const Rule& rule, LabelPlacement& placement) const {
  if (rule.label.empty() || !(rule.vertical ? geometry_.x : geometry_.y).Holds(rule.value)) return "";
  const Box& frame = geometry_.frame;
  const double w = TextWidth(rule.label) * kTextSize;
  std::vector<Box> candidates;
  for (int i = 0; i <= 10; ++i) {
    if (rule.vertical) {
      const double x = geometry_.Column(rule.value);
      const double y = frame.top + 4 + (frame.bottom - frame.top - kNoteLine - 8) * i / 10;
      candidates.push_back(TextBox(x + 5, y, w, kNoteLine));
      candidates.push_back(TextBox(x - 5 - w, y, w, kNoteLine));
    } else {
      const double y = geometry_.Row(rule.value);
      const double x = frame.right - 6 - w - (frame.right - frame.left - w - 12) * i / 10;
      candidates.push_back(TextBox(x, y - kNoteLine - 2, w, kNoteLine));
      candidates.push_back(TextBox(x, y + 2, w, kNoteLine));
    }
  }
  const Box box = placement.Place(candidates);
  return SvgText(rule.label, box.left, box.top + 11.5, {.look = "halo soft"});
}

}  // namespace hydro::page
