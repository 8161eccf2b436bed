// A program that looks for runs receives beacons of unknown senders. Input: datagrams.
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "services/runtime/discovery/announcements.h"
#include "services/runtime/transport/lcm_url.h"
#include "tests/fuzz/samples.h"
#include "tools/watch/announced.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxDatagrams = 512;
constexpr const char* kHost = "lab1";
constexpr std::int64_t kNow_us = 1'700'000'000'000'000;

void DemandSoundRuns(runtime::Bytes input) {
  runtime::Announcements announcements(kHost);
  TimePoint now{};
  Cutter cutter(input);
  std::int64_t heard = 0;
  for (; static_cast<std::size_t>(heard) < kMaxDatagrams && !cutter.empty(); ++heard) {
    now += milliseconds(1);
    announcements.Hear(cutter.Datagram(), now, kNow_us);
  }
  const std::vector<runtime::Announcement> runs = announcements.Current(now);
  if (!runs.empty()) Took();
  Demand(runs.size() <= runtime::Announcements::kMax, "runs fill no memory");
  Demand(static_cast<std::int64_t>(runs.size()) + announcements.refused() <= heard,
         "a beacon is taken or refused");
  for (const runtime::Announcement& run : runs) {
    Demand(runtime::MayBeAnnounced(run.url), "a program may go where a run is said to be");
    Demand(Printable(run.Text()) && run.Text().find('\n') == std::string::npos,
           "a run can be written to a terminal");
    Demand(IsUtf8(run.scenario) && run.host == kHost, "a title is text, of this machine");
    Demand(run.awaited.size() <= kRoles.size(), "a role is waited for once");
  }
  for (const watch::Line& line : watch::AnnouncedLines(runs, true)) {
    Demand(Printable(line.text), "a line can be written to a terminal");
  }
  Demand(nlohmann::json::accept(watch::AnnouncedJson(runs, true).dump()),
         "the JSON text is valid JSON");
}

Input Seed(const std::vector<beacon_t>& beacons) {
  Input seed;
  for (const beacon_t& beacon : beacons) AddDatagram(Encoded(beacon), seed);
  return seed;
}

}  // namespace

std::vector<Input> Seeds() {
  beacon_t beacon{};
  beacon.header.run_id = kRunId;
  beacon.began_us = kNow_us;
  beacon.url = "udpm://239.255.76.67:7700?ttl=0&recv_buf_size=2097152";
  beacon.scenario = "fog \xc3\xbc";
  beacon.host = kHost;
  beacon.pid = 4711;
  beacon.awaited = {"driver", "acc"};
  beacon.num_awaited = 2;
  beacon_t relayed = beacon;
  relayed.header.run_id = kRunId + 1;
  relayed.url = "tcpq://127.0.0.1:7700";
  beacon_t over = beacon;
  over.over = 1;
  beacon_t bad = beacon;
  bad.scenario = "\x1b[2J";
  return {Seed({beacon, relayed, beacon}), Seed({relayed, beacon, over}), Seed({bad, relayed})};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundRuns({data, size});
  return 0;
}
