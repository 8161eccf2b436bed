// An algorithm as the work of a node. StepNode connects the typed inputs and outputs of the
// algorithm with the bytes of Inputs and Outputs.
//
// In real time, two roles continue to compute when inputs fail: the role that begins the steps (the
// world), and the role that decides in every step (the arbitrator). Each of these two roles has a
// second algorithm for this case, Failsafe, which takes each input as a Heard<M>. The other roles
// leave out a step that lacks an input.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "services/algorithm.h"
#include "services/runtime/lockstep/lockstep_rule.h"
#include "services/runtime/lockstep/step_gate.h"
#include "services/runtime/node/node.h"
#include "services/runtime/realtime/deadline_rule.h"
#include "services/runtime/realtime/realtime_rule.h"
#include "services/runtime/realtime/tick_rule.h"
#include "services/runtime/seat/live_input.h"

namespace fogline::runtime {

/// @tparam Failsafe the algorithm that replaces Algorithm in real time; void: Algorithm also runs
///     in real time
template <class Algorithm, class Failsafe = void>
class StepNode final : public Work {
 public:
  using Traits = AlgorithmTraits<Algorithm>;

  StepNode(Bus& bus, std::optional<std::int64_t> run_id)
      : node_(bus, Traits::kRole, run_id, *this) {
    WithIndex<kInputs>([this]<std::size_t I> { KeepMessagesOf<I>(parts_.inputs.Of(kPlace<I>)); });
    if constexpr (Traits::kStarts) gate_.emplace(bus, parts_.own.message());
  }

  Node& node() override { return node_; }

 private:
  template <class Messages>
  struct Rings;
  template <class... M>
  struct Rings<std::tuple<M...>> {
    using Type = std::tuple<std::array<M, kRingSteps>...>;
  };
  using AllInputs = typename Traits::AllInputs;
  using InputRings = typename Rings<AllInputs>::Type;
  static constexpr std::size_t kInputs = std::tuple_size_v<typename Traits::Inputs>;
  template <std::size_t I>
  static constexpr std::int64_t kLag = LagOf(ChannelOf<std::tuple_element_t<I, AllInputs>>().from,
                                             Traits::kRole);
  template <std::size_t I>
  static constexpr std::size_t kPlace = IndexOf<std::tuple_element_t<I, AllInputs>>();
  static constexpr bool kFailsafe = !std::is_void_v<Failsafe>;
  struct Nothing {};
  using InRealtime = std::conditional_t<kFailsafe, Failsafe, Nothing>;
  static_assert(
      !kFailsafe || Traits::kHasOnDemand == requires { &InRealtime::SetOnDemandInput; },
      "an algorithm and its failsafe have the same input on demand");

  /// Makes an input store its decoded messages in rings_.
  template <std::size_t I>
  void KeepMessagesOf(Input& input) {
    input.keep = [this](std::int64_t step, Arrival& arrival) {
      std::get<I>(rings_)[RingSlot(step)] = *arrival.As<std::tuple_element_t<I, AllInputs>>();
    };
  }

  std::unique_ptr<FireRule> Join(const Scenario& scenario) override {
    algorithm_ = std::make_unique<Algorithm>(scenario);
    if constexpr (Traits::kHasOnDemand) {
      uses_on_demand_ = Traits::UsesOnDemandInput(scenario);
      if (uses_on_demand_) KeepMessagesOf<kInputs>(parts_.inputs.ReadOnDemand(kPlace<kInputs>));
    }
    if (Traits::UsesLiveInput(scenario)) live_.emplace(parts_, scenario);
    if constexpr (kFailsafe) {
      if (parts_.run.realtime) failsafe_ = std::make_unique<Failsafe>(scenario);
    }
    if constexpr (Traits::kStarts) {
      gate_->Configure(scenario, *parts_.run.id);
      Prepare();
    }
    return parts_.run.realtime ? RuleInRealtime(scenario) : RuleInLockstep();
  }

