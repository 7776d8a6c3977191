// [scope]: what hydro-scope serves, to whom, and how much it remembers.
#pragma once

#include <string>
#include <vector>

namespace hydro::settings {

class SectionReader;

struct ScopeSection {
  int port = 8765;  // of TCP; 0: any free one
  std::string bind = "127.0.0.1";
  bool control = false;    // the page may re-arm and change gains; it may always stop
  double history_s = 120;  // plant time that is kept of a running stack
  double upload_mb = 512;  // the largest log that a browser may hand in
  // Names besides 127.0.0.1, localhost and [::1] under which a browser may reach it ("rig.lab:443"), and origins besides
  // its own whose pages may talk to it ("https://rig.lab").
  std::vector<std::string> hosts;
  std::vector<std::string> origins;
};

// Reads and checks [scope]. Throws InputError.
ScopeSection ReadScope(SectionReader section);

// The [scope] of a configuration's whole text (StackConfig::text), which need not have one: the processes of a stack check
// it and do without it. `name` stands for the text in messages. Throws InputError.
ScopeSection ScopeSectionOf(const std::string& config_text, const std::string& name);

}  // namespace hydro::settings
