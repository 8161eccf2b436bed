// The view of a run for the experimenter: fogline-web as a child, on the same port for all runs of
// a session. If it dies, it is started again; the run and the session go on without it.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "tools/processes/child.h"

namespace fogline::trials {

class RunPage {
 public:
  /// @param traffic the option --key and its file, for fogline-web; empty if there is no key
  explicit RunPage(std::vector<std::string> traffic) : traffic_(std::move(traffic)) {}
  ~RunPage();
  RunPage(const RunPage&) = delete;
  RunPage& operator=(const RunPage&) = delete;

  /// Shows the run on this network. @return the address; "" if there is no page
  const std::string& Show(const std::string& url);
  /// Starts fogline-web again if it has died. Call it now and then while the run goes on.
  /// @return whether it had died
  bool Look();
  void End();

 private:
  void Start(bool wait);

  std::vector<std::string> traffic_;
  std::string url_;
  std::string address_;
  std::optional<processes::Pipe> output_;  // of fogline-web
  pid_t pid_ = -1;
  TimePoint start_at_{};  // not before
};

}  // namespace fogline::trials
