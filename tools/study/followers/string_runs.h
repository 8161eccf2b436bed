// Runs strings of cars behind the host, to follow a disturbance from car to car.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Number of cars behind the host.
inline constexpr std::size_t kStringCars = 5;

/// Values of one car from one second before the fog, seed by seed. Place 0 is the host, which has
/// only a deceleration.
struct CarInString {
  std::vector<double> max_deceleration_mps2;
  /// Ratio of its deceleration to that of the car ahead: above 1 a disturbance grows. NaN behind a
  /// car that did not brake.
  std::vector<double> amplification;
  std::vector<double> min_ttc_s;  // infinite if it never closed in on the car ahead
  std::vector<double> min_gap_m;
};

/// One kind of driver in all cars, and one variant of the host.
struct StringOutcome {
  std::string kind;
  std::string variant;
  std::vector<CarInString> cars;  // by place: the host, then the followers
  std::int64_t collisions = 0;    // runs that end with a collision
};

/// All kinds with all variants, ordered by kind. In the scenarios of `kinds` the fog must begin
/// after the string has settled. @throws InputError, StudyStopped
std::vector<StringOutcome> RunStrings(const StudyContext& context, std::span<const StudyCase> kinds,
                                      std::span<const StudyVariant> variants);

}  // namespace fogline::study
