// Chooses among the sets under proof by what they predict and what they cost.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/prove/proof_sets.h"

namespace hydro::diagnose {

// All results are places in the sets.
class Chooser {
 public:
  // `sets` must outlive this object.
  explicit Chooser(ProofSets* sets) : sets_(*sets) {}

  // The place of the set that is worth most once every effect that does not pay its price is left out; that
  // of the model as given where nothing is worth more.
  size_t Choice();
  // Whether the set leaves so much that what balances cannot show is worth trying.
  bool LeavesAGap(size_t place) const;
  // Adds to the set at `from`, one by one, those changes that it does not have.
  void Race(size_t from, const std::vector<Change>& blind);
  // Takes the same effects with the given base values where they predict as well. Then no value is called
  // wrong.
  size_t TakeGivenValues(size_t place);
  // Where many other values explain the runs, the effect of one number that does as well with all
  // values as given: torques and flows have no unit of their own, so what a pressure sensor's gain does,
  // eight values that are off alike do too. The values are reported as tied with it.
  size_t OneNumberForManyValues(size_t place);
  // Adds the effect that the balances find more likely than not, where windows neither confirm nor deny it: a
  // small error of a gain, or a ripple, hardly changes predictions over the length of a window. Both
  // witnesses together have to speak for it. The effect is reported as tied with the set that does without
  // it.
  size_t WithWhatBalancesSay(size_t place) const;
  // The best set with other values alone; that of the model as given where none predicts better.
  size_t BestValues() const;

 private:
  bool IsKept(size_t with, size_t without, double price);
  // What remains when one unneeded effect is left out; the set itself where all are needed. What is unneeded
  // even while the other values stay as they are goes first, that of which least is lost. It needs no fit,
  // and fits take most of the work. Otherwise values are refitted without one effect after another, until one
  // is unneeded.
  size_t Reduced(size_t place);
  // Among sets with equally many effects and equal worth, prefers the one whose effects have the fewest
  // numbers: a bias has one, an asymmetry two.
  size_t WithFewerNumbers(size_t place) const;
  // The chosen set must not be worse than another set with as few effects.
  size_t BetterOfTheSameSize(size_t place) const;
  // Whether the set predicts as well as the one in the other place, or leaves no more than noise.
  bool IsAlike(size_t place, size_t set) const;

  ProofSets& sets_;
};

}  // namespace hydro::diagnose
