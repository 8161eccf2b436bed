// The page of a run that `fogline run --view` shows: fogline-web as a child. If fogline-web fails,
// the run goes on without the page, and the reason is printed once. The destructor ends
// fogline-web.
#pragma once

#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "tools/processes/web_child.h"

namespace fogline::processes {

class RunViewer {
 public:
  /// @param traffic arguments for fogline-web: --key, if the run has a key
  explicit RunViewer(std::vector<std::string> traffic) : traffic_(std::move(traffic)) {}
  ~RunViewer();
  RunViewer(const RunViewer&) = delete;
  RunViewer& operator=(const RunViewer&) = delete;

  /// Shows the run on this network. Returns when the page can be opened, so the page shows the run
  /// from its beginning. If fogline-web does not listen within a second, prints a warning and
  /// returns. The address is then printed as soon as fogline-web listens.
  void ShowNetwork(const std::string& url);
  /// Shows a log in place of the network, at the same address. Open pages connect again. Does
  /// nothing if the page of the network could not be shown.
  void ShowLog(const std::filesystem::path& log);
  /// Whether fogline-web runs. It ends by itself only if it fails.
  bool Runs();

 private:
  /// @param more the arguments of fogline-web that say what it shows, and at which port
  /// @return false if fogline-web cannot be started
  bool Start(const std::vector<std::string>& more);
  /// Waits for the address, and prints it. @return false if no address comes within the limit
  bool TakeAddress(Duration limit);
  void TakeAddressLater();
  void Say(const std::string& trouble);

  std::vector<std::string> traffic_;
  WebChild web_;
  std::string address_;  // "http://127.0.0.1:7680/"; "": nothing was shown
  bool said_ = false;    // whether the user was told that there is no page
  std::jthread late_;    // waits for an address that comes after the limit
};

}  // namespace fogline::processes
