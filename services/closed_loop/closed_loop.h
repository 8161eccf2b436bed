// The whole experiment in one process, without transport of messages. Sweeps, calibration and tests
// use it. ClosedLoop calls the same Step functions as the processes, in the order of the graph
// table. The results equal the results of the distributed run.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

#include "scenario/sections/scenario.h"
#include "services/algorithm.h"
#include "services/closed_loop/algorithms.h"
#include "services/graph.h"
#include "services/metrics/sample.h"

namespace fogline::closed_loop {

/// The newest message of each kStep channel. If a channel has had no message yet, all fields of its
/// message are zero.
class Messages {
 public:
  Messages() {
    ForEachStepChannel([this]<class M>(std::size_t /*channel*/) {
      static const M kBeforeTheRun{};
      this->Put(kBeforeTheRun);
    });
  }

  template <class M>
  const M& Get() const {
    return *static_cast<const M*>(messages_[IndexOf<M>()]);
  }
  template <class M>
  void Put(const M& message) {
    messages_[IndexOf<M>()] = &message;
  }
  template <class... M>
  void Put(const std::tuple<M...>& messages) {
    (Put(std::get<M>(messages)), ...);
  }

 private:
  std::array<const void*, kNumChannels> messages_{};
};

/// A message of each channel. Only the messages of kStep channels are used.
using StepMessages = decltype(std::apply(
    [](const auto&... channel) {
      return std::tuple<typename std::decay_t<decltype(channel)>::Message...>();
    },
    kGraph));

/// The messages of one step. They are valid until the next step.
struct StepView {
  explicit StepView(const Messages& messages)
      : truth(messages.Get<truth_t>()),
        ego(messages.Get<ego_t>()),
        radar(messages.Get<radar_t>()),
        lidar(messages.Get<lidar_t>()),
        track(messages.Get<track_t>()),
        acc(messages.Get<accel_command_t>()),
        driver(messages.Get<driver_command_t>()),
        host(messages.Get<arbitration_t>()),
        follower(messages.Get<follower_command_t>()),
        all(messages) {}

  // The messages that the measures and the studies use.
  const truth_t& truth;
  const ego_t& ego;
  const radar_t& radar;
  const lidar_t& lidar;
  const track_t& track;
  const accel_command_t& acc;
  const driver_command_t& driver;
  const arbitration_t& host;
  const follower_command_t& follower;
  const Messages& all;

  /// Calls `visit(message)` for each message, in the order of the graph table.
  template <class Visit>
  void ForEachMessage(Visit&& visit) const {
    ForEachStepChannel([&]<class M>(std::size_t /*channel*/) { visit(all.Get<M>()); });
  }

  metrics::Sample ToSample() const {
    return metrics::MakeSample(truth, radar, lidar, track, acc, driver, host, follower);
  }
};

class ClosedLoop {
 public:
  /// @throws InputError if the weights of an ACC make an ill-conditioned problem.
  explicit ClosedLoop(const Scenario& scenario);
  ClosedLoop(const ClosedLoop&) = delete;
  ClosedLoop& operator=(const ClosedLoop&) = delete;

  /// Resets the object for another run. This run equals the run of a new ClosedLoop(scenario) bit
  /// by bit. Restart() is cheaper than a new object, because an ACC with an unchanged section keeps
  /// its precomputed gains.
  /// @throws the exceptions of the constructor; Restart() must then succeed before the next Run()
  void Restart(const Scenario& scenario);

  /// Computes all steps, and calls `visit(const StepView&)` after each step. Call Run() once after
  /// construction, and once after each Restart().
  /// @throws InputError if a person drives
  template <class Visit>
  void Run(std::int64_t run_id, Visit&& visit) {
    const Ending ending(*this);
    Begin(run_id);
    do {
      ComputeBeforeArbitrator();
      Arbitrate();
      ComputeAfterArbitrator();
      visit(StepView(messages_));
    } while (Advance());
  }

  // The parts of Run(), for SharedRuns.

  /// Ends the run of a loop, even if a step throws.
  class Ending {
   public:
    explicit Ending(ClosedLoop& loop) : loop_(loop) {}
    ~Ending() { loop_.End(); }
    Ending(const Ending&) = delete;
    Ending& operator=(const Ending&) = delete;

   private:
    ClosedLoop& loop_;
  };

  /// Ends the run. End() may be called before the last step, too.
  void End();
  /// Computes the first role's messages of step 0. @throws InputError if a person drives
  void Begin(std::int64_t run_id);
  /// These three functions compute the messages of a step: first the messages of the roles between
  /// the first role and the arbitrator, then the message of the arbitrator, then the messages of
  /// the roles after the arbitrator.
  void ComputeBeforeArbitrator();
  void Arbitrate() { ArbitrateFor(*this); }
  void ComputeAfterArbitrator();
  /// Computes the first role's messages of the next step. @return false after the last step
  bool Advance();

