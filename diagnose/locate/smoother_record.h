// What the filter records for the backward pass. Only for the smoother's own files: it exposes Eigen's types.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "diagnose/locate/disturbance_smoother.h"
#include "model/terms/state.h"

namespace hydro::diagnose::smoother {

inline constexpr int kMostStates = model::kMaxStates + static_cast<int>(kBalances);
inline constexpr int kColumns = 1 + static_cast<int>(kNoiseDraws);  // the data, then draws of noise
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostStates, kMostStates>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostStates, 1>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, kColumns, 0, kMostStates, kColumns>;
using RowOfColumns = Eigen::Matrix<double, 1, kColumns>;

// One entry a sample, in flat arrays: the number of states is known only at run time.
class Record {
 public:
  Record(size_t samples, int size)
      : size_(size),
        updates_(samples),
        covariance_(samples * size * size),
        transition_(samples * size * size),
        state_(samples * size * kColumns),
        informative_(samples) {}

  struct Update {
    int sensor = 0;
    double variance = 0;
    RowOfColumns innovation;
  };

  Eigen::Map<Eigen::MatrixXd> covariance(size_t k) {  // after the sample's readings
    return {&covariance_[k * size_ * size_], size_, size_};
  }
  Eigen::Map<Eigen::MatrixXd> transition(size_t k) {  // to the next sample
    return {&transition_[k * size_ * size_], size_, size_};
  }
  // After the readings: the data's state, then the draws' differences from it.
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kColumns>> state(size_t k) {
    return {&state_[k * size_ * kColumns], size_, kColumns};
  }
  std::array<uint8_t, kBalances>& informative(size_t k) { return informative_[k]; }

  // Readings are added in the order of the samples and removed in reverse.
  void Add(size_t k, const Update& update, const Vector& gain) {
    ++updates_[k];
    update_.push_back(update);
    gain_.insert(gain_.end(), gain.data(), gain.data() + size_);
  }
  bool Take(size_t k, Update* update, Vector* gain) {
    if (updates_[k] == 0) return false;
    --updates_[k];
    *update = update_.back();
    update_.pop_back();
    *gain = Eigen::Map<const Eigen::VectorXd>(gain_.data() + gain_.size() - size_, size_);
    gain_.resize(gain_.size() - size_);
    return true;
  }
  void Forget(size_t k) {
    Update update;
    Vector gain;
    while (Take(k, &update, &gain)) {
    }
  }

 private:
  int size_;
  std::vector<int> updates_;
  std::vector<Update> update_;
  std::vector<double> gain_, covariance_, transition_, state_;
  std::vector<std::array<uint8_t, kBalances>> informative_;
};

}  // namespace hydro::diagnose::smoother
