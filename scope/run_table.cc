#include "scope/run_table.h"

#include <algorithm>
#include <utility>

namespace hydro::scope {

std::unique_ptr<Run> RunTable::NewRun(const Live& live) {
  auto run = std::make_unique<Run>(0, live.name, Run::Kind::kLive, live.rows);
  run->suffix = live.suffix;
  run->listened = live.config;
  run->messages = std::make_unique<MessageStore>(live.bytes);
  return run;
}

Run& RunTable::StartLive(const std::string& name, const std::string& suffix, uint64_t rows, size_t bytes,
                         std::shared_ptr<const settings::StackConfig> config) {
  Live& live = live_.emplace_back(Live{name, suffix, rows, bytes, std::move(config)});
  auto run = NewRun(live);
  live.run = run.get();
  Add(std::move(run));
  return *live.run;
}

Run& RunTable::RestartLive(uint32_t id) {
  Live& live = *std::ranges::find(live_, id, [](const Live& one) { return one.run->id; });
  if (live.past != nullptr) Close(live.past->id);
  live.past = live.run;
  auto run = NewRun(live);
  run->id = live.run->id;
  run->of_a_limb = live.run->of_a_limb;
  run->processes = live.run->processes;
  live.past->id = next_id_++;
  live.past->kind = Run::Kind::kPast;
  live.past->name += ", the run before";
  live.run = run.get();
  runs_.push_back(std::move(run));
  changes_ += live.run->revision + 1;
  return *live.run;
}

std::vector<const Run*> RunTable::AllLive() const {
  std::vector<const Run*> all;
  all.reserve(live_.size());
  for (const Live& live : live_) all.push_back(live.run);
  return all;
}

uint32_t RunTable::Add(std::unique_ptr<Run> run) {
  run->id = next_id_++;
  runs_.push_back(std::move(run));
  ++changes_;
  return runs_.back()->id;
}

bool RunTable::Close(uint32_t id) {
  const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const auto& r) { return r->id == id; });
  if (run == runs_.end()) return false;
  for (Live& live : live_) {
    if (run->get() == live.run) return false;
    if (run->get() == live.past) live.past = nullptr;
  }
  changes_ += (*run)->revision + 1;
  runs_.erase(run);
  return true;
}

Run* RunTable::Find(uint32_t id) {
  const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const auto& r) { return r->id == id; });
  return run == runs_.end() ? nullptr : run->get();
}

std::vector<const Run*> RunTable::All() const {
  std::vector<const Run*> all;
  all.reserve(runs_.size());
  for (const auto& run : runs_) all.push_back(run.get());
  std::sort(all.begin(), all.end(), [](const Run* a, const Run* b) { return a->id < b->id; });
  return all;
}

uint64_t RunTable::revision() const {
  uint64_t sum = changes_;
  for (const auto& run : runs_) sum += run->revision;
  return sum;
}

size_t RunTable::memory() const {
  size_t sum = 0;
  for (const auto& run : runs_) sum += run->memory();
  return sum;
}

}  // namespace hydro::scope
