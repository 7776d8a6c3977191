// Made-up rigs with proposals for them, for tests of what exact simulation on held-out runs chooses.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/prove/prove.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

using diagnose::Change;
using diagnose::Proof;
using diagnose::Proposal;
using diagnose::ProvedSet;

inline const Change kDrag = {"pump.quadratic_drag", {}, ""}, kBias = {"amp.bias", {}, ""},
                    kRelief = {"valve.relief", {}, ""};

inline model::EffectDescription Drag(double k) { return {"pump.quadratic_drag", {{"k", k}}, {}}; }
inline model::EffectDescription Bias(double bias) { return {"amp.bias", {{"bias", bias}}, {}}; }

inline const std::vector<std::string>& Values() {
  static const std::vector<std::string> values = {"J", "b", "T_s", "beta", "c_I"};
  return values;
}

// Three runs that are fitted and two that are not, of 2 s each.
class ProveTest : public ::testing::Test {
 protected:
  void Record(const model::ModelDescription& truth) {
    for (int which = 0; which < 5; ++which) {
      const bool free = which == 2;
      runs_.push_back(
          SmallRun(truth, free ? model::Shaft::kFree : model::Shaft::kClamped, which == 3, 2, which, 7));
    }
    context_.given = Table1With();
    context_.runs = {&runs_[0], &runs_[2], &runs_[3]};
    context_.held_out = {&runs_[1], &runs_[4]};
    context_.sizes = diagnose::SizesOf(context_.given, context_.runs);
    context_.changes = {kDrag, kBias, kRelief, {"", {}, "b"}};
    as_given_.model = context_.given;
    for (const std::string& name : Values()) allowed_.push_back(model::BasePlace(name));
  }

  // With the model's own values, all of them open.
  Proposal Proposed(const std::vector<Change>& changes, std::vector<model::EffectDescription> effects) const {
    Proposal proposal;
    proposal.changes = changes;
    proposal.model = Table1With(std::move(effects));
    proposal.base = allowed_;
    return proposal;
  }

  Proof Prove(const std::vector<Proposal>& proposals, const std::vector<Change>& blind = {},
              const diagnose::SaidByBalances& said = {}) {
    return diagnose::ProveProposals(context_, as_given_, allowed_, proposals, blind, said);
  }

  std::vector<diagnose::RunData> runs_;
  diagnose::ProofContext context_;
  diagnose::Hypothesis as_given_;
  std::vector<size_t> allowed_;
};

inline double NearGap(const Proof& proved, const std::vector<Change>& changes) {
  double least = std::numeric_limits<double>::infinity();
  for (const ProvedSet& one : proved.sets) {
    if (one.tested() && one.hypothesis.changes == changes) least = std::min(least, TypicalGap(one.near));
  }
  return least;
}

inline double ValueOf(const Proof& proved, const std::string& effect, const std::string& name) {
  for (const model::EffectDescription& has : proved.Found().model.effects) {
    if (has.id == effect) return has.parameters.at(name);
  }
  return std::nan("");
}

}  // namespace hydro::testing
