// The tables of conflict measures. Studies, policies, documents and tests use them.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"

namespace fogline::conflict {

/// One measure: a row of the table ConflictMeasures() or of the table BlameMeasures(). `Measure` is
/// ConflictMeasure for a measure of conflict, and BlameMeasure for a measure of blame.
template <class Measure>
struct MetricRow {
  std::string_view name;  // name in the scenario (scenario/sections/decision.h)
  std::string_view source;
  std::string_view range;    // range of the score, with the unit if there is one
  std::string_view missing;  // treatment of a step without radar or LiDAR value
  std::unique_ptr<Measure> (*make)(const ConflictParameters& parameters);
  bool posterior = false;  // the score is the posterior probability of conflict, given all evidence
};

using ConflictMeasureRow = MetricRow<ConflictMeasure>;
using BlameMeasureRow = MetricRow<BlameMeasure>;

/// All measures of conflict, in the order of services/decision/conflict/README.md.
std::span<const ConflictMeasureRow> ConflictMeasures();
/// All measures that find the sensor that is wrong.
std::span<const BlameMeasureRow> BlameMeasures();

}  // namespace fogline::conflict
