#include "services/models/sumo/lane_path.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace fogline::sumo {
namespace {

using Names = std::vector<std::string>;

/// The lanes inside of the junction between `lane` and `next`, and `next` itself; empty if no
/// connection leads to `next`. Each lane inside of a junction has only one connection onward.
Names Through(const std::string& lane, const std::string& next) {
  for (const libsumo::TraCIConnection& link : libsumo::Lane::getLinks(lane)) {
    if (link.approachedLane != next) continue;
    Names lanes;
    std::string inside = link.approachedInternal;
    while (!inside.empty()) {
      lanes.push_back(inside);
      const std::vector<libsumo::TraCIConnection> onward = libsumo::Lane::getLinks(inside);
      inside = onward.empty() ? "" : onward.front().approachedInternal;
    }
    lanes.push_back(next);
    return lanes;
  }
  return {};
}

/// The lanes inside of the junction between `before` and `lane`, from the last to the first, and
/// then `before`; empty if no connection leads from `before` to `lane`.
Names BackThrough(const std::string& lane, const std::string& before) {
  Names lanes = Through(before, lane);
  if (lanes.empty()) return lanes;
  lanes.pop_back();
  std::ranges::reverse(lanes);
  lanes.push_back(before);
  return lanes;
}

Names LanesOf(const std::string& edge) {
  Names lanes;
  for (int i = 0; i < libsumo::Edge::getLaneNumber(edge); ++i) {
    lanes.push_back(edge + "_" + std::to_string(i));
  }
  return lanes;
}

/// Finds the longest way from a lane along edges: the way with the most lanes. If several ways are
/// equally long, the class takes the way on the rightmost lanes. If each lane leads to several
/// lanes, there are very many ways. So the class searches each lane of an edge only once. This is
/// sufficient, because the longest way from a lane does not depend on the way to this lane.
class LongestWay {
 public:
  /// Function that returns the lanes from `lane` to `next`, which is a lane of the next edge.
  /// `next` is the last of these lanes. The result is empty if no lanes lead to `next`.
  using Between = Names (*)(const std::string& lane, const std::string& next);

  LongestWay(Names edges, Between between) : edges_(std::move(edges)), between_(between) {}

  Names From(const std::string& lane) {
    Names way;
    const std::string* at = &lane;
    for (std::size_t edge = 0;; ++edge) {
      const Names& begin = Find(*at, edge).begin;
      if (begin.empty()) return way;
      way.insert(way.end(), begin.begin(), begin.end());
      at = &begin.back();
    }
  }

 private:
  struct Way {
    std::size_t lanes = 0;  // number of its lanes
    Names begin;            // first lanes of the way, up to the lane of the next edge
  };

  /// The longest way that begins at `lane` and goes along edges_, from the index `edge` on.
  const Way& Find(const std::string& lane, std::size_t edge) {
    const auto [found, is_new] = found_.try_emplace({lane, edge});
    Way& longest = found->second;
    if (!is_new || edge == edges_.size()) return longest;
    for (const std::string& next : LanesOf(edges_[edge])) {
      Names begin = between_(lane, next);
      if (begin.empty()) continue;
      const std::size_t lanes = begin.size() + Find(next, edge + 1).lanes;
      if (lanes > longest.lanes) longest = {.lanes = lanes, .begin = std::move(begin)};
    }
    return longest;
  }

  const Names edges_;
  const Between between_;
  std::map<std::pair<std::string, std::size_t>, Way> found_;
};

}  // namespace

LanePath::LanePath(const Names& route, const std::string& lane) {
  const auto at = std::ranges::find(route, libsumo::Lane::getEdgeID(lane));
  Names names = LongestWay({std::make_reverse_iterator(at), route.rend()}, BackThrough).From(lane);
  std::ranges::reverse(names);
  names.push_back(lane);
  if (at != route.end()) {
    std::ranges::move(LongestWay({at + 1, route.end()}, Through).From(lane),
                      std::back_inserter(names));
  }
  double begin_m = 0;
  for (const std::string& name : names) {
    const double length_m = libsumo::Lane::getLength(name);
    lanes_.push_back({name, begin_m, length_m});
    begin_m += length_m;
  }
}

LanePlace LanePath::At(double along_m) const {
  const auto next = std::ranges::upper_bound(lanes_, along_m, {}, &Lane::begin_m);
  const Lane& lane = next == lanes_.begin() ? *next : *(next - 1);
  return {.lane = lane.id, .position_m = along_m - lane.begin_m};
}

}  // namespace fogline::sumo
