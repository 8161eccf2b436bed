// Strings of cars behind the host: how a disturbance goes from car to car.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"
#include "tools/study/study.h"

namespace fogline {

/// Cars behind the host.
inline constexpr std::size_t kStringCars = 5;

/// What happens to one car from a second before the fog on, seed by seed. Place 0 is the host, of
/// which there is the deceleration alone.
struct CarInString {
  std::vector<double> max_deceleration_mps2;
  /// The same over that of the car ahead: above 1 a disturbance grows. NaN behind a car that did
  /// not brake.
  std::vector<double> amplification;
  std::vector<double> min_ttc_s;  // infinite where it never closed in on the car ahead
  std::vector<double> min_gap_m;
};

/// A kind of driver in all cars, and a variant of the host.
struct StringOutcome {
  std::string kind;
  std::string variant;
  std::vector<CarInString> cars;  // by place: the host, then the followers
  std::int64_t collisions = 0;    // runs that end with one
};

/// All kinds with all variants, by kind. The scenarios of `kinds` begin their fog late enough for
/// a string to have settled. @throws InputError, StudyStopped
std::vector<StringOutcome> RunStrings(const StudyContext& context, std::span<const StudyCase> kinds,
                                      std::span<const StudyVariant> variants);

}  // namespace fogline
