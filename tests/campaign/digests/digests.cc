// Prints the digest of every shipped scenario with every fog model, in lines such as "paper none
// 63a1...".
#include <cstdio>

#include "tests/property/services/closed_loop/shipped.h"

int main() {
  using namespace fogline;
  for (auto& [name, scenario] : test::ShippedScenarios(FOGLINE_SOURCE_DIR "/scenario")) {
    for (std::size_t fog = 0; fog < ChoiceNames<FogModel>::kNames.size(); ++fog) {
      scenario.fog.model = static_cast<FogModel>(fog);
      closed_loop::ClosedLoop loop(scenario);
      std::printf("%s %s %s\n", name.c_str(), ChoiceNames<FogModel>::kNames[fog].data(),
                  test::DigestOf(loop).c_str());
    }
  }
}
