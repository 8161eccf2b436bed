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

/// What happened in a step. Where only a driver's input became effective, or a ramp of the
/// authorities passed the half, the mode stays.
struct TakeOverEntry {
  std::int64_t step = 0;
  std::int64_t utime = 0;
  std::int8_t from = 0;  // modes
  std::int8_t to = 0;
  bool transfer = false;  // the main authority went to or from the driver, as measures count it
  std::string_view logged;
};

/// Reads commands in the order of steps; some may be missing.
///
/// A state tells whether the driver has been given a share of the wheel, lambda_H how large it is:
/// it may be small, 0 even, and it may be growing. So his getting a share is one thing, and the
/// transfer another, where lambda_H passes kMainAuthority. Where one step does both one entry says
/// so. His input is effective by what it does to the command, lambda_H (a_H - a), a the command
/// before he got his share: what the automation does with the rest is not his.
class TakeOverLog {
 public:
  /// @param human_mps2 a_H, the driver's offer; nullopt if that is not known
  void Add(const arbitration_t& command, std::optional<double> human_mps2);

  const std::vector<TakeOverEntry>& entries() const { return entries_; }
  const std::vector<TakeOverRequest>& requests() const { return requests_; }

 private:
  void Change(const arbitration_t& command, std::int8_t from, bool transfer);
  void Transfer(const arbitration_t& command);
  void Drive(const arbitration_t& command, double human_mps2);

  std::optional<arbitration_t> last_;
  // Of the driver who has a share of the wheel: the command before he got it, until he has changed
  // it; and whether he was asked.
  std::optional<double> before_share_mps2_;
  bool asked_ = false;
  std::vector<TakeOverEntry> entries_;
  std::vector<TakeOverRequest> requests_;
};

}  // namespace fogline
