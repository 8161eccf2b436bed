// Finds several points that are far from each other and at which a function is small enough: the
// search for an ensemble of calibrations, without the simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tools/calibrate/minimise.h"

namespace fogline::calibrate {

/// What a search looks at. A point gives each field as a share of the field's range, in [0, 1].
struct Landscape {
  std::size_t fields = 0;
  /// Squared distance from the target over the seeds of the search, and over fresh seeds. No value
  /// stops the search.
  FunctionOfShares searched;
  FunctionOfShares fresh;
  /// The point whose values are those of a file, which are rounded. Both functions have the same
  /// value there as at the point itself.
  std::function<std::vector<double>(const std::vector<double>& shares)> rounded;
};

/// What counts as an ensemble, and how long to search for it.
struct EnsembleRules {
  int sets = 1;
  /// A point meets the target if its distance is at most this, in the unit of the target.
  double within = 1;
  /// Least distance (ShareDistance) of two points.
  double apart = 0.2;
  /// Number of points from which the search may begin, and largest number of evaluations from each.
  int starts = 200;
  int evaluations = 1000;
  std::int64_t seed = 1;  // of the starts
};

/// What became of the searches.
struct EnsembleCounts {
  int evaluations = 0;  // over the seeds of the search
  int searches = 0;     // from one start each
  int missed = 0;       // searches that did not meet the target
  int too_near = 0;     // points too near to a point found before
  int rejected = 0;     // points that did not meet the target on fresh seeds
};

/// Points that meet the target over both kinds of seeds and are distinct, in the order in which
/// they were found.
struct PointEnsemble {
  std::vector<std::vector<double>> points;
  EnsembleCounts counts;
  bool interrupted = false;
};

/// Called after each evaluation, with the number of points so far.
using EnsembleProgress = std::function<void(int found, const EnsembleCounts& counts)>;

/// Root mean square of the differences of the shares: 0 for equal points, at most 1. Two random
/// points are 0.41 apart on average, whatever the number of fields.
double ShareDistance(std::span<const double> a, std::span<const double> b);

/// Points of a Latin hypercube (McKay, Beckman & Conover 1979): in each field, each of `points`
/// equal parts of the range has one point.
std::vector<std::vector<double>> LatinHypercube(int points, std::size_t fields, std::int64_t seed);

/// Evaluates a Latin hypercube of starts. Then it searches around one start after the other, the
/// best first, and keeps each point that is distinct and meets the target on fresh seeds, too. It
/// ends when it has enough points or no starts are left. The result depends only on the landscape
/// and the rules.
PointEnsemble FindPoints(const Landscape& landscape, const EnsembleRules& rules,
                         const EnsembleProgress& progress);

}  // namespace fogline::calibrate
