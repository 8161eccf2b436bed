// The events of a run as a data recorder would keep them (UN R157, 8: DSSAD), from what every log
// has: the commands of the host. Not only of runs whose driver must be asked: every change of mode.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fogline/arbitration_t.hpp"
#include "services/arbitrator/take_over_request.h"

namespace fogline {

/// How the state of a mode of HOST_COMMAND is called; "UNKNOWN" for a mode that is none.
std::string_view NameOfMode(std::int8_t mode);

/// What happened in a step. Where only a driver's input became effective the mode stays.
struct TakeOverEntry {
  std::int64_t step = 0;
  std::int64_t utime = 0;
  std::int8_t from = 0;  // modes
  std::int8_t to = 0;
  std::string_view logged;
};

/// Reads commands in the order of steps; some may be missing.
class TakeOverLog {
 public:
  void Add(const arbitration_t& command);

  const std::vector<TakeOverEntry>& entries() const { return entries_; }
  const std::vector<TakeOverRequest>& requests() const { return requests_; }

 private:
  void Change(const arbitration_t& command);
  void Drive(const arbitration_t& command);

  std::optional<arbitration_t> last_;
  // Of the driver who has the wheel: the command before he got it, until he has changed it.
  std::optional<double> before_transfer_mps2_;
  std::vector<TakeOverEntry> entries_;
  std::vector<TakeOverRequest> requests_;
};

}  // namespace fogline
