// Finds the inputs and outputs of an algorithm from the types of its Step function. The graph table
// (graph.h) then gives the channels and the role of the algorithm.
//
// An algorithm may have one input in addition to the inputs of Step: an input on demand. The
// algorithm uses this input only in some scenarios. An algorithm with an input on demand has these
// two functions.
//
//     static bool UsesOnDemandInput(const Scenario& scenario);  // whether the input is used
//     void SetOnDemandInput(const M& message);                  // called before each Step, if used
//
// M is the message of the same step if the producer of M comes before this role in the order of
// evaluation. If the producer comes after this role, M is the message of the previous step. At step
// 0 all fields of this message are zero. In real time the role does not wait for M:
// SetOnDemandInput gets the newest M that has come. SetOnDemandInput is not called before the first
// M has come.
//
// An algorithm may have a live input: the actions of a person. No role computes this input. An
// algorithm with a live input has these two functions.
//
//     static bool UsesLiveInput(const Scenario& scenario);  // whether the input is used
//     void SetLiveInput(const driver_input_t* input);       // called before each Step, if used
//
// Only a run in real time has a live input. SetLiveInput gets the newest message, or nullptr if no
// person is there (services/runtime/seat/seat_gate.h). The output of the algorithm contains the
// instance and the sequence number of this message, so a replay can find the message in the log.
//
// Every algorithm except the arbitrator can be copied. The copy continues the run from the same
// step. In some scenarios, the copies of an algorithm may share a part of their state. Such an
// algorithm has this function, which returns true for these scenarios.
//
//     static bool CopiesShareState(const Scenario& scenario);
//
// The role that begins the steps (the world) has a function Start(run_id) for step 0. This role may
// also have a function Prepare(). Prepare() does the slow part of step 0 before the role reports
// that it is ready.
#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include "scenario/sections/scenario.h"
#include "services/graph.h"

namespace fogline {

namespace internal {

template <class T>
struct AsTuple {
  using Type = std::tuple<T>;
};
template <class... T>
struct AsTuple<std::tuple<T...>> {
  using Type = std::tuple<T...>;
};

template <class StepFunction>
struct StepSignature;
template <class A, class Out, class... In>
struct StepSignature<const Out& (A::*)(const In&...)> {
  using Inputs = std::tuple<In...>;
  using Output = Out;
  using Outputs = typename AsTuple<Out>::Type;
};

template <class SetFunction>
struct OnDemandSignature;
template <class A, class M>
struct OnDemandSignature<void (A::*)(const M&)> {
  using Inputs = std::tuple<M>;
};

template <class A>
struct OnDemandInputs {
  using Type = std::tuple<>;
};
template <class A>
requires requires { &A::SetOnDemandInput; }
struct OnDemandInputs<A> {
  using Type = typename OnDemandSignature<decltype(&A::SetOnDemandInput)>::Inputs;
};

template <class A>
concept HasLiveInput = requires(A a, const driver_input_t* input) {
  a.SetLiveInput(input);
};

/// Whether the tuple has exactly the types of the kStep channels that kGraph sends to the role.
template <class... In>
constexpr bool Reads(Role role, std::type_identity<std::tuple<In...>>) {
  bool exact = true;
  ForEachStepChannel([&]<class M>(std::size_t i) {
    exact = exact && kChannels[i].to.Has(role) == (std::is_same_v<M, In> || ...);
  });
  return exact;
}

template <class... Out>
constexpr bool Writes(Role role, std::type_identity<std::tuple<Out...>>) {
  bool exact = true;
  ForEachStepChannel([&]<class M>(std::size_t i) {
    exact = exact && (kChannels[i].from == role) == (std::is_same_v<M, Out> || ...);
  });
  return exact;
}

/// Whether kGraph lets a role read messages of these types as its input on demand (see the top of
/// this file).
template <class... In>
constexpr bool MayReadOnDemand([[maybe_unused]] Role role, std::type_identity<std::tuple<In...>>) {
  return (ChannelOf<In>().on_demand.Has(role) && ...);
}

}  // namespace internal

/// Traits of an algorithm. An algorithm is a class with a constructor from a Scenario and one
/// function `const Output& Step(const Input&...)`, where Output is a message or a tuple of
/// messages.
template <class A>
struct AlgorithmTraits {
  using Signature = internal::StepSignature<decltype(&A::Step)>;
  using Inputs = typename Signature::Inputs;
  using Output = typename Signature::Output;
  using Outputs = typename Signature::Outputs;

  /// A tuple with the type of the input on demand (see the top of this file); an empty tuple if the
  /// algorithm has no such input.
  using OnDemand = typename internal::OnDemandInputs<A>::Type;
  static constexpr bool kHasOnDemand = std::tuple_size_v<OnDemand> != 0;
  /// The types of all messages that the algorithm can read: first the types of the inputs of Step,
  /// then the type of the input on demand.
  using AllInputs = decltype(std::tuple_cat(std::declval<Inputs>(), std::declval<OnDemand>()));

  static constexpr Role kRole = ChannelOf<std::tuple_element_t<0, Outputs>>().from;
  /// Whether the role begins the steps. Start() then computes step 0 without inputs. Each later
  /// step uses messages of the previous step.
  static constexpr bool kStarts = requires(A a) { a.Start(std::int64_t{}); };

  /// Whether the algorithm reads its input on demand in this scenario; false if it has no such
  /// input.
  static bool UsesOnDemandInput([[maybe_unused]] const Scenario& scenario) {
    if constexpr (kHasOnDemand) {
      return A::UsesOnDemandInput(scenario);
    } else {
      return false;
    }
  }

  /// Whether a copy of the algorithm shares a part of its state with the original in this scenario.
  /// If it does, only one of the two objects may continue the run.
  static bool CopiesShareState([[maybe_unused]] const Scenario& scenario) {
    if constexpr (requires { A::CopiesShareState(scenario); }) {
      return A::CopiesShareState(scenario);
    } else {
      return false;
    }
  }

  /// Whether the algorithm can read a live input: the actions of a person.
  static constexpr bool kHasLive = internal::HasLiveInput<A>;

  /// Whether the algorithm reads its live input in this scenario.
  static bool UsesLiveInput([[maybe_unused]] const Scenario& scenario) {
    if constexpr (kHasLive) {
      return A::UsesLiveInput(scenario);
    } else {
      return false;
    }
  }

  static_assert(std::constructible_from<A, const Scenario&>);
  static_assert(internal::Reads(kRole, std::type_identity<Inputs>{}),
                "the inputs of Step are not the channels that kGraph sends to this role; see its "
                "rows in services/graph.h");
  static_assert(internal::Writes(kRole, std::type_identity<Outputs>{}),
                "the outputs of Step are not the channels that kGraph expects from this role; see "
                "its rows in services/graph.h");
  // The check goes in one direction only: kGraph may allow an input on demand that this algorithm
  // does not have.
  static_assert(internal::MayReadOnDemand(kRole, std::type_identity<OnDemand>{}),
                "kGraph does not let this role read the message of SetOnDemandInput on demand");
  static_assert(
      kHasOnDemand == requires(const Scenario& scenario) { A::UsesOnDemandInput(scenario); },
      "UsesOnDemandInput and SetOnDemandInput are only of use together");
  static_assert(!(kHasOnDemand && kStarts),
                "the role that begins the steps has no input on demand");
};

}  // namespace fogline
