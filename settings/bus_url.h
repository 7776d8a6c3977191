// The LCM address of a stack.
#pragma once

#include <string>

namespace hydro::settings {

// Empty when `url` is udpm://GROUP:PORT with optional ?ttl=N&recv_buf_size=BYTES, else what is allowed. LCM
// itself takes malformed addresses for others without a word.
std::string WhatIsWrongWithBusUrl(const std::string& url);

}  // namespace hydro::settings
