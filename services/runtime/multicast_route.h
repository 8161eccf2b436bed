// Whether multicast has a way out of this machine, asked before LCM is: where it has none, LCM
// names an address that nobody has given and a command that few systems have.
#pragma once

#include <string>

namespace fogline {

/// Why a udpm:// URL cannot be opened, and what to do about it; "" if nothing is known against it.
std::string WhyNoMulticast(const std::string& url);

}  // namespace fogline
