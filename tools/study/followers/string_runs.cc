#include "tools/study/followers/string_runs.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "services/closed_loop/closed_loop.h"
#include "services/metrics/follower_metrics.h"
#include "tools/stats/in_order.h"
#include "tools/stats/statistics.h"
#include "tools/study/sensor_noise.h"

namespace fogline::study {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The measurement starts this long before the fog, so that it includes the whole effect of the fog.
constexpr double kBefore_s = 1;

// Smaller decelerations do not count as braking, because noise causes them in clear air.
constexpr double kLeastBraking_mps2 = 0.01;

// Overrides that start the fog later. So the cars behind the host reach steady gaps before the fog,
// even with long time gaps. The fog lasts as long as in the file.
const std::vector<std::string> kLater{"/fog/start_s=60", "/steps=1200"};

/// Result of one run.
struct StringRun {
  std::array<double, kStringCars + 1> max_deceleration_mps2{};
  std::vector<metrics::FollowerMetrics> followers;
  bool collided = false;
};

StringRun RunString(closed_loop::ReusedLoop& loop, const Scenario& scenario, std::int64_t seed) {
  StringRun run;
  metrics::FollowerAccumulator followers;
  loop.Run(scenario, seed, [&](const closed_loop::StepView& step) {
    const truth_t& truth = step.truth;
    run.collided = truth.collision != truth_t::COLLISION_NONE;
    const double time_s = static_cast<double>(truth.header.utime) * 1e-6;
    if (time_s < scenario.fog.start_s - kBefore_s) return;
    followers.Add(truth, step.follower);
    const auto brakes = [&](std::size_t place, double acceleration_mps2) {
      double& most = run.max_deceleration_mps2[place];
      most = std::max(most, -acceleration_mps2);
    };
    brakes(0, truth.host_acceleration_mps2);
    const auto cars = std::min(kStringCars, truth.follower_acceleration_mps2.size());
    for (std::size_t i = 0; i < cars; ++i) brakes(i + 1, truth.follower_acceleration_mps2[i]);
  });
  run.followers = followers.Result();
  return run;
}

void AddToString(const StringRun& run, StringOutcome& outcome) {
  outcome.collisions += run.collided ? 1 : 0;
  for (std::size_t place = 0; place <= kStringCars; ++place) {
    CarInString& car = outcome.cars[place];
    const double own_mps2 = run.max_deceleration_mps2[place];
    car.max_deceleration_mps2.push_back(own_mps2);
    if (place == 0) continue;
    const double ahead_mps2 = run.max_deceleration_mps2[place - 1];
    car.amplification.push_back(ahead_mps2 < kLeastBraking_mps2 ? stats::kMissing
                                                                : own_mps2 / ahead_mps2);
    const bool there = place <= run.followers.size();
    const metrics::FollowerMetrics measures =
        there ? run.followers[place - 1] : metrics::FollowerMetrics{};
    car.min_ttc_s.push_back(measures.min_ttc_s.value_or(there ? kInfinite : stats::kMissing));
    car.min_gap_m.push_back(measures.min_gap_m.value_or(stats::kMissing));
  }
}

}  // namespace

const std::vector<StudyVariant>& HostVariants() {
  static const std::vector<StudyVariant> kVariants{{"none", {"/arbitrator/policy=none"}},
                                                   {"traded", {"/arbitrator/policy=traded"}}};
  return kVariants;
}

std::vector<StudyCase> StringKinds() {
  std::vector<StudyCase> kinds;
  const auto add = [&](std::string_view name, std::vector<std::string> overrides) {
    overrides.insert(overrides.end(), kLater.begin(), kLater.end());
    kinds.push_back(
        {.name = std::string(name), .file = "dense_fog.json", .overrides = std::move(overrides)});
  };
  add("acc", {});
  for (const std::string_view style : {"aggressive", "normal", "cautious"}) {
    add(fmt::format("{} humans", style),
        {"/followers/driver=human", fmt::format("/followers/style={}", style)});
  }
  add("drawn", {"/followers/driver=drawn", "/followers/style=drawn"});
  for (const std::string_view name : {"acc", "normal humans"}) {
    kinds.push_back(WithRealisticNoise(*std::ranges::find(kinds, name, &StudyCase::name)));
  }
  return kinds;
}

std::vector<StringOutcome> RunStrings(const StudyContext& context, std::span<const StudyCase> kinds,
                                      std::span<const StudyVariant> variants) {
  std::vector<StringOutcome> outcomes;
  std::vector<Scenario> scenarios;
  for (const StudyCase& kind : kinds) {
    for (const StudyVariant& variant : variants) {
      std::vector<std::string> overrides = variant.overrides;
      overrides.push_back("/followers/count=" + std::to_string(kStringCars));
      scenarios.push_back(context.Load(kind.file, kind.overrides, overrides));
      outcomes.push_back({.kind = kind.name,
                          .variant = variant.name,
                          .cars = std::vector<CarInString>(kStringCars + 1)});
    }
  }
  const std::int64_t seeds = context.seeds.count();
  const std::int64_t units = static_cast<std::int64_t>(scenarios.size()) * seeds;
  stats::ComputeInOrder(
      0, units, context.jobs, [] { return closed_loop::ReusedLoop(); },
      [&](closed_loop::ReusedLoop& loop, std::int64_t unit) {
        return RunString(loop, scenarios[static_cast<std::size_t>(unit / seeds)],
                         context.seeds.first + unit % seeds);
      },
      [&](std::int64_t unit, const StringRun& run) {
        AddToString(run, outcomes[static_cast<std::size_t>(unit / seeds)]);
        context.Show(unit + 1, units);
        return true;
      });
  return outcomes;
}

std::string StringSays(std::string_view kind) {
  return fmt::format("The last car of a string brakes less hard: {}.", kind);
}

std::vector<Claim> ClaimsOnStrings(std::span<const StringOutcome> strings) {
  std::vector<Claim> claims;
  for (const StringOutcome& traded : strings) {
    if (traded.variant != "traded") continue;
    const auto none = std::ranges::find_if(strings, [&](const StringOutcome& other) {
      return other.kind == traded.kind && other.variant == "none";
    });
    claims.push_back({.says = StringSays(traded.kind),
                      .compared = fmt::format("string of {}: traded against none, largest "
                                              "deceleration of follower {} (m/s2)",
                                              traded.kind, kStringCars),
                      .sign = Sign::kLess,
                      .difference = PairedDifference(traded.cars[kStringCars].max_deceleration_mps2,
                                                     none->cars[kStringCars].max_deceleration_mps2),
                      .margin = 0,
                      .p = {},
                      .hindrance = traded.collisions + none->collisions > 0
                                       ? "not comparable: runs end early"
                                       : ""});
  }
  return claims;
}

}  // namespace fogline::study
