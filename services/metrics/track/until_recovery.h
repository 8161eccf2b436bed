// Sums over the steps from the first one in fog until the track has recovered.
#pragma once

namespace fogline::metrics {

/// The fog does harm after its end, too. A deceived filter needs time to settle, and the automation
/// drives on this filter. This class keeps sums over the steps from the first one in fog to the
/// last one that is in fog or has a wrong track (TrackJudge). After that step the fused distance
/// stays right. If it is not right at the end of the run, the sums have all steps up to the end.
///
/// Only later steps show which step was the last one. So the class has two sums, one over all steps
/// so far, and one over the steps that surely count.
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

  /// The sums. They are as constructed if the run has no fog.
  const Sums& sums() const { return sums_; }

 private:
  bool begun_ = false;
  Sums so_far_{};
  Sums sums_{};
};

}  // namespace fogline::metrics
