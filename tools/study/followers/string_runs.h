// Runs strings of cars behind the host, to measure how a disturbance travels from car to car.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/claim.h"
#include "tools/study/comparison.h"
#include "tools/study/study.h"

namespace fogline::study {

/// Number of cars behind the host.
inline constexpr std::size_t kStringCars = 5;

/// Values of one car, seed by seed. The measurement begins one second before the fog. The host is
/// the car at place 0. Of the host, only max_deceleration_mps2 has values.
struct CarInString {
  std::vector<double> max_deceleration_mps2;
  /// Ratio of the car's largest deceleration to the largest deceleration of the car ahead. A
  /// disturbance grows if the ratio is above 1. NaN if the car ahead did not brake.
  std::vector<double> amplification;
  std::vector<double> min_ttc_s;  // infinite if the car was never faster than the car ahead
  std::vector<double> min_gap_m;
};

/// Results for one kind of driver in all cars, and one variant of the host.
struct StringOutcome {
  std::string kind;
  std::string variant;
  std::vector<CarInString> cars;  // by place: the host, then the followers
  std::int64_t collisions = 0;    // runs that end with a collision
};

/// The host without and with traded control.
const std::vector<StudyVariant>& HostVariants();
/// The kinds of strings. A string is a row of cars behind the host. All drivers of a string are of
/// one kind, or each driver is drawn at random. Two kinds exist a second time, with realistic
/// noise: `acc` and `normal humans`.
std::vector<StudyCase> StringKinds();

/// Runs each kind of string with each variant of the host. The result is ordered by kind. The
/// measurement begins one second before the fog. So in the scenarios of `kinds`, the fog must begin
/// after the cars have reached steady gaps. @throws InputError, StudyStopped
std::vector<StringOutcome> RunStrings(const StudyContext& context, std::span<const StudyCase> kinds,
                                      std::span<const StudyVariant> variants);

/// The sentence of the claim that ClaimsOnStrings() makes about this kind of string (row of cars).
std::string StringSays(std::string_view kind);
/// For each kind of string (row of cars behind the host), the claim that the last car brakes less
/// hard behind a host with traded control than behind a host without it.
/// @pre `strings` has both HostVariants() of each kind
std::vector<Claim> ClaimsOnStrings(std::span<const StringOutcome> strings);

}  // namespace fogline::study
