// Runs that look like the experiment, for tests of the report: three cars at 20 m/s, 33 m apart,
// fog from 19 s to 30 s, thresholds of 0.2, 0.5 and 0.8, and a run without traded control. The runs
// are a rough sketch without simulation, because the report does not depend on the source of the
// samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/random.h"
#include "tools/report/report.h"

namespace fogline {

// The value of a sample that a run does not have.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The offset of the LiDAR's mounting.
inline constexpr double kExampleLidarBias_m = -0.93;

/// The settings that differ between example runs. Without a threshold there is no traded control.
struct ExampleSettings {
  std::optional<double> threshold = {};
  std::int64_t steps = 500;
};

/// A car that follows another car. `speed_mps` and `gap_m` are those of the current step.
struct ExampleCar {
  double speed_mps = 20.0;
  double gap_m = 33.0;
  double acceleration_mps2 = 0.0;

  double SafeDistance() const { return 1.5 * speed_mps + 3.0; }

  void Move(double command_mps2, double speed_ahead_mps, double step_s) {
    gap_m += (speed_ahead_mps - speed_mps) * step_s;
    speed_mps += command_mps2 * step_s;
    acceleration_mps2 = command_mps2;
  }
};

/// A simplified step of the experiment.
class ExampleRoad {
 public:
  explicit ExampleRoad(std::optional<double> threshold) : threshold_(threshold) {}

  metrics::Sample Step(std::int64_t step) {
    constexpr double kStep = 0.1;
    metrics::Sample sample = Observe(step, static_cast<double>(step) * kStep);
    Decide(sample);
    const double follower = 0.05 * (follower_.gap_m - follower_.SafeDistance()) +
                            0.45 * (host_.speed_mps - follower_.speed_mps);
    follower_.Move(follower, host_.speed_mps, kStep);
    host_.Move(sample.command_mps2, kLeadSpeed, kStep);
    return sample;
  }

 private:
  static constexpr double kLeadSpeed = 20.0;

  metrics::Sample Observe(std::int64_t step, double time_s) const {
    const double phase = (time_s - 19.0) / 11.0;
    const bool fog = phase >= 0 && phase < 1;
    const double level = fog ? std::sin(std::numbers::pi * phase) : 0.0;
    const double radar = host_.gap_m + 0.02 * radar_noise_.Normal2(step, 0)[0];
    const double lidar =
        host_.gap_m + kExampleLidarBias_m - 0.34 * level + 0.01 * lidar_noise_.Normal2(step, 0)[0];
    return {.step = step,
            .time_s = time_s,
            .preceding_speed_mps = kLeadSpeed,
            .host_speed_mps = host_.speed_mps,
            .host_acceleration_mps2 = host_.acceleration_mps2,
            .host_gap_m = host_.gap_m,
            .host_safe_distance_m = host_.SafeDistance(),
            .radar_range_m = radar,
            .lidar_range_m = step % 97 == 96 ? std::numeric_limits<double>::quiet_NaN() : lidar,
            .fused_distance_m = 0.2 * radar + 0.8 * lidar + 0.75,
            .follower_speed_mps = follower_.speed_mps,
            .follower_acceleration_mps2 = follower_.acceleration_mps2,
            .follower_gap_m = follower_.gap_m,
            .follower_safe_distance_m = follower_.SafeDistance(),
            .fog_present = fog,
            .fog_level = level,
            .fog_visibility_m = fog ? 60.0 : 20000.0};
  }

  void Decide(metrics::Sample& sample) {
    constexpr std::size_t kWindow = 8;
    if (std::isfinite(sample.lidar_range_m)) {
      differences_.push_back(sample.radar_range_m - sample.lidar_range_m);
    }
    if (differences_.size() > kWindow) differences_.pop_front();
    sample.conflict_m = std::accumulate(differences_.begin(), differences_.end(), 0.0) /
                        static_cast<double>(differences_.size());
    sample.doc = 1.0 / (1.0 + std::exp(-10.0 * (sample.conflict_m - 1.0)));
    sample.threshold = threshold_.value_or(1.0);
    sample.lambda_human = threshold_ && sample.doc >= *threshold_ ? 1.0 : 0.0;
    sample.acc_acceleration_mps2 =
        std::clamp(0.3 * (sample.fused_distance_m - sample.host_safe_distance_m) +
                       0.8 * (kLeadSpeed - sample.host_speed_mps),
                   -3.0, 2.0);
    sample.driver_acceleration_mps2 =
        0.02 * (host_.gap_m - 33.0) + 0.9 * (kLeadSpeed - host_.speed_mps);
    sample.command_mps2 =
        sample.lambda_human > 0 ? sample.driver_acceleration_mps2 : sample.acc_acceleration_mps2;
  }

