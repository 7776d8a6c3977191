// What the readers of the configuration's sections know of its keys: default, what is allowed, where a key
// applies.
#pragma once

#include <string>
#include <vector>

namespace hydro::settings {

struct KeyFacts {
  std::string section;   // dotted, e.g. "driver.voltage"
  std::string key;       // e.g. "limit_V"
  std::string standard;  // as TOML, "none" or "required"; empty: the code does not tell it (see kByHand)
  std::string allowed;   // in the few words of a table, e.g. "above 0, or `inf`"
  std::vector<std::string>
      kinds;  // the `kind` or `source` with which the section has it; empty: it has no such key
};

// The keys whose default the page's writer must know, with the reason. Dotted.
struct HandWritten {
  std::string key;
  std::string reason;
};
const std::vector<HandWritten>& HandWrittenDefaults();

// The facts of each key, from the sections' readers: the keys are those that they ask for, the defaults what
// they found there before, and what is allowed they say themselves when a key holds a date, which none
// allows. Throws InputError when a reader takes a date, or two readers disagree.
std::vector<KeyFacts> ConfigurationFacts();

// The words of an error message for a table: "a finite number of at least 0 and at most 1" is "0 to 1".
std::string ShortAllowed(std::string allowed);

}  // namespace hydro::settings
