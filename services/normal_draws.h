// Random numbers with the standard normal distribution, two for each step. The numbers are kept for
// further runs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/random.h"

namespace fogline {

/// The numbers that Random::Normal2() gives for one draw index in each step. Runs with the same
/// seed have the same numbers. So the first run keeps the numbers, and later runs do not compute
/// them again. An object and its copies share the numbers that they keep. So only one thread may
/// use an object and its copies.
class NormalDraws {
 public:
  /// The numbers of at most this many steps are kept, in 64 KiB. The numbers of later steps are
  /// computed in each run. We chose this number, because most runs are shorter.
  static constexpr std::int64_t kMostKept = 4096;

  /// Only the constructor allocates memory. @param steps number of steps of a run
  NormalDraws(const Random& random, std::uint32_t index, std::int64_t steps)
      : random_(random), index_(index) {
    kept_->reserve(static_cast<std::size_t>(std::clamp<std::int64_t>(steps, 0, kMostKept)));
  }

  /// The two numbers of this step.
  std::array<double, 2> At(std::int64_t step) {
    const auto place = static_cast<std::size_t>(step);
    std::vector<std::array<double, 2>>& kept = *kept_;
    if (place >= kept.capacity()) return random_.Normal2(step, index_);
    while (kept.size() <= place) {  // more than one pass if earlier steps had no draw
      kept.push_back(random_.Normal2(static_cast<std::int64_t>(kept.size()), index_));
    }
    return kept[place];
  }

  /// Shares the numbers that `other` has kept. This happens only if both objects have the same
  /// numbers, and if `other` can keep the numbers of at least as many steps as this object.
  void Keep(const NormalDraws& other) {
    if (other.random_ == random_ && other.index_ == index_ &&
        other.kept_->capacity() >= kept_->capacity()) {
      kept_ = other.kept_;
    }
  }

 private:
  Random random_;
  std::uint32_t index_;
  std::shared_ptr<std::vector<std::array<double, 2>>> kept_ =
      std::make_shared<std::vector<std::array<double, 2>>>();  // the numbers of the first steps
};

}  // namespace fogline
