// The participant's page of `fogline drive`: fogline-web with a seat, as a child. The destructor
// ends it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/processes/web_child.h"

namespace fogline::processes {

/// Waits until a person at a seat of this run is ready to drive.
/// @param look is called again and again while it waits
/// @return false if the user has interrupted this program
/// @throws what `look` throws
bool WaitForPerson(std::int64_t run_id, const std::string& url,
                   const runtime::TrafficOptions& traffic, const std::function<void()>& look);

class PageSeat {
 public:
  /// Starts the page of this run on this network. Returns when it can be opened.
  /// @param more arguments of fogline-web, such as --listen ADDRESS
  /// @throws std::runtime_error if there is no page; Interrupted
  PageSeat(std::int64_t run_id, const std::string& url, const runtime::TrafficOptions& traffic,
           const std::vector<std::string>& more);

  /// The address of the participant's page, and that of the page for those who look.
  const std::string& drive_address() const { return drive_address_; }
  const std::string& view_address() const { return view_address_; }

  /// Waits until a person at the page is ready to drive.
  /// @return false if the user has interrupted this program
  /// @throws std::runtime_error if fogline-web ends
  bool WaitForPerson();
  /// Whether fogline-web runs. It ends by itself only if it fails; that is said once.
  bool Runs();

 private:
  std::int64_t run_id_;
  std::string url_;
  runtime::TrafficOptions traffic_;
  WebChild web_;
  bool told_ = false;  // that fogline-web has ended
  std::string drive_address_;
  std::string view_address_;
};

}  // namespace fogline::processes
