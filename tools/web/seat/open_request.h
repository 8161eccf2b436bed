// The request to take over that is open in a run, found in its HOST_COMMANDs.
#pragma once

#include <cstdint>
#include <optional>

#include "fogline/arbitration_t.hpp"

namespace fogline::web {

/// Follows the request of a run. Some commands may be missing, and the first command may be of any
/// step.
class OpenRequest {
 public:
  struct Request {
    std::int64_t since_us = 0;  // utime of the first command of the request
    // Whether the request began at since_us. If not, it may have begun earlier: earlier commands
    // are missing, or emergency braking has hidden the state.
    bool begin_known = false;
  };

  /// Takes a command of the shown run. Older commands of this run are ignored.
  /// @return whether a request has begun
  bool Hear(const arbitration_t& command) {
    const header_t& header = command.header;
    if (run_id_ != header.run_id) Forget();
    run_id_ = header.run_id;
    if (header.step == 0) Forget();  // the run begins, or is played again
    if (header.step <= step_) return false;
    step_ = header.step;
    if (command.mode == arbitration_t::EMERGENCY_BRAKING) return false;
    const bool follows = header.step - state_step_ <= 1 || header.utime - state_us_ <= kMostGap_us;
    state_step_ = header.step;
    state_us_ = header.utime;
    if (!Asks(command.mode)) request_.reset();
    if (!Asks(command.mode) || request_) return false;
    request_ = Request{.since_us = header.utime, .begin_known = follows};
    return true;
  }

  /// The open request; nullopt if no request is open.
  const std::optional<Request>& request() const { return request_; }

 private:
  /// If the command before a request is missing, the request may have begun earlier. But if the
  /// last known command is older than the request by at most this time, the beginning counts as
  /// known. Our choice: a fifth of a second, because the countdown shows whole seconds.
  static constexpr std::int64_t kMostGap_us = 200'000;

  static bool Asks(std::int8_t mode) {
    return mode == arbitration_t::REQUEST || mode == arbitration_t::REQUEST_URGENT ||
           mode == arbitration_t::HANDOVER;
  }

  void Forget() {
    const auto run_id = run_id_;
    *this = {};
    run_id_ = run_id;
  }

  std::optional<std::int64_t> run_id_;
  std::int64_t step_ = -1;
  // The newest step and time at which the state was known. Before the first command, they are step
  // -1 and time 0, as at the start of a run.
  std::int64_t state_step_ = -1;
  std::int64_t state_us_ = 0;
  std::optional<Request> request_;
};

}  // namespace fogline::web
