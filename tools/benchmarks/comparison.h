// Measures two ways to do the same work, in one run and in alternating rounds. So a disturbance of
// the machine affects both ways. Each round gives the ratio of the two results.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fogline::benchmarks {

/// Whether a ratio must be at most or at least its goal.
enum class Bound { kAtMost, kAtLeast };

/// The two sides of a comparison, and the expected result. Both functions measure once and return
/// the same quantity. An exception from a function ends only this comparison. The text of the
/// exception becomes the note of the finding.
struct Comparison {
  std::string name;       // short, for --only
  std::string quantity;   // returned by both functions, such as "time per step"
  std::string unit;       // of the quantity, such as "us"
  std::string ours;       // Fogline's side
  std::string reference;  // the side that Fogline is compared with
  Bound bound = Bound::kAtMost;
  double goal = 1;
  std::optional<double> bar;  // an intermediate goal
  std::function<double()> measure_ours;
  std::function<double()> measure_reference;
};

/// Median and quartiles of measurements.
struct Spread {
  double median = 0;
  double lower_quartile = 0;
  double upper_quartile = 0;
};

/// @pre `values` is not empty
Spread SpreadOf(std::vector<double> values);

/// Result of a comparison.
struct Finding {
  Comparison comparison;
  Spread ours;
  Spread reference;
  Spread ratio;      // ours / reference of each round
  std::string note;  // reason for a missing result; "" if there is a result

  bool Meets(double limit) const;
  bool met() const { return note.empty() && Meets(comparison.goal); }
  /// "met", "missed", "not measured", or a text such as "bar 2 met". This text means that only the
  /// intermediate goal `bar` is met, and that its value is 2.
  std::string Verdict() const;
};

/// Measures both sides in each round. The side that is measured first changes from round to round.
Finding Compare(const Comparison& comparison, int rounds);

}  // namespace fogline::benchmarks
