// Normal random numbers of one draw in each step, which are kept for further runs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/random.h"

namespace fogline {

/// The numbers of Random::Normal2() of one draw, for one step after another. Runs with the same
/// seed have the same numbers, so a run after another run does not compute them again. Copies of an
/// object keep their numbers in one place. Only one thread may use an object and its copies.
class NormalDraws {
 public:
  /// Numbers of so many steps are kept (64 KiB); later ones are computed in each run. The value is
  /// our choice; most runs are shorter.
  static constexpr std::int64_t kMostKept = 4096;

  /// Only the constructor allocates memory. @param steps of a run
  NormalDraws(const Random& random, std::uint32_t index, std::int64_t steps)
      : random_(random), index_(index) {
    kept_->reserve(static_cast<std::size_t>(std::clamp<std::int64_t>(steps, 0, kMostKept)));
  }

  /// The two numbers of this step.
  std::array<double, 2> At(std::int64_t step) {
    const auto place = static_cast<std::size_t>(step);
    std::vector<std::array<double, 2>>& kept = *kept_;
    if (place >= kept.capacity()) return random_.Normal2(step, index_);
    while (kept.size() <= place) {  // more than one if there are steps without a draw
      kept.push_back(random_.Normal2(static_cast<std::int64_t>(kept.size()), index_));
    }
    return kept[place];
  }

  /// Takes over the numbers that another object has kept, if they are the same numbers.
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
      std::make_shared<std::vector<std::array<double, 2>>>();  // those of the first steps
};

}  // namespace fogline
