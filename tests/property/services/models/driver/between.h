// Numbers in a range, for random drivers and situations.
#pragma once

namespace fogline {

/// Returns the number at the share `u` of the way from `low` to `high`. @param u in [0, 1]
inline double Between(double low, double high, double u) { return low + (high - low) * u; }

}  // namespace fogline
