#include "services/arbitrator/request_debouncer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/whole_steps.h"
#include "services/host_modes.h"

namespace fogline::arbitrator {
namespace {

// ln(p/(1 - p)). p is limited to [1e-12, 1 - 1e-12], because a smaller distance from 0 or 1 is only
// a rounding error.
double LogOdds(double probability) {
  constexpr double kNearest = 1e-12;
  const double p = std::clamp(probability, kNearest, 1 - kNearest);
  return std::log(p / (1 - p));
}

}  // namespace

RequestDebouncer::RequestDebouncer(const TransferSection& section, double step_s, bool posterior)
    : section_(section),
      posterior_(posterior),
      plain_(section.hysteresis == Hysteresis::kNone && section.min_dwell_s == 0 &&
             section.hand_back == HandBack::kConflict),
      accept_human_(std::log((1 - section.sprt_beta) / section.sprt_alpha)),
      accept_automation_(std::log(section.sprt_beta / (1 - section.sprt_alpha))),
      dwell_steps_(StepsUntil(section.min_dwell_s, step_s)),
      steps_since_change_(dwell_steps_) {}

double RequestDebouncer::Follow(double lambda_human) {
  decided_human_ = HumanDrives(lambda_human);
  evidence_ = 0;
  ++steps_since_change_;
  if (decided_human_ != wanted_human_) {
    wanted_human_ = decided_human_;
    steps_since_change_ = 0;
  }
  return lambda_human;
}

double RequestDebouncer::PutOff(const policies::EngagementRequest& request, double doc,
                                bool recovered) {
  decided_human_ = HumanByHysteresis(request, doc);
  ++steps_since_change_;
  const bool waits = !decided_human_ && section_.hand_back == HandBack::kFusion && !recovered;
  if (decided_human_ != wanted_human_ && steps_since_change_ >= dwell_steps_ && !waits) {
    wanted_human_ = decided_human_;
    steps_since_change_ = 0;
  }
  return wanted_human_ ? 1 : 0;
}

double RequestDebouncer::LowerThreshold(double threshold) const {
  return threshold - std::min(section_.band, threshold / 2);
}

bool RequestDebouncer::HumanByHysteresis(const policies::EngagementRequest& request, double doc) {
  switch (section_.hysteresis) {
    case Hysteresis::kNone:
      break;
    case Hysteresis::kBand:
      return !(doc < (decided_human_ ? LowerThreshold(request.threshold) : request.threshold));
    case Hysteresis::kSprt:
      if (posterior_) evidence_ = 0;
      evidence_ += LogOdds(doc) - LogOdds(request.threshold);
      if (evidence_ < accept_human_ && evidence_ > accept_automation_) return decided_human_;
      return posterior_ ? evidence_ > 0 : std::exchange(evidence_, 0.0) > 0;
  }
  return request.lambda_human > 0;
}

}  // namespace fogline::arbitrator
