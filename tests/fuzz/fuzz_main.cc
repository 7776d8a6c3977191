// libFuzzer's entry into the target HYDRO_FUZZ_TARGET.
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const hydro::fuzz::Target* const target = hydro::fuzz::FindTarget(HYDRO_FUZZ_TARGET);
  target->run(data, size);
  return 0;
}
