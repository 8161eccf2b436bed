#include "tools/processes/run_viewer.h"

#include <exception>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/process/signals_blocked.h"

namespace fogline::processes {
namespace {

// fogline-web listens after about 50 ms. A run waits for it no longer than this limit.
constexpr Duration kPageLimit = milliseconds(1000);
// fogline-web reads the log before it listens. The reading may take seconds, but it does not delay
// the run, because the run is over.
constexpr Duration kLogLimit = milliseconds(10'000);
constexpr Duration kLookEvery = milliseconds(50);  // interval between checks of a wait

}  // namespace

RunViewer::~RunViewer() {
  late_ = {};  // ends the thread, which uses web_, before web_ is destroyed
}

void RunViewer::ShowNetwork(const std::string& url) {
  std::vector<std::string> arguments{"--lcm-url", url};
  arguments.insert(arguments.end(), traffic_.begin(), traffic_.end());
  if (!Start(arguments) || TakeAddress(kPageLimit) || !Runs()) return;
  Complain(
      fmt::format("fogline run: warning: --view: fogline-web does not listen after {} s; the "
                  "run does not wait for it",
                  Seconds(kPageLimit)));
  TakeAddressLater();
}

void RunViewer::ShowLog(const std::filesystem::path& log) {
  if (late_.joinable()) {
    late_.request_stop();
    late_.join();
    if (address_.empty()) TakeAddress(kPageLimit);
  }
  if (!Runs()) return;
  const bool shown = !address_.empty();
  web_.End();
  if (!shown) return Say("fogline-web does not listen");
  if (!Start({log.string(), "--no-browser", "--port", PortOf(address_)})) return;
  if (TakeAddress(kLogLimit) || WasInterrupted() || !Runs()) return;
  Say("fogline-web does not listen");
  web_.End();
}

bool RunViewer::Start(const std::vector<std::string>& more) {
  try {
    web_.Start(more);
    return true;
  } catch (const std::exception& error) {
    Say(error.what());
    return false;
  }
}

bool RunViewer::TakeAddress(Duration limit) {
  if (!web_.Listens(1, limit)) return false;
  const std::string line = web_.addresses().front();
  if (line != std::exchange(address_, line)) Notice("view: " + line);
  return true;
}

/// Starts a thread that waits for the address, because the thread of the run must not wait for it.
void RunViewer::TakeAddressLater() {
  const SignalsBlocked blocked;  // only the thread of the run handles signals
  late_ = std::jthread([this](const std::stop_token& stop) {
    while (!stop.stop_requested() && !WasInterrupted() && web_.prints()) {
      if (TakeAddress(kLookEvery)) return;
    }
  });
}

void RunViewer::Say(const std::string& trouble) {
  if (std::exchange(said_, true)) return;
  Complain(fmt::format("fogline run: warning: --view: {}; the run goes on without it", trouble));
}

bool RunViewer::Runs() {
  const bool runs = web_.Runs();
  if (!runs && !web_.how_it_ended().empty()) Say("fogline-web " + web_.how_it_ended());
  return runs;
}

}  // namespace fogline::processes
