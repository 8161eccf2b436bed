// Quantiles of durations. The memory does not grow with the number of durations.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "common/clock.h"

namespace fogline::runtime {

/// Counts durations in cells whose width grows with the duration, as in G. Tene's HdrHistogram.
/// Below 128 us each microsecond has its own cell. Above 128 us each range from a power of two to
/// the next is divided into 64 cells. A quantile is therefore too large by at most 1/64 (1.6 %) and
/// never too small. Maximum and count are exact. The histogram takes 14 kB, allocates nothing, and
/// adds a duration in constant time.
///
/// The P2 estimator of Boost.Accumulators is not used, because its error for high quantiles has no
/// bound. HdrHistogram in C is not used, because Debian has no package of it.
class DurationHistogram {
 public:
  /// Counts a duration, in whole microseconds, rounded up. A negative duration counts as 0. A
  /// duration above kMaxUs counts as kMaxUs.
  void Add(Duration duration);

  /// The `q` quantile of the durations, in microseconds; 0 if there are no durations. @pre 0 <= q
  /// <= 1
  std::int64_t QuantileUs(double q) const;
  std::int64_t MaxUs() const { return max_us_; }
  std::int64_t count() const { return count_; }

  static constexpr std::int64_t kMaxUs = (std::int64_t{1} << 32) - 1;  // 71 minutes

 private:
  static constexpr int kCellBits = 6;  // 2^6 = 64 cells for each power of two
  static constexpr int kExactBits = kCellBits + 1;
  static constexpr std::size_t kNumCells = (32 - kExactBits + 2) << kCellBits;

  static std::size_t CellOf(std::int64_t us);
  static std::int64_t LargestOf(std::size_t cell);

  std::array<std::int64_t, kNumCells> cells_{};
  std::int64_t count_ = 0;
  std::int64_t max_us_ = 0;
};

}  // namespace fogline::runtime
