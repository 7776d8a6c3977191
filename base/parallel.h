// A loop whose iterations run on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace hydro {

// Calls work(i) for each i below `count`, on up to `jobs` threads. Each call must write its result to its own
// place, so that results do not depend on the order. Rethrows the first exception when all threads have
// stopped.
template <class Work>
void ParallelFor(size_t count, int jobs, const Work& work) {
  std::atomic<size_t> next = 0;
  std::exception_ptr error;
  std::mutex mutex;
  const auto loop = [&] {
    for (size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int j = 1; j < jobs && static_cast<size_t>(j) < count; ++j) threads.emplace_back(loop);
  loop();
  threads.clear();
  if (error) std::rethrow_exception(error);
}

}  // namespace hydro
