#include "services/metrics/surrogate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fogline::metrics {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A car that is slower than this speed counts as standing and has no time gap. The least speed that
// a wheel speed sensor detects is ten times this speed.
constexpr double kStanding_mps = 0.01;

double NormalShare(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

std::optional<double> IfFinite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

double TimeToCollision(const CarPair& pair) {
  if (pair.gap_m <= 0) return 0;
  return pair.closing_mps() > 0 ? pair.gap_m / pair.closing_mps() : kInfinite;
}

double DecelerationToAvoidCrash(const CarPair& pair) {
  const double closing_mps = pair.closing_mps();
  if (closing_mps <= 0) return 0;
  return pair.gap_m > 0 ? closing_mps * closing_mps / (2 * pair.gap_m) : kInfinite;
}

double UrgentDecelerationGap(const MeasuresSection& section, const CarPair& pair) {
  return pair.gap_m +
         (pair.lead_speed_mps * pair.lead_speed_mps - pair.speed_mps * pair.speed_mps) /
             (2 * section.picud_braking_mps2) -
         pair.speed_mps * section.picud_reaction_s;
}

double CrashProbability(const MeasuresSection& section, double drac_mps2) {
  if (drac_mps2 <= section.madr_least_mps2) return 0;
  if (drac_mps2 >= section.madr_most_mps2) return 1;
  const auto share = [&](double deceleration_mps2) {
    return NormalShare((deceleration_mps2 - section.madr_mean_mps2) / section.madr_std_mps2);
  };
  const double least = share(section.madr_least_mps2);
  const double mass = share(section.madr_most_mps2) - least;
  // If the limits are so far from the mean that the probability between them rounds to 0, all cars
  // count as being at the nearer limit.
  if (mass <= 0) return section.madr_mean_mps2 < section.madr_least_mps2 ? 1 : 0;
  return (share(drac_mps2) - least) / mass;
}

double CompromisedSafety(double safe_distance_m, double gap_m) {
  const double shortfall_m = safe_distance_m - gap_m;
  return shortfall_m < 0 ? 0 : shortfall_m;
}

PairAccumulator::PairAccumulator(const MeasuresSection& section)
    : section_(section),
      rss_{.response_s = section.rss_response_s,
           .acceleration_mps2 = section.rss_acceleration_mps2,
           .least_braking_mps2 = section.rss_least_braking_mps2,
           .most_braking_mps2 = section.rss_most_braking_mps2},
      min_ttc_s_(kInfinite),
      min_time_gap_s_(kInfinite),
      max_drac_mps2_(-kInfinite),
      min_picud_m_(kInfinite),
      min_rss_margin_m_(kInfinite),
      min_rss_margin_ad_rss_m_(kInfinite) {}

void PairAccumulator::Pass(double duration_s) {
  if (!ttc_s_) return;
  time_s_ += duration_s;
  crash_time_s_ += crash_probability_ * duration_s;
  if (*ttc_s_ > section_.critical_ttc_s) return;
  tet_s_ += duration_s;
  tit_s2_ += (section_.critical_ttc_s - *ttc_s_) * duration_s;
}

void PairAccumulator::Add(const CarPair& pair, double since_s) {
  Pass(since_s);
  if (std::isnan(pair.gap_m) || std::isnan(pair.closing_mps())) {
    ttc_s_.reset();
    return;
  }
  met_ = true;
  ttc_s_ = TimeToCollision(pair);
  const double drac_mps2 = DecelerationToAvoidCrash(pair);
  crash_probability_ = CrashProbability(section_, drac_mps2);
  min_ttc_s_ = std::min(min_ttc_s_, *ttc_s_);
  if (pair.gap_m > 0) max_drac_mps2_ = std::max(max_drac_mps2_, drac_mps2);
  if (pair.speed_mps > kStanding_mps) {
    min_time_gap_s_ = std::min(min_time_gap_s_, std::max(0.0, pair.gap_m) / pair.speed_mps);
  }
  min_picud_m_ = std::min(min_picud_m_, UrgentDecelerationGap(section_, pair));
  const auto margin_m = [&](const models::RssParameters& rss) {
    return pair.gap_m - models::RssSafeDistance(rss, pair.speed_mps, pair.lead_speed_mps);
  };
  min_rss_margin_m_ = std::min(min_rss_margin_m_, margin_m(rss_));
  min_rss_margin_ad_rss_m_ = std::min(min_rss_margin_ad_rss_m_, margin_m(models::RssParameters{}));
}

PairMetrics PairAccumulator::Result() const {
  PairMetrics result{.min_ttc_s = IfFinite(min_ttc_s_),
                     .min_time_gap_s = IfFinite(min_time_gap_s_),
                     .max_drac_mps2 = IfFinite(max_drac_mps2_),
                     .min_picud_m = IfFinite(min_picud_m_),
                     .min_rss_margin_m = IfFinite(min_rss_margin_m_),
                     .min_rss_margin_ad_rss_m = IfFinite(min_rss_margin_ad_rss_m_)};
  if (met_) {
    result.tet_s = tet_s_;
    result.tit_s2 = tit_s2_;
  }
  if (time_s_ > 0) result.cpi = crash_time_s_ / time_s_;
  return result;
}

}  // namespace fogline::metrics
