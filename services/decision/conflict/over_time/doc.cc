#include "services/decision/conflict/over_time/doc.h"

#include <optional>

namespace fogline::conflict {

Doc::Doc(const ConflictParameters& parameters)
    : source_(parameters, DisagreementSource::Offset::kKept),
      window_(parameters.window_steps),
      reading_(parameters.doc_reading),
      slope_pm_(parameters.doc_slope_pm),
      centre_m_(parameters.doc_centre_m) {}

void Doc::Observe(const Evidence& evidence) {
  const std::optional<Disagreement> disagreement = source_.Next(evidence);
  window_.Push(disagreement ? std::optional(disagreement->difference_m) : std::nullopt);
}

double Doc::Step(const Evidence& evidence) {
  Observe(evidence);
  return DegreeOfConflict(conflict_m(), slope_pm_, centre_m_);
}

void Doc::Reset() {
  source_.Reset();
  window_.Clear();
}

}  // namespace fogline::conflict
