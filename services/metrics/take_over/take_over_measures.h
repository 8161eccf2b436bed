// Measures of each request to take over: how fast the driver answered, and how the car moved in the
// judged interval.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace fogline::metrics {

/// How a request to take over ended.
enum class TakeOverEnd : std::uint8_t {
  kOpen,           // the run ended before the request ended
  kTakenOver,      // the driver got a share of the authority before any manoeuvre
  kTakenOverLate,  // the driver ended a minimal risk manoeuvre
  kMinimalRisk,    // a minimal risk manoeuvre, and the driver did not take over
  kWithdrawn,      // the automation drives again, and the driver had no share of the authority
  kFallback,       // the driver drives without an answer, because inputs have failed
  kUnknown,        // the log lacks the end of the run, and with it the end of the request
};

/// Name of an outcome for JSON and CSV, such as "taken_over".
std::string_view NameOf(TakeOverEnd end);

/// Measures of one request. Times begin with the step of the request, unless a comment names
/// another beginning. A field is empty if its event has not happened, or if no step is relevant for
/// the measure.
///
/// The *judged interval* begins with the step of the request. It ends with the first step in which
/// the driver counts as recovered, the automation drives again, or the car stands after a minimal
/// risk manoeuvre. If no such step comes, the interval ends with the run. If the log ends before
/// the end of the run, and the interval has not ended yet, all measures of the interval are empty.
struct TakeOverMeasures {
  TakeOverEnd outcome = TakeOverEnd::kOpen;
  /// Time of the request since the start of the run, s.
  double requested_s = 0;
  /// Length of the judged interval, s.
  std::optional<double> judged_s = 0;

  /// The next two times, in s, exist only if a person drives (input_times.h). Both begin with the
  /// request. first_movement_time_s ends with the first DRIVER_INPUT in which the person has moved
  /// a pedal since the request, or has pressed the button for taking over. pedal_on_time_s ends
  /// with the first DRIVER_INPUT in which a pedal has reached the threshold for taking over.
  std::optional<double> first_movement_time_s;
  std::optional<double> pedal_on_time_s;
  /// Time from the request to the acknowledgement, s. The acknowledgement is the driver's first
  /// answer that the arbitrator has received.
  std::optional<double> reaction_time_s;
  /// Time from the request to the transfer, s. In the transfer the driver gets the main authority
  /// (HumanDrives).
  std::optional<double> take_over_time_s;
  /// Time from the request to the driver's first effective input (take_over_request.h), s.
  std::optional<double> effective_input_time_s;
  /// Time from the request to the beginning of a minimal risk manoeuvre, s.
  std::optional<double> manoeuvre_time_s;

  /// Speed of the host in the step of the request, m/s.
  double speed_at_request_mps = 0;
  /// Speed of the host in the first step of a fog, m/s. If there is fog at the request, this fog
  /// counts. Otherwise the first fog that begins in the judged interval counts. Empty if the log
  /// begins in this fog.
  std::optional<double> speed_at_fog_mps;
  /// Largest applied deceleration of the host in the judged interval, m/s2; 0 if it never slows
  /// down.
  std::optional<double> max_deceleration_mps2;
  /// Mean of the applied deceleration over the steps of the judged interval in which the host slows
  /// down, m/s2.
  std::optional<double> mean_deceleration_mps2;
  /// Largest |jerk| of the host in the judged interval, averaged over 1 s (AveragedJerk), m/s3. The
  /// averaged second may begin before the request. Empty if the log begins later than this second.
  std::optional<double> max_abs_jerk_1s_mps3;
  /// Smallest time to collision and smallest time gap of the host in the judged interval, s
  /// (PairMetrics).
  std::optional<double> min_ttc_s;
  std::optional<double> min_time_gap_s;

  /// Times in the judged interval in which automation, driver and manoeuvre drove the host, s.
  /// While authority is shared, the mode in HOST_COMMAND decides which side counts. A step without
  /// HOST_COMMAND counts like the step before it.
  std::optional<double> automation_drove_s = 0;
  std::optional<double> driver_drove_s = 0;
  std::optional<double> manoeuvre_drove_s = 0;
  /// Part of automation_drove_s in which the policy excluded a value of a sensor from the fusion,
  /// s. A step in which this sensor has no value does not count.
  std::optional<double> sensor_excluded_s = 0;

  friend bool operator==(const TakeOverMeasures&, const TakeOverMeasures&) = default;
};

/// Calls `visit(name, value, unit, description)` for each measure that is a number, in order;
/// `name` contains the unit, `value` is std::optional<double>. JSON, CSV and tables use these
/// calls.
template <class Visitor>
void VisitTakeOver(const TakeOverMeasures& m, Visitor&& visit) {
  const auto number = [&](std::string_view name, std::optional<double> value, std::string_view unit,
                          std::string_view description) { visit(name, value, unit, description); };
  number("requested_s", m.requested_s, "s", "request");
  number("first_movement_time_s", m.first_movement_time_s, "s", "first movement");
  number("pedal_on_time_s", m.pedal_on_time_s, "s", "pedal-on time");
  number("reaction_time_s", m.reaction_time_s, "s", "reaction time");
  number("take_over_time_s", m.take_over_time_s, "s", "take-over time");
  number("effective_input_time_s", m.effective_input_time_s, "s", "first effective input");
  number("manoeuvre_time_s", m.manoeuvre_time_s, "s", "minimal risk manoeuvre");
  number("judged_s", m.judged_s, "s", "judged interval");
  number("speed_at_request_mps", m.speed_at_request_mps, "m/s", "speed at the request");
  number("speed_at_fog_mps", m.speed_at_fog_mps, "m/s", "speed when the fog began");
  number("max_deceleration_mps2", m.max_deceleration_mps2, "m/s2", "largest deceleration");
  number("mean_deceleration_mps2", m.mean_deceleration_mps2, "m/s2", "mean deceleration");
  number("max_abs_jerk_1s_mps3", m.max_abs_jerk_1s_mps3, "m/s3", "largest jerk averaged over 1 s");
  number("min_ttc_s", m.min_ttc_s, "s", "smallest TTC");
  number("min_time_gap_s", m.min_time_gap_s, "s", "smallest time gap");
  number("automation_drove_s", m.automation_drove_s, "s", "driving time of the automation");
  number("sensor_excluded_s", m.sensor_excluded_s, "s", "of this with a sensor excluded");
  number("driver_drove_s", m.driver_drove_s, "s", "driving time of the driver");
  number("manoeuvre_drove_s", m.manoeuvre_drove_s, "s", "driving time of the manoeuvre");
}

}  // namespace fogline::metrics
