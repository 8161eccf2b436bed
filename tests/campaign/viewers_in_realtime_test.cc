// Viewers do not disturb a run in real time.
#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include <nlohmann/json.hpp>

#include "services/runtime/transport/bus.h"
#include "tests/integration/web/viewed.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

/// Reads all frames of the server until End().
class Reader {
 public:
  explicit Reader(std::uint16_t port)
      : client_(port), thread_([this](const std::stop_token& stop) {
          try {
            while (!stop.stop_requested()) {
              if (KindOf(client_.Receive()) == 1) ++frames_;
            }
          } catch (const std::exception&) {  // closed: too few frames are counted
          }
        }) {}

  /// Stops the reader. @return the number of frames with messages that have come
  std::int64_t End() {
    thread_.request_stop();
    thread_.join();
    return frames_;
  }

 private:
  WebClient client_;
  std::int64_t frames_ = 0;
  std::jthread thread_;
};

/// The number of deadlines that a run of one minute at 100 Hz misses.
/// @param viewers the number of viewers
std::int64_t MissedWith(int viewers) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  EXPECT_NE(viewed.port(), 0) << viewed.process().Err();
  std::vector<std::unique_ptr<Reader>> readers;
  for (int i = 0; i < viewers; ++i) readers.push_back(std::make_unique<Reader>(viewed.port()));
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime",
                                  "--set", "/step_s=0.01", "--set", "/steps=6000", "--lcm-url", url,
                                  "--log", folder.File("run.lcm"), "--json", "--quiet"});
  EXPECT_EQ(run.code, 0) << run.err;
  for (const auto& reader : readers) {
    EXPECT_GT(reader->End(), 1000);
  }
  EXPECT_EQ(viewed.End(), 0);
  return nlohmann::json::parse(run.out)["realtime"]["deadline_misses"];
}

TEST(ViewersInRealtimeTest, TwentyViewersCostNoDeadline) {
  // If a run without viewers also misses deadlines, the machine has disturbed the attempt.
  constexpr int kAttempts = 5;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::int64_t before = MissedWith(0);
    const std::int64_t with = MissedWith(20);
    if (with == 0) return;
    if (MissedWith(0) + before > 0) continue;
    FAIL() << with << " deadlines missed with 20 viewers, none without";
  }
  MachineLacks("time: it misses deadlines without viewers, too");
}

}  // namespace
}  // namespace fogline::test
