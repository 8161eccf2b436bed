// A fixture for tests of logs that lack messages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/event_log.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"

namespace fogline::test {

/// Makes copies of the log of a run. The copies lack some messages.
class GapTest : public testing::Test {
 protected:
  /// @param setting of the run, such as "/seed=2"
  explicit GapTest(const std::string& setting = "/seed=1") {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                    "direct", "--quiet", "--set", setting, "--log", whole_});
    EXPECT_EQ(run.code, 0) << run.err;
  }

  /// A copy of whole_ without the seal, and without the messages for which `lost` returns true.
  std::string Without(const std::function<bool(std::string_view channel, std::int64_t step)>& lost,
                      const std::string& name = "gaps.lcm") const {
    const std::string copy = folder_.File(name);
    log::EventLogReader reader(whole_);
    log::EventLogWriter writer(copy);
    while (const auto event = reader.Next()) {
      const std::int64_t step = runtime::ReadInt64(event->data, runtime::kStepOffset);
      if (event->channel == "FOGLINE_SEAL" || lost(event->channel, step)) continue;
      writer.Write(event->channel, event->utime, event->data);
    }
    return copy;
  }
  std::string WithoutOne(const std::string& channel) const {
    return Without(
        [&](std::string_view of, std::int64_t step) { return of == channel && step == 394; });
  }

  static Outcome Fogline(const std::vector<std::string>& words) {
    std::vector<std::string> command{Program("fogline")};
    command.insert(command.end(), words.begin(), words.end());
    return RunCommand(command);
  }
  static nlohmann::json Json(const std::vector<std::string>& words, int code) {
    std::vector<std::string> command = words;
    command.emplace_back("--json");
    const Outcome outcome = Fogline(command);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }

  const ScratchFolder folder_;
  std::string whole_ = folder_.File("whole.lcm");
};

}  // namespace fogline::test
