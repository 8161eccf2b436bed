// Jerk averaged over 1 s, as in ISO 15622.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace fogline::metrics {

/// Computes the jerk of a car as an average over 1 s, because ISO 15622 limits this average for an
/// ACC. The magnitude of the average at time t is the change of the acceleration over the last
/// second:
///
///     |a(t) - a(t - 1 s)| / 1 s
///
/// For a change within one step, such as a hand-over, this value does not depend on the length of
/// the step. (The change divided by the length of the step would be larger for a shorter step.)
class AveragedJerk {
 public:
  /// Adds a sample. The times of the samples ascend.
  /// @param acceleration_mps2 the acceleration that was applied between the time of the previous
  ///     sample and `time_s`
  /// @return |jerk| in m/s3, averaged over the second that ends now; nullopt before the
  ///     accelerations of a whole second are known
  std::optional<double> Add(double time_s, double acceleration_mps2);

 private:
  struct Point {
    double time_s;
    double acceleration_mps2;
  };
  /// Size of the ring buffer, which keeps only the points of the last second. A second has at most
  /// 1000 steps, because a step lasts at least 0.001 s (Scenario::step_s).
  static constexpr std::size_t kMostPoints = 1002;

  const Point& Oldest() const { return points_[begin_]; }
  void DropOldest();

  std::array<Point, kMostPoints> points_;
  std::size_t begin_ = 0;
  std::size_t count_ = 0;
  bool dropped_ = false;  // whether older points have been dropped
};

}  // namespace fogline::metrics