  /// Does the slow part of step 0 before the role reports READY.
  void Prepare() {
    if constexpr (requires(InRealtime failsafe) { failsafe.Prepare(); }) {
      if (failsafe_) return failsafe_->Prepare();
    }
    if constexpr (requires { algorithm_->Prepare(); }) algorithm_->Prepare();
  }

  std::unique_ptr<FireRule> RuleInLockstep() {
    return std::make_unique<LockstepRule>(parts_, gate_ ? &*gate_ : nullptr);
  }

  std::unique_ptr<FireRule> RuleInRealtime([[maybe_unused]] const Scenario& scenario) {
    if constexpr (kFailsafe && Traits::kStarts) {
      return Watched(std::make_unique<TickRule>(parts_, scenario, *gate_,
                                                [this](const truth_t& truth) { Resume(truth); }));
    } else if constexpr (kFailsafe) {
      return Watched(std::make_unique<DeadlineRule>(parts_, scenario));
    } else if constexpr (Traits::kStarts) {
      throw std::runtime_error("this world cannot run in real time: it has no Failsafe class");
    } else {
      return std::make_unique<RealtimeRule>(parts_, scenario);
    }
  }

  /// Stores a pointer to the RealtimeWatch of `rule`, which judges the inputs. @return `rule`
  template <class Rule>
  std::unique_ptr<Rule> Watched(std::unique_ptr<Rule> rule) {
    watch_ = &rule->watch();
    return rule;
  }

  void Compute(std::int64_t step) override {
    if constexpr (kFailsafe) {
      if (failsafe_) return ComputeFailsafe(step);
    }
    if constexpr (Traits::kStarts) {
      if (step == 0) return Publish(step, algorithm_->Start(*parts_.run.id));
    }
    PassOnDemandInput(*algorithm_, step);
    if constexpr (Traits::kHasLive) {
      if (live_) algorithm_->SetLiveInput(live_->Newest(Clock::now()));
    }
    Publish(step, Step(step, std::make_index_sequence<kInputs>{}));
  }

  template <std::size_t... I>
  const typename Traits::Output& Step(std::int64_t step, std::index_sequence<I...>) {
    return algorithm_->Step(std::get<I>(rings_)[RingSlot(step - kLag<I>)]...);
  }

  /// Before each step, passes the newest message of the input on demand (services/algorithm.h) to
  /// the algorithm's SetOnDemandInput(). Does nothing if the algorithm has no such input, or does
  /// not use it in this scenario.
  template <class A>
  void PassOnDemandInput(A& algorithm, std::int64_t step) {
    if constexpr (Traits::kHasOnDemand) {
      if (!uses_on_demand_) return;
      static const std::tuple_element_t<kInputs, AllInputs> kBeforeTheRun{};
      const auto* newest = NewestOf<kInputs>(step - kLag<kInputs>);
      if (newest == nullptr && !parts_.run.realtime) newest = &kBeforeTheRun;
      if (newest != nullptr) algorithm.SetOnDemandInput(*newest);
    }
  }

  /// The newest message of an input up to step `step`; nullptr if no message has come. In lockstep,
  /// the result is the message of `step`.
  template <std::size_t I>
  const std::tuple_element_t<I, AllInputs>* NewestOf(std::int64_t step) {
    const StepRing& ring = parts_.inputs.Of(kPlace<I>).ring;
    std::int64_t newest = std::min(step, ring.newest());
    const std::int64_t oldest = std::max<std::int64_t>(0, newest - kRingSteps + 1);
    while (newest >= oldest && !ring.Has(newest)) --newest;
    return newest < oldest ? nullptr : &std::get<I>(rings_)[RingSlot(newest)];
  }

  // ---- real time, with the inputs that are there ------------------------------------------------

  void ComputeFailsafe(std::int64_t step) {
    if constexpr (Traits::kStarts) {
      Publish(step, step == 0 ? failsafe_->Start(*parts_.run.id) : StepFailsafe(step));
    } else {
      if ((parts_.run.minimal_risk & status_t::HOST) != 0) failsafe_->DemandMinimalRisk();
      Publish(step, StepFailsafe(step));
    }
    parts_.own.message().fallback = failsafe_->fallback();
    parts_.own.message().minimal_risk = failsafe_->minimal_risk();
  }

