// The live input of a role: the DRIVER_INPUT messages of a seat at which a person sits.
#pragma once

#include "scenario/sections/scenario.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/seat/seat_gate.h"

namespace fogline::runtime {

/// Subscribes to DRIVER_INPUT. Messages that are refused are counted in the role's STATUS. Messages
/// that come before the role's first TRUTH have no effect.
class LiveInput {
 public:
  /// @param parts the parts of a role that has joined
  /// @throws InputError if the run is not in real time
  LiveInput(Parts& parts, const Scenario& scenario);
  LiveInput(const LiveInput&) = delete;  // the bus refers to this object
  LiveInput& operator=(const LiveInput&) = delete;

  /// The newest message of the seat that drives (SeatGate); nullptr if no seat drives. The pointer
  /// is valid until the bus is read again.
  const driver_input_t* Newest(TimePoint now) const { return gate_.Newest(now); }

 private:
  RefusalCounter Take(Arrival& arrival);

  Parts& parts_;
  SeatGate gate_;
};

}  // namespace fogline::runtime
