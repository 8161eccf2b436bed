#include "services/models/sumo/lane_path.h"

#include <libsumo/libsumo.h>

#include <algorithm>
#include <optional>

namespace fogline::sumo {
namespace {

using Names = std::vector<std::string>;

/// The lanes inside of the junction between `lane` and `next`, and `next` itself; empty if no
/// connection leads there. Each of these lanes has one connection onward.
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

Names LanesOf(const std::string& edge) {
  Names lanes;
  for (int i = 0; i < libsumo::Edge::getLaneNumber(edge); ++i) {
    lanes.push_back(edge + "_" + std::to_string(i));
  }
  return lanes;
}

/// The longest way onward from a lane along the edges from `edge` on; of equally long ways, that
/// on the rightmost lanes.
Names Onward(const std::string& lane, Names::const_iterator edge, Names::const_iterator end) {
  Names longest;
  if (edge == end) return longest;
  for (const std::string& next : LanesOf(*edge)) {
    Names way = Through(lane, next);
    if (way.empty()) continue;
    std::ranges::move(Onward(next, edge + 1, end), std::back_inserter(way));
    if (way.size() > longest.size()) longest = std::move(way);
  }
  return longest;
}

/// The longest way to a lane along the edges before `edge`, the last of them first.
Names Backward(const std::string& lane, Names::const_reverse_iterator edge,
               Names::const_reverse_iterator end) {
  Names longest;
  if (edge == end) return longest;
  for (const std::string& before : LanesOf(*edge)) {
    Names inside = Through(before, lane);
    if (inside.empty()) continue;
    inside.pop_back();
    Names way = Backward(before, edge + 1, end);
    way.push_back(before);
    std::ranges::move(inside, std::back_inserter(way));
    if (way.size() > longest.size()) longest = std::move(way);
  }
  return longest;
}

}  // namespace

LanePath::LanePath(const Names& route, const std::string& lane) {
  const auto at = std::ranges::find(route, libsumo::Lane::getEdgeID(lane));
  Names names = Backward(lane, std::make_reverse_iterator(at), route.rend());
  names.push_back(lane);
  if (at != route.end())
    std::ranges::move(Onward(lane, at + 1, route.end()), std::back_inserter(names));
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
