// Finds several points that are far from each other and at which a function is small enough. The
// search for an ensemble of calibrations uses these points. This file does not use the simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tools/calibrate/minimise.h"

namespace fogline::calibrate {

/// Input of a search. A point gives each field as a share of the field's range, in [0, 1].
struct Landscape {
  std::size_t fields = 0;
  /// Functions of a point. With the values of the point, a scenario has a table of SI and RHE. The
  /// result is the squared distance of this table from the target table. `searched` computes the
  /// table over the seeds of the search, and `fresh` over other seeds. If a function returns
  /// nullopt, the search stops.
  FunctionOfShares searched;
  FunctionOfShares fresh;
  /// Returns the point of the rounded values. A file contains the values in this rounded form.
  /// `searched` has the same value at the rounded point as at `shares`, and so has `fresh`.
  std::function<std::vector<double>(const std::vector<double>& shares)> rounded;
};

/// The requirements on an ensemble, and the limits of the search for it.
struct EnsembleRules {
  int sets = 1;
  /// A point meets the target if its distance from the target is at most this value. The distance
  /// is the square root of the value of Landscape::searched or Landscape::fresh.
  double within = 1;
  /// Least allowed distance (ShareDistance()) between two points.
  double apart = 0.2;
  /// Number of starting points, and largest number of evaluations in the search from each starting
  /// point.
  int starts = 200;
  int evaluations = 1000;
  std::int64_t seed = 1;  // seed of the starting points
};

/// Counts of the searches and their outcomes.
struct EnsembleCounts {
  int evaluations = 0;  // over the seeds of the search
  int searches = 0;     // searches, each from one starting point
  int missed = 0;       // searches that did not meet the target
  int too_near = 0;     // points too near to a point found before
  int rejected = 0;     // points that did not meet the target on fresh seeds
};

/// Distinct points that meet the target over the seeds of the search and over fresh seeds, in the
/// order in which they were found.
struct PointEnsemble {
  std::vector<std::vector<double>> points;
  EnsembleCounts counts;
  bool interrupted = false;
};

/// Called after each evaluation, with the number of points so far.
using EnsembleProgress = std::function<void(int found, const EnsembleCounts& counts)>;

/// Distance of two points: the root mean square of the differences of their shares. It is 0 for
/// equal points, and at most 1. For two random points the mean of its square is 1/6, so a typical
/// distance is 0.41 for any number of fields.
double ShareDistance(std::span<const double> a, std::span<const double> b);

/// Points of a Latin hypercube (McKay, Beckman & Conover 1979): in each field, each of `points`
/// equal parts of the range has one point.
std::vector<std::vector<double>> LatinHypercube(int points, std::size_t fields, std::int64_t seed);

/// Evaluates the starting points of a Latin hypercube. Then FindPoints() searches around one
/// starting point after the other, the best first. A point that a search finds is added to the
/// result if it is far enough from all points in the result (EnsembleRules::apart), and also meets
/// the target over fresh seeds. FindPoints() ends when it has enough points or no starting points
/// are left. The result depends only on the landscape and the rules.
PointEnsemble FindPoints(const Landscape& landscape, const EnsembleRules& rules,
                         const EnsembleProgress& progress);

}  // namespace fogline::calibrate
