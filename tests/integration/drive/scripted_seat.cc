// A seat whose person acts by a script, for tests. The seat joins the first run whose TRUTH it
// receives.
//
//     scripted_seat URL "0 0.3 0 1 1; 2.5 0 0.8 0 1"
//
// Each part of the script has five numbers: the time from which on the part holds, in s since the
// first TRUTH; the throttle; the brake; the buttons (bits of driver_input_t); 1 if a person is
// present.
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/interrupt.h"
#include "services/graph.h"
#include "services/runtime/transport/bus.h"
#include "tools/drive/seat.h"

namespace fogline::drive {
namespace {

struct Act {
  double from_s = 0;
  PedalState state;
};

std::vector<Act> ParseScript(const std::string& script) {
  std::vector<Act> acts;
  std::istringstream parts(script);
  for (std::string part; std::getline(parts, part, ';');) {
    std::istringstream numbers(part);
    Act act;
    int present = 1;
    numbers >> act.from_s >> act.state.throttle >> act.state.brake >> act.state.buttons >> present;
    if (!numbers) throw std::invalid_argument("script: " + part);
    act.state.present = present != 0;
    acts.push_back(act);
  }
  return acts;
}

class Script final : public PedalSource {
 public:
  explicit Script(std::vector<Act> acts) : acts_(std::move(acts)) {}

  PedalState Read(TimePoint now) override {
    PedalState state{.axes = {}};
    for (const Act& act : acts_) {
      if (Seconds(now - begin_) >= act.from_s) state = act.state;
    }
    state.at = now;
    return state;
  }
  int fd() const override { return -1; }
  std::int8_t kind() const override { return driver_input_t::EVDEV; }
  std::string name() const override { return "script"; }

 private:
  std::vector<Act> acts_;
  TimePoint begin_ = Clock::now();
};

std::optional<std::int64_t> WaitForRun(const std::string& url) {
  runtime::Bus bus(url);
  std::optional<std::int64_t> run_id;
  bus.Subscribe(ChannelOf<truth_t>().name, [&](runtime::Arrival& arrival) {
    if (const auto* truth = arrival.As<truth_t>()) run_id = truth->header.run_id;
  });
  while (!run_id && !WasInterrupted()) bus.Wait(milliseconds(20));
  return run_id;
}

}  // namespace
}  // namespace fogline::drive

int main(int argc, char** argv) {
  using namespace fogline;
  if (argc != 3) return 2;
  const std::vector<drive::Act> acts = drive::ParseScript(argv[2]);
  WatchInterrupts();
  const auto run_id = drive::WaitForRun(argv[1]);
  if (!run_id) return 0;
  const drive::Seat seat(argv[1], *run_id, {}, std::make_unique<drive::Script>(acts));
  // The seat sends in a thread of its own. This thread waits for the signal that ends the program.
  while (!WasInterrupted()) std::this_thread::sleep_for(milliseconds(20));
  return 0;
}
