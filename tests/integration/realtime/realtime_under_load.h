// Real time while other programs use all cores: no message is missed, and no process needs more and
// more memory.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <list>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "services/log/event_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"

namespace fogline::test {

/// One busy program for each core. The programs end with the lifetime of this object, or after 20
/// minutes.
class Load {
 public:
  Load() {
    for (unsigned core = 0; core < std::max(2U, std::thread::hardware_concurrency()); ++core) {
      busy_.emplace_back(
          std::vector<std::string>{"timeout", "1200", "sh", "-c", "while :; do :; done"});
    }
  }

 private:
  std::list<Background> busy_;
};

/// The resident memory of every role during a run, by role, from the STATUS of the role.
inline std::map<std::string, std::vector<std::int64_t>> MemoryIn(const std::string& log) {
  std::map<std::string, std::vector<std::int64_t>> memory;
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    status_t status{};
    if (event->channel != ChannelOf<status_t>().name || !runtime::Decode(event->data, status))
      continue;
    if (status.state == status_t::RUNNING) memory[status.role].push_back(status.rss_bytes);
  }
  return memory;
}

/// Milliseconds of processor time that the hypervisor has taken from this machine since the machine
/// started.
inline std::int64_t StolenMs() {
  std::ifstream stat("/proc/stat");
  std::string cpu;
  std::int64_t ticks = 0;
  stat >> cpu;
  for (int column = 0; column < 8; ++column) stat >> ticks;  // columns user to softirq, then steal
  return ticks * 1000 / sysconf(_SC_CLK_TCK);
}

/// Expects that a run in real time under load misses no message.
/// @param rate_hz steps per second
inline void ExpectRunUnderLoadMissesNothing(int rate_hz, double seconds) {
  const int steps = static_cast<int>(seconds * rate_hz);
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Load load;
  const std::int64_t stolen_before_ms = StolenMs();
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--json",
                                  "--realtime", "--set", "/steps=" + std::to_string(steps), "--set",
                                  "/step_s=" + std::to_string(1.0 / rate_hz), "--log", log},
                                 std::chrono::seconds(static_cast<int>(seconds) + 60));
  ASSERT_EQ(run.code, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto realtime = result["realtime"];
  std::cout << realtime.dump(2) << "\n";
  EXPECT_EQ(realtime["ticks"], steps);
  EXPECT_EQ(realtime["missed_messages"], 0)
      << "the hypervisor took the processors away for " << StolenMs() - stolen_before_ms << " ms";
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  EXPECT_EQ(result["refused"]["out_of_window"], 0)
      << "a message names a step that cannot be under way";
  EXPECT_TRUE(realtime["ticks_late"].is_number());
  EXPECT_GT(realtime["latency_p99_us"], 0);

  const auto memory = MemoryIn(log);
  EXPECT_EQ(memory.size(), kRoles.size());
  for (const auto& [role, bytes] : memory) {
    // After bytes[first] the memory may still grow by kFlat. At bytes[first] a role has used all of
    // its code and data. But LCM's ring of received datagrams (200 KiB) may have pages that the
    // role has not used yet.
    constexpr std::int64_t kFlat = 512 * 1024;
    const std::size_t first = std::max<std::size_t>(10, bytes.size() / 10);
    ASSERT_GT(bytes.size(), first + 1) << role;
    std::cout << role << ": " << bytes[first] << " to " << bytes.back() << " bytes\n";
    EXPECT_LE(bytes.back() - bytes[first], kFlat) << role;
  }
}

}  // namespace fogline::test
