// What an algorithm's Step function says about its role: the types of its inputs and outputs, and
// from these, by the graph table, its channels and the role itself.
#pragma once

#include <concepts>
#include <tuple>
#include <type_traits>

#include "scenario/scenario.h"
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

/// The types of kGraph's kStep channels that go to a role are exactly those of the tuple.
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

}  // namespace internal

/// Traits of an algorithm: a class with a constructor from a Scenario and one function
/// `const Output& Step(const Input&...)`, where Output is a message or a tuple of messages.
template <class A>
struct AlgorithmTraits {
  using Signature = internal::StepSignature<decltype(&A::Step)>;
  using Inputs = typename Signature::Inputs;
  using Output = typename Signature::Output;
  using Outputs = typename Signature::Outputs;

  static constexpr Role kRole = ChannelOf<std::tuple_element_t<0, Outputs>>().from;
  /// An algorithm with Start() makes step 0 from nothing and each further step from the one before.
  static constexpr bool kStarts = requires(A a) { a.Start(std::int64_t{}); };

  static_assert(std::constructible_from<A, const Scenario&>);
  static_assert(internal::Reads(kRole, std::type_identity<Inputs>{}),
                "the inputs of Step are not the channels that kGraph sends to this role");
  static_assert(internal::Writes(kRole, std::type_identity<Outputs>{}),
                "the outputs of Step are not the channels that kGraph expects from this role");
};

}  // namespace fogline
