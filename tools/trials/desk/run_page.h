// The pages of fogline-web for a run: the view for the experimenter and, if the participant drives,
// the seat. fogline-web is a child, at the same addresses for all runs of a session, unless another
// program takes a port that nobody has chosen. If it dies, it is started again, after a pause that
// grows; the run and the session go on without it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/clock.h"
#include "tools/processes/web_child.h"

namespace fogline::trials {

struct RunPageOptions {
  std::string address = "127.0.0.1";  // IPv4 in numbers, at which fogline-web listens
  std::uint16_t port = 0;            // 0: any free port, the same one for all runs if it stays free
  std::vector<std::string> traffic;  // the options --key for fogline-web
};

class RunPage {
 public:
  enum class Seat { kNone, kOpen };
  enum class Change { kNone, kDied, kIsBack };

  explicit RunPage(RunPageOptions options);

  /// Shows this run on this network, and returns when the pages can be opened.
  /// @throws Interrupted; std::runtime_error if there is no seat. A run can do without its view,
  /// but
  ///     not without the person who drives
  void Show(std::int64_t run_id, const std::string& url, Seat seat);
  /// Starts fogline-web again if it has died. Call it now and then while the run goes on.
  Change Look();
  /// Why no fogline-web can be expected any more; "" if there is one, or the next start may help.
  std::string WhyHopeless() const;
  void End();

  /// The addresses with their tokens; "" if there is no such page.
  const std::string& view_address() const { return view_address_; }
  const std::string& seat_address() const { return seat_address_; }

 private:
  enum class State { kNoRun, kStarting, kListening, kPausing };

  void Start();
  /// Starts it, and waits until it listens. @return false if that was in vain @throws Interrupted
  bool Comes();
  /// The start was in vain. Says so at the first time.
  void Fail(const std::string& how);
  /// Takes the addresses that fogline-web prints. @return whether it listens
  bool TakeAddresses(Duration limit);

  const RunPageOptions options_;
  std::uint16_t port_;  // of the next start
  // They stay the same, so a page that was open connects again after fogline-web has died.
  const std::string view_token_;
  const std::string seat_token_;
  std::int64_t run_id_ = 0;
  std::string url_;  // of the network
  Seat seat_ = Seat::kNone;
  std::string view_address_;
  std::string seat_address_;
  processes::WebChild web_;
  State state_ = State::kNoRun;
  int failed_ = 0;         // starts in a row that were in vain
  TimePoint listen_by_{};  // kStarting
  TimePoint start_at_{};   // kPausing
};

}  // namespace fogline::trials
