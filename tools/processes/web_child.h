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

/// The port in the address of a page, such as "7680" in "http://127.0.0.1:7680/". "0", which means
/// any free port, without an address.
std::string PortOf(const std::string& address);

/// One fogline-web. The destructor ends it.
class WebChild {
 public:
  WebChild() = default;
  ~WebChild() { End(); }
  WebChild(const WebChild&) = delete;
  WebChild& operator=(const WebChild&) = delete;

  /// Starts it; one that runs is ended before.
  /// @param input what it reads from stdin, short enough for a pipe. Other users of this machine
  /// can
  ///     read the arguments of a process, but not its input
  /// @throws std::runtime_error if it cannot be started
  void Start(const std::vector<std::string>& arguments, const std::string& input = "");
  /// Waits until it has printed so many addresses, which it does when it listens.
  /// @return false after the limit, if it ends, or if a signal asks this program to end
  bool Listens(std::size_t addresses, Duration limit);
  /// The addresses that it has printed since its start, in their order.
  std::vector<std::string> addresses() const;

  /// Whether it can still print addresses: its stdout is open.
  bool prints() const { return lines_ && !lines_->ended(); }
  /// Whether it runs. May be called while another thread waits in Listens().
  bool Runs();
  /// How it ended by itself; "" if it runs, or was ended.
  const std::string& how_it_ended() const { return how_it_ended_; }
  /// Ends it with SIGTERM, and returns when it has ended. After 2 s it is killed.
  void End();
  /// Kills it, and returns at once. Runs() becomes false when it has ended.
  void Kill() const;

 private:
  pid_t pid_ = -1;
  std::optional<Pipe> output_;
  std::optional<LineReader> lines_;
  std::string how_it_ended_;
};

}  // namespace fogline::processes
