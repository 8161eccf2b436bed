// Searches for a minimum of a function (FunctionOfShares) by algorithms of NLopt.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace fogline::calibrate {

/// A function of a point. A point gives each field as a share of the field's range, in [0, 1]. The
/// result nullopt stops a search.
using FunctionOfShares = std::function<std::optional<double>(const std::vector<double>& shares)>;

enum class Reach {
  kWholeRange,
  kAroundStart,
};

/// Searches from `start`. The search ends after `most` evaluations, at a value of at most `enough`,
/// or when its steps are as small as the rounding of values. The search uses no random numbers.
/// Minimise() returns no point, because the caller's `function` receives each evaluated point. An
/// exception of `function` reaches the caller.
/// @param most at least 1
void Minimise(Reach reach, const FunctionOfShares& function, std::vector<double> start,
              double enough, int most);

}  // namespace fogline::calibrate
