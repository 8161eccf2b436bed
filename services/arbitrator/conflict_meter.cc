#include "services/arbitrator/conflict_meter.h"

namespace fogline {

ConflictMeter::ConflictMeter(const Scenario& scenario)
    : slope_(scenario.arbitrator.doc_slope_per_m),
      centre_(scenario.arbitrator.doc_centre_m),
      doc_(ConflictParametersOf(scenario.arbitrator)),
      witness_(scenario.fusion) {
  const ArbitratorSection& section = scenario.arbitrator;
  if (section.measure == MeasureChoice::kDoc) return;
  measure_ = RowOf(section.measure).make(ConflictParametersOf(section));
  slope_ = section.measure_slope;
  centre_ = section.measure_centre;
}

}  // namespace fogline
