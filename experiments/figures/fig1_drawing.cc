#include "experiments/figures/fig1_drawing.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "page/panel_drawing.h"

namespace hydro::experiments {
namespace {

// Pixels, y downwards.
constexpr double kWidth = 1100;
constexpr double kHeight = 515;
constexpr double kLine1 = 110;  // y of the two lines and of what is between them
constexpr double kMiddle = 270;
constexpr double kLine2 = 430;
constexpr double kPump = 275;  // x of the parts
constexpr double kInternalLeakage = 365;
constexpr double kValves = 470;
constexpr double kExternalLeakage = 560;
constexpr double kBypass = 740;
constexpr double kActuator = 900;
constexpr double kRadius = 82;  // of the actuator
constexpr double kPort = kActuator - 30;

constexpr char kSide1[] = "#0b3c6f";
constexpr char kSide2[] = "#b04a00";
constexpr char kInk[] = "#1a1a1a";
constexpr char kGrey[] = "#666666";

class Drawing {
 public:
  // `attributes`: of the element, without stroke and fill.
  void Path(const std::string& data, const char* colour = kInk, double width = 1.6,
            const std::string& attributes = "fill=\"none\"") {
    svg_ += fmt::format("<path d=\"{}\" stroke=\"{}\" stroke-width=\"{}\" {}/>\n", data, colour, width,
                        attributes);
  }
  void Solid(const std::string& data, const char* colour) {
    svg_ += fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", data, colour);
  }
  void Circle(double x, double y, double r, const char* colour = kInk, const char* fill = "#ffffff") {
    svg_ +=
        fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"/>\n",
                    x, y, r, fill, colour);
  }
  void Rectangle(double x, double y, double w, double h) {
    svg_ += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#ffffff\" stroke=\"{}\" "
        "stroke-width=\"1.6\"/>\n",
        x, y, w, h, kInk);
  }
  // An arrow head at (x, y) that points along (dx, dy), of length 1.
  void Head(double x, double y, double dx, double dy, const char* colour) {
    Solid(fmt::format("M{:.1f},{:.1f} L{:.1f},{:.1f} L{:.1f},{:.1f} z", x, y, x - 10 * dx - 4 * dy,
                      y - 10 * dy + 4 * dx, x - 10 * dx + 4 * dy, y - 10 * dy - 4 * dx),
          colour);
  }
  void Arrow(double x0, double y0, double x1, double y1, const char* colour) {
    const double length = std::hypot(x1 - x0, y1 - y0);
    Path(fmt::format("M{},{} L{},{}", x0, y0, x1, y1), colour);
    Head(x1, y1, (x1 - x0) / length, (y1 - y0) / length, colour);
  }
  void Dot(double x, double y, const char* colour) { Circle(x, y, 3, colour, colour); }
  // Lines of text, one below the other.
  void Text(double x, double y, const std::vector<std::string>& lines, page::TextStyle style = {.size = 13}) {
    for (const std::string& line : lines) {
      svg_ += page::SvgText(line, x, y, style);
      y += 17;
    }
  }
  // A throttle in a vertical pipe.
  void Throttle(double x, double y) {
    Path(fmt::format("M{},{} q10,14 0,28 M{},{} q-10,14 0,28", x - 10, y - 14, x + 10, y - 14));
  }
  // A one-way valve in a vertical pipe: the ball lies against the seat; flow goes the way `direction` says,
  // -1 up, 1 down.
  void OneWayValve(double x, double y, int direction) {
    const double seat = y - 7 * direction;
    Circle(x, y + 2 * direction, 7);
    Path(fmt::format("M{},{} L{},{} L{},{}", x - 13, y + 6 * direction, x, seat - 3 * direction, x + 13,
                     y + 6 * direction));
  }

  std::string svg() const {
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
               "aria-label=\"schematic of the apparatus\" stroke-linecap=\"round\" "
               "stroke-linejoin=\"round\">\n",
               kWidth, kHeight) +
           svg_ + "</svg>";
  }

 private:
  std::string svg_;
};

page::TextStyle Centred(bool bold = false) { return {.size = 13, .anchor = "middle", .bold = bold}; }
page::TextStyle Value(const char* anchor = "start") {
  return {.size = 12, .colour = kGrey, .anchor = anchor};
}

