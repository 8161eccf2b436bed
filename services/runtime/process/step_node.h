// An algorithm as a node: it connects the typed inputs and outputs of the algorithm with the bytes
// of Node.
//
// Two roles go on in real time when inputs fail: the role that begins the steps (the world) and one
// that decides in every step (the arbitrator). They have an algorithm for that, Failsafe, which
// takes each input as a Heard<M>. The other roles leave out a step that lacks an input.
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
#include "services/runtime/lockstep/lead_rule.h"
#include "services/runtime/lockstep/node.h"
#include "services/runtime/realtime/deadline_rule.h"
#include "services/runtime/realtime/tick_rule.h"

namespace fogline::runtime {

/// @tparam Failsafe the algorithm that replaces Algorithm in real time; void: Algorithm also runs
///     in real time
template <class Algorithm, class Failsafe = void>
class StepNode final : public Node {
 public:
  using Traits = AlgorithmTraits<Algorithm>;

  StepNode(Bus& bus, std::optional<std::int64_t> run_id) : Node(bus, Traits::kRole, run_id) {
    if constexpr (Traits::kStarts) gate_.emplace(bus, status());
  }

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
  static constexpr bool kFailsafe = !std::is_void_v<Failsafe>;
  struct Nothing {};
  using InRealtime = std::conditional_t<kFailsafe, Failsafe, Nothing>;
  static_assert(
      !kFailsafe || Traits::kHasOnDemand == requires { &InRealtime::SetOnDemandInput; },
      "an algorithm and its failsafe have the same input on demand");

  void Configure(const Scenario& scenario) override {
    algorithm_ = std::make_unique<Algorithm>(scenario);
    if constexpr (Traits::kHasOnDemand) {
      uses_on_demand_ = Traits::UsesOnDemandInput(scenario);
      if (uses_on_demand_) ReadOnDemand(IndexOf<std::tuple_element_t<kInputs, AllInputs>>());
    }
    if constexpr (kFailsafe) {
      if (realtime()) failsafe_ = std::make_unique<Failsafe>(scenario);
    }
    if constexpr (Traits::kStarts) gate_->Configure(scenario, run_id());
  }

  RefusalCounter Wrong(std::size_t input, Arrival& arrival) override {
    RefusalCounter wrong = nullptr;
    WithIndex<std::tuple_size_v<InputRings>>([&]<std::size_t I> {
      using M = std::tuple_element_t<I, AllInputs>;
      if (inputs()[input].channel == IndexOf<M>()) wrong = arrival.Wrong<M>();
    });
    return wrong;
  }

  RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) override {
    RefusalCounter wrong = nullptr;
    WithIndex<std::tuple_size_v<InputRings>>([&]<std::size_t I> {
      using M = std::tuple_element_t<I, AllInputs>;
      if (inputs()[input].channel != IndexOf<M>()) return;
      if (const M* message = arrival.As<M>()) {
        std::get<I>(rings_)[RingSlot(step)] = *message;
      } else {
        wrong = arrival.Wrong<M>();
      }
    });
    return wrong;
  }

  std::unique_ptr<FireRule> MakeRule(const Scenario& scenario) override {
    if (!realtime()) {
      if constexpr (Traits::kStarts) return std::make_unique<LeadRule>(*this, *gate_);
      return Node::MakeRule(scenario);
    }
    if constexpr (kFailsafe && Traits::kStarts) {
      return std::make_unique<TickRule>(*this, scenario, pace(), *gate_,
                                        [this](const truth_t& truth) { Resume(truth); });
    } else if constexpr (kFailsafe) {
      return std::make_unique<DeadlineRule>(*this, scenario, pace());
    } else if constexpr (Traits::kStarts) {
      throw std::runtime_error("nothing here keeps the time of a run in real time");
    } else {
      return std::make_unique<RealtimeRule>(*this, scenario, pace());
    }
  }

  void Compute(std::int64_t step) override {
    if constexpr (kFailsafe) {
      if (failsafe_) return ComputeFailsafe(step);
    }
    if constexpr (Traits::kStarts) {
      if (step == 0) return Publish(step, algorithm_->Start(run_id()));
    }
    PassOnDemandInput(*algorithm_, step);
    Publish(step, Step(step, std::make_index_sequence<kInputs>{}));
  }

