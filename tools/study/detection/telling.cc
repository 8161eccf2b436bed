#include "tools/study/detection/telling.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace fogline::study {
namespace {

/// A condition (a fog model, a visibility and a noise) ranks detectors only if some detector finds
/// at least this share of the fogs.
constexpr double kLeastFound = 0.1;
/// A condition does not rank detectors if this share of them raises the alarm at about the same
/// time. The share is below 1, because some detectors may hardly detect any fog.
constexpr double kMostDetectors = 0.9;

bool HaveEqualAlarms(const AlarmTimes& a, const AlarmTimes& b) {
  return a.common == b.common && (a.further.size() != b.further.size() || a.further == b.further);
}

}  // namespace

std::vector<std::size_t> OneOfEqualAlarms(std::span<const AlarmTimes> detectors) {
  std::vector<std::size_t> most_runs_first(detectors.size());
  std::iota(most_runs_first.begin(), most_runs_first.end(), std::size_t{0});
  std::ranges::stable_sort(most_runs_first, std::ranges::greater(),
                           [&](std::size_t d) { return detectors[d].further.size(); });
  std::vector<std::size_t> one_of(detectors.size());
  std::vector<std::size_t> ones;
  for (const std::size_t d : most_runs_first) {
    const auto same = std::ranges::find_if(
        ones, [&](std::size_t one) { return HaveEqualAlarms(detectors[d], detectors[one]); });
    one_of[d] = same == ones.end() ? d : *same;
    if (same == ones.end()) ones.push_back(d);
  }
  return one_of;
}

std::string_view Text(Telling telling) {
  switch (telling) {
    case Telling::kRanks:
      return "ranked";
    case Telling::kAllAtOnce:
      return "all raise the alarm at once";
    case Telling::kHardlyAny:
      return "hardly any alarm";
  }
  return "";
}

Telling TellingOf(std::span<const DelayAndShare> detectors, double shortest_s) {
  if (detectors.empty()) return Telling::kRanks;
  if (std::ranges::max(detectors, {}, &DelayAndShare::share).share < kLeastFound) {
    return Telling::kHardlyAny;
  }
  std::vector<double> delays_s;
  for (const DelayAndShare& one : detectors) delays_s.push_back(one.delay_s);
  std::ranges::sort(delays_s);
  const auto most =
      static_cast<std::size_t>(std::ceil(kMostDetectors * static_cast<double>(delays_s.size())));
  return delays_s[most - 1] - delays_s.front() < shortest_s ? Telling::kAllAtOnce : Telling::kRanks;
}

}  // namespace fogline::study
