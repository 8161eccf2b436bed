#include "services/closed_loop/closed_loop.h"

namespace fogline::closed_loop {

ClosedLoop::ClosedLoop(const Scenario& scenario)
    : person_(scenario.person.drives), roles_(Roles::Make(scenario)) {}

void ClosedLoop::Restart(const Scenario& scenario) {
  person_ = scenario.person.drives;
  std::apply([&scenario](auto&... role) { (role.Restart(scenario), ...); }, roles_);
}

}  // namespace fogline::closed_loop
