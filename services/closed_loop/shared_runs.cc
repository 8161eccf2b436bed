#include "services/closed_loop/shared_runs.h"

#include <algorithm>
#include <tuple>
#include <type_traits>

#include "services/algorithm.h"

namespace fogline::closed_loop {
namespace {

/// Whether the state of every role except the arbitrator can be copied.
bool CanBeCopied(const Scenario& scenario) {
  return []<class... A>(std::type_identity<std::tuple<A...>>, const Scenario& of) {
    return ((AlgorithmTraits<A>::kRole == Role::kArbitrator ||
             !AlgorithmTraits<A>::CopiesShareState(of)) &&
            ...);
  }(std::type_identity<Algorithms>{}, scenario);
}

}  // namespace

bool MayShareSteps(const Scenario& a, const Scenario& b) {
  if (a == b) return true;
  if (!CanBeCopied(a) || !CanBeCopied(b)) return false;
  Scenario other = b;
  other.arbitrator = a.arbitrator;
  return a == other;
}

std::vector<SharedRuns::Group> SharedRuns::GroupsOf(std::span<const Scenario> scenarios) {
  std::vector<Group> groups;
  for (std::size_t run = 0; run < scenarios.size(); ++run) {
    const auto group = std::ranges::find_if(groups, [&](const Group& one) {
      return MayShareSteps(scenarios[one.front()], scenarios[run]);
    });
    if (group == groups.end()) {
      groups.push_back({run});
    } else {
      group->push_back(run);
    }
  }
  return groups;
}

void SharedRuns::Prepare(std::span<const Scenario> scenarios, const std::vector<Group>& groups) {
  for (std::size_t run = 0; run < scenarios.size(); ++run) {
    current_ = run;
    const auto begins = [run](const Group& group) { return group.front() == run; };
    if (run == loops_.size()) {
      loops_.emplace_back(scenarios[run]);
    } else if (std::ranges::any_of(groups, begins)) {
      loops_[run].Restart(scenarios[run]);
    } else {
      loops_[run].RestartArbitrator(scenarios[run]);
    }
  }
}

void SharedRuns::Decide(Group& group, std::vector<Group>& left) {
  ClosedLoop& front = Front(group);
  front.ComputeBeforeArbitrator();
  for (const std::size_t run : group) loops_[run].ArbitrateFor(front);
  const std::size_t before = left.size();
  std::erase_if(group, [&](std::size_t run) {
    ClosedLoop& loop = loops_[run];
    if (loop.CommandsAs(front)) return false;
    const auto same = std::find_if(left.begin() + static_cast<std::ptrdiff_t>(before), left.end(),
                                   [&](const Group& one) { return loop.CommandsAs(Front(one)); });
    if (same == left.end()) {
      loop.LeaveFrom(front);
      left.push_back({run});
    } else {
      same->push_back(run);
    }
    return true;
  });
}

}  // namespace fogline::closed_loop