void DrawDrive(Drawing& d, const model::Parameters& p) {
  d.Arrow(8, kMiddle, 45, kMiddle, kInk);
  d.Text(10, kMiddle - 10, {"v"});
  d.Rectangle(45, kMiddle - 28, 74, 56);
  d.Text(82, kMiddle - 3, {"current", "amplifier"}, Centred());
  d.Path(fmt::format("M119,{0} H150", kMiddle));
  d.Circle(180, kMiddle, 30);
  d.Text(180, kMiddle + 5, {"M"}, Centred(true));
  d.Text(180, kMiddle - 58, {"brushless", "DC motor"}, Centred());
  d.Text(45, kMiddle + 52,
         {fmt::format("k_1 = {:g} in-lbf/V", p.k_1), fmt::format("|T_p| ≤ {:g} in-lbf", p.T_pmax)}, Value());
  // The shaft, two lines as usual, with its sense of rotation.
  d.Path(fmt::format("M210,{} H{} M210,{} H{}", kMiddle - 3, kPump - 38, kMiddle + 3, kPump - 38));
  d.Path(fmt::format("M218,{} a9,20 0 0 1 0,-32", kMiddle + 16), kInk, 1.3);
  d.Head(225, kMiddle - 16.5, 1, 0.1, kInk);
  d.Text(211, kMiddle - 24, {"θ'"});
  d.Text(205, kMiddle + 52, {"T_p"}, {.size = 13, .anchor = "end"});
}

void DrawPump(Drawing& d, const model::Parameters& p) {
  d.Path(fmt::format("M{0},{1} V{2}", kPump, kMiddle - 38, kLine1), kSide1, 3);
  d.Path(fmt::format("M{0},{1} V{2}", kPump, kMiddle + 38, kLine2), kSide2, 3);
  d.Circle(kPump, kMiddle, 38);
  d.Solid(fmt::format("M{0},{1} l-11,17 h22 z", kPump, kMiddle - 37), kSide1);
  d.Solid(fmt::format("M{0},{1} l-11,-17 h22 z", kPump, kMiddle + 37), kSide2);
  d.Text(kPump - 14, kLine1 + 18, {"fixed-", "displacement", "pump D"}, {.size = 13, .anchor = "end"});
  d.Arrow(kPump - 14, kLine2 - 95, kPump - 14, kLine2 - 62, kSide2);
  d.Text(kPump - 22, kLine2 - 74, {"D θ'"}, {.size = 13, .anchor = "end"});
  d.Text(45, kLine2 - 30,
         {fmt::format("D = {:g} in^3/rad", p.D), fmt::format("J = {:g} lbf-in-s^2", p.J),
          fmt::format("b = {:g} in-lbf-s", p.b), fmt::format("T_s = {:g} in-lbf, f = {:g}", p.T_s, p.f)},
         Value());
}

