// An algorithm as a node: its typed inputs and outputs around the bytes of Node.
#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "services/runtime/algorithm.h"
#include "services/runtime/lead_rule.h"
#include "services/runtime/node.h"

namespace fogline {

template <class Algorithm>
class StepNode final : public Node {
 public:
  using Traits = AlgorithmTraits<Algorithm>;

  StepNode(Bus& bus, std::optional<std::int64_t> run_id) : Node(bus, Traits::kRole, run_id) {
    if constexpr (Traits::kStarts) {
      lead_ = 1;
      gate_.emplace(bus, status());
    }
  }

 private:
  template <class Messages>
  struct Rings;
  template <class... M>
  struct Rings<std::tuple<M...>> {
    using Type = std::tuple<std::array<M, kRingSteps>...>;
  };
  using InputRings = typename Rings<typename Traits::Inputs>::Type;

  void Configure(const Scenario& scenario) override {
    algorithm_ = std::make_unique<Algorithm>(scenario);
    if constexpr (Traits::kStarts) gate_->Configure(scenario, run_id());
  }

  RefusalCounter Wrong(std::size_t input, Arrival& arrival) override {
    RefusalCounter wrong = nullptr;
    WithIndex<std::tuple_size_v<InputRings>>([&]<std::size_t I> {
      using M = std::tuple_element_t<I, typename Traits::Inputs>;
      if (inputs()[input].channel == IndexOf<M>()) wrong = arrival.Wrong<M>();
    });
    return wrong;
  }

  RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) override {
    RefusalCounter wrong = nullptr;
    WithIndex<std::tuple_size_v<InputRings>>([&]<std::size_t I> {
      using M = std::tuple_element_t<I, typename Traits::Inputs>;
      if (inputs()[input].channel != IndexOf<M>()) return;
      wrong = arrival.Wrong<M>();
      if (wrong == nullptr) std::get<I>(rings_)[RingSlot(step)] = *arrival.As<M>();
    });
    return wrong;
  }

  void Compute(std::int64_t step) override {
    if constexpr (Traits::kStarts) {
      if (step == 0) return Publish(step, algorithm_->Start(run_id()));
    }
    const std::size_t slot = RingSlot(step - lead_);
    Publish(step, std::apply([&](const auto&... ring)
                                 -> decltype(auto) { return algorithm_->Step(ring[slot]...); },
                             rings_));
  }

  std::unique_ptr<FireRule> MakeRule(const Scenario& scenario) override {
    if constexpr (Traits::kStarts) return std::make_unique<LeadRule>(*this, *gate_);
    return Node::MakeRule(scenario);
  }

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
  InputRings rings_;
  std::vector<std::uint8_t> encoded_;
  std::optional<LeadGate> gate_;  // of the role that begins the steps
};

}  // namespace fogline
