// [scope]: what hydro-scope serves, to whom, and how much history it keeps.
#pragma once

#include <string>
#include <vector>

namespace hydro::settings {

class SectionReader;

struct ScopeSection {
  int port = 8765;  // TCP port; 0: any free one
  std::string bind = "127.0.0.1";
  bool control = false;    // the page may re-arm and change gains; it may stop the stack in any case
  double history_s = 120;  // plant time of a running stack that is kept
  double upload_mb = 512;  // the largest log that a browser may upload
  // Names under which a browser may reach hydro-scope besides 127.0.0.1, localhost and [::1] ("rig.lab:443"),
  // and origins besides its own whose pages may talk to it ("https://rig.lab").
  std::vector<std::string> hosts;
  std::vector<std::string> origins;
};

// Reads and checks [scope]. Throws InputError.
ScopeSection ReadScope(SectionReader section);

// Reads the [scope] of a configuration's whole text (StackConfig::text). The section may be missing: the
// processes of a stack check it but do not need it. `name` stands for the text in messages. Throws
// InputError.
ScopeSection ScopeSectionOf(const std::string& config_text, const std::string& name);

}  // namespace hydro::settings
