#include "batch/slurm/array_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "batch/slurm/grouping.h"
#include "batch/store/small_file.h"

namespace hydro::batch {
namespace {

using std::chrono::milliseconds;

// squeue is asked rarely, because all users' commands go to the same slurmctld. At the beginning it is asked
// more often, because a study may be over soon.
milliseconds NextWait(milliseconds waited) {
  return std::clamp(waited / 50, milliseconds(200), milliseconds(10000));
}

const QueuedArray* Named(const std::vector<QueuedArray>& queue, const std::string& name) {
  const auto found = std::ranges::find(queue, name, &QueuedArray::name);
  return found == queue.end() ? nullptr : &*found;
}

}  // namespace

ArrayDriver::ArrayDriver(DriveRequest request, Cluster* cluster)
    : request_(std::move(request)),
      cluster_(*cluster),
      store_(request_.folder),
      folders_(request_.folder),
      count_(store_, request_.cases) {}

DriveEnd ArrayDriver::Run() {
  limits_ = cluster_.Limits(request_.partition);
  Adopt();
  for (milliseconds waited{0};;) {
    const StopWish wish = request_.stop();
    if (wish != StopWish::kNone) return EndEarly(wish);
    const bool answered = Look();
    if (progress_.done + progress_.failed == request_.cases) return End();
    if (answered) {
      if (PassIsOver() && !StartsPass()) return DriveEnd::kGaveUp;
      TryToAdd();
      if (request_.detach && !MayAdd()) return EndEarly(StopWish::kLeave);
    }
    const milliseconds wait = NextWait(waited);
    request_.wait(wait);
    waited += wait;
  }
}

// Finds the arrays of earlier drivers.
void ArrayDriver::Adopt() {
  const std::vector<ArrayRecord> records = folders_.Read();
  if (records.empty()) {
    cursor_ = request_.cases;  // no pass has begun yet
    pass_ = -1;
    return;
  }
  auto queue = cluster_.Queue();
  while (!queue) {
    if (request_.stop() != StopWish::kNone) return;
    request_.wait(milliseconds(1000));
    queue = cluster_.Queue();
  }
  pass_ = records.back().pass;
  cursor_ = request_.cases;
  for (ArrayRecord record : records) {
    if (record.id == 0) {
      unknown_.push_back(record);  // Look() cancels it when it appears
      continue;
    }
    const QueuedArray* queued = Named(*queue, record.name);
    if (queued == nullptr) continue;
    if (!record.released) {
      cluster_.Release(record.id);
      record.released = true;
      folders_.Write(record);
    }
    request_.say(fmt::format("found array {} of {} jobs, submitted before: {} running, {} waiting", record.id,
                             record.jobs, queued->running, queued->pending));
    active_.push_back(record);
    if (record.pass == pass_) cursor_ = record.end;
  }
  const CaseCount count = count_.Count();
  there_before_ = count.done + count.failed;
}

// Updates active_ and progress_; returns false when the batch system does not answer.
bool ArrayDriver::Look() {
  const auto queue = cluster_.Queue();
  progress_.answered = queue.has_value();
  if (queue) {
    progress_.running = progress_.pending = 0;
    std::erase_if(unknown_, [&](const ArrayRecord& record) {
      const QueuedArray* queued = Named(*queue, record.name);
      if (queued != nullptr) cluster_.Cancel(queued->id);
      return queued != nullptr;
    });
    std::erase_if(active_, [&](const ArrayRecord& record) {
      const QueuedArray* queued = Named(*queue, record.name);
      if (queued == nullptr) {
        ended_.push_back(record);
        return true;
      }
      progress_.running += queued->running;
      progress_.pending += queued->pending;
      progress_.reason = queued->reason;
      ReleaseForgotten(record, *queued);
      return false;
    });
  }
  // The count comes after the queue, so that it includes what an array had stored when it ended.
  const CaseCount count = count_.Count();
  progress_.cases = request_.cases;
  progress_.done = count.done;
  progress_.failed = count.failed;
  request_.progress(progress_);
  return queue.has_value();
}

// A controller that was killed forgets the last seconds: that an array was released, and that some of its
// jobs have begun. An array that its user holds has no more pending jobs than before.
void ArrayDriver::ReleaseForgotten(const ArrayRecord& record, const QueuedArray& queued) {
  const auto seen = pending_.find(record.id);
  if (!queued.held) {
    pending_[record.id] = queued.pending;
  } else if (seen == pending_.end() || queued.pending > seen->second) {
    cluster_.Release(record.id);
  }
}

// Called when no array has any of the missing cases. Returns false when another pass is of no use.
bool ArrayDriver::StartsPass() {
  const int64_t there = progress_.done + progress_.failed;
  if (!ended_.empty()) {
    barren_ = there > there_before_ ? 0 : barren_ + 1;
    const std::string complaint = folders_.LastComplaint(ended_.back());
    request_.say(fmt::format("{} of {} cases are missing, and no job has them any more{}{}",
                             request_.cases - there, request_.cases,
                             complaint.empty() ? "" : "; a job said: ", complaint));
    if (barren_ >= request_.barren_passes) return false;
  }
  // On a full disk, the next jobs would fail like those before.
  WriteSmallFile(request_.folder + "/slurm.probe", std::string(65536, ' '));
  std::error_code ignored;
  std::filesystem::remove(request_.folder + "/slurm.probe", ignored);
  there_before_ = there;
  ++pass_;
  cursor_ = 0;
  return true;
}

// The number of its jobs that can run at the same time; 0: unknown. Other users need the cluster too, so the
// true number only appears with time.
int64_t ArrayDriver::AtOnce() const {
  const int64_t places = limits_.processors / request_.processors;
  if (request_.at_once == 0) return places;
  return places == 0 ? request_.at_once : std::min(places, request_.at_once);
}

// With a limit on simultaneous jobs, arrays run one after another, because Slurm knows such a limit only
// within an array.
bool ArrayDriver::MayAdd() const {
  if (cursor_ >= request_.cases) return false;
  if (request_.at_once > 0) return active_.empty();
  return progress_.running + progress_.pending + limits_.array_jobs <=
         std::max(limits_.all_jobs / 2, limits_.array_jobs);
}

void ArrayDriver::TryToAdd() {
  constexpr int kMostRefusals = 30;
  while (MayAdd()) {
    try {
      Add();
      refusals_ = 0;
    } catch (const ClusterError& error) {
      if (request_.stop() != StopWish::kNone) return;
      if (!submitted_ || ++refusals_ >= kMostRefusals) throw;
      if (refusals_ == 1) request_.say(std::string(error.what()) + "; tried again");
      return;
    }
  }
}

void ArrayDriver::Add() {
  const Grouping grouping = ChooseGrouping({.missing = request_.cases - progress_.done - progress_.failed,
                                            .case_s = request_.case_s(),
                                            .start_s = limits_.start_s,
                                            .limit_s = request_.limit_s,
                                            .processors = request_.processors,
                                            .at_once = AtOnce(),
                                            .cases_wished = request_.cases_per_job});
  const std::vector<CaseRange> ranges = NextRanges(grouping.cases, limits_.array_jobs);
  if (ranges.empty()) {
    cursor_ = request_.cases;
    return;
  }
  ArrayRecord record = folders_.Make(request_.name, ranges, pass_);
  const std::string folder = folders_.ArrayFolder(record.number);
  try {
    record.id = cluster_.SubmitHeld({.name = record.name,
                                     .script = folder + "/script",
                                     .folder = request_.folder,
                                     .jobs = record.jobs,
                                     .at_once = request_.at_once,
                                     .arguments = request_.arguments});
  } catch (const ClusterError& error) {
    std::error_code ignored;
    if (error.refused()) {
      std::filesystem::remove_all(folder, ignored);
    } else {
      unknown_.push_back(record);
    }
    throw;
  }
  folders_.Write(record);
  active_.push_back(record);
  progress_.pending += record.jobs;
  cursor_ = record.end;
  cluster_.Release(record.id);
  record.released = active_.back().released = true;
  folders_.Write(record);
  submitted_ = true;
  request_.say(fmt::format("array {}: {}", record.id, grouping.why));
}

// Splits the cases from the cursor on into ranges with this many missing cases each.
std::vector<CaseRange> ArrayDriver::NextRanges(int64_t cases_per_job, int64_t most_jobs) {
  std::vector<CaseRange> ranges;
  int64_t in_range = 0;
  int64_t i = cursor_;
  for (ShardCases there; i < request_.cases; ++i) {
    if (i == cursor_ || i % kShard == 0) there = store_.Shard(i / kShard);
    const auto place = static_cast<size_t>(i % kShard);
    if (there.done[place] || there.failed[place]) continue;
    if (ranges.empty() || in_range == cases_per_job) {
      if (static_cast<int64_t>(ranges.size()) == most_jobs) break;
      ranges.emplace_back(i, i);
      in_range = 0;
    }
    ranges.back().second = i + 1;
    ++in_range;
  }
  return ranges;
}

DriveEnd ArrayDriver::EndEarly(StopWish wish) {
  if (wish == StopWish::kLeave) return DriveEnd::kLeft;
  if (!CancelAll(&Cluster::Cancel)) return DriveEnd::kLeft;
  // Half a minute after its signal, Slurm kills what has not ended by itself.
  WaitForTheirEnd(milliseconds(60000));
  return active_.empty() ? DriveEnd::kCancelled : DriveEnd::kLeft;
}

// All cases are there. Jobs that still wait in the queue would find nothing to do. Jobs that run are about to
// end: they make their last cases durable.
DriveEnd ArrayDriver::End() {
  CancelAll(&Cluster::CancelPending);
  WaitForTheirEnd(milliseconds(10000));
  SayWaits();
  return DriveEnd::kAllThere;
}

void ArrayDriver::WaitForTheirEnd(milliseconds patience) {
  constexpr milliseconds kStep{300};
  for (milliseconds left = patience; !active_.empty() && left.count() > 0; left -= kStep) {
    request_.wait(kStep);
    Look();
  }
}

bool ArrayDriver::CancelAll(void (Cluster::*cancel)(int64_t)) {
  bool all = true;
  for (const ArrayRecord& record : active_) {
    try {
      (cluster_.*cancel)(record.id);
    } catch (const ClusterError& error) {
      request_.say(error.what());
      all = false;
    }
  }
  return all;
}

// Reports how long it really took to start jobs.
void ArrayDriver::SayWaits() const {
  double busy = 0;
  double waits = 0, weight = 0;
  std::vector<ArrayRecord> records = ended_;
  records.insert(records.end(), active_.begin(), active_.end());
  for (const ArrayRecord& record : records) {
    const std::vector<JobSpan> spans = ReadJobSpans(folders_.ArrayFolder(record.number), record.jobs);
    const auto wait = MeanWait_s(spans);
    if (!wait) continue;
    for (const JobSpan& span : spans) busy += span.ended - span.began;
    waits += *wait * static_cast<double>(spans.size());
    weight += static_cast<double>(spans.size());
  }
  if (weight == 0) return;
  request_.say(fmt::format("between two jobs a processor waited {:.2g} s, {:.2g} % of a job's {:.3g} s",
                           waits / weight, 100 * waits / (waits + busy), busy / weight));
}

}  // namespace hydro::batch
