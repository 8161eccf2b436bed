#include "tools/report/metric_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/text.h"

namespace fogline::report {
namespace {

constexpr int kSignificant = 4;
constexpr std::string_view kPercent = "%";

/// Largest number of decimals that are meaningful in traffic for a measure with this unit.
int DecimalsOfUnit(std::string_view unit) {
  constexpr int kOther = 3;  // a millimetre, a millimetre per second ...
  // Percentages have the decimals of the paper.
  constexpr std::array<std::pair<std::string_view, int>, 5> kDecimals{
      {{kPercent, 2}, {"s", 2}, {"s2", 2}, {"1/min", 2}, {"1/h", 1}}};
  const auto* const found =
      std::ranges::find(kDecimals, unit, &std::pair<std::string_view, int>::first);
  return found == kDecimals.end() ? kOther : found->second;
}

}  // namespace

bool IsTimeToCollision(std::string_view name) { return name.ends_with("ttc_s"); }

std::string MetricText(std::string_view name, double value, std::string_view unit) {
  if (value == 0) return "0";
  if (unit.empty() && value == std::round(value)) return fmt::format("{:.0f}", value);
  if (IsTimeToCollision(name) && value > kLongestTtc_s) return fmt::format("> {}", kLongestTtc_s);
  int decimals = DecimalsOfUnit(unit);
  const double least = std::pow(10, -decimals);
  if (std::fabs(value) < least / 2) {
    return fmt::format("{} {:.{}f}", value < 0 ? ">" : "<", std::copysign(least, value), decimals);
  }
  if (unit != kPercent) {
    const int magnitude = static_cast<int>(std::floor(std::log10(std::fabs(value))));
    decimals = std::clamp(kSignificant - 1 - magnitude, 0, decimals);
  }
  return fmt::format("{:.{}f}", value, decimals);
}

std::string ListText(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

std::string_view OutcomeText(metrics::TakeOverEnd end) {
  switch (end) {
    case metrics::TakeOverEnd::kOpen:
      return "open at the end of the run";
    case metrics::TakeOverEnd::kTakenOver:
      return "taken over";
    case metrics::TakeOverEnd::kTakenOverLate:
      return "taken over late, in the manoeuvre";
    case metrics::TakeOverEnd::kMinimalRisk:
      return "minimal risk manoeuvre";
    case metrics::TakeOverEnd::kWithdrawn:
      return "withdrawn";
    case metrics::TakeOverEnd::kFallback:
      return "fallback to the human";
    case metrics::TakeOverEnd::kUnknown:
      return "unknown: the log ends first";
  }
  return "";
}

std::string CollisionText(const metrics::RunMetrics& measures) {
  if (!measures.collision_time_s) return "";
  return fmt::format("{} at {} s",
                     measures.collision == truth_t::COLLISION_HOST
                         ? "the host hit the preceding car"
                         : "a following car hit the car ahead",
                     TimeText(*measures.collision_time_s));
}

}  // namespace fogline::report
