#include "services/runtime/realtime/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace fogline::runtime {

// Returns the index of the cell that counts a duration. The duration is rounded down to m 2^e us,
// where m and e are whole numbers, and the index is 64 e + m. Below 128 us, e is 0 and m is the
// duration in us. From 128 us on, e is above 0 and m is in [64, 128).
std::size_t DurationHistogram::CellOf(std::int64_t us) {
  const auto value = static_cast<std::uint64_t>(us);
  const auto width = static_cast<int>(std::bit_width(value));
  const int exponent = std::max(0, width - kExactBits);
  return (static_cast<std::size_t>(exponent) << kCellBits) +
         static_cast<std::size_t>(value >> exponent);
}

std::int64_t DurationHistogram::LargestOf(std::size_t cell) {
  constexpr std::size_t kExact = std::size_t{1} << kExactBits;
  if (cell < kExact) return static_cast<std::int64_t>(cell);
  const std::size_t exponent = (cell >> kCellBits) - 1;
  const std::size_t mantissa = cell - (exponent << kCellBits);
  return static_cast<std::int64_t>(((mantissa + 1) << exponent) - 1);
}

void DurationHistogram::Add(Duration duration) {
  const std::int64_t us = std::clamp(std::chrono::ceil<std::chrono::microseconds>(duration).count(),
                                     std::int64_t{0}, kMaxUs);
  ++cells_[CellOf(us)];
  ++count_;
  max_us_ = std::max(max_us_, us);
}

std::int64_t DurationHistogram::QuantileUs(double q) const {
  if (count_ == 0) return 0;
  const auto wanted = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::ceil(q * static_cast<double>(count_))));
  std::int64_t seen = 0;
  for (std::size_t cell = 0; cell < kNumCells; ++cell) {
    seen += cells_[cell];
    if (seen >= wanted) return std::min(LargestOf(cell), max_us_);
  }
  return max_us_;
}

}  // namespace fogline::runtime