void DrawLines(Drawing& d, const model::Parameters& p) {
  d.Path(fmt::format("M{},{} H{} V{}", kPump, kLine1, kPort, kMiddle - 70), kSide1, 3);
  d.Path(fmt::format("M{},{} H{} V{}", kPump, kLine2, kPort, kMiddle + 70), kSide2, 3);
  // Flows out of the actuator, as eqs. (9) and (10) count them.
  d.Head(kBypass + 50, kLine1, -1, 0, kSide1);
  d.Text(kBypass + 46, kLine1 - 12, {"q_1"}, Centred());
  d.Head(kBypass + 50, kLine2, -1, 0, kSide2);
  d.Text(kBypass + 46, kLine2 + 24, {"q_2"}, Centred());
  for (const bool first : {true, false}) {
    const double y = first ? kLine1 : kLine2;
    const double outwards = first ? -1 : 1;
    const double x = 650;
    d.Path(fmt::format("M{},{} v{}", x, y, 22 * outwards), first ? kSide1 : kSide2);
    d.Circle(x, y + 38 * outwards, 17, first ? kSide1 : kSide2);
    d.Text(x, y + 38 * outwards + 5, {first ? "p_1" : "p_2"}, Centred());
    d.Text(x + 26, y + 38 * outwards + 5, {"pressure transducer"});
    d.Text(kPump + 40, y + (first ? -14 : 24), {first ? "side 1" : "side 2"},
           {.size = 13, .colour = first ? kSide1 : kSide2, .bold = true});
  }
  d.Text(kPump + 110, kLine1 - 14, {fmt::format("bulk modulus β = {:g} psi", p.beta)}, Value());

  d.Path(fmt::format("M{0},{1} V{2}", kInternalLeakage, kLine1, kLine2), kInk, 1.3,
         "fill=\"none\" stroke-dasharray=\"5 4\"");
  d.Throttle(kInternalLeakage, kMiddle);
  d.Dot(kInternalLeakage, kLine1, kSide1);
  d.Dot(kInternalLeakage, kLine2, kSide2);
  d.Text(kInternalLeakage + 8, kMiddle + 110, {"c_I"});
  d.Text(kInternalLeakage + 8, kMiddle + 128, {fmt::format("{:.1e}", p.c_I)}, Value());

  d.Path(fmt::format("M{0},{1} V{2} M{0},{3} V{4}", kBypass, kLine1, kMiddle - 13, kMiddle + 13, kLine2),
         kInk, 1.6);
  d.Path(fmt::format("M{},{} h22 l-22,26 h22 z", kBypass - 11, kMiddle - 13), kInk, 1.6, "fill=\"#ffffff\"");
  d.Path(fmt::format("M{},{} h-16 m0,-7 v14", kBypass, kMiddle));
  d.Dot(kBypass, kLine1, kSide1);
  d.Dot(kBypass, kLine2, kSide2);
  d.Text(kBypass - 12, kMiddle - 44, {"bypass", "valve"}, {.size = 13, .anchor = "end"});
}

void DrawAccumulator(Drawing& d, const model::Parameters& p) {
  d.Path(fmt::format("M{0},{1} V{2} M{0},{3} V{4}", kValves, kLine1, kMiddle - 87, kMiddle - 68, kMiddle));
  d.Path(fmt::format("M{0},{1} V{2} M{0},{3} V{4}", kValves, kMiddle, kMiddle + 68, kMiddle + 87, kLine2));
  d.OneWayValve(kValves, kMiddle - 78, -1);
  d.OneWayValve(kValves, kMiddle + 78, 1);
  d.Text(kValves - 20, kMiddle - 80, {"one-way", "valves"}, {.size = 13, .anchor = "end"});
  d.Path(fmt::format("M{0},{1} V{2} M{0},{3} V{4}", kExternalLeakage, kLine1, kMiddle, kMiddle, kLine2), kInk,
         1.3, "fill=\"none\" stroke-dasharray=\"5 4\"");
  d.Throttle(kExternalLeakage, kMiddle - 78);
  d.Throttle(kExternalLeakage, kMiddle + 78);
  d.Text(kExternalLeakage + 18, kMiddle - 84, {"c_E"});
  d.Text(kExternalLeakage + 18, kMiddle - 66, {fmt::format("{:.1e}", p.c_E)}, Value());
  d.Text(kExternalLeakage + 18, kMiddle + 82, {"c_E"});
  for (const double x : {kValves, kExternalLeakage}) {
    d.Dot(x, kLine1, kSide1);
    d.Dot(x, kLine2, kSide2);
    d.Dot(x, kMiddle, kInk);
  }
  // The vessel: oil on the left of the piston, the spring on its right.
  d.Path(fmt::format("M{},{} H590", kValves, kMiddle));
  d.Rectangle(590, kMiddle - 20, 96, 40);
  d.Solid(fmt::format("M591,{} h33 v38 h-33 z", kMiddle - 19), "#d9e4ee");
  d.Path(fmt::format("M628,{} v38", kMiddle - 19), kInk, 6, "fill=\"none\" stroke-linecap=\"butt\"");
  std::string spring = fmt::format("M631,{}", kMiddle);
  for (int i = 0; i < 6; ++i) spring += fmt::format(" l8,{}", i == 0 ? 12 : (i % 2 == 1 ? -24 : 24));
  d.Path(spring + fmt::format(" L685,{}", kMiddle), kInk, 1.3);
  d.Text(590, kMiddle + 40, {fmt::format("accumulator p_3 = {:g} psi", p.p_3)});
}

