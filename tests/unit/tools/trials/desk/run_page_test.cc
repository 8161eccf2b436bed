#include "tools/trials/desk/run_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/children.h"
#include "tests/support/command.h"
#include "tests/unit/tools/trials/desk/taken_port.h"

namespace fogline::trials {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

constexpr std::int64_t kRunId = 4711;

class RunPageTest : public ::testing::Test {
 protected:
  /// Kills fogline-web, the only child of this process.
  static void Kill() {
    const std::vector<pid_t> children = test::ChildrenOf(getpid());
    ASSERT_EQ(children.size(), 1U);
    test::SignalOne(children.front(), SIGKILL);
  }
  /// The next change; kNone if no change comes in time.
  static RunPage::Change NextChange(RunPage& page) {
    const TimePoint end = Clock::now() + test::kPatience;
    while (Clock::now() < end && page.WhyHopeless().empty()) {
      if (const auto change = page.Look(); change != RunPage::Change::kNone) return change;
      std::this_thread::sleep_for(test::kLookEvery);
    }
    return RunPage::Change::kNone;
  }
  static std::uint16_t PortOf(const std::string& address) {
    return static_cast<std::uint16_t>(std::stoi(processes::PortOf(address)));
  }

  const std::string url_ = runtime::FreshMulticastUrl();
};

TEST_F(RunPageTest, HasTheAddressesOfARunUntilItsEnd) {
  RunPage page({});
  page.Show(kRunId, url_, RunPage::Seat::kOpen);
  const std::string seat = page.seat_address();
  const std::string view = page.view_address();
  EXPECT_THAT(seat, MatchesRegex("http://127.0.0.1:[0-9]+/drive#token=[0-9a-f]+"));
  EXPECT_THAT(view, MatchesRegex("http://127.0.0.1:[0-9]+/#token=[0-9a-f]+"));
  page.End();
  EXPECT_EQ(page.seat_address() + page.view_address(), "");
  EXPECT_EQ(page.Look(), RunPage::Change::kNone);
  page.Show(kRunId, url_, RunPage::Seat::kNone);
  EXPECT_EQ(page.seat_address(), "");
  EXPECT_EQ(page.view_address(), view) << "the same for all runs";
}

TEST_F(RunPageTest, IsBackAtTheSameAddressesAfterAKill) {
  RunPage page({});
  page.Show(kRunId, url_, RunPage::Seat::kOpen);
  const std::string seat = page.seat_address();
  Kill();
  EXPECT_EQ(NextChange(page), RunPage::Change::kDied);
  EXPECT_EQ(NextChange(page), RunPage::Change::kIsBack);
  EXPECT_EQ(page.seat_address(), seat);
}

TEST_F(RunPageTest, MovesIfAnotherProgramTakesAPortThatNobodyHasChosen) {
  RunPage page({});
  page.Show(kRunId, url_, RunPage::Seat::kOpen);
  const std::uint16_t port = PortOf(page.seat_address());
  page.End();
  test::TakenPort taken(port);
  ASSERT_TRUE(taken.Take());
  page.Show(kRunId, url_, RunPage::Seat::kOpen);
  EXPECT_NE(PortOf(page.seat_address()), port);
}

TEST_F(RunPageTest, WithoutAPortThereIsNoSeatAndNoAddress) {
  test::TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  RunPage page({.port = taken.port(), .traffic = {}});
  EXPECT_THROW(page.Show(kRunId, url_, RunPage::Seat::kOpen), std::runtime_error);
  EXPECT_EQ(page.seat_address() + page.view_address(), "");
  // A run can go on without its view. The view is started as soon as this is possible.
  EXPECT_NO_THROW(page.Show(kRunId, url_, RunPage::Seat::kNone));
}

TEST_F(RunPageTest, IsHopelessAfterSomeStartsInVainWithGrowingPauses) {
  test::TakenPort taken(0);
  ASSERT_TRUE(taken.Take());
  RunPage page({.port = taken.port(), .traffic = {}});
  page.Show(kRunId, url_, RunPage::Seat::kNone);
  const TimePoint begin = Clock::now();
  EXPECT_EQ(NextChange(page), RunPage::Change::kNone);
  EXPECT_THAT(page.WhyHopeless(), HasSubstr("started 5 times in vain"));
  EXPECT_GT(Clock::now() - begin, milliseconds(7000)) << "the pauses grow";
}

}  // namespace
}  // namespace fogline::trials
