// A program that shows the roles that wait for a run. It receives STATUS of unknown senders. Input:
// datagrams.
#include <nlohmann/json.hpp>

#include "services/runtime/discovery/waiting_roles.h"
#include "tests/fuzz/samples.h"
#include "tools/watch/announced.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxDatagrams = 512;
constexpr Duration kEvery = milliseconds(1);

void DemandSoundRoles(runtime::Bytes input) {
  runtime::WaitingRoles waiting;
  TimePoint now{};
  Cutter cutter(input);
  std::int64_t heard = 0;
  for (; static_cast<std::size_t>(heard) < kMaxDatagrams && !cutter.empty(); ++heard) {
    now += kEvery;
    waiting.Hear(cutter.Datagram(), now);
  }
  const std::vector<runtime::WaitingRole> roles = waiting.Current(now);
  if (!roles.empty()) Took();
  Demand(roles.size() <= runtime::WaitingRoles::kMax, "roles fill no memory");
  Demand(static_cast<std::int64_t>(roles.size()) + waiting.undecodable() <= heard,
         "a message is of one role, or is counted");
  Demand(!roles.empty() || waiting.undecodable() == heard, "no message is passed over");
  for (const runtime::WaitingRole& role : roles) {
    Demand(Printable(role.Text()) && role.Text().find('\n') == std::string::npos,
           "a role can be written to a terminal");
    Demand(role.pid > 0 && role.waiting_s >= 0, "a process waits for a time");
  }
  Demand(nlohmann::json::accept(watch::WaitingJson(roles).dump()), "the JSON text is valid JSON");
  Demand(waiting.Current(now + runtime::WaitingRoles::kGone + kEvery).empty(),
         "a silent role is gone");
}

Input Seed(const std::vector<status_t>& messages) {
  Input seed;
  for (const status_t& status : messages) AddDatagram(Encoded(status), seed);
  return seed;
}

}  // namespace

std::vector<Input> Seeds() {
  auto status = Sample<status_t>(0);
  status.header.run_id = 0;
  status.state = status_t::WAITING;
  status.pid = 4711;
  status.instance = 1;
  status.version = "0.1.0";
  status.waiting_for = "udpm://239.255.76.67:7700?ttl=1";
  status.waiting_ms = 2500;
  status_t other = status;
  other.role = "acc";
  other.instance = 2;
  ++other.type_fingerprint;
  status_t wild = status;
  wild.host = "lab\x1b[2J\n" + std::string(198, 'x') + "\xc3\xbc";
  return {Seed({status, other, status}), Seed({wild}), Seed({other, wild})};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundRoles({data, size});
  return 0;
}