void DrawActuator(Drawing& d, const model::Parameters& p) {
  const double angle = 22 * std::numbers::pi / 180;  // shown
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  const auto point = [&](double along, double across = 0) {
    return fmt::format("{:.1f},{:.1f}", kActuator + along * cosine - across * sine,
                       kMiddle - along * sine - across * cosine);
  };
  d.Circle(kActuator, kMiddle, kRadius);
  // The chambers: side 2 below, so that p_2 > p_1 lifts the arm.
  const std::string end = point(kRadius);
  d.Solid(fmt::format("M{0},{1} A{2},{2} 0 0 1 {3} L{4},{1} z", kActuator - kRadius, kMiddle, kRadius, end,
                      kActuator),
          "#dde7f1");
  d.Solid(fmt::format("M{0},{1} A{2},{2} 0 1 0 {3} L{4},{1} z", kActuator - kRadius, kMiddle, kRadius, end,
                      kActuator),
          "#f6e3d3");
  d.Path(fmt::format("M{0},{1} a{2},{2} 0 1 0 {3},0 a{2},{2} 0 1 0 {4},0", kActuator - kRadius, kMiddle,
                     kRadius, 2 * kRadius, -2 * kRadius),
         kInk, 2);
  d.Solid(
      fmt::format("M{},{} h{} v16 h{} z", kActuator - kRadius, kMiddle - 8, kRadius - 10, -(kRadius - 10)),
      "#8a8a8a");
  d.Path(fmt::format("M{} L{}", point(0), point(kRadius - 2)), kInk, 7,
         "fill=\"none\" stroke-linecap=\"butt\"");
  d.Path(fmt::format("M{0},{1} H{2}", kActuator, kMiddle, kWidth - 20), kGrey, 1,
         "fill=\"none\" stroke-dasharray=\"7 4 2 4\"");
  // The arm.
  d.Path(fmt::format("M{} L{}", point(kRadius), point(190)), kInk, 5);
  d.Circle(kActuator + 150 * cosine, kMiddle - 150 * sine, 9, kInk, kInk);
  d.Arrow(kActuator + 150 * cosine, kMiddle - 150 * sine + 9, kActuator + 150 * cosine,
          kMiddle - 150 * sine + 44, kGrey);
  d.Text(kActuator + 150 * cosine + 9, kMiddle - 150 * sine + 42, {"m g"});
  d.Text(kActuator + 118, kMiddle - 84, {"arm J_a"}, {.size = 13, .anchor = "middle"});
  d.Path(fmt::format("M{0:.1f},{1} A112,112 0 0 0 {2}", kActuator + 112, kMiddle, point(112)), kInk, 1.3);
  d.Head(kActuator + 112 * cosine, kMiddle - 112 * sine, -sine, -cosine, kInk);
  d.Text(kActuator + 117, kMiddle - 8, {"α"});
  d.Circle(kActuator, kMiddle, 11);
  d.Text(kActuator - 22, kMiddle - 34, {"V_1, p_1"}, Centred());
  d.Text(kActuator - 5, kMiddle + 48, {"V_2, p_2"}, Centred());
  d.Text(kActuator + 20, kLine1 - 6, {"rotary vane actuator", "V_1 = V_ms - c α", "V_2 = V_ms + c α"});
  d.Text(kActuator + 10, kLine2 - 50,
         {fmt::format("V_ms = {:g} in^3", p.V_ms), fmt::format("c = r^2 d/2 = {:.4g} in^3/rad", p.c),
          fmt::format("k_2 = {:g} in-lbf/psi", p.k_2), fmt::format("J_a = {:g} lbf-in-s^2", p.J_a),
          "m g l is not printed", "the shaft is free or clamped"},
         Value());
}

}  // namespace

std::string ApparatusDrawing(const model::Parameters& parameters) {
  Drawing drawing;
  DrawLines(drawing, parameters);
  DrawAccumulator(drawing, parameters);
  DrawDrive(drawing, parameters);
  DrawPump(drawing, parameters);
  DrawActuator(drawing, parameters);
  return drawing.svg();
}

}  // namespace hydro::experiments
