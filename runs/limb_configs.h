// The configurations of the limbs in a log, as the limbs describe themselves there.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runs/channel_suffix.h"
#include "runs/log/log_reader.h"

namespace hydro::runs {

class LimbConfigs {
 public:
  // Takes the first event of a channel, whichever channel it is.
  void TakeFirst(const log::LogEvent& event);

  // The configuration, as TOML, of the limb whose own channels have this suffix; empty where the log has
  // none.
  std::string Of(const std::string& limb) const;

  // Sorts the joints of each limb into the order of its configuration. Joints that are not in it come last,
  // by suffix.
  void Order(std::vector<JointChannels>* joints) const;

 private:
  std::map<std::string, std::string> texts_;  // by suffix
};

// Whether this configuration of a limb has an [arm], which couples the loads of its joints.
bool HasArm(const std::string& limb_config);

}  // namespace hydro::runs
