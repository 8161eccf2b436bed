#include "services/runtime/process/version.h"

#include <cstdint>

#include <fmt/core.h>

#include "fogline/fingerprint.hpp"

namespace fogline::runtime {

std::string VersionText() {
  return fmt::format("{}, message types {:016x}", FOGLINE_VERSION,
                     static_cast<std::uint64_t>(TypeFingerprint()));
}

}  // namespace fogline::runtime
