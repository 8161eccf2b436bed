#include "tools/replay/role_replay.h"

#include <exception>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/algorithm.h"
#include "services/closed_loop/algorithms.h"
#include "services/runtime/wire/refusals.h"

namespace fogline::replay {
namespace {

template <class Algorithm>
class ReplayOf final : public RoleReplay {
 public:
  ReplayOf(const log::RunLog& run, const log::DriverInputs& inputs)
      : algorithm_(run.scenario),
        run_id_(run.run_id),
        live_(Traits::UsesLiveInput(run.scenario)),
        live_inputs_(inputs),
        uses_on_demand_(Traits::UsesOnDemandInput(run.scenario)) {}

  std::optional<Difference> Step(std::int64_t step, const log::StepMessages& messages,
                                 const log::StepMessages& before) override {
    if constexpr (Traits::kStarts) {
      if (step == 0) return Compare(step, algorithm_.Start(run_id_), messages);
    }
    if constexpr (Traits::kHasLive) {
      if (live_) {
        if (messages[IndexOf<truth_t>()].empty() || messages[IndexOf<Output>()].empty()) return {};
        if (auto missing = PassLiveInput(step, messages)) return missing;
      }
    }
    WithIndex<kInputs>([&]<std::size_t I> { Read<I>(step, messages, before); });
    try {
      if constexpr (Traits::kHasOnDemand) {
        if (uses_on_demand_) PassOnDemandInput(step, messages, before);
      }
      return Compare(step, Compute(std::make_index_sequence<kInputs>{}), messages);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(
          fmt::format("step {}: {} refuses it: {}", step, NameOf(Traits::kRole), error.what()));
    }
  }

 private:
  using Traits = AlgorithmTraits<Algorithm>;
  using AllInputs = typename Traits::AllInputs;
  using Output = typename Traits::Output;
  static constexpr std::size_t kInputs = std::tuple_size_v<typename Traits::Inputs>;

  template <std::size_t N, class F>
  static void WithIndex(F&& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f.template operator()<I>(), ...); }
    (std::make_index_sequence<N>{});
  }

  /// Reads input I of a step. As in the role's process, the input comes from this step or, if its
  /// sender computes after this role, from the previous step.
  template <std::size_t I>
  void Read(std::int64_t step, const log::StepMessages& messages, const log::StepMessages& before) {
    using M = std::tuple_element_t<I, AllInputs>;
    constexpr std::int64_t kLag = LagOf(ChannelOf<M>().from, Traits::kRole);
    const runtime::Bytes bytes = (kLag == 0 ? messages : before)[IndexOf<M>()];
    if (runtime::Examine(bytes, std::get<I>(inputs_)) == nullptr) return;
    throw InputError(
        fmt::format("step {}: the {} in the log is not a message of its type, or has a value that "
                    "is not finite",
                    step - kLag, ChannelOf<M>().name));
  }

  void PassOnDemandInput(std::int64_t step, const log::StepMessages& messages,
                         const log::StepMessages& before) {
    using M = std::tuple_element_t<kInputs, AllInputs>;
    // In the first step there is no earlier message: the input is all zero (services/algorithm.h).
    if (step >= LagOf(ChannelOf<M>().from, Traits::kRole)) Read<kInputs>(step, messages, before);
    algorithm_.SetOnDemandInput(std::get<kInputs>(inputs_));
  }

  /// Passes the person's input that the logged command names. @return a difference if the log lacks
  /// this input
  std::optional<Difference> PassLiveInput(
      std::int64_t step, const log::StepMessages& messages) requires Traits::kHasLive {
    Output logged{};
    if (runtime::Examine(messages[IndexOf<Output>()], logged) != nullptr) {
      throw InputError(fmt::format("step {}: the {} in the log is not a message of its type", step,
                                   ChannelOf<Output>().name));
    }
    const driver_input_t* input = nullptr;
    if (logged.input_instance != 0) {
      input = live_inputs_.Find(logged.input_instance, logged.input_sequence);
      if (input == nullptr) {
        return Difference{.step = step,
                          .channel = std::string(ChannelOf<Output>().name),
                          .field = "input_sequence",
                          .a = fmt::format("{}", logged.input_sequence),
                          .b = "not in the log"};
      }
    }
    algorithm_.SetLiveInput(input);
    return {};
  }

  template <std::size_t... I>
  const typename Traits::Output& Compute(std::index_sequence<I...>) {
    return algorithm_.Step(std::get<I>(inputs_)...);
  }

  std::optional<Difference> Compare(std::int64_t step, const typename Traits::Output& output,
                                    const log::StepMessages& messages) {
    std::optional<Difference> first;
    const auto compare = [&]<class M>(const M& message) {
      if (first) return;
      runtime::Encode(message, encoded_);
      first = FirstDifference(IndexOf<M>(), step, messages[IndexOf<M>()], encoded_);
    };
    if constexpr (std::is_same_v<std::tuple<typename Traits::Output>, typename Traits::Outputs>) {
      compare(output);
    } else {
      std::apply([&](const auto&... message) { (compare(message), ...); }, output);
    }
    return first;
  }

  Algorithm algorithm_;
  std::int64_t run_id_;
  bool live_;  // whether a person drives
  log::DriverInputs live_inputs_;
  bool uses_on_demand_;  // whether the role reads its input on demand in this scenario
  AllInputs inputs_{};
  std::vector<std::uint8_t> encoded_;
};

}  // namespace

std::unique_ptr<RoleReplay> MakeRoleReplay(Role role, const log::RunLog& run,
                                           const log::DriverInputs& inputs) {
  std::unique_ptr<RoleReplay> replay;
  [&]<class... A>(std::type_identity<std::tuple<A...>>) {
    (
        [&] {
          if (AlgorithmTraits<A>::kRole == role)
            replay = std::make_unique<ReplayOf<A>>(run, inputs);
        }(),
        ...);
  }(std::type_identity<closed_loop::Algorithms>{});
  return replay;
}

std::string MissingChannels(Role role, const log::RunLog& run) {
  std::string names;
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    const ChannelInfo& channel = kChannels[i];
    if (channel.pace != Pace::kStep || run.channels[i]) continue;
    if (channel.from != role && !channel.to.Has(role)) continue;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", channel.name);
  }
  return names;
}

bool CanReplay(Role role, const log::RunLog& run) {
  return !run.realtime || (role == Role::kDriver && run.scenario.person.drives);
}

}  // namespace fogline::replay
