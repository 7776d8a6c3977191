#include "experiments/figures/fig8_block_diagram.h"

#include <spdlog/fmt/fmt.h>

#include <cctype>
#include <string_view>

namespace hydro::experiments {
namespace {

constexpr double kAxis = 120;  // y of the forward path
constexpr double kBlockHeight = 64;

// "c_1 = 3" with the letters and digits after each underscore set lower.
std::string WithSubscripts(std::string_view text) {
  std::string set;
  for (size_t i = 0; i < text.size();) {
    if (text[i] != '_') {
      set += text[i++];
      continue;
    }
    size_t end = i + 1;
    while (end < text.size() && std::isalnum(static_cast<unsigned char>(text[end]))) ++end;
    set += fmt::format("<tspan dy=\"4\" font-size=\"75%\">{}</tspan><tspan dy=\"-4\">&#8203;</tspan>",
                       text.substr(i + 1, end - i - 1));
    i = end;
  }
  return set;
}

std::string Text(double x, double y, std::string_view text, double size = 15,
                 std::string_view anchor = "middle", std::string_view colour = "#222") {
  return fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x,
                     y, size, anchor, colour, WithSubscripts(text));
}

// Through the points "x,y x,y ...", an arrow's head at the last one.
std::string Arrow(std::string_view points) {
  return fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.4\" "
      "marker-end=\"url(#position-loop-arrow)\"/>\n",
      points);
}

std::string Box(double x, double width) {
  return fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#fff\" stroke=\"#222\" "
      "stroke-width=\"1.4\"/>\n",
      x, kAxis - kBlockHeight / 2, width, kBlockHeight);
}

std::string Block(double x, double width, std::string_view text) {
  return Box(x, width) + Text(x + width / 2, kAxis + 5, text);
}

std::string FractionBlock(double x, double width, std::string_view numerator, std::string_view denominator) {
  return Box(x, width) + Text(x + width / 2, kAxis - 9, numerator) +
         fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"#222\" stroke-width=\"1.2\"/>\n",
                     x + 10, kAxis, x + width - 10, kAxis) +
         Text(x + width / 2, kAxis + 20, denominator);
}

// What a group of blocks is, with its numbers below.
std::string Legend(double from, double to, std::string_view what, std::string_view numbers) {
  const double middle = (from + to) / 2;
  return fmt::format("<path d=\"M{0} 64 v-8 H{1} v8\" fill=\"none\" stroke=\"#888\" stroke-width=\"1\"/>\n",
                     from, to) +
         Text(middle, 46, what, 13, "middle", "#555") + Text(middle, 178, numbers, 13, "middle", "#555");
}

}  // namespace

std::string DrawPositionLoop(const DesignModel& m, double gain) {
  const double squared = m.natural_frequency * m.natural_frequency;
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 960 250\" font-family=\"Helvetica, Arial, "
      "sans-serif\">\n<defs><marker id=\"position-loop-arrow\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" "
      "markerWidth=\"8\" markerHeight=\"8\" orient=\"auto\"><path d=\"M0 1 L10 5 L0 9 z\" "
      "fill=\"#222\"/></marker></defs>\n<rect width=\"960\" height=\"250\" fill=\"#fff\"/>\n";
  // The comparison, then the blocks from left to right.
  svg += Text(38, kAxis - 10, "α_ref") + Arrow("14,120 76,120");
  svg +=
      "<circle cx=\"90\" cy=\"120\" r=\"14\" fill=\"#fff\" stroke=\"#222\" stroke-width=\"1.4\"/>\n"
      "<path d=\"M80 110 L100 130 M80 130 L100 110\" stroke=\"#222\" stroke-width=\"1\"/>\n";
  svg += Text(68, kAxis + 18, "+") + Text(105, kAxis + 32, "−");
  svg += Text(122, kAxis - 10, "−e") + Arrow("104,120 146,120");
  svg += Block(146, 122, fmt::format("g (s + {:g})", m.zero));
  svg += Text(302, kAxis - 10, "Δp_ref") + Arrow("268,120 338,120");
  svg += FractionBlock(338, 184, fmt::format("{:g}", squared),
                       fmt::format("s² + {:g} s + {:g}", 2 * m.damping_ratio * m.natural_frequency, squared));
  svg += Text(546, kAxis - 10, "Δp") + Arrow("522,120 572,120");
  svg += Block(572, 84, fmt::format("{:g}", m.k_2));
  svg += Text(684, kAxis - 10, "k_2 Δp") + Arrow("656,120 714,120");
  svg += FractionBlock(714, 92, "1", fmt::format("{:g} s²", m.J_a));
  svg += Text(870, kAxis - 10, "α") + Arrow("806,120 940,120");
  svg += "<circle cx=\"840\" cy=\"120\" r=\"3\" fill=\"#222\"/>\n" + Arrow("840,120 840,220 90,220 90,134");

  svg += Legend(146, 268, "digital PD, eq. (17)", fmt::format("g = {:g}", gain));
  svg += Text(207, 196, fmt::format("c_1 = {:g}, c_2 = {:g}", m.zero * gain, gain), 13, "middle", "#555");
  svg += Legend(338, 522, "closed pressure loop, eq. (16)",
                fmt::format("ω_n = {:g} rad/s, ζ = {:g}", m.natural_frequency, m.damping_ratio));
  svg += Legend(572, 656, "actuator", "k_2, in-lbf/psi");
  svg += Legend(714, 806, "arm, eq. (15)", "J_a, lbf-in-s²");
  return svg + "</svg>\n";
}

}  // namespace hydro::experiments
