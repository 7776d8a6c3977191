#include "runs/measured/run_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include "base/number_text.h"
#include "runs/measured/measured_run.h"

namespace hydro::runs {
namespace {

using settings::SectionReader;
using settings::TomlNode;
using Kind = settings::TomlNode::Kind;

constexpr double kFromTheBeginning = -std::numeric_limits<double>::infinity();
// A recorded valve is open above this.
constexpr double kOpenAbove = 0.5;

std::string ShaftsAllowed() {
  std::vector<std::string> names;
  names.reserve(std::size(kShafts));
  for (const auto& [name, shaft] : kShafts) names.push_back(name);
  return QuotedList(names) +
         ", or a list of what holds from which time on: [{ from = 0, is = \"clamped\", arm_angle = 0.1 }, { "
         "from = 5.2, is = \"free\" }]";
}
const char kBypassAllowed[] =
    "true or false, or a list of what holds from which time on: [{ from = 0, is = false }, { from = 5.2, is "
    "= true }]";
const char kWindowsAllowed[] =
    "windows in s, each [from, to] with from below to and none before the end of the one before: [[1.0, "
    "5.2], [6, 8]]";

// Calls read(item, from) for each item of a list that changes with time.
template <class Read>
void ReadChanges(SectionReader& document, const std::string& key, const TomlNode& list,
                 const std::string& allowed, Read read) {
  if (list.items.empty()) throw document.Error(key, "an empty list", allowed);
  double before = kFromTheBeginning;
  for (size_t i = 0; i < list.items.size(); ++i) {
    const TomlNode& item = list.items[i];
    if (!item.is(Kind::kTable)) throw document.Error(key, item.Shown(), allowed);
    SectionReader section = document.Item(item, key);
    section.Require("is", allowed);
    double from = kFromTheBeginning;
    if (!section.Number("from", &from) && i > 0)
      throw document.Error(key, "an entry without from", "a time in s with every entry but the first");
    if (i > 0 && !(from > before))
      throw document.Error(key, "from = " + ShortestNumber(from), "times that increase from entry to entry");
    before = from;
    read(section, from);
    section.Finish();
  }
}

// Reads the angle of a clamped shaft, under the name that the model's unit allows.
void ReadAngle(SectionReader& section, const UnitSystem& units, model::Shaft shaft, double* angle) {
  const bool present = section.Number("arm_angle", angle);
  const bool in_rad = section.Number("arm_angle_rad", angle);
  if (in_rad && present) throw section.Error("arm_angle_rad", "it beside arm_angle", "one of the two");
  if (in_rad && units.linear_arm) {
    const std::string unit = units.UnitFor("rad", 1);
    throw section.Error("arm_angle_rad", "a key in rad, and a model whose arm is in " + unit,
                        "arm_angle, a number in " + unit + " or a text such as \"30 mm\"");
  }
  if (!(present || in_rad) || shaft == model::Shaft::kClamped) return;
  const std::string key = present ? "arm_angle" : "arm_angle_rad";
  throw section.Error(key, "it with a shaft that is not clamped", key + " with shaft = \"clamped\" only");
}

void ReadShafts(SectionReader& document, const UnitSystem& units, RunPlan* plan) {
  document.Require("shaft", ShaftsAllowed());
  const TomlNode* node = document.Take("shaft");
  if (node == nullptr || !node->is(Kind::kArray)) {
    RunPlan::ShaftFrom one{.from = kFromTheBeginning};
    if (node != nullptr && !node->is(Kind::kString))
      throw document.Error("shaft", node->Shown(), ShaftsAllowed());
    if (!document.Choice("shaft", kShafts, &one.shaft)) one.shaft = model::Shaft::kClamped;  // Finish reports
    ReadAngle(document, units, one.shaft, &one.arm_angle);
    plan->shafts.push_back(one);
    return;
  }
  ReadChanges(document, "shaft", *node, ShaftsAllowed(), [&](SectionReader& section, double from) {
    RunPlan::ShaftFrom one{.from = from};
    section.Choice("is", kShafts, &one.shaft);
    ReadAngle(section, units, one.shaft, &one.arm_angle);
    plan->shafts.push_back(one);
  });
}

void ReadBypasses(SectionReader& document, RunPlan* plan) {
  const TomlNode* node = document.Take("bypass");
  if (node == nullptr) return;
  if (!node->is(Kind::kArray)) {
    RunPlan::BypassFrom one{.from = kFromTheBeginning};
    if (!node->is(Kind::kBoolean)) throw document.Error("bypass", node->Shown(), kBypassAllowed);
    one.open = node->boolean;
    plan->bypasses.push_back(one);
    return;
  }
  ReadChanges(document, "bypass", *node, kBypassAllowed, [&](SectionReader& section, double from) {
    RunPlan::BypassFrom one{.from = from};
    section.Boolean("is", &one.open);
    plan->bypasses.push_back(one);
  });
}

std::vector<RunPlan::Window> ReadWindows(SectionReader& document, const std::string& key) {
  std::vector<RunPlan::Window> windows;
  const TomlNode* node = document.Take(key);
  if (node == nullptr) return windows;
  if (!node->is(Kind::kArray) || node->items.empty())
    throw document.Error(key, node->is(Kind::kArray) ? "an empty list" : node->Shown(), kWindowsAllowed);
  for (const TomlNode& item : node->items) {
    const bool pair = item.is(Kind::kArray) && item.items.size() == 2 && item.items[0].is_number() &&
                      item.items[1].is_number();
    if (!pair) throw document.Error(key, item.Shown(), kWindowsAllowed);
    const RunPlan::Window window{item.items[0].AsDouble(), item.items[1].AsDouble()};
    const bool after = windows.empty() || window.from >= windows.back().to;
    if (!(window.from < window.to) || !after) {
      throw document.Error(key, "[" + ShortestNumber(window.from) + ", " + ShortestNumber(window.to) + "]",
                           kWindowsAllowed);
    }
    windows.push_back(window);
  }
  return windows;
}

const RunPlan::Window* Holding(const std::vector<RunPlan::Window>& windows, double time) {
  for (const RunPlan::Window& one : windows) {
    if (time >= one.from && time <= one.to) return &one;
  }
  return nullptr;
}

// The entry that holds at a time.
template <class Change>
const Change& At(const std::vector<Change>& changes, double time) {
  size_t place = 0;
  while (place + 1 < changes.size() && changes[place + 1].from <= time) ++place;
  return changes[place];
}

// Consecutive samples of one window, one shaft and one state of the bypass.
struct Part {
  size_t first = 0, last = 0;
  const RunPlan::Window* window = nullptr;
  const RunPlan::ShaftFrom* shaft = nullptr;
  bool bypass = false;
};

std::vector<Part> FindParts(const MeasuredRun& run, const RunPlan& plan) {
  std::vector<Part> parts;
  bool open = false, used_before = false;
  for (size_t i = 0; i < run.samples(); ++i) {
    const double time = run.time[i];
    const RunPlan::Window* window = Holding(plan.use, time);
    const RunPlan::ShaftFrom* shaft = &At(plan.shafts, time);
    if (run.bypass_valve.measured()) {
      const double state = run.bypass_valve.values[i];
      if (!std::isnan(state)) open = state > kOpenAbove;
    } else {
      open = !plan.bypasses.empty() && At(plan.bypasses, time).open;
    }
    const bool used = (plan.use.empty() || window != nullptr) && Holding(plan.skip, time) == nullptr;
    if (used) {
      const bool goes_on = used_before && std::tie(parts.back().window, parts.back().shaft,
                                                   parts.back().bypass) == std::tie(window, shaft, open);
      if (!goes_on) parts.push_back({i, i, window, shaft, open});
      parts.back().last = i + 1;
    }
    used_before = used;
  }
  return parts;
}

std::string Shown(const RunPlan::Window& window) {
  return "[" + ShortestNumber(window.from) + ", " + ShortestNumber(window.to) + "]";
}

std::string Range(const MeasuredRun& run) {
  return "from " + ShortestNumber(run.time.front()) + " to " + ShortestNumber(run.time.back()) + " s";
}

// The table's times, with the ends that delays have cut off.
RunPlan::Window TimesOf(const MeasuredRun& run) {
  double cut = 0;
  for (const SignalName& name : kSignals) cut = std::max(cut, std::abs((run.*name.signal).source.delay));
  return {run.time.front() - cut, run.time.back() + cut};
}

// A window or a time that is of no sample, such as one in ms, would do nothing without a word.
template <class Change>
void RequireActing(const std::string& key, const std::vector<Change>& changes, const MeasuredRun& run,
                   const SectionReader& document) {
  const RunPlan::Window times = TimesOf(run);
  for (size_t i = 0; i < changes.size(); ++i) {
    const bool over = i + 1 < changes.size() && changes[i + 1].from <= times.from;
    if (changes[i].from <= times.to && !over) continue;
    const std::string from = changes[i].from == kFromTheBeginning
                                 ? "an entry without from"
                                 : "from = " + ShortestNumber(changes[i].from);
    throw document.Error(key,
                         from +
                             (over ? ", which ends at " + ShortestNumber(changes[i + 1].from) + " s" : "") +
                             ", and no sample of the run for it",
                         "entries that hold in a part of the run, " + Range(run) + ", with times in s");
  }
}

void RequireActing(const std::vector<RunPlan::Window>& skip, const MeasuredRun& run,
                   const SectionReader& document) {
  const RunPlan::Window times = TimesOf(run);
  for (const RunPlan::Window& window : skip) {
    if (window.from <= times.to && window.to >= times.from) continue;
    throw document.Error("skip", Shown(window) + ", which holds no sample",
                         "windows in s of a run " + Range(run));
  }
}

// What holds before the first entry would otherwise be a guess.
template <class Change>
void RequireFromBegin(const std::string& key, const std::vector<Change>& changes, double begin,
                      const MeasuredRun& run, const SectionReader& document) {
  if (changes.empty() || changes.front().from <= begin) return;
  throw document.Error(key, "a first entry with from = " + ShortestNumber(changes.front().from),
                       "what holds from the first sample that is read on, at " + ShortestNumber(begin) +
                           " s: a first entry without from, or with from at or before that, of a run " +
                           Range(run));
}

void RequireEnoughIn(const std::vector<Part>& parts, const MeasuredRun& run, const RunPlan& plan,
                     const SectionReader& document) {
  const std::string allowed =
      "windows of " + std::to_string(kFewestOfAPart) + " samples or more, of a run " + Range(run);
  for (const RunPlan::Window& window : plan.use) {
    size_t most = 0;
    for (const Part& part : parts)
      if (part.window == &window) most = std::max(most, part.last - part.first);
    if (most >= kFewestOfAPart) continue;
    throw document.Error("use", Shown(window) + ", with " + std::to_string(most) + " samples in a row",
                         allowed);
  }
  const bool any = std::any_of(parts.begin(), parts.end(),
                               [](const Part& part) { return part.last - part.first >= kFewestOfAPart; });
  if (any) return;
  const std::string key = !plan.skip.empty() ? "skip" : plan.shafts.size() > 1 ? "shaft" : "bypass";
  throw document.Error(key, "no " + std::to_string(kFewestOfAPart) + " samples in a row that remain",
                       allowed);
}

}  // namespace

RunPlan ReadPlan(SectionReader& document, const UnitSystem& units) {
  RunPlan plan;
  ReadShafts(document, units, &plan);
  ReadBypasses(document, &plan);
  plan.use = ReadWindows(document, "use");
  plan.skip = ReadWindows(document, "skip");
  return plan;
}

std::vector<TomlNode*> AnglesIn(TomlNode* sidecar) {
  std::vector<TomlNode*> angles = {sidecar->Find("arm_angle")};
  TomlNode* shafts = sidecar->Find("shaft");
  if (shafts != nullptr && shafts->is(Kind::kArray)) {
    for (TomlNode& item : shafts->items)
      if (item.is(Kind::kTable)) angles.push_back(item.Find("arm_angle"));
  }
  std::erase(angles, nullptr);
  return angles;
}

std::vector<MeasuredRun> PartsOf(const MeasuredRun& whole, const RunPlan& plan,
                                 const SectionReader& document) {
  if (whole.bypass_valve.measured() && !plan.bypasses.empty())
    throw document.Error("bypass", "it beside columns.bypass", "one of the two");
  RequireActing(plan.skip, whole, document);
  RequireActing("shaft", plan.shafts, whole, document);
  RequireActing("bypass", plan.bypasses, whole, document);
  const std::vector<Part> parts = FindParts(whole, plan);
  const bool is_whole = parts.size() == 1 && parts[0].last - parts[0].first == whole.samples();
  if (!is_whole) RequireEnoughIn(parts, whole, plan, document);
  const double begin = whole.time[parts.front().first];
  RequireFromBegin("shaft", plan.shafts, begin, whole, document);
  RequireFromBegin("bypass", plan.bypasses, begin, whole, document);
  std::vector<MeasuredRun> runs;
  size_t short_ones = 0;
  for (const Part& part : parts) {
    if (!is_whole && part.last - part.first < kFewestOfAPart) {
      ++short_ones;
      continue;
    }
    MeasuredRun run = whole;
    run.shaft = part.shaft->shaft;
    run.arm_angle_rad = part.shaft->arm_angle;
    run.bypass = part.bypass;
    if (run.shaft == model::Shaft::kDriven && !run.arm_angle.measured()) {
      throw document.Error("shaft", "\"driven\" without columns.arm_angle",
                           "\"driven\" with the measured arm angle, which is imposed on the model");
    }
    if (!is_whole) run.Keep(part.first, part.last);
    if (!runs.empty()) run.name += ", from " + ShortNumber(run.time.front(), 4) + " s";
    runs.push_back(std::move(run));
  }
  if (short_ones == 0) return runs;
  for (MeasuredRun& run : runs) {
    run.layout += (run.layout.empty() ? "" : ", ") + std::to_string(short_ones) +
                  (short_ones == 1 ? " part" : " parts") + " of fewer than " +
                  std::to_string(kFewestOfAPart) + " samples left out";
  }
  return runs;
}

}  // namespace hydro::runs
