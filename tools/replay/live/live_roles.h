// The roles of a live replay: each recorded role has a thread and an LCM instance of its own, in
// the process of the runner.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/replay/live/recorded_node.h"

namespace fogline::replay {

class LiveRoles {
 public:
  /// @param messages must outlive this object
  /// @param realtime whether the run is in real time. If so, the threads ask the kernel for the
  ///     priority that the processes of roles have in real time
  LiveRoles(const RecordedMessages& messages, runtime::TrafficOptions traffic, bool realtime);
  /// Ends the threads.
  ~LiveRoles();
  LiveRoles(const LiveRoles&) = delete;
  LiveRoles& operator=(const LiveRoles&) = delete;

  /// The roles whose messages are recorded, in the order of kRoles.
  std::vector<Role> roles() const;
  /// Lets all these roles join a run. @throws like runtime::Bus()
  void Join(std::int64_t run_id, const std::string& url);

 private:
  struct Part {
    std::unique_ptr<runtime::Bus> bus;
    std::unique_ptr<RecordedNode> node;
    std::thread thread;
  };
  /// The function of a thread: takes part in the run until its end.
  void TakePart(Part& part) const;

  const RecordedMessages& messages_;
  runtime::TrafficOptions traffic_;
  bool realtime_;
  std::atomic<bool> over_ = false;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace fogline::replay
