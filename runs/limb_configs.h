// The configurations of the limbs that a log is of, as the limbs describe themselves in it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runs/channel_suffix.h"
#include "runs/log/log_reader.h"

namespace hydro::runs {

class LimbConfigs {
 public:
  // Takes the first event of a channel, whatever it is.
  void TakeFirst(const log::LogEvent& event);

  // The configuration of the limb whose own channels end in this, as TOML; empty where the log has none.
  std::string Of(const std::string& limb) const;

  // Sorts the joints of each limb into the order of its configuration. Those that it does not have come last, by suffix.
  void Order(std::vector<JointChannels>* joints) const;

 private:
  std::map<std::string, std::string> texts_;  // by suffix
};

// Whether this configuration of a limb has an [arm], which couples the loads of its joints.
bool HasArm(const std::string& limb_config);

}  // namespace hydro::runs
