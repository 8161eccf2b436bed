// How a role joins and leaves a run: the role listens to RUN, collects the scenario, and watches
// its runner.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "common/clock.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/node/runner_watch.h"
#include "services/runtime/node/work.h"

namespace fogline::runtime {

class Membership {
 public:
  /// @param run_id the run to join; nullopt: the first run that waits for the role
  /// @param rule is set when the role joins a run; the rule decides when the role computes a step
  Membership(Parts& parts, std::optional<std::int64_t> run_id, Work& work,
             std::unique_ptr<FireRule>& rule);

  /// Sets the function that is called after the role has prepared for its run and before the role
  /// reports READY.
  void BeforeReady(std::function<void()> call) { before_ready_ = std::move(call); }
  /// Does what is due: asks for the scenario, or leaves the run if the runner is gone.
  /// @return the latest time for the next call
  TimePoint Poll(TimePoint now);
  /// Whether the role's runner has been silent for so long that the role may join another run.
  bool RunnerSilent(TimePoint now) { return runner_.Silent(runner_.Attend(now)); }

 private:
  void OnRun(Bytes bytes);
  /// Handles a RUN of another run.
  void OnOtherRun(const run_t& run, TimePoint now);
  /// Whether the runner is known to have sent this RUN just now. Otherwise the RUN may be a copy
  /// from an old run. In this case the function calls AskWhetherThere() and returns false.
  bool IsFresh(const run_t& run, TimePoint now);
  /// Asks the runner of `run` for a new RUN. The field answer_to of the new RUN names this process,
  /// which shows that the runner is there and that the RUN is no copy.
  void AskWhetherThere(const run_t& run, TimePoint now);
  /// In lockstep the role fails if nothing could be sent since it joined, for longer than the run's
  /// stall limit.
  void CheckSends(TimePoint now);
  /// Whether the runner has given the role's place to another process. If an option names the run,
  /// the RUN may come from a played log, and then it names a process of the logged run. So in this
  /// case only a RUN that answers this process counts. The function asks the runner for such a RUN.
  bool HasLostItsPlace(const run_t& run, TimePoint now);
  /// Whether the role follows a played log in place of a run, and the log has ended.
  bool LogIsOver(TimePoint now);
  /// Evaluates a RUN if it is newer than all earlier RUN messages.
  /// @return whether the RUN is newer
  bool TakeNews(const run_t& run, TimePoint now);
  /// Forgets a run whose runner stopped sending before the whole scenario had come.
  void Unbind();
  void Join(const run_t& run);

  Parts& parts_;
  RunNews& run_;
  OwnStatus& own_;
  Work& work_;
  std::unique_ptr<FireRule>& rule_;
  std::function<void()> before_ready_ = [] {};
  const bool chosen_;  // whether an option names the run: then the role looks for no other run
  bool fresh_;         // whether the runner has answered this process; also true without a key
  RateLimiter questions_{200, 20};  // limits the requests that ask runners for an answer
  TimePoint part_at_{};             // when to ask for the next part of the scenario
  TimePoint joined_{};              // when the role joined its run
  TimePoint announced_at_{};        // when a repeated announcement was last answered
  RunnerWatch runner_{Clock::now()};
  // Whether the runner has started this process. The kernel then ends this process when the runner
  // ends.
  const bool ends_with_runner_;
};

}  // namespace fogline::runtime
