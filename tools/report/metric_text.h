// Formats a measure's number for a reader, on the report's HTML page and in a terminal. JSON and
// CSV have all digits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/metrics/run_metrics.h"
#include "services/metrics/take_over/take_over_measures.h"

namespace fogline::report {

/// The longest time to collision that is printed as a number, s. When the speeds of two cars become
/// equal, this time grows without bound. At a gap of 36 m, 1000 s correspond to a closing speed of
/// 4 cm/s, which is as small as the noise of a radar's range rate. Critical times are below 4 s
/// (measures.critical_ttc_s).
inline constexpr double kLongestTtc_s = 1000;

/// Whether the measure with this name is a time to collision.
bool IsTimeToCollision(std::string_view name);

/// Formats a finite value with its meaningful digits. The unit limits the decimals, for example to
/// a millimetre or to a hundredth of a second. Decimals after the fourth significant digit are left
/// out, except in a percentage. A whole number without unit has no decimals. 0 is "0". Any other
/// value that rounds to 0 becomes "< 0.001" or "> -0.001". "> 1000" stands for any time to
/// collision above kLongestTtc_s.
/// @param name as in VisitMetrics()
std::string MetricText(std::string_view name, double value, std::string_view unit);

/// Names as one text: "a, b and c".
std::string ListText(const std::vector<std::string>& names);

/// The outcome of a request to take over, such as "taken over".
std::string_view OutcomeText(metrics::TakeOverEnd end);

/// A text such as "the host hit the preceding car at 12.3 s"; "" without a collision.
std::string CollisionText(const metrics::RunMetrics& measures);

}  // namespace fogline::report
