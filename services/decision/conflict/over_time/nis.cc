#include "services/decision/conflict/over_time/nis.h"

#include <cmath>

namespace fogline::conflict {
namespace {

struct Sum {
  double sum = 0;
  int count = 0;
};

Sum SumOf(const Window& window) {
  Sum sum;
  window.ForEach([&](double value) {
    sum.sum += value;
    ++sum.count;
  });
  return sum;
}

}  // namespace

double Mean(const Window& window) {
  const auto [sum, count] = SumOf(window);
  return count > 0 ? sum / count : 0;
}

double StandardisedMean(const Window& window) {
  const auto [sum, count] = SumOf(window);
  return count > 0 ? sum / std::sqrt(count) : 0;
}

}  // namespace fogline::conflict
