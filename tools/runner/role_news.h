// Messages for the user of a run about the processes of its roles. Each message is printed once.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "common/process/progress.h"
#include "services/runtime/coordination/run_coordinator.h"
#include "tools/runner/scenario_run.h"

namespace fogline::runner {

/// The last STATUS of each process of a role.
std::vector<status_t> LastWords(const runtime::RunCoordinator& coordinator, Role role);

/// The processes whose build differs from the runner's build, including processes that have ended.
std::vector<runtime::OtherBuild> OtherBuilds(const runtime::RunCoordinator& coordinator);

/// Reports processes that belong to another run, if this run waits for their roles. Each process is
/// reported once.
class BusyElsewhere {
 public:
  BusyElsewhere(std::int64_t run_id, std::function<void(const std::string&)> say)
      : run_id_(run_id), say_(std::move(say)) {}

  void Look(const runtime::RunCoordinator& coordinator, TimePoint now);

 private:
  std::int64_t run_id_;
  std::function<void(const std::string&)> say_;
  std::set<std::string> told_;
  TimePoint look_at_{};
};

/// Prints warnings while a run goes on, each warning once.
class Warnings {
 public:
  Warnings(runtime::RunCoordinator& coordinator, Progress& progress)
      : coordinator_(coordinator), progress_(progress) {}

  void LookAtTheClock();
  void LookAtTheRoles();

 private:
  void Say(const std::string& what) { progress_.Say("warning: " + what); }
  /// Names the processes that claim a role which another process already has.
  void NameTheRefused();

  runtime::RunCoordinator& coordinator_;
  Progress& progress_;
  bool compared_ = false;  // whether the builds were compared
  std::string key_trouble_;
  std::set<std::int64_t> refused_;  // instances of the processes that were named
};

/// Examines once, when a run in real time has begun, which roles have real-time priority.
class PriorityWatch {
 public:
  explicit PriorityWatch(bool realtime) : done_(!realtime) {}

  /// @return true if this call has made the examination
  bool Look(const runtime::RunCoordinator& coordinator, TimePoint now);
  /// The result; nullopt before the examination.
  const std::optional<log::RealtimePriority>& found() const { return found_; }
  /// @pre found()
  std::string Text() const;

 private:
  bool done_;
  TimePoint since_{};  // when Look() first found the run in its running phase
  std::optional<log::RealtimePriority> found_;
};

}  // namespace fogline::runner
