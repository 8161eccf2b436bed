#include "tools/benchmarks/comparison.h"

#include <algorithm>
#include <exception>

#include <fmt/core.h>

namespace fogline::benchmarks {
namespace {

/// Quantile of `sorted` at `share`, with linear interpolation between the two nearest values.
double Quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Spread SpreadOf(std::vector<double> values) {
  std::ranges::sort(values);
  return {.median = Quantile(values, 0.5),
          .lower_quartile = Quantile(values, 0.25),
          .upper_quartile = Quantile(values, 0.75)};
}

bool Finding::Meets(double limit) const {
  return comparison.bound == Bound::kAtMost ? ratio.median <= limit : ratio.median >= limit;
}

std::string Finding::Verdict() const {
  if (!note.empty()) return "not measured";
  if (met()) return "met";
  if (comparison.bar && Meets(*comparison.bar)) return fmt::format("bar {:g} met", *comparison.bar);
  return "missed";
}

Finding Compare(const Comparison& comparison, int rounds) {
  std::vector<double> ours, reference, ratio;
  try {
    for (int round = 0; round < rounds; ++round) {
      const bool ours_first = round % 2 != 0;
      if (ours_first) ours.push_back(comparison.measure_ours());
      reference.push_back(comparison.measure_reference());
      if (!ours_first) ours.push_back(comparison.measure_ours());
      ratio.push_back(ours.back() / reference.back());
    }
  } catch (const std::exception& error) {
    return {
        .comparison = comparison, .ours = {}, .reference = {}, .ratio = {}, .note = error.what()};
  }
  return {.comparison = comparison,
          .ours = SpreadOf(ours),
          .reference = SpreadOf(reference),
          .ratio = SpreadOf(ratio),
          .note = ""};
}

}  // namespace fogline::benchmarks
