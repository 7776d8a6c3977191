// How report.html looks: on a screen, on paper, and the pictures' lines.
#pragma once

namespace hydro::diagnose {

// Colours are of Okabe and Ito's set for the colour-blind; widths and dashes tell the lines apart without
// any.
inline constexpr char kReportStyle[] = R"css(
:root { color-scheme: light; }
body { margin: 0 auto; padding: 2rem 1.5rem 4rem; max-width: 61rem; color: #1a1a1a; background: #ffffff;
  font: 1rem/1.5 Charter, "Bitstream Charter", Georgia, "Times New Roman", serif; }
h1, h2, h3, th, .meta, .badge, svg { font-family: Helvetica, Arial, sans-serif; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; margin: 2.4rem 0 .6rem; padding-top: .7rem; border-top: 1px solid #9a9a9a; }
h3 { font-size: .98rem; margin: 1.3rem 0 .3rem; }
p { margin: .3rem 0 .7rem; }
.meta { color: #555555; font-size: .85rem; }
.verdict { font-size: 1.15rem; line-height: 1.4; border-left: 5px solid #0072b2; padding: .5rem .9rem; margin: 1rem 0;
  background: #f3f7fa; }
.badge { font-size: .8rem; font-weight: bold; text-transform: uppercase; letter-spacing: .04em; color: #0072b2;
  display: block; }
.unexplained { border-color: #d55e00; background: #fdf5ef; }
.unexplained .badge { color: #b14e00; }
.equation { font-style: italic; }
table { border-collapse: collapse; width: 100%; font-size: .86rem; line-height: 1.35; margin: .4rem 0 1rem; }
thead { display: table-header-group; }
th { text-align: left; font-size: .78rem; color: #333333; border-bottom: 1.5px solid #333333;
  padding: .3rem .7rem .3rem 0; vertical-align: bottom; }
td { vertical-align: top; border-bottom: 1px solid #dcdcdc; padding: .3rem .7rem .3rem 0; }
tr { break-inside: avoid; }
table.narrow { width: auto; }
table.narrow th, table.narrow td { padding-right: 1.6rem; }
table.small { font-size: .76rem; line-height: 1.2; }
table.small td { padding-top: .1rem; padding-bottom: .1rem; }
.beside { display: flex; flex-wrap: wrap; gap: 1.2rem; align-items: flex-start; }
h3 .meta { font-weight: normal; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.unit { white-space: nowrap; }
tr.taken td { font-weight: bold; }
tr.all td { border-bottom-color: #333333; }
.flag { color: #b14e00; font-weight: bold; }
figure { margin: .8rem 0 1.2rem; break-inside: avoid; }
figure svg { display: block; max-width: 100%; height: auto; }
pre { font-size: .82rem; line-height: 1.4; background: #f6f6f6; padding: .7rem .9rem; white-space: pre-wrap;
  overflow-wrap: anywhere; }
svg text { font-size: 11px; fill: #333333; }
svg text.x { text-anchor: middle; }
svg text.y { text-anchor: end; }
svg path { fill: none; }
.frame { fill: none; stroke: #777777; stroke-width: .8; }
.grid { stroke: #e4e4e4; stroke-width: .8; }
.zero { stroke: #999999; stroke-width: .8; }
.span { fill: #f0e442; fill-opacity: .35; }
.band { fill: #009e73; fill-opacity: .16; }
.line { stroke-width: 1.1; stroke-linejoin: round; }
.line.measured { stroke: #a8a8a8; stroke-width: 3; }
.line.before { stroke: #d55e00; }
.line.after { stroke: #0072b2; }
.line.faint { stroke-width: .7; stroke-opacity: .4; }
.line.mean { stroke-width: 2; }
.line.before.mean { stroke-dasharray: 6 3; }
.line.found { stroke: #0072b2; stroke-width: 1; }
.line.floor { stroke: #009e73; stroke-width: 2; stroke-dasharray: 5 3; }
.dots { stroke-linecap: round; stroke-width: 2; }
.dots.before { stroke: #d55e00; stroke-opacity: .45; }
.dots.after { stroke: #0072b2; stroke-opacity: .45; }
.dots.refit { stroke: #777777; }
.dots.found { stroke: #0072b2; stroke-width: 5; }
.dots.big { stroke-width: 11; stroke-opacity: 1; }
.bar { stroke: #0072b2; stroke-width: 1.4; }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2 { break-after: avoid; margin-top: 1.4rem; }
  h3, .lead { break-after: avoid; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  @page { size: A4; margin: 15mm 14mm; }
}
)css";

}  // namespace hydro::diagnose
