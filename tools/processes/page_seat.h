// The page on which a person drives (`fogline drive`). A child process shows the page: fogline-web
// with a seat. The destructor ends the child.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "services/runtime/transport/traffic_options.h"
#include "tools/processes/web_child.h"

namespace fogline::processes {

/// Waits until a person at a seat of this run is ready to drive.
/// @param look is called again and again during the wait
/// @return false if the user has interrupted this program
/// @throws the exceptions of `look`
bool WaitForPerson(std::int64_t run_id, const std::string& url,
                   const runtime::TrafficOptions& traffic, const std::function<void()>& look);

class PageSeat {
 public:
  /// Starts fogline-web for this run on this network. Returns when the page can be opened.
  /// @param more arguments of fogline-web, such as --listen ADDRESS
  /// @throws std::runtime_error if fogline-web cannot show the page; Interrupted if the user
  ///     interrupts this program
  PageSeat(std::int64_t run_id, const std::string& url, const runtime::TrafficOptions& traffic,
           const std::vector<std::string>& more);

  /// The addresses of the participant's page, and of the page for people who only watch.
  const std::string& drive_address() const { return drive_address_; }
  const std::string& view_address() const { return view_address_; }

  /// Waits until a person at the page is ready to drive.
  /// @return false if the user has interrupted this program
  /// @throws std::runtime_error if fogline-web ends
  bool WaitForPerson();
  /// Whether fogline-web runs. It ends by itself only if it fails. The first call after such an end
  /// prints an error.
  bool Runs();

 private:
  std::int64_t run_id_;
  std::string url_;
  runtime::TrafficOptions traffic_;
  WebChild web_;
  bool told_ = false;  // whether the end of fogline-web was reported
  std::string drive_address_;
  std::string view_address_;
};

}  // namespace fogline::processes
