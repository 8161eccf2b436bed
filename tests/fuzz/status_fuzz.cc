// What the runner does with arbitrary STATUS and RESEND messages. Input: for each message a byte,
// odd for RESEND, and a datagram.
#include <algorithm>

#include "services/runtime/conductor.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxDatagrams = 64;
constexpr Duration kLongAfter = milliseconds(60'000);

void DemandPrintable(const Conductor& conductor) {
  Demand(Printable(conductor.error()), "an error can be printed");
  Demand((conductor.phase() == Conductor::Phase::kFailed) == !conductor.error().empty(),
         "who fails says why");
  Demand(Printable(conductor.NotReady()), "who is not ready can be printed");
  const Strangers& strangers = conductor.strangers();
  Demand(strangers.known().size() <= Strangers::kMax, "strangers fill no memory");
  const std::string text = strangers.Text();
  Demand(Printable(text), "strangers can be printed");
  Demand(static_cast<std::size_t>(std::ranges::count(text, '\n')) <= Strangers::kMax,
         "a stranger takes one line");
  static_cast<void>(conductor.Refused());
}

void DemandSoundRunner(Bytes input) {
  Bus bus("memq://");
  Conductor conductor(bus, {.run_id = kRunId, .scenario_text = std::string(kScenarioText)});
  Cutter cutter(input);
  for (std::size_t i = 0; i < kMaxDatagrams && !cutter.empty(); ++i) {
    const bool resend = cutter.Byte() % 2 == 1;
    const auto& channel = resend ? ChannelOf<resend_t>() : ChannelOf<status_t>();
    bus.Publish(channel.name, cutter.Datagram());
    bus.Drain();
    conductor.Poll(Clock::now());
  }
  const bool heard = std::ranges::any_of(kRoles, [&conductor](const RoleInfo& info) {
    return conductor.member(info.role).status.has_value();
  });
  if (heard || !conductor.strangers().known().empty()) Took();
  DemandPrintable(conductor);
  conductor.Poll(Clock::now() + kLongAfter);  // nothing has moved: the runner must blame a role
  DemandPrintable(conductor);
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

  Input strangers;
  for (int i = 0; i < 3; ++i) {
    status.header.run_id = kRunId + 1 + i;
    status.host = "lab\x1b[2J";
    Add(status, strangers);
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
  return {all_ready, strangers, failed, twice};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundRunner({data, size});
  return 0;
}
