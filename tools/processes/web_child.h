// The program fogline-web as a child.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "tools/processes/child.h"

namespace fogline::processes {

/// The port in the address of a page of fogline-web, such as "7680" in "http://127.0.0.1:7680/".
/// Without an address, "0", which means any free port.
std::string PortOf(const std::string& address);

/// A fogline-web process, or none. The destructor ends the process.
class WebChild {
 public:
  WebChild() = default;
  ~WebChild() { End(); }
  WebChild(const WebChild&) = delete;
  WebChild& operator=(const WebChild&) = delete;

  /// Starts fogline-web. First ends the process that an earlier call has started.
  /// @param input stdin of fogline-web, short enough for a pipe. It is meant for secrets: other
  ///     users of this machine can read the arguments of a process, but not its stdin
  /// @throws std::runtime_error if fogline-web cannot be started
  void Start(const std::vector<std::string>& arguments, const std::string& input = "");
  /// Waits until fogline-web has printed this number of addresses. fogline-web prints them when it
  /// listens.
  /// @return false after the limit, if fogline-web ends, or if a signal asks this program to end
  bool Listens(std::size_t addresses, Duration limit);
  /// The addresses that fogline-web has printed since its start, in this order.
  std::vector<std::string> addresses() const;

  /// Whether fogline-web can still print addresses: its stdout is open.
  bool prints() const { return lines_ && !lines_->ended(); }
  /// Whether fogline-web runs. May be called while another thread waits in Listens().
  bool Runs();
  /// How fogline-web ended by itself; "" if it runs, or End() has ended it.
  const std::string& how_it_ended() const { return how_it_ended_; }
  /// Ends fogline-web with SIGTERM, and returns when it has ended. After 2 s it is killed.
  void End();
  /// Kills fogline-web. Does not wait for its end; Runs() becomes false when the process has ended.
  void Kill() const;

 private:
  pid_t pid_ = -1;
  std::optional<Pipe> output_;
  std::optional<LineReader> lines_;
  std::string how_it_ended_;
};

}  // namespace fogline::processes
