#include "launch/make_key.h"

#include <cstdio>

#include "bus/seal/bus_key.h"
#include "settings/limb_config.h"

namespace hydro::launch {

int MakeKey(const settings::CommonOptions& options) {
  const settings::StackConfig config = settings::LoadCommonConfig(options.config, options.overrides);
  const std::string& file = config.bus.resolved_key_file;
  if (file.empty()) {
    throw InputError(options.config +
                     ": bus.key_file: found nothing, allowed is the path of the key file to create");
  }
  bus::MakeBusKeyFile(file);
  std::printf(
      "%s: a new key, readable by you alone; every host of the stack needs a copy (docs/security.md)\n",
      file.c_str());
  return 0;
}

}  // namespace hydro::launch
