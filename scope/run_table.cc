#include "scope/run_table.h"

#include <algorithm>
#include <utility>

namespace hydro::scope {

std::unique_ptr<Run> RunTable::NewLive() const {
  auto run = std::make_unique<Run>(0, name_, Run::Kind::kLive, rows_);
  run->suffix = suffix_;
  run->messages = std::make_unique<MessageStore>(bytes_);
  return run;
}

Run& RunTable::StartLive(const std::string& name, const std::string& suffix, uint64_t rows, size_t bytes) {
  name_ = name;
  suffix_ = suffix;
  rows_ = rows;
  bytes_ = bytes;
  auto run = NewLive();
  live_ = run.get();
  Add(std::move(run));
  return *live_;
}

Run& RunTable::RestartLive() {
  if (past_ != nullptr) Close(past_->id);
  past_ = live_;
  auto run = NewLive();
  run->id = live_->id;
  run->processes = live_->processes;
  past_->id = next_id_++;
  past_->kind = Run::Kind::kPast;
  past_->name += ", the run before";
  live_ = run.get();
  runs_.push_back(std::move(run));
  changes_ += live_->revision + 1;
  return *live_;
}

uint32_t RunTable::Add(std::unique_ptr<Run> run) {
  run->id = next_id_++;
  runs_.push_back(std::move(run));
  ++changes_;
  return runs_.back()->id;
}

bool RunTable::Close(uint32_t id) {
  const auto run = std::find_if(runs_.begin(), runs_.end(), [&](const auto& r) { return r->id == id; });
  if (run == runs_.end() || run->get() == live_) return false;
  if (run->get() == past_) past_ = nullptr;
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
