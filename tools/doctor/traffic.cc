// Examines other processes on the network: runs, and roles that wait for a run.
#include <algorithm>
#include <set>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "common/text.h"
#include "services/runtime/discovery/beacon.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/lcm_url.h"
#include "tools/doctor/doctor_findings.h"
#include "tools/watch/traffic_statistics.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;

std::string DescribeRun(const watch::RunView& run) {
  std::string text = fmt::format("run {} at step {}", run.run_id, run.step);
  for (const watch::RoleView& role : run.roles) {
    text += fmt::format("{} {} {}@{}", &role == run.roles.data() ? ":" : ",",
                        Printable(role.status.role), role.status.pid, Printable(role.status.host));
  }
  return text;
}

void ReportAnnounced(const std::string& url, const runtime::BeaconListener& beacons,
                     Findings& findings) {
  for (const runtime::Announcement& run : beacons.Runs()) {
    findings.push_back({"announced_runs", Level::kOk, run.Text(), ""});
  }
  if (beacons.refused() > 0) {
    findings.push_back({"announced_runs", Level::kWarning,
                        fmt::format("on {}: {} announcements were refused, because no run of this "
                                    "machine can have made them",
                                    url, beacons.refused()),
                        "use another port for runs of your own"});
  }
}

void ReportWaiting(const runtime::WaitingRoles& waiting, Findings& findings) {
  for (const runtime::WaitingRole& role : waiting.Current(Clock::now())) {
    findings.push_back({"waiting_roles", role.same_types ? Level::kOk : Level::kProblem,
                        role.Text(), role.same_types ? "" : "use the same build on every machine"});
  }
  if (waiting.undecodable() > 0) {
    findings.push_back(
        {"waiting_roles", Level::kProblem,
         fmt::format("{} messages of waiting roles cannot be decoded: their programs "
                     "have other message types",
                     waiting.undecodable()),
         "use the same build on every machine"});
  }
}

/// Reports machines whose messages arrive here, although the URL has ttl=0. With ttl=0 no message
/// leaves this machine, so the other machines do not hear this machine.
void ExamineReach(const std::string& url, const watch::TrafficView& view,
                  const runtime::WaitingRoles& waiting, Findings& findings) {
  const auto address = runtime::ParseMulticastUrl(url);
  if (!address || address->ttl > 0) return;
  std::set<std::string> others;
  for (const watch::RunView& run : view.runs) {
    for (const watch::RoleView& role : run.roles) others.insert(Printable(role.status.host));
  }
  for (const runtime::WaitingRole& role : waiting.Current(Clock::now())) others.insert(role.host);
  others.erase(Printable(HostName()));
  for (const std::string& host : others) {
    findings.push_back(
        {"ttl", Level::kProblem,
         fmt::format("messages of {} come here, but with ttl=0 {} never hears this "
                     "machine",
                     host, host),
         fmt::format("use udpm://{}:{}?ttl=1 on every machine", address->group, address->port)});
  }
}

}  // namespace

void ExamineTraffic(const std::string& url, Findings& findings) {
  constexpr Duration kListen = milliseconds(1000);
  constexpr Duration kLookEvery = milliseconds(20);
  runtime::Bus bus(url);
  runtime::BeaconListener beacons(url);
  const TimePoint end = Clock::now() + kListen;
  watch::TrafficStatistics statistics(Clock::now());
  runtime::WaitingRoles waiting;
  bus.SubscribeAll([&](std::string_view channel, runtime::Bytes bytes) {
    const TimePoint now = Clock::now();
    if (channel == runtime::kWaitingChannel) waiting.Hear(bytes, now);
    if (!watch::IsHousekeeping(channel)) statistics.Add(channel, bytes, now);
  });
  for (TimePoint now = Clock::now(); now < end; now = Clock::now()) {
    bus.Wait(std::min(end - now, kLookEvery));
    beacons.Look();
  }
  ReportAnnounced(url, beacons, findings);
  ReportWaiting(waiting, findings);
  const watch::TrafficView view = statistics.Observe(Clock::now());
  for (const watch::RunView& run : view.runs) {
    findings.push_back(
        {"other_runs", Level::kOk, fmt::format("on {}: {}", url, DescribeRun(run)), ""});
  }
  for (const watch::ChannelView& other : view.others) {
    findings.push_back({"other_runs", Level::kWarning,
                        fmt::format("on {}: {} messages on channel {} belong to no run", url,
                                    other.arrivals.messages, Printable(other.channel)),
                        "fogline top shows more; use another port for runs of your own"});
  }
  if (view.runs.empty() && view.others.empty()) {
    findings.push_back({"other_runs", Level::kOk, fmt::format("no traffic on {}", url), ""});
  }
  ExamineReach(url, view, waiting, findings);
}

}  // namespace fogline::doctor