  const typename Traits::Output& StepFailsafe(std::int64_t step) {
    PassOnDemandInput(*failsafe_, step);
    return [&]<std::size_t... I>(std::index_sequence<I...>)->const typename Traits::Output& {
      if constexpr (Traits::kStarts) {
        return failsafe_->Step({HeardBy<I>(step - kLag<I>)...});
      } else {
        return failsafe_->Step(HeaderOf(step), {HeardBy<I>(step - kLag<I>)...});
      }
    }
    (std::make_index_sequence<kInputs>{});
  }

  template <std::size_t I>
  Heard<std::tuple_element_t<I, AllInputs>> HeardBy(std::int64_t step) {
    const auto* newest = NewestOf<I>(step);
    const auto input = &parts_.inputs.Of(kPlace<I>) - parts_.inputs.all().data();
    const InputState state = watch_->StateFor(static_cast<std::size_t>(input), step);
    // A restarted process may decide a step that is older than all messages it has received. Then
    // there is no message to use, although the input is not lost.
    const bool lacks_message = Usable(state) && newest == nullptr;
    return {.state = lacks_message ? InputState::kAwaited : state, .newest = newest};
  }

  /// The header of the first input. This input is the world's message that begins the step.
  header_t HeaderOf(std::int64_t step) { return std::get<0>(rings_)[RingSlot(step)].header; }

  /// Takes over from a world that was killed. Computes the steps after the last recorded step
  /// again, up to the step that the run has reached according to RUN. Does not publish these steps,
  /// so no step is published twice.
  void Resume(const truth_t& truth) {
    if constexpr (kFailsafe && Traits::kStarts) {
      failsafe_->Resume(truth, parts_.run.minimal_risk);
      truth_t newest = truth;
      while (newest.header.step < parts_.run.progress && !newest.last) {
        newest = std::get<truth_t>(StepFailsafe(newest.header.step + 1));
      }
      parts_.steps.StartAt(newest.header.step + 1);
      if (newest.last) node_.rule().SetFinal(newest.header.step);
    }
  }

  // ----------------------------------------------------------------------------------------------

  void Publish(std::int64_t step, const typename Traits::Output& output) {
    if constexpr (std::is_same_v<std::tuple<typename Traits::Output>, typename Traits::Outputs>) {
      PublishOne(step, output);
    } else {
      WithIndex<std::tuple_size_v<typename Traits::Outputs>>(
          [&]<std::size_t I> { PublishOne(step, std::get<I>(output)); });
    }
    if constexpr (Traits::kStarts) {
      if (std::get<truth_t>(output).last) node_.rule().SetFinal(step);
    }
  }

  template <class M>
  void PublishOne(std::int64_t step, const M& message) {
    if (const std::string_view field = FirstNonFiniteField(message); !field.empty()) {
      throw std::runtime_error(fmt::format("step {}: {} of {} is not a finite number", step, field,
                                           ChannelOf<M>().name));
    }
    Encode(message, encoded_);
    node_.outputs().Publish(IndexOf<M>(), step, encoded_);
  }

  template <std::size_t N, class F>
  static void WithIndex(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f.template operator()<I>(), ...); }
    (std::make_index_sequence<N>{});
  }

  Node node_;
  Parts& parts_ = node_.parts();
  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<InRealtime> failsafe_;  // only in real time, if Failsafe is not void
  InputRings rings_;
  bool uses_on_demand_ = false;  // whether the input on demand is read in this scenario
  std::vector<std::uint8_t> encoded_;
  std::optional<StepGate> gate_;          // only for the role that begins the steps
  std::optional<LiveInput> live_;         // only if the scenario uses the live input
  const RealtimeWatch* watch_ = nullptr;  // the watch of the rule; nullptr without failsafe_
};

}  // namespace fogline::runtime
