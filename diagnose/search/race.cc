#include "diagnose/search/race.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/search/refits.h"

namespace hydro::diagnose {

namespace {

constexpr int kIterationsToQualify = 3;
// One that has then come no nearer than this many times the best one's sum of squares is left as it is.
constexpr double kOutOfTheRace = 3;
constexpr size_t kMostInTheRace = 4;
// Another start of the same change beats it by so much.
constexpr double kBeaten = 1.1;

// Fewer windows than this are all fitted.
constexpr size_t kFewWindows = 12;
constexpr size_t kSampleEvery = 3;
// The windows of the runs' extremes are the last of a search: what opens or saturates acts in no others.
constexpr size_t kExtremes = 5;

constexpr char kNoTime[] = "the time limit ended the search";

struct Entry {
  std::vector<const RunData*> runs;
  std::vector<model::StartState> starts;
};

Fitted FitUnlessTimeIsUp(const SearchContext& context, const Hypothesis& hypothesis, const Entry& entry,
                         const FitOptions& options) {
  if (!TimeIsUp(context)) return Fit(hypothesis, entry.runs, entry.starts, options);
  Fitted none;
  none.hypothesis = hypothesis;
  none.failure = kNoTime;
  return none;
}

double MostOf(const Bar& bar, const std::vector<size_t>& sample) {
  if (bar.rival == nullptr) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const size_t r : sample) sum += bar.rival->runs[r].sum;
  return bar.times * sum;
}

Entry Some(const Entry& all, const std::vector<size_t>& sample) {
  Entry some;
  for (const size_t r : sample) {
    some.runs.push_back(all.runs[r]);
    some.starts.push_back(all.starts[r]);
  }
  return some;
}

// Each of the runs starts where the hypothesis predicts it better from: its start so far, which made up for what was missing, or
// the measured one.
void StartBetter(const Hypothesis& hypothesis, const std::vector<size_t>& which, Entry* entry) {
  for (const size_t r : which) {
    const RunData& run = *entry->runs[r];
    const double measured = SumOfSquares(hypothesis.model, run, run.start);
    if (measured < SumOfSquares(hypothesis.model, run, entry->starts[r])) entry->starts[r] = run.start;
  }
}

// Takes the starts of the sample from the fit.
void StartOthers(const Fitted& fit, const std::vector<size_t>& sample, Entry* entry) {
  std::vector<bool> fitted(entry->runs.size());
  for (size_t s = 0; s < sample.size(); ++s) {
    entry->starts[sample[s]] = fit.runs[s].start;
    fitted[sample[s]] = true;
  }
  std::vector<size_t> others;
  for (size_t r = 0; r < fitted.size(); ++r) {
    if (!fitted[r]) others.push_back(r);
  }
  StartBetter(fit.hypothesis, others, entry);
}

// As if all windows were fitted as well as the sample.
void ScaleTo(const std::vector<const RunData*>& runs, Fitted* fit) {
  size_t count = 0;
  for (const RunData* run : runs) count += CountValid(*run);
  fit->sum = fit->squared_gap() * static_cast<double>(count);
  fit->count = count;
}

}  // namespace

std::vector<size_t> RaceSample(size_t runs) {
  std::vector<size_t> sample;
  for (size_t r = 0; r < runs; ++r) {
    if (runs < kFewWindows || r % kSampleEvery == 0 || r + kExtremes >= runs) sample.push_back(r);
  }
  return sample;
}

std::vector<bool> InTheRace(const std::vector<Fitted>& fits, double most) {
  std::vector<size_t> order;
  for (size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].ok()) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return fits[a].sum < fits[b].sum; });
  std::vector<bool> in(fits.size());
  size_t count = 0;
  for (const size_t i : order) {
    if (count >= kMostInTheRace || fits[i].sum > most) break;
    if (fits[i].sum > kOutOfTheRace * fits[order.front()].sum) break;
    const bool beaten = std::any_of(order.begin(), order.end(), [&](size_t other) {
      return in[other] && fits[i].sum > kBeaten * fits[other].sum &&
             SameChanges(fits[i].hypothesis, fits[other].hypothesis);
    });
    if (beaten) continue;
    in[i] = true;
    ++count;
  }
  return in;
}

RaceResult Race(const SearchContext& context, const std::vector<Scanned>& pool,
                const std::vector<model::StartState>& starts, const FitOptions& options, const Bar& bar) {
  FitOptions first = options, rest = options;
  first.most_iterations = kIterationsToQualify;
  rest.most_iterations = options.most_iterations - kIterationsToQualify;
  std::vector<size_t> sample(context.runs.size());
  for (size_t r = 0; r < sample.size(); ++r) sample[r] = r;
  if (context.windows) sample = RaceSample(context.runs.size());

  std::vector<Fitted> fits(pool.size());
  std::vector<Entry> entries(pool.size());
  ParallelFor(pool.size(), context.jobs, [&](size_t i) {
    entries[i] = {context.runs, pool[i].run_starts.empty() ? starts : pool[i].run_starts};
    StartBetter(pool[i].start, sample, &entries[i]);
    fits[i] = FitUnlessTimeIsUp(context, pool[i].start, Some(entries[i], sample), first);
  });
  const std::vector<bool> in = InTheRace(fits, MostOf(bar, sample));
  ParallelFor(fits.size(), context.jobs, [&](size_t i) {
    if (!in[i]) return;
    StartOthers(fits[i], sample, &entries[i]);
    Fitted more = FitUnlessTimeIsUp(context, fits[i].hypothesis, entries[i], rest);
    if (more.ok()) fits[i] = std::move(more);  // otherwise it keeps what it has
  });
  RaceResult result;
  for (size_t i = 0; i < fits.size(); ++i) {
    if (!fits[i].ok()) {
      result.failed.push_back(std::move(fits[i]));
    } else if (in[i] && fits[i].runs.size() == context.runs.size()) {
      result.leading.push_back(std::move(fits[i]));
    } else {
      ScaleTo(context.runs, &fits[i]);
      result.behind.push_back(std::move(fits[i]));
    }
  }
  return result;
}

}  // namespace hydro::diagnose
