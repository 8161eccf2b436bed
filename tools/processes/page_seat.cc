#include "tools/processes/page_seat.h"

#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "services/graph.h"
#include "services/runtime/transport/bus.h"

namespace fogline::processes {
namespace {

// fogline-web listens within this time, also on a busy machine.
constexpr Duration kSeatLimit = milliseconds(10'000);
// Interval at which a wait checks whether it must end.
constexpr Duration kLook = milliseconds(50);

/// The options of a program that only receives or sends DRIVER_INPUT: the key, and no faults.
runtime::TrafficOptions OnlyKey(const runtime::TrafficOptions& traffic) {
  return {.key_file = traffic.key_file, .faults = {}};
}

}  // namespace

bool WaitForPerson(std::int64_t run_id, const std::string& url,
                   const runtime::TrafficOptions& traffic, const std::function<void()>& look) {
  const auto bus = runtime::OpenBus(url, OnlyKey(traffic), Role::kDriver);
  bool present = false;
  bus->Subscribe(ChannelOf<driver_input_t>().name, [&](runtime::Arrival& arrival) {
    const auto* input = arrival.As<driver_input_t>();
    const bool ours = input != nullptr && input->header.run_id == run_id;
    present = present || (ours && input->present);
  });
  while (!present && !WasInterrupted()) {
    bus->Wait(kLook);
    look();
  }
  return present;
}

PageSeat::PageSeat(std::int64_t run_id, const std::string& url,
                   const runtime::TrafficOptions& traffic, const std::vector<std::string>& more)
    : run_id_(run_id), url_(url), traffic_(OnlyKey(traffic)) {
  std::vector<std::string> arguments{"--seat", "--run", std::to_string(run_id), "--lcm-url", url};
  for (const std::string& argument : runtime::ToArguments(traffic_)) arguments.push_back(argument);
  arguments.insert(arguments.end(), more.begin(), more.end());
  web_.Start(arguments);
  if (!web_.Listens(2, kSeatLimit)) {
    if (WasInterrupted()) throw Interrupted("interrupted before the page could be opened");
    throw std::runtime_error("fogline-web does not listen, so no person can drive at a page");
  }
  drive_address_ = web_.addresses()[0];
  view_address_ = web_.addresses()[1];
}

bool PageSeat::WaitForPerson() {
  return processes::WaitForPerson(run_id_, url_, traffic_, [this] {
    if (!Runs()) throw std::runtime_error("the page is gone, so no person can drive");
  });
}

bool PageSeat::Runs() {
  const bool runs = web_.Runs();
  if (!runs && !std::exchange(told_, true)) {
    Complain("fogline-web " + web_.how_it_ended() + "; no person can drive any more");
  }
  return runs;
}

}  // namespace fogline::processes