  template <std::size_t... I>
  const typename Traits::Output& Step(std::int64_t step, std::index_sequence<I...>) {
    return algorithm_->Step(std::get<I>(rings_)[RingSlot(step - kLag<I>)]...);
  }

  /// Passes the input on demand to the algorithm before each step, if the scenario uses it.
  template <class A>
  void PassOnDemandInput(A& algorithm, std::int64_t step) {
    if constexpr (Traits::kHasOnDemand) {
      if (!uses_on_demand_) return;
      static const std::tuple_element_t<kInputs, AllInputs> kBeforeTheRun{};
      const auto* newest = NewestOf<kInputs>(step - kLag<kInputs>);
      if (newest == nullptr && !realtime()) newest = &kBeforeTheRun;
      if (newest != nullptr) algorithm.SetOnDemandInput(*newest);
    }
  }

  /// The newest message of an input that is not newer than `step`; nullptr if none has come. In
  /// lockstep it is the message of `step`.
  template <std::size_t I>
  const std::tuple_element_t<I, AllInputs>* NewestOf(std::int64_t step) {
    const StepRing& ring = InputOf<I>().ring;
    std::int64_t newest = std::min(step, ring.newest());
    const std::int64_t oldest = std::max<std::int64_t>(0, newest - kRingSteps + 1);
    while (newest >= oldest && !ring.Has(newest)) --newest;
    return newest < oldest ? nullptr : &std::get<I>(rings_)[RingSlot(newest)];
  }

  template <std::size_t I>
  const Input& InputOf() {
    return *std::ranges::find(inputs(), IndexOf<std::tuple_element_t<I, AllInputs>>(),
                              &Input::channel);
  }

  // ---- real time, with the inputs that are there ------------------------------------------------

  void ComputeFailsafe(std::int64_t step) {
    if constexpr (Traits::kStarts) {
      Publish(step, step == 0 ? failsafe_->Start(run_id()) : StepFailsafe(step));
    } else {
      if ((minimal_risk() & status_t::HOST) != 0) failsafe_->DemandMinimalRisk();
      Publish(step, StepFailsafe(step));
    }
    status().fallback = failsafe_->fallback();
    status().minimal_risk = failsafe_->minimal_risk();
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
    if (newest == nullptr) return {};
    const auto place = static_cast<std::size_t>(&InputOf<I>() - inputs().data());
    const auto& rule = static_cast<const RealtimeRule&>(this->rule());
    return {.state = rule.StateFor(place, step), .newest = newest};
  }

  /// The header of the first input, which brings the step.
  header_t HeaderOf(std::int64_t step) { return std::get<0>(rings_)[RingSlot(step)].header; }

  /// Takes over from a world that was killed. It computes the steps after the last recorded one up
  /// to the known progress again without publishing them, so that no step is published twice.
  void Resume(const truth_t& truth) {
    if constexpr (kFailsafe && Traits::kStarts) {
      failsafe_->Resume(truth, minimal_risk());
      truth_t newest = truth;
      while (newest.header.step < progress() && !newest.last) {
        newest = std::get<truth_t>(StepFailsafe(newest.header.step + 1));
      }
      StartAt(newest.header.step + 1);
      if (newest.last) rule().SetFinal(newest.header.step);
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
      if (std::get<truth_t>(output).last) rule().SetFinal(step);
    }
  }

  template <class M>
  void PublishOne(std::int64_t step, const M& message) {
    if (const std::string_view field = FirstNonFiniteField(message); !field.empty()) {
      throw std::runtime_error(fmt::format("step {}: {} of {} is not a finite number", step, field,
                                           ChannelOf<M>().name));
    }
    Encode(message, encoded_);
    Emit(IndexOf<M>(), step, encoded_);
  }

  template <std::size_t N, class F>
  static void WithIndex(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f.template operator()<I>(), ...); }
    (std::make_index_sequence<N>{});
  }

  std::unique_ptr<Algorithm> algorithm_;
  std::unique_ptr<InRealtime> failsafe_;  // in real time, if Failsafe is not void
  InputRings rings_;
  bool uses_on_demand_ = false;  // whether the input on demand is read in this scenario
  std::vector<std::uint8_t> encoded_;
  std::optional<StepGate> gate_;  // only for the role that begins the steps
};

}  // namespace fogline::runtime
