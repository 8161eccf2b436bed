// Surrogate measures of safety between a car and the car ahead of it. The measures say how near a
// collision is. Gaps are measured from bumper to bumper, and speeds along the lane. The car ahead
// is assumed to keep its speed, except where a measure states another assumption.
#pragma once

#include <optional>

#include "scenario/sections/scenario.h"
#include "services/models/follower/safe_distance.h"

namespace fogline::metrics {

/// A car and the car ahead of it at one moment. The formulas below have the symbols d (gap), v
/// (speed of the car behind) and v_l (speed of the car ahead).
struct CarPair {
  double gap_m;
  double speed_mps;       // speed of the car behind
  double lead_speed_mps;  // speed of the car ahead

  double closing_mps() const { return speed_mps - lead_speed_mps; }
};

/// Time to collision in s, d/(v - v_l) (Hayward 1972). Infinite while the gap does not close, 0 at
/// contact.
double TimeToCollision(const CarPair& pair);

/// Deceleration rate to avoid a crash in m/s2, (v - v_l)^2/(2 d) (Cooper & Ferguson 1976). 0 while
/// the gap does not close, infinite at contact.
double DecelerationToAvoidCrash(const CarPair& pair);

/// Possibility index for collision with urgent deceleration in m, d + (v_l^2 - v^2)/(2 b) - v t_r.
/// PICUD is the gap that remains if the car ahead brakes now with b = picud_braking_mps2, and the
/// car behind brakes equally hard after its reaction time t_r = picud_reaction_s (Uno et al. 2002).
/// A value below 0 is dangerous.
double UrgentDecelerationGap(const MeasuresSection& section, const CarPair& pair);

/// Probability that a car's maximum available deceleration is below `drac_mps2`. The maximum
/// available deceleration has a truncated normal distribution (Cunto & Saccomanno 2008).
double CrashProbability(const MeasuresSection& section, double drac_mps2);

/// Compromised safety CS in m, max(0, d_r - d) (Sourav & Cheng 2024): the length by which a car's
/// gap d is below the dynamic safe distance d_r of its driver. The result is NaN if d or d_r is
/// NaN.
double CompromisedSafety(double safe_distance_m, double gap_m);

/// Measures of a pair of cars over a run. A field is nullopt if the run has no step that is
/// relevant for the measure.
struct PairMetrics {
  /// Least time to collision, s.
  std::optional<double> min_ttc_s;
  /// Time exposed: time during which the time to collision TTC is at most TTC* = critical_ttc_s, s
  /// (Minderhoud & Bovy 2001).
  std::optional<double> tet_s;
  /// Time integrated: the integral of TTC* - TTC over the time exposed, s2 (Minderhoud & Bovy
  /// 2001).
  std::optional<double> tit_s2;
  /// Least time gap d/v, s, while the car moves: from the rear bumper of the car ahead to the front
  /// bumper of the car behind. A headway is from front to front and also contains a car length (SAE
  /// J2944).
  std::optional<double> min_time_gap_s;
  /// Largest deceleration rate to avoid a crash, m/s2; steps in contact do not count.
  std::optional<double> max_drac_mps2;
  /// Least PICUD, m.
  std::optional<double> min_picud_m;
  /// Least gap minus RSS safe distance, m (Shalev-Shwartz, Shammah & Shashua 2017), with the
  /// parameters of the scenario.
  std::optional<double> min_rss_margin_m;
  /// Least gap minus RSS safe distance, m, with the parameters that ad-rss-lib suggests (the
  /// defaults of models::RssParameters).
  std::optional<double> min_rss_margin_ad_rss_m;
  /// Crash potential index, in [0, 1] (Cunto & Saccomanno 2008): the mean over time of the
  /// probability that the deceleration rate to avoid a crash exceeds the car's maximum available
  /// deceleration (CrashProbability()).
  std::optional<double> cpi;
};

/// Collects the measures, step by step.
class PairAccumulator {
 public:
  explicit PairAccumulator(const MeasuresSection& section);

  /// Adds a step. `since_s` is the time since the previous step; 0 at the first step. The values of
  /// the previous step count for this time. A pair with NaN does not count.
  void Add(const CarPair& pair, double since_s);

  PairMetrics Result() const;

 private:
  /// Adds the results of the previous step, which apply for `duration_s`.
  void Pass(double duration_s);

  MeasuresSection section_;
  models::RssParameters rss_;
  std::optional<double> ttc_s_;  // TTC in the previous step; nullopt if that step had no pair
  double crash_probability_ = 0;
  bool met_ = false;

  // Extremes so far; infinite while there is no value.
  double min_ttc_s_;
  double min_time_gap_s_;
  double max_drac_mps2_;
  double min_picud_m_;
  double min_rss_margin_m_;
  double min_rss_margin_ad_rss_m_;
  // Integrals so far.
  double time_s_ = 0;
  double tet_s_ = 0;
  double tit_s2_ = 0;
  double crash_time_s_ = 0;
};

}  // namespace fogline::metrics
