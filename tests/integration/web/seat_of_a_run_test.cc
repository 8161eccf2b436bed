// If the network has several runs, the seat of `fogline view` stays with its own run.
#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/integration/web/seat_network.h"

namespace fogline::test {
namespace {

/// Waits until the server has received the TRUTH of another run.
void WaitForTruthOf(WebClient& viewer, std::int64_t run_id) {
  const auto is_it = [&](const WebMessage& message) {
    return message.channel == IndexOf<truth_t>() &&
           runtime::ReadInt64(BytesOf(message.bytes), runtime::kRunIdOffset) == run_id;
  };
  while (!std::ranges::any_of(MessagesOf(ReceiveKind(viewer, 1)), is_it)) {
  }
}

constexpr std::int64_t kOtherRun = 9;

TEST_F(SeatPageTest, APersonStaysInTheRunWhenTheNetworkGetsAnotherOne) {
  WebClient viewer(port());
  WebClient page = Page(port());
  network_.SendRun(kSeatRun);
  network_.SendTruth(7);
  network_.Hear([](const driver_input_t& input) { return input.header.step == 7; });
  network_.SendTruth(7);  // otherwise the run may count as silent on a busy machine
  network_.SendRun(kOtherRun);
  network_.SendTruth(8, kOtherRun);
  WaitForTruthOf(viewer, kOtherRun);
  page.Send(Braking(0));
  EXPECT_EQ(network_.Hear(IsThere).header.run_id, kSeatRun);
}

/// A seat that is opened for one run.
class SeatOfARunTest : public SeatPageTest {
 protected:
  SeatOfARunTest() : SeatPageTest({"--run", std::to_string(kSeatRun)}) {}
};

TEST_F(SeatOfARunTest, ItsPersonDrivesInNoOtherRunAlsoIfThatRunBeginsFirst) {
  WebClient viewer(port());
  WebClient page = Page(port());
  network_.SendRun(kOtherRun);
  network_.SendTruth(8, kOtherRun);
  WaitForTruthOf(viewer, kOtherRun);
  page.Send(Braking(0));
  const driver_input_t before = network_.Hear(IsThere);
  EXPECT_EQ(before.header.run_id, kSeatRun);
  EXPECT_EQ(before.header.step, -1);
  network_.SendRun(kSeatRun);
  network_.SendTruth(3);
  network_.Hear([](const driver_input_t& input) {
    return input.header.run_id == kSeatRun && input.header.step == 3;
  });
}

}  // namespace
}  // namespace fogline::test
