#include "services/closed_loop/closed_loop.h"

#include <bit>
#include <string>
#include <type_traits>
#include <utility>

#include "common/errors.h"

namespace fogline::closed_loop {
namespace {

/// Computes a role's messages of a step from the newest messages. @return the messages
template <class A>
const auto& StepOf(A& algorithm, bool uses_on_demand, const Messages& messages) {
  using Traits = AlgorithmTraits<A>;
  if constexpr (Traits::kHasOnDemand) {
    using M = std::tuple_element_t<0, typename Traits::OnDemand>;
    if (uses_on_demand) algorithm.SetOnDemandInput(messages.Get<M>());
  }
  return [&]<class... In>(std::type_identity<std::tuple<In...>>) -> const auto& {
    return algorithm.Step(messages.Get<In>()...);
  }
  (std::type_identity<typename Traits::Inputs>{});
}

}  // namespace

ClosedLoop::ClosedLoop(const Scenario& scenario)
    : person_(scenario.person.drives), roles_(Roles::Make(scenario)) {}

void ClosedLoop::Restart(const Scenario& scenario) {
  person_ = scenario.person.drives;
  std::apply([&scenario](auto&... role) { (role.Restart(scenario), ...); }, roles_);
}

void ClosedLoop::RestartArbitrator(const Scenario& scenario) {
  std::get<kArbitrator>(roles_).Restart(scenario);
}

template <std::size_t kBegin, std::size_t kEnd>
void ClosedLoop::ComputeRoles() {
  [this]<std::size_t... I>(std::index_sequence<I...>) {
    const auto compute = [this](auto& role) {
      messages_.Put(StepOf(role.algorithm, role.uses_on_demand, messages_));
    };
    (compute(std::get<kBegin + I>(roles_)), ...);
  }
  (std::make_index_sequence<kEnd - kBegin>{});
}

void ClosedLoop::Begin(std::int64_t run_id) {
  if (person_) throw InputError(std::string(kPersonNeedsRealtime));
  messages_ = Messages();
  messages_.Put(First().Start(run_id));
}

void ClosedLoop::End() { First().End(); }

void ClosedLoop::ComputeBeforeArbitrator() { ComputeRoles<1, kArbitrator>(); }

void ClosedLoop::ComputeAfterArbitrator() {
  messages_.Put(*command_);
  ComputeRoles<kArbitrator + 1, kNumRoles>();
}

bool ClosedLoop::Advance() {
  if (messages_.Get<truth_t>().last) return false;
  ComputeRoles<0, 1>();
  return true;
}

void ClosedLoop::ArbitrateFor(const ClosedLoop& shared) {
  auto& arbitrator = std::get<kArbitrator>(roles_);
  command_ = &StepOf(arbitrator.algorithm, arbitrator.uses_on_demand, shared.messages_);
}

bool ClosedLoop::CommandsAs(const ClosedLoop& other) const {
  // The world reads only the acceleration of HOST_COMMAND, and the driver only the mode. So the
  // other fields may differ.
  return std::bit_cast<std::uint64_t>(command_->acceleration_mps2) ==
             std::bit_cast<std::uint64_t>(other.command_->acceleration_mps2) &&
         command_->mode == other.command_->mode;
}

void ClosedLoop::LeaveFrom(const ClosedLoop& shared) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto copy = [&]<std::size_t Place>(std::integral_constant<std::size_t, Place>) {
      if constexpr (Place != kArbitrator) {
        std::get<Place>(roles_) = std::get<Place>(shared.roles_);
      }
    };
    (copy(std::integral_constant<std::size_t, I>{}), ...);
  }
  (std::make_index_sequence<kNumRoles>{});
  ForEachStepChannel([&]<class M>(std::size_t /*channel*/) {
    std::get<M>(copies_) = shared.messages_.Get<M>();
    messages_.Put(std::get<M>(copies_));
  });
}

}  // namespace fogline::closed_loop
