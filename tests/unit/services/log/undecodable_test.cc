#include "services/log/undecodable.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace fogline {
namespace {

TEST(UndecodableTest, IsTheFirstMessageThatDoesNotDecodeInTheOrderOfTheGraph) {
  std::vector<std::uint8_t> truth;
  std::vector<std::uint8_t> radar;
  std::vector<std::uint8_t> lidar;
  runtime::Encode(truth_t{}, truth);
  runtime::Encode(radar_t{}, radar);
  runtime::Encode(lidar_t{}, lidar);
  // A message that is missing does not count as a message that does not decode.
  log::StepMessages messages{};
  messages[IndexOf<truth_t>()] = truth;
  messages[IndexOf<radar_t>()] = radar;
  messages[IndexOf<lidar_t>()] = lidar;
  EXPECT_EQ(log::FirstUndecodable(messages), "");
  messages[IndexOf<lidar_t>()] = runtime::Bytes(lidar).first(lidar.size() - 1);
  EXPECT_EQ(log::FirstUndecodable(messages), "LIDAR");
  radar[0] ^= 1;  // the fingerprint of the type
  EXPECT_EQ(log::FirstUndecodable(messages), "RADAR");
  EXPECT_EQ(log::DoesNotDecode("step 4 of RADAR"),
            "step 4 of RADAR does not decode: was it altered, or recorded with other message "
            "types?");
}

}  // namespace
}  // namespace fogline
