// A multicast port for a new run on this machine.
#pragma once

#include <cstddef>
#include <string>

namespace fogline::runtime {

/// How many ports FreshMulticastUrl() reserves.
inline constexpr std::size_t kReservedPorts = 16;

/// A multicast URL for this machine only, with a random port that no other socket uses. The ports
/// of the last kReservedPorts calls stay reserved until the process ends, so no other process gets
/// them.
std::string FreshMulticastUrl();

}  // namespace fogline::runtime
