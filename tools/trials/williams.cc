#include "tools/trials/williams.h"

#include <algorithm>

namespace fogline::trials {

std::vector<std::vector<std::size_t>> WilliamsDesign(std::size_t conditions) {
  const std::size_t n = conditions;
  // The first order alternates between both ends: 0, 1, n - 1, 2, n - 2 ... If n is even, all
  // differences (modulo n) between neighbours in this order are distinct. If n is odd, this order
  // and the reversed order together have each difference twice.
  std::vector<std::size_t> zigzag;
  for (std::size_t place = 0; place < n; ++place) {
    zigzag.push_back(place % 2 == 1 ? (place + 1) / 2 : (n - place / 2) % n);
  }
  std::vector<std::vector<std::size_t>> orders;
  // Each order adds its own number (modulo n) to all conditions of the first order. So all orders
  // have the same differences between neighbours, and each condition comes once at each place (a
  // Latin square).
  for (std::size_t shift = 0; shift < n; ++shift) {
    std::vector<std::size_t> order;
    for (const std::size_t condition : zigzag) order.push_back((condition + shift) % n);
    orders.push_back(std::move(order));
  }
  if (n % 2 == 1 && n > 1) {
    for (std::size_t row = 0; row < n; ++row) {
      orders.push_back({orders[row].rbegin(), orders[row].rend()});
    }
  }
  return orders;
}

}  // namespace fogline::trials
