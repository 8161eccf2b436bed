// Messages that processes of a run could not send, because the kernel or a relay refused them. Such
// a message counts as lost, like a message that the network loses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fogline::runtime {

/// The failed sends of a role, over all its processes, or of the runner.
struct SendTrouble {
  std::string role;
  std::int64_t count = 0;
  std::string error;  // why the last message could not be sent
};

/// Returns a text such as "world 3, fusion 12 (Operation not permitted); lidar 1 (Network is
/// unreachable)"; "" if `troubles` is empty.
std::string Text(const std::vector<SendTrouble>& troubles);

}  // namespace fogline::runtime
