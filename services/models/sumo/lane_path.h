// The lanes of SUMO's network along which the cars of Fogline drive. The lanes follow each other
// and form one axis.
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

/// A path along a route. A car on this path never changes to a lane beside its own lane. The path
/// contains one given lane. It begins with the lanes that lead to this lane, and ends with the
/// lanes that follow this lane. The lanes inside of junctions belong to the path.
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
  /// The place at this distance from the beginning of the path. @pre 0 <= along_m <= length_m()
  LanePlace At(double along_m) const;

 private:
  std::vector<Lane> lanes_;
};

}  // namespace fogline::sumo
