#include "services/runtime/transport/load_shedder.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

/// Simulates a sender with a constant rate, and a process. The process admits the messages that its
/// LoadShedder allows.
class Sender {
 public:
  explicit Sender(runtime::LoadShedder& shedder) : shedder_(shedder) {}

  /// @return admitted messages per second
  double Send(double rate_hz, double seconds) {
    const auto sent = static_cast<int>(rate_hz * seconds);
    double through = 0;
    for (int i = 0; i < sent; ++i) {
      now_ += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz));
      due_ += share_;
      if (due_ < 1) continue;
      due_ -= 1;
      ++through;
      share_ = shedder_.Count(now_).value_or(share_);
    }
    return through / seconds;
  }
  double share() const { return share_; }

 private:
  runtime::LoadShedder& shedder_;
  TimePoint now_ = Clock::now();
  double share_ = 1;
  double due_ = 0;
};

TEST(LoadShedderTest, LetsEverythingInThatIsNoFlood) {
  runtime::LoadShedder shedder(3000);
  Sender sender(shedder);
  EXPECT_NEAR(sender.Send(2400, 2), 2400, 1);
  EXPECT_EQ(sender.share(), 1);
}

TEST(LoadShedderTest, LetsInOfAFloodAboutWhatIsWelcome) {
  runtime::LoadShedder shedder(3000);
  Sender sender(shedder);
  sender.Send(20'000, 0.2);
  EXPECT_NEAR(sender.Send(20'000, 1), 3000, 0.2 * 3000);
  sender.Send(200'000, 0.2);
  EXPECT_NEAR(sender.Send(200'000, 1), 3000, 0.2 * 3000);
}

TEST(LoadShedderTest, LetsEverythingInAgainWhenItIsOver) {
  runtime::LoadShedder shedder(3000);
  Sender sender(shedder);
  sender.Send(20'000, 1);
  sender.Send(100, 1);
  EXPECT_EQ(sender.share(), 1);
}

}  // namespace
}  // namespace fogline
