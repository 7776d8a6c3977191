// The LCM address of a stack.
#pragma once

#include <string>

namespace hydro::settings {

// Returns an empty text when `url` is udpm://GROUP:PORT with optional ?ttl=N&recv_buf_size=BYTES; otherwise
// returns what is allowed. LCM itself silently misreads malformed addresses.
std::string WhatIsWrongWithBusUrl(const std::string& url);

}  // namespace hydro::settings
