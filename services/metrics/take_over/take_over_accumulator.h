// Collects the measures of all requests to take over in a run, step by step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "fogline/track_t.hpp"
#include "fogline/truth_t.hpp"
#include "services/decision/take_over/take_over_log.h"
#include "services/metrics/averaged_jerk.h"
#include "services/metrics/running.h"
#include "services/metrics/surrogate.h"
#include "services/metrics/take_over/take_over_measures.h"

namespace fogline::metrics {

/// Collects the measures from the steps of a run, in order; steps may be missing. TakeOverLog gives
/// the times of a request, so `fogline events`, which also uses TakeOverLog, lists the same times.
/// The memory grows with the number of requests, and not with the length of the run.
class TakeOverAccumulator {
 public:
  /// Adds a step.
  /// @param command HOST_COMMAND of the step; nullptr if the message is missing. The state of a
  ///     request then does not change in this step.
  /// @param track TRACK of the step; nullptr if the message is missing. If the policy excluded a
  ///     sensor in the last TRACK, the sensor then still counts as excluded.
  /// @param human_mps2 a_H, the driver's offer; nullopt if it is not known
  void Add(const truth_t& truth, const arbitration_t* command, const track_t* track,
           std::optional<double> human_mps2);

  /// The measures of each request so far, in order of time.
  std::vector<TakeOverMeasures> Result() const;
  /// Empties the measures that are unknown if the last step of the run was not added. These are the
  /// measures of a judged interval that has not ended, and the outcome if it may still change.
  /// @param requests of Result()
  void CutOff(std::vector<TakeOverMeasures>& requests) const;
  /// Whether the log may lack the beginning of a request (TakeOverLog::BeganInRequest). Result()
  /// does not contain this request.
  bool BeganInRequest() const { return log_.BeganInRequest(); }

 private:
  /// Values of the judged interval, while it lasts.
  struct Judged {
    bool fog_unknown = false;   // the request is in a fog whose beginning the log lacks
    bool jerk_unknown = false;  // the log begins less than 1 s before a step of the interval
    Mean deceleration_mps2;
    // Only the TTC and the time gap of `pair` are used. These two measures do not depend on the
    // values of MeasuresSection.
    PairAccumulator pair{MeasuresSection{}};
    // The time in which each side drove, and the time of the last step.
    std::int64_t automation_us = 0;
    std::int64_t excluded_us = 0;
    std::int64_t driver_us = 0;
    std::int64_t manoeuvre_us = 0;
    std::int64_t last_us = 0;
  };

  /// @param first whether this is the first step
  void AddFog(const truth_t& truth, bool first);
  void AddMotion(const truth_t& truth, std::optional<double> jerk_mps3);
  void AddCommand(const truth_t& truth, const arbitration_t& command,
                  std::optional<double> human_mps2);
  void Begin(const truth_t& truth);
  /// Adds the time since the last step to the side that has driven since then.
  void AddDriving(std::int64_t utime);
  /// Adds the values of TRUTH. Called for the step of the request and for each later step of the
  /// judged interval.
  void Look(const truth_t& truth);
  void NoteTimes(std::int64_t utime);
  void NoteOutcome(std::int8_t mode);
  /// Ends the judged interval.
  void End();
  static void Finish(const Judged& judged, TakeOverMeasures& measures);

  take_over::TakeOverLog log_;
  AveragedJerk jerk_;
  std::optional<bool> late_;  // whether the log lacks the first steps; empty before the first step
  bool foggy_ = false;
  // Speed when the current fog began. Empty in clear air, and if the log lacks the first step of
  // this fog.
  std::optional<double> fog_speed_mps_;
  std::vector<TakeOverMeasures> requests_;
  std::int64_t requested_us_ = 0;  // time of the last request
  std::optional<Judged> judged_;   // values of the last request; empty after its judged interval
  bool excludes_ = false;          // the policy excluded a value of a sensor in the last TRACK
};

}  // namespace fogline::metrics