  std::optional<double> threshold_ = {};
  ExampleCar host_;
  ExampleCar follower_;
  std::deque<double> differences_;
  Random radar_noise_{7, Stream::kRadar};
  Random lidar_noise_{7, Stream::kLidar};
};

inline report::ReportRun ExampleRun(const ExampleSettings& settings) {
  report::ReportRun run;
  run.name = settings.threshold ? fmt::format("threshold {}", *settings.threshold)
                                : "without traded control";
  run.scenario_title = "Traded control in fog";
  run.scenario_json = fmt::format(
      "{{\n  \"version\": 1,\n  \"title\": \"Traded control in fog\",\n  \"seed\": 7,\n"
      "  \"steps\": {},\n  \"fog\": {{\n    \"start_s\": 19.0,\n    \"duration_s\": 11.0\n  }},\n"
      "  \"arbitrator\": {{\n    \"policy\": \"{}\",\n    \"threshold\": {}\n  }}\n}}\n",
      settings.steps, settings.threshold ? "traded" : "none", settings.threshold.value_or(0.5));
  run.seed = 7;
  run.scenario.title = run.scenario_title;
  run.scenario.seed = run.seed;
  run.scenario.steps = settings.steps;
  run.scenario.lidar.bias_m = kExampleLidarBias_m;
  run.scenario.arbitrator.policy = settings.threshold ? Policy::kTraded : Policy::kNone;
  run.scenario.arbitrator.threshold = settings.threshold.value_or(0.5);
  run.digest = fmt::format("{:064x}", std::hash<std::string>{}(run.name));
  ExampleRoad road(settings.threshold);
  for (std::int64_t step = 0; step < settings.steps; ++step) run.samples.push_back(road.Step(step));
  run.samples.back().last = true;
  const auto& samples = run.samples;
  const auto least_gap = std::min_element(samples.begin(), samples.end(), [](auto& a, auto& b) {
    return a.follower_gap_m < b.follower_gap_m;
  });
  run.measures = {
      {"least follower gap", least_gap->follower_gap_m, "m", "smallest gap behind the host"},
      {"time of least follower gap", least_gap->time_s, "s", "when that was"},
      {"hand-overs", settings.threshold ? 2.0 : 0.0, "", "changes of who drives"},
      {"minimum time to collision", std::numeric_limits<double>::quiet_NaN(), "s",
       "of host and preceding car; none if they never close in"},
  };
  return run;
}

/// A run without traded control, and runs with thresholds of 0.2, 0.5 and 0.8.
inline std::vector<report::ReportRun> ExampleRuns(std::int64_t steps = 500) {
  std::vector<report::ReportRun> runs{ExampleRun({.steps = steps})};
  for (const double threshold : {0.2, 0.5, 0.8}) {
    runs.push_back(ExampleRun({.threshold = threshold, .steps = steps}));
  }
  runs[1].si_pct = 100.0;
  runs[2].si_pct = 80.8125;
  runs[3].si_pct = 10.25;
  return runs;
}

inline report::ReportTable ExampleTable() {
  return {.rows = {{.threshold = 0.2,
                    .si_pct = 100.0,
                    .rhe_pct = 100.0,
                    .si_std_pct = 0.0,
                    .rhe_std_pct = 0.0,
                    .published_si_pct = 100.0,
                    .published_rhe_pct = 100.0},
                   {.threshold = 0.5,
                    .si_pct = 80.8125,
                    .rhe_pct = 0.0,
                    .si_std_pct = 4.5,
                    .rhe_std_pct = 0.0,
                    .published_si_pct = 80.79,
                    .published_rhe_pct = 0.0},
                   {.threshold = 0.65, .si_pct = 41.375, .rhe_pct = 0.0},
                   {.threshold = 0.8,
                    .si_pct = -10.25,
                    .rhe_pct = 0.0,
                    .si_std_pct = 9.75,
                    .rhe_std_pct = 0.0,
                    .published_si_pct = 10.23,
                    .published_rhe_pct = 0.0}},
          .note = "Mean and standard deviation over seeds 1 to 200."};
}

}  // namespace fogline
