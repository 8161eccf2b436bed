// The commands between which the arbitrator decides, for tests.
#pragma once

namespace fogline {

inline constexpr double kAutomation_mps2 = 0.123;  // a_A
inline constexpr double kHuman_mps2 = -0.456;      // a_H

}  // namespace fogline
