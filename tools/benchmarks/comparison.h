// A side-by-side measurement: two ways to do something, in one run, in alternating rounds, so that
// whatever else the machine does hits both. What counts is the ratio of each round.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fogline {

/// On which side of its goal a ratio has to be.
enum class Bound { kAtMost, kAtLeast };

/// What is compared, and what should come out. Both functions measure once and return the same
/// quantity; they may throw, which ends this comparison with a note and no other.
struct Comparison {
  std::string name;       // short, for --only
  std::string quantity;   // what both return, such as "time per step"
  std::string unit;       // of both, such as "us"
  std::string ours;       // what of Fogline is measured
  std::string reference;  // what it is compared with
  Bound bound = Bound::kAtMost;
  double goal = 1;
  std::optional<double> bar;  // what has to be reached on the way to the goal
  std::function<double()> measure_ours;
  std::function<double()> measure_reference;
};

/// Median and quartiles of some measurements.
struct Spread {
  double median = 0;
  double lower_quartile = 0;
  double upper_quartile = 0;
};

/// @pre `values` is not empty
Spread SpreadOf(std::vector<double> values);

/// What came out of a comparison.
struct Finding {
  Comparison comparison;
  Spread ours;
  Spread reference;
  Spread ratio;      // ours / reference, round by round
  std::string note;  // why there is no result; "" if there is one

  bool Meets(double limit) const;
  bool met() const { return note.empty() && Meets(comparison.goal); }
  /// "met", "bar 2 met", "missed" or "not measured".
  std::string Verdict() const;
};

/// Measures. Who goes first changes from round to round.
Finding Compare(const Comparison& comparison, int rounds);

}  // namespace fogline
