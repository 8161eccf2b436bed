// Williams designs: orders of conditions in which each condition follows each other condition
// equally often. E. J. Williams, "Experimental Designs Balanced for the Estimation of Residual
// Effects of Treatments", Australian Journal of Scientific Research A 2 (1949) 149-168.
#pragma once

#include <cstddef>
#include <vector>

namespace fogline::trials {

/// Orders of the conditions 0 to conditions - 1, one for each participant of a block. In all orders
/// together, each condition is equally often at each place, and each ordered pair of neighbours
/// appears equally often. With an even number of conditions, the orders are one Latin square. With
/// an odd number above 1, one Latin square cannot balance the pairs. Then the orders are two Latin
/// squares, one after the other, and each pair appears twice.
std::vector<std::vector<std::size_t>> WilliamsDesign(std::size_t conditions);

}  // namespace fogline::trials
