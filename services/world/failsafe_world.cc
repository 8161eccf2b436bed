#include "services/world/failsafe_world.h"

#include "fogline/status_t.hpp"

namespace fogline::world {

void FailsafeWorld::Resume(const truth_t& truth, std::int8_t minimal_risk) {
  world_.Resume(truth);
  if ((minimal_risk & status_t::HOST) != 0) vehicles_.ResumeHost(truth);
  if ((minimal_risk & status_t::FOLLOWER) != 0) vehicles_.ResumeFollowers(truth);
}

const FailsafeWorld::Output& FailsafeWorld::Step(const WorldInputs& inputs) {
  vehicles_.Step(world_.truth(), inputs.host, inputs.followers);
  Describe(inputs);
  return world_.Step(vehicles_.host(), vehicles_.followers());
}

std::int8_t FailsafeWorld::minimal_risk() const {
  std::int8_t cars = 0;
  if (vehicles_.host_in_minimal_risk()) cars |= status_t::HOST;
  if (vehicles_.follower_in_minimal_risk()) cars |= status_t::FOLLOWER;
  return cars;
}

void FailsafeWorld::Describe(const WorldInputs& inputs) {
  fallback_.clear();
  const auto add = [this](const char* text) {
    fallback_ += fallback_.empty() ? "" : "; ";
    fallback_ += text;
  };
  if (vehicles_.host_stops_by_itself()) {
    add("minimal risk manoeuvre of the host");
  } else if (inputs.host.state == InputState::kStale) {
    add("the host's last command holds");
  }
  if (vehicles_.follower_in_minimal_risk()) {
    add("minimal risk manoeuvre of the follower");
  } else if (vehicles_.follower_state() == InputState::kStale) {
    add("the follower's last command holds");
  }
}

}  // namespace fogline::world
