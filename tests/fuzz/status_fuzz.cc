// The runner receives arbitrary STATUS and RESEND messages. Input: for each message a byte, which
// is odd for RESEND, and a datagram.
#include <algorithm>

#include "services/runtime/coordination/run_coordinator.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxDatagrams = 64;
constexpr Duration kLongAfter = milliseconds(60'000);

void DemandPrintable(const runtime::RunCoordinator& coordinator) {
  Demand(Printable(coordinator.error()), "an error can be printed");
  Demand((coordinator.phase() == runtime::RunCoordinator::Phase::kFailed) ==
             !coordinator.error().empty(),
         "a failure has an error text");
  Demand(Printable(coordinator.NotReady()), "the roles that are not ready can be printed");
  const runtime::ForeignPeers& foreign_peers = coordinator.foreign_peers();
  Demand(foreign_peers.known().size() <= runtime::ForeignPeers::kMax,
         "foreign peers fill no memory");
  const std::string text = foreign_peers.Text();
  Demand(Printable(text), "foreign peers can be printed");
  Demand(static_cast<std::size_t>(std::ranges::count(text, '\n')) <= runtime::ForeignPeers::kMax,
         "a foreign peer takes one line");
  static_cast<void>(coordinator.Refused());
}

void DemandSoundRunner(runtime::Bytes input) {
  runtime::Bus bus("memq://");
  runtime::RunCoordinator coordinator(
      bus, {.run_id = kRunId, .scenario_text = std::string(kScenarioText)});
  Cutter cutter(input);
  for (std::size_t i = 0; i < kMaxDatagrams && !cutter.empty(); ++i) {
    const bool resend = cutter.Byte() % 2 == 1;
    const auto& channel = resend ? ChannelOf<resend_t>() : ChannelOf<status_t>();
    bus.Publish(channel.name, cutter.Datagram());
    bus.Drain();
    coordinator.Poll(Clock::now());
  }
  const bool heard = std::ranges::any_of(kRoles, [&coordinator](const RoleInfo& info) {
    return coordinator.member(info.role).status.has_value();
  });
  if (heard || !coordinator.foreign_peers().known().empty()) Took();
  DemandPrintable(coordinator);
  coordinator.Poll(Clock::now() + kLongAfter);  // no progress: the runner must name a role
  DemandPrintable(coordinator);
}

void Add(const status_t& status, Input& seed) {
  seed.push_back(0);
  AddDatagram(Encoded(status), seed);
}

}  // namespace

std::vector<Input> Seeds() {
  Input all_ready;
  auto status = Sample<status_t>(1);
  for (const RoleInfo& info : kRoles) {
    status.role = info.name;
    status.waiting_for = info.role == Role::kWorld ? "" : "TRUTH";
    Add(status, all_ready);
  }
  all_ready.push_back(1);
  AddDatagram(Encoded(Sample<resend_t>(0)), all_ready);

  Input foreign_peers;
  for (int i = 0; i < 3; ++i) {
    status.header.run_id = kRunId + 1 + i;
    status.host = "lab\x1b[2J";
    Add(status, foreign_peers);
  }
  Input failed;
  status = Sample<status_t>(1);
  status.state = status_t::FAILED;
  status.error = "no disk\x07";
  Add(status, failed);

  Input twice;
  status = Sample<status_t>(1);
  Add(status, twice);
  status.instance = 1;
  status.host = "\xff\n";
  Add(status, twice);
  return {all_ready, foreign_peers, failed, twice};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundRunner({data, size});
  return 0;
}
