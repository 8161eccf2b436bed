// Who drives which following car: as the scenario says, or drawn by its seed.
#pragma once

#include <cstddef>

#include "scenario/scenario.h"
#include "services/follower_models/style.h"

namespace fogline {

/// One who drives.
struct Part {
  bool has_acc = true;
  Style style = Style::kNormal;  // of a person
};

/// Who drives this following car, counted from 0 from behind the host. What is drawn is drawn for
/// each car by itself: more cars, or other parameters of one of them, change no other.
Part PartOf(const Scenario& scenario, std::size_t car);

}  // namespace fogline
