// Computes how much the tracks of two runs differ, step by step.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "services/log/run_log.h"

namespace fogline::replay {

/// The differences of one number of track_t::state, over the steps in which both tracks are valid.
struct StateDifference {
  std::string_view name;   // such as "distance_m"
  double largest = 0;      // largest absolute difference
  std::int64_t step = -1;  // step of the largest difference; -1: no step was compared
  double rms = 0;
};

struct TrackDifference {
  std::array<StateDifference, 3> states{{{"distance_m"}, {"speed_mps"}, {"acceleration_mps2"}}};
  std::int64_t compared = 0;      // steps in which both tracks are valid
  std::int64_t valid_in_one = 0;  // steps in which only one track is valid
  std::int64_t not_in_both = 0;   // steps for which only one of the logs has a TRACK
};

/// Compares the TRACK of two logs. @throws InputError if a log cannot be read
TrackDifference CompareTracks(const std::filesystem::path& a, const log::ReadOptions& options_of_a,
                              const std::filesystem::path& b);

}  // namespace fogline::replay
