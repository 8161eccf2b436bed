#include "services/arbitrator/conflict_meter.h"

#include <fmt/core.h>

#include "common/errors.h"

namespace fogline::arbitrator {

ConflictMeter::ConflictMeter(const Scenario& scenario)
    : slope_(scenario.arbitrator.doc_slope_per_m),
      centre_(scenario.arbitrator.doc_centre_m),
      doc_(policies::ConflictParametersOf(scenario.arbitrator)),
      witness_(scenario) {
  const ArbitratorSection& section = scenario.arbitrator;
  is_posterior_ = section.measure_scale == MeasureScale::kProbability;
  if (is_posterior_ && !policies::RowOf(section.measure).posterior) {
    throw InputError(
        fmt::format("/arbitrator/measure_scale: \"probability\" needs a measure whose score is a "
                    "probability, such as \"lidar_modes\"; /arbitrator/measure is \"{}\"",
                    policies::RowOf(section.measure).name));
  }
  if (section.measure == MeasureChoice::kDoc) return;
  measure_ = policies::RowOf(section.measure).make(policies::ConflictParametersOf(section));
  slope_ = section.measure_slope;
  centre_ = section.measure_centre;
}

}  // namespace fogline::arbitrator
