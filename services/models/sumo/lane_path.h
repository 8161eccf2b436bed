// The lanes along which the cars of Fogline drive in SUMO's network, one after another, as one
// axis.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fogline::sumo {

/// A lane, and a place on it.
struct LanePlace {
  std::string lane;
  double position_m = 0;
};

/// The lanes of a route that lead to a given lane, and from this lane onward, without a change of
/// lane. The path includes the lanes inside of junctions.
class LanePath {
 public:
  struct Lane {
    std::string id;
    double begin_m;  // along the path
    double length_m;
  };

  /// @param route edges; the edge of `lane` is one of them
  /// @pre SUMO has the network
  LanePath(const std::vector<std::string>& route, const std::string& lane);

  const std::vector<Lane>& lanes() const { return lanes_; }
  double length_m() const { return lanes_.back().begin_m + lanes_.back().length_m; }
  /// The place at this distance from the beginning. @pre 0 <= along_m <= length_m()
  LanePlace At(double along_m) const;

 private:
  std::vector<Lane> lanes_;
};

}  // namespace fogline::sumo
