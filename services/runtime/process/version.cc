#include "services/runtime/process/version.h"

#include <lcm/lcm.h>

#include <cstdint>

#include <fmt/core.h>

#include "fogline/fingerprint.hpp"

namespace fogline::runtime {

std::string_view Version() { return FOGLINE_VERSION; }

std::string VersionText() {
  return fmt::format("{}, message types {:016x}, LCM {}.{}.{}", Version(),
                     static_cast<std::uint64_t>(TypeFingerprint()), LCM_MAJOR_VERSION,
                     LCM_MINOR_VERSION, LCM_MICRO_VERSION);
}

}  // namespace fogline::runtime