  /// Resets only the arbitrator, for a run that shares its first steps with another loop. Call
  /// ArbitrateFor() with the other loop in each of these steps. LeaveFrom() then makes the run
  /// independent of the other loop.
  void RestartArbitrator(const Scenario& scenario);
  /// Computes the arbitrator's message from the messages of `shared`.
  void ArbitrateFor(const ClosedLoop& shared);
  /// Whether the last HOST_COMMANDs of this loop and of `other` have the same effect on the roles
  /// that read them.
  bool CommandsAs(const ClosedLoop& other) const;
  /// Copies from `shared` the state of all roles except the arbitrator, and the messages of the
  /// step. Call ComputeAfterArbitrator() next. @pre ArbitrateFor(shared) was called in this step
  void LeaveFrom(const ClosedLoop& shared);
  /// Calls `visit` with the messages of `shared`, but with the HOST_COMMAND of this loop's
  /// arbitrator.
  template <class Visit>
  void VisitStepOf(const ClosedLoop& shared, Visit&& visit) const {
    Messages messages = shared.messages_;
    messages.Put(*command_);
    visit(StepView(messages));
  }

 private:
  /// An algorithm, and whether it uses its input on demand in this scenario (services/algorithm.h).
  template <class A>
  struct RoleOf {
    explicit RoleOf(const Scenario& scenario)
        : algorithm(scenario), uses_on_demand(AlgorithmTraits<A>::UsesOnDemandInput(scenario)) {}
    void Restart(const Scenario& scenario) {
      uses_on_demand = AlgorithmTraits<A>::UsesOnDemandInput(scenario);
      if constexpr (requires { algorithm.Restart(scenario); }) {
        algorithm.Restart(scenario);
      } else {
        algorithm = A(scenario);
      }
    }
    A algorithm;
    bool uses_on_demand;
  };
  template <class T>
  struct RolesOf;
  template <class First, class... A>
  struct RolesOf<std::tuple<First, A...>> {
    static_assert(AlgorithmTraits<First>::kStarts, "the first role of graph.h begins the steps");
    static_assert(!(AlgorithmTraits<A>::kStarts || ...), "one role begins the steps");
    using Type = std::tuple<RoleOf<First>, RoleOf<A>...>;
    static Type Make(const Scenario& scenario) {
      // Braces construct the roles in their order. So if several roles refuse the scenario, the
      // first of these roles always throws the exception.
      return Type{RoleOf<First>(scenario), RoleOf<A>(scenario)...};
    }
  };
  using Roles = RolesOf<Algorithms>;
  static constexpr std::size_t kNumRoles = std::tuple_size_v<Algorithms>;
  /// Position of the arbitrator in the order of evaluation.
  static constexpr auto kArbitrator = static_cast<std::size_t>(Role::kArbitrator);

  auto& First() { return std::get<0>(roles_).algorithm; }

  /// Computes the messages of the roles from position kBegin up to, but not including, kEnd. The
  /// algorithms are evaluated in their order. So an input is of the same step if its producer comes
  /// before its reader. Otherwise the input is of the previous step (LagOf() in graph.h).
  template <std::size_t kBegin, std::size_t kEnd>
  void ComputeRoles();

  bool person_;  // whether the scenario has a person who drives
  Roles::Type roles_;
  Messages messages_;                       // newest messages of the run
  const arbitration_t* command_ = nullptr;  // newest message of the arbitrator
  StepMessages copies_;                     // messages that LeaveFrom() has copied
};

/// A ClosedLoop for one run after another, with equal or different scenarios. Only one thread may
/// use an object.
class ReusedLoop {
 public:
  /// Computes one run; ClosedLoop::Run() describes `visit`. @throws the exceptions of ClosedLoop's
  /// constructor and of ClosedLoop::Run()
  template <class Visit>
  void Run(const Scenario& scenario, Visit&& visit) {
    if (loop_) {
      loop_->Restart(scenario);
    } else {
      loop_.emplace(scenario);
    }
    loop_->Run(0, visit);
  }
  /// Computes one run with `seed` in place of the scenario's seed.
  template <class Visit>
  void Run(const Scenario& scenario, std::int64_t seed, Visit&& visit) {
    scenario_ = scenario;
    scenario_.seed = seed;
    Run(scenario_, visit);
  }

 private:
  std::optional<ClosedLoop> loop_;
  Scenario scenario_;
};

}  // namespace fogline::closed_loop
