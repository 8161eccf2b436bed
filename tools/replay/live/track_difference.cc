#include "tools/replay/live/track_difference.h"

#include <cmath>
#include <optional>

#include "services/runtime/wire/wire.h"

namespace fogline::replay {
namespace {

/// The tracks of a log, one step after another.
class Tracks {
 public:
  Tracks(const std::filesystem::path& log, const log::ReadOptions& options)
      : reader_(log, options) {
    Next();
  }

  bool over() const { return over_; }
  std::int64_t step() const { return reader_.step(); }
  /// The track of the step; nullptr if the log lacks it.
  const track_t* track() const { return has_ ? &track_ : nullptr; }

  void Next() {
    const log::StepMessages* messages = reader_.Next();
    over_ = messages == nullptr;
    has_ = !over_ && runtime::Decode((*messages)[IndexOf<track_t>()], track_);
  }

 private:
  log::RunLogReader reader_;
  track_t track_{};
  bool over_ = false;
  bool has_ = false;
};

void AddStep(const track_t& a, const track_t& b, TrackDifference& difference) {
  if (!a.valid || !b.valid) {
    difference.valid_in_one += a.valid != b.valid ? 1 : 0;
    return;
  }
  ++difference.compared;
  for (std::size_t i = 0; i < difference.states.size(); ++i) {
    StateDifference& state = difference.states[i];
    const double error = std::abs(a.state[i] - b.state[i]);
    state.rms += error * error;
    if (state.step >= 0 && error <= state.largest) continue;
    state.largest = error;
    state.step = a.header.step;
  }
}

}  // namespace

TrackDifference CompareTracks(const std::filesystem::path& a, const log::ReadOptions& options_of_a,
                              const std::filesystem::path& b) {
  TrackDifference difference;
  Tracks one(a, options_of_a);
  Tracks other(b, {.gaps = true});
  while (!one.over() || !other.over()) {
    const bool take_one = other.over() || (!one.over() && one.step() <= other.step());
    const bool take_other = one.over() || (!other.over() && other.step() <= one.step());
    const track_t* track = take_one ? one.track() : nullptr;
    const track_t* other_track = take_other ? other.track() : nullptr;
    if (track != nullptr && other_track != nullptr) {
      AddStep(*track, *other_track, difference);
    } else if (track != nullptr || other_track != nullptr) {
      ++difference.not_in_both;
    }
    if (take_one) one.Next();
    if (take_other) other.Next();
  }
  for (StateDifference& state : difference.states) {
    if (difference.compared > 0) {
      state.rms = std::sqrt(state.rms / static_cast<double>(difference.compared));
    }
  }
  return difference;
}

}  // namespace fogline::replay
