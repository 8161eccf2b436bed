#include "services/runtime/discovery/run_seeker.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/process/this_process.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"

namespace fogline {
namespace {

/// A run that announces itself at a meeting address of this test.
class RunSeekerTest : public testing::Test {
 protected:
  void Announce(const std::vector<std::string>& awaited) {
    beacon_t beacon{};
    beacon.header.run_id = 7;
    beacon.began_us = 1;
    beacon.url = "udpm://239.255.76.67:7700?ttl=0";
    beacon.host = HostName();
    beacon.pid = getpid();
    beacon.awaited = awaited;
    beacon.num_awaited = static_cast<std::int32_t>(awaited.size());
    std::vector<std::uint8_t> bytes;
    runtime::Encode(beacon, bytes);
    runner_.Publish(runtime::kBeaconChannel, bytes);
  }

  /// Announces the run until the driver's seeker returns it. @return whether the seeker returned
  /// this run
  bool Finds(TimePoint now) {
    for (int tries = 0; tries < 2000; ++tries) {
      Announce({"driver"});
      if (const auto run = driver_.Look(now)) return run->run_id == 7;
      runner_.Wait(milliseconds(10));
    }
    return false;
  }

  std::string meeting_ = runtime::FreshMulticastUrl();
  runtime::Bus runner_{meeting_};
  runtime::RunSeeker driver_{Role::kDriver, meeting_};
  TimePoint begin_ = Clock::now();
};

TEST_F(RunSeekerTest, FindsTheRunOfItsRoleAgainIfItIsResumedOnAnotherNetwork) {
  driver_.Ignore(7, "udpm://239.255.76.67:7701?ttl=0");
  EXPECT_TRUE(Finds(begin_));
}

// The test gives the seeker times in steps of 0.4 s. The seeker would regard a longer step as a
// pause of its own process.
TEST_F(RunSeekerTest, TriesARunAgainSomeSecondsAfterItWasInVain) {
  // GIVEN a seeker that has tried a run without success
  ASSERT_TRUE(Finds(begin_));
  driver_.GiveUp(begin_);
  EXPECT_FALSE(driver_.Tries());
  // WHEN the run still waits, THEN the seeker ignores the run for five seconds, and then tries it
  // again
  TimePoint now = begin_;
  for (; now < begin_ + std::chrono::seconds(5); now += milliseconds(400)) {
    Announce({"driver"});
    EXPECT_FALSE(driver_.Look(now)) << (now - begin_).count();
  }
  EXPECT_TRUE(Finds(now));
}

TEST_F(RunSeekerTest, TriesARunAgainAtOnceWhenItsPlaceWasTakenAndLeft) {
  // GIVEN a seeker that has tried a run without success at `begin_`
  ASSERT_TRUE(Finds(begin_));
  driver_.GiveUp(begin_);
  // WHEN the run waits only for another role, and then for the driver again
  bool found = false;
  for (int tries = 0; !found && tries < 1000; ++tries) {
    Announce({tries % 2 == 0 ? "acc" : "driver"});
    runner_.Wait(milliseconds(10));
    found = driver_.Look(begin_).has_value();
  }
  // THEN the seeker tries the run again at time `begin_`, without a pause
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace fogline
