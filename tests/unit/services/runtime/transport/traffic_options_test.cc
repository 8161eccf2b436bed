#include "services/runtime/transport/traffic_options.h"

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline::runtime {
namespace {

// LCM cannot open a network with this address.
constexpr const char* kNoNetwork = "udpm://no.such.address:7700?ttl=0";

std::string ErrorOfOpening(const std::string& url, const TrafficOptions& options) {
  return test::ErrorOf([&] { OpenBus(url, options, Role::kRadar); });
}

TEST(TrafficOptionsTest, AreCheckedBeforeTheNetworkIsOpened) {
  const test::ScratchFolder folder;
  const std::string key = folder.File("key");
  EXPECT_EQ(ErrorOfOpening(kNoNetwork, {.key_file = key, .faults = ""}).rfind(key, 0), 0U);
  SigningKey::Create(key);
  EXPECT_EQ(ErrorOfOpening(kNoNetwork, {.key_file = "", .faults = "nonsense=1"})
                .rfind("error: --faults: ", 0),
            0U);
  EXPECT_EQ(ErrorOfOpening("mpudpm://239.255.76.67:7700?ttl=0", {.key_file = key, .faults = ""}),
            "error: --key: mpudpm has no filter, so every message reaches LCM's parser; use udpm");
  const std::string of_network =
      ErrorOfOpening(kNoNetwork, {.key_file = key, .faults = "loss=0.1"});
  EXPECT_NE(of_network.find("no.such.address"), std::string::npos) << of_network;
}

}  // namespace
}  // namespace fogline::runtime
