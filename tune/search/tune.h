// hydro-tune: computes gains, a report and a configuration from a configuration and goals.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace hydro::tune {

struct TuneRequest {
  std::string config;                   // the file
  std::vector<std::string> overrides;   // "section.key=value", as with --set
  std::string joint;                    // which joint of a limb; empty: the configuration is a stack's
  std::vector<std::string> goals;       // as ParseGoals reads them
  std::optional<std::string> interval;  // s, T; none: the configuration's
  std::string output;                   // the configuration with the gains; empty: none
  std::string folder;                   // for the report; empty: none
  int samples = 8;
  int jobs = 2;
  bool fixed_gains = false;  // eq. (17) alone, without a braking curve
  bool noise = false;
  bool si = false;
};

// Tables go to `out`, progress goes to `progress` (a bar on a terminal). Returns 0. Throws InputError for
// wrong input, and std::runtime_error, naming the limit, for goals that cannot be met, and where nothing
// better than the configured gains is found; then it writes no file.
int Tune(const TuneRequest& request, std::FILE* out, std::FILE* progress, bool terminal);

}  // namespace hydro::tune
