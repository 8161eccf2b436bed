// Runs that differ only in their arbitrators, without a second computation of equal steps.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/closed_loop/closed_loop.h"

namespace fogline::closed_loop {

/// Computes runs of several scenarios. Runs of scenarios that differ only in their section
/// `arbitrator`, such as a run with traded control and its baseline, are equal until their
/// arbitrators command something different: often until the fog. Such runs share all roles but the
/// arbitrator up to that step. Then the state of the roles is copied. Each run has the same
/// messages as in a ClosedLoop, bit by bit. An object keeps its loops from call to call. Only one
/// thread may use an object.
class SharedRuns {
 public:
  /// Computes all steps of all runs, and calls `visit(std::size_t run, const StepView&)` after each
  /// step, where `run` is the position of the scenario. The steps of a run come in their order. A
  /// step of the first run comes before the same step of other runs.
  /// @throws the exceptions of ClosedLoop; current() is then the run that has thrown
  template <class Visit>
  void Run(std::span<const Scenario> scenarios, Visit&& visit) {
    std::vector<Group> groups = GroupsOf(scenarios);
    Prepare(scenarios, groups);
    for (Group& group : groups) {
      current_ = group.front();
      const ClosedLoop::Ending ending(Front(group));
      Front(group).Begin(0);
      std::vector<Group> left;
      Decide(group, left);
      RunGroup(std::move(group), std::move(left), visit);
    }
  }

  /// The run whose exception Run() has thrown. @pre Run() has thrown
  std::size_t current() const { return current_; }

 private:
  /// Positions of runs that have been equal so far.
  using Group = std::vector<std::size_t>;

  /// Divides the runs into groups that may share steps. The first run is in the first group.
  static std::vector<Group> GroupsOf(std::span<const Scenario> scenarios);
  /// Makes a loop for each scenario, in their order.
  void Prepare(std::span<const Scenario> scenarios, const std::vector<Group>& groups);
  /// The loop that computes the steps of the group.
  ClosedLoop& Front(const Group& group) { return loops_[group.front()]; }
  /// Computes the next step of the group up to the arbitrators. If the command of a run's
  /// arbitrator does not have the same effect as the command of the front's arbitrator, the run is
  /// moved from `group` to a new group in `left`. Runs whose commands have the same effect are
  /// moved to the same new group.
  void Decide(Group& group, std::vector<Group>& left);

  /// Computes the rest of the runs of a group, and of the groups that have left it.
  /// @pre Decide(group, left) was called
  template <class Visit>
  void RunGroup(Group group, std::vector<Group> left, Visit& visit) {
    ClosedLoop& front = Front(group);
    current_ = group.front();
    while (true) {
      front.ComputeAfterArbitrator();
      for (const std::size_t run : group) {
        loops_[run].VisitStepOf(front, [&](const StepView& step) { visit(run, step); });
      }
      if (!front.Advance()) break;
      Decide(group, left);
    }
    for (Group& other : left) RunGroup(std::move(other), {}, visit);
  }

  std::deque<ClosedLoop> loops_;  // by position of the run
  std::size_t current_ = 0;
};

/// Whether the runs of two scenarios may share steps. The scenarios must be equal, or they differ
/// only in the arbitrator and the state of every other role can be copied.
bool MayShareSteps(const Scenario& a, const Scenario& b);

}  // namespace fogline::closed_loop
