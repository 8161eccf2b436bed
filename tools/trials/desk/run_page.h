// The pages of fogline-web for a run: the view for the experimenter and, if the participant drives,
// the seat. fogline-web is a child process. It has the same addresses in all runs of a session. The
// exception is a port that the system chose: if another program has taken this port, the system
// chooses another one. If fogline-web ends too early, it is started again after a pause, which
// grows with each failure. Meanwhile the run and the session continue.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/clock.h"
#include "tools/processes/web_child.h"

namespace fogline::trials {

struct RunPageOptions {
  std::string address = "127.0.0.1";  // numeric IPv4 address on which fogline-web listens
  std::uint16_t port = 0;             // 0: any free port; the same port for all runs, if possible
  std::vector<std::string> traffic;   // the option --key for fogline-web, if there is a key
};

class RunPage {
 public:
  enum class Seat { kNone, kOpen };
  enum class Change { kNone, kDied, kIsBack };

  explicit RunPage(RunPageOptions options);

  /// Shows this run on this network, and returns when the pages can be opened. If they cannot be
  /// opened, a run without a seat continues without its view.
  /// @throws Interrupted; std::runtime_error if the pages cannot be opened, and the run has a seat
  void Show(std::int64_t run_id, const std::string& url, Seat seat);
  /// Starts fogline-web again if it has ended. Call this function regularly during the run.
  Change Look();
  /// The reason why further starts of fogline-web would probably fail, too; "" if fogline-web runs,
  /// or if the next start may succeed.
  std::string WhyHopeless() const;
  void End();

  /// The addresses with their tokens; "" if the page does not exist.
  const std::string& view_address() const { return view_address_; }
  const std::string& seat_address() const { return seat_address_; }

 private:
  enum class State { kNoRun, kStarting, kListening, kPausing };

  void Start();
  /// Starts fogline-web, and waits until it listens. @return whether it listens @throws Interrupted
  bool Comes();
  /// Handles a failed start. Prints a warning only for the first of several successive failures.
  void Fail(const std::string& how);
  /// Takes the addresses that fogline-web prints. @return whether it listens
  bool TakeAddresses(Duration limit);

  const RunPageOptions options_;
  std::uint16_t port_;  // port of the next start
  // The tokens stay the same. So an open page can connect again after a restart of fogline-web.
  const std::string view_token_;
  const std::string seat_token_;
  std::int64_t run_id_ = 0;
  std::string url_;  // URL of the network
  Seat seat_ = Seat::kNone;
  std::string view_address_;
  std::string seat_address_;
  processes::WebChild web_;
  State state_ = State::kNoRun;
  int failed_ = 0;         // number of failed starts in a row
  TimePoint listen_by_{};  // in kStarting: the time limit of the start
  TimePoint start_at_{};   // in kPausing: the time of the next start
};

}  // namespace fogline::trials
