// Computes runs that differ only in their arbitrators. Steps that are equal in several runs are
// computed only once.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/closed_loop/closed_loop.h"

namespace fogline::closed_loop {

/// Computes runs of several scenarios. If scenarios differ only in their section `arbitrator`,
/// their runs are equal until the arbitrators command something different. For example, a run with
/// traded control and its baseline are often equal until the fog begins. Up to the first different
/// command, these runs share all roles except the arbitrator. From this command on, a run that
/// commands something different continues with a copy of the state of these roles. Each run has the
/// same messages as in a ClosedLoop, bit by bit. An object keeps its loops from call to call. Only
/// one thread may use an object.
class SharedRuns {
 public:
  /// Computes all steps of all runs, and calls `visit(std::size_t run, const StepView&)` after each
  /// step, where `run` is the position of the scenario. The steps of a run come in their order. A
  /// step of the first run comes before the same step of every other run.
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
  /// The positions of the runs of a group. These runs have been equal so far.
  using Group = std::vector<std::size_t>;

  /// Divides the runs into groups. The runs of a group may share steps. The first run is in the
  /// first group.
  static std::vector<Group> GroupsOf(std::span<const Scenario> scenarios);
  /// Makes a loop for each scenario, in their order.
  void Prepare(std::span<const Scenario> scenarios, const std::vector<Group>& groups);
  /// The loop that computes the steps of the group.
  ClosedLoop& Front(const Group& group) { return loops_[group.front()]; }
  /// Computes the next step of the group up to the arbitrators. Then compares the command of each
  /// run with the command of the group's first run. If the two commands do not have the same
  /// effect, the run is moved from `group` to a new group in `left`. Runs whose commands have the
  /// same effect are moved to the same new group.
  void Decide(Group& group, std::vector<Group>& left);

  /// Computes the remaining steps of the runs in `group`, and then of the runs that have left the
  /// group.
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

/// Whether the runs of two scenarios may share steps. This is true if the scenarios are equal. It
/// is also true if they differ only in section `arbitrator`, and the state of every other role can
/// be copied.
bool MayShareSteps(const Scenario& a, const Scenario& b);

}  // namespace fogline::closed_loop
