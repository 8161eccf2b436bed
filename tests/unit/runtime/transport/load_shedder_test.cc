#include "services/runtime/transport/load_shedder.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

/// Sends messages at a rate to a process that admits the share that its rate limiter allows.
class Sender {
 public:
  explicit Sender(runtime::LoadShedder& gate) : gate_(gate) {}

  /// @return messages per second that pass
  double Send(double rate_hz, double seconds) {
    const auto sent = static_cast<int>(rate_hz * seconds);
    double through = 0;
    for (int i = 0; i < sent; ++i) {
      now_ += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz));
      due_ += share_;
      if (due_ < 1) continue;
      due_ -= 1;
      ++through;
      share_ = gate_.Count(now_).value_or(share_);
    }
    return through / seconds;
  }
  double share() const { return share_; }

 private:
  runtime::LoadShedder& gate_;
  TimePoint now_ = Clock::now();
  double share_ = 1;
  double due_ = 0;
};

TEST(LoadShedderTest, LetsEverythingInThatIsNoFlood) {
  runtime::LoadShedder gate(3000);
  Sender sender(gate);
  EXPECT_NEAR(sender.Send(2400, 2), 2400, 1);
  EXPECT_EQ(sender.share(), 1);
}

TEST(LoadShedderTest, LetsInOfAFloodAboutWhatIsWelcome) {
  runtime::LoadShedder gate(3000);
  Sender sender(gate);
  sender.Send(20'000, 0.2);
  EXPECT_NEAR(sender.Send(20'000, 1), 3000, 0.2 * 3000);
  sender.Send(200'000, 0.2);
  EXPECT_NEAR(sender.Send(200'000, 1), 3000, 0.2 * 3000);
}

TEST(LoadShedderTest, LetsEverythingInAgainWhenItIsOver) {
  runtime::LoadShedder gate(3000);
  Sender sender(gate);
  sender.Send(20'000, 1);
  sender.Send(100, 1);
  EXPECT_EQ(sender.share(), 1);
}

}  // namespace
}  // namespace fogline
