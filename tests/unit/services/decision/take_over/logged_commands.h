// Commands of the host, for tests of TakeOverLog.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "services/decision/take_over/take_over_log.h"
#include "services/host_modes.h"

namespace fogline::test {

inline arbitration_t Command(std::int64_t step, std::int8_t mode, double acceleration_mps2 = 0) {
  arbitration_t command{};
  command.header.step = step;
  command.header.utime = step * 100'000;
  command.mode = mode;
  command.acceleration_mps2 = acceleration_mps2;
  command.lambda_human = HumanDrives(mode) ? 1 : 0;
  return command;
}

/// A command in which the human has the authority `lambda_human`.
inline arbitration_t Shared(std::int64_t step, std::int8_t mode, double lambda_human,
                            double acceleration_mps2 = 0) {
  arbitration_t command = Command(step, mode, acceleration_mps2);
  command.lambda_human = lambda_human;
  return command;
}

/// Adds a command of the automation alone, or of the human alone. The acceleration that the human
/// offers equals the command.
inline void Add(take_over::TakeOverLog& log, const arbitration_t& command) {
  log.Add(command, command.acceleration_mps2);
}

inline std::vector<std::int64_t> Transfers(const take_over::TakeOverLog& log) {
  std::vector<std::int64_t> steps;
  for (const take_over::TakeOverEntry& entry : log.entries()) {
    if (entry.transfer) steps.push_back(entry.step);
  }
  return steps;
}

inline std::vector<std::string_view> Texts(const take_over::TakeOverLog& log) {
  std::vector<std::string_view> texts;
  for (const take_over::TakeOverEntry& entry : log.entries()) texts.push_back(entry.logged);
  return texts;
}

/// A command of emergency braking, or of its warning.
inline arbitration_t Emergency(std::int64_t step, std::int8_t mode, double lambda_human = 0) {
  arbitration_t command = Command(step, mode, -9);
  command.lambda_human = lambda_human;
  return command;
}

}  // namespace fogline::test
