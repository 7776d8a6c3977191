// What hydro-tune found, as text for a terminal and as a page.
#pragma once

#include <string>
#include <vector>

#include "tune/search/search.h"

namespace hydro::tune {

// One way to run the stack, with its steps from mid-stroke.
struct Proposal {
  std::string name;  // "as configured", "proposed"
  Tried tried;
  std::vector<StepResult> steps;  // in the order of StepJudge::steps()
  design::LoopCheck uncertain;    // the worst margins over the samples of the model
};

// The fastest gains for each gain margin. They show the price of a wider margin.
struct TradeOff {
  double gain_margin = 0;
  Tried tried;
};
std::vector<TradeOff> TradeOffs(const std::vector<Tried>& tried);

struct TuningReport {
  std::string config;                // the file's name
  const StepJudge* judge = nullptr;  // must outlive this
  std::vector<Proposal> proposals;
  std::vector<TradeOff> trade_offs;  // of the proposed law
  std::vector<Tried> tried;          // for the picture
  bool noise = false;
};

// The margins of the loops over the samples of the model, with the gains unchanged.
design::LoopCheck UncertainMargins(const StepJudge& judge, const Gains& gains);

// Tables of gains, margins, steps and the trade-off. `si`: gains in SI units.
std::string ReportText(const TuningReport& report, bool si);

// A page with the same tables and with pictures; one file.
std::string ReportPage(const TuningReport& report, bool si);
// The page's picture as an SVG file.
std::string ReportPicture(const TuningReport& report);

}  // namespace hydro::tune
