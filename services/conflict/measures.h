// THE table of conflict measures: studies, policies, documents and tests come from it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "services/conflict/conflict_measure.h"
#include "services/conflict/parameters.h"

namespace fogline {

/// One measure. `Measure` is ConflictMeasure or BlameMeasure.
template <class Measure>
struct MeasureRow {
  std::string_view name;        // lower_snake, unique in its table
  std::string_view definition;  // in a line
  std::string_view source;
  std::string_view range;    // with unit, if it has one
  std::string_view missing;  // what a step without radar or LiDAR value is
  std::unique_ptr<Measure> (*make)(const ConflictParameters& parameters);
  bool posterior = false;  // a posterior probability of conflict by all evidence so far
};

using ConflictMeasureRow = MeasureRow<ConflictMeasure>;
using BlameMeasureRow = MeasureRow<BlameMeasure>;

/// All measures of conflict, in the order of services/conflict/README.md.
std::span<const ConflictMeasureRow> ConflictMeasures();
/// All measures of who is wrong.
std::span<const BlameMeasureRow> BlameMeasures();

/// The row of that name; nullptr if there is none.
const ConflictMeasureRow* FindConflictMeasure(std::string_view name);
const BlameMeasureRow* FindBlameMeasure(std::string_view name);

}  // namespace fogline
