// Sums over the steps from the first step in fog until the track has recovered.
#pragma once

namespace fogline::metrics {

/// The fog also has an effect after its end. A deceived filter needs time to settle, and in this
/// time the automation uses a wrong track. This class computes sums from the first step in fog to
/// the last step that is in fog or has a wrong track (TrackJudge). After this last step, the fused
/// distance stays right. If the fused distance is wrong at the end of the run, the sums contain all
/// steps up to the end.
///
/// A step without fog and with a right track counts only if a later step counts. So the class has
/// two sums: one over all steps so far, and one over the steps that certainly count.
template <class Sums>
class UntilRecovery {
 public:
  /// Adds the next step. `add(Sums&)` adds the values of this step to the sums.
  template <class Add>
  void Step(bool fog, bool wrong_track, Add&& add) {
    begun_ = begun_ || fog;
    if (!begun_) return;
    add(so_far_);
    if (fog || wrong_track) sums_ = so_far_;
  }

  /// The sums. If the run has no fog, the sums have their initial values.
  const Sums& sums() const { return sums_; }

 private:
  bool begun_ = false;
  Sums so_far_{};
  Sums sums_{};
};

}  // namespace fogline::metrics
