// Sums over the steps from the first one in fog until the track has recovered.
#pragma once

namespace fogline::metrics {

/// The fog harms beyond its end: a filter that was deceived needs time to settle, and the
/// automation drives on it meanwhile. This class keeps sums over the steps from the first one in
/// fog to the last one that is in fog or has a wrong track (TrackJudge). After that step the fused
/// distance is right for good. If it is not right at the end of the run, the sums have all steps up
/// to the end.
///
/// That a step was the last one is known only later, so the class has the sums twice: over all
/// steps so far, and over those that surely count.
template <class Sums>
class UntilRecovery {
 public:
  /// Next step. `add(Sums&)` adds its values.
  template <class Add>
  void Step(bool fog, bool wrong_track, Add&& add) {
    begun_ = begun_ || fog;
    if (!begun_) return;
    add(so_far_);
    if (fog || wrong_track) sums_ = so_far_;
  }

  /// As constructed if the run has no fog.
  const Sums& sums() const { return sums_; }

 private:
  bool begun_ = false;
  Sums so_far_{};
  Sums sums_{};
};

}  // namespace fogline::metrics
