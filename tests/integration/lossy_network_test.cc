// The lockstep on networks that lose, repeat and reorder datagrams: slower, and the same result.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"

namespace fogline::test {
namespace {

/// A run with every process on such a network; chances in per cent.
nlohmann::json RunOn(const std::string& chances, const std::string& log) {
  const std::string library = (ProgramDirectory() / "../lib/libfogline_lossy_network.so").string();
  const Outcome outcome =
      RunCommand({"env", "LD_PRELOAD=" + library, "FOGLINE_TEST_NETWORK=" + chances,
                  Program("fogline"), "run", "scenario/paper.json", "--json", "--quiet", "--log",
                  log, "--set", "/steps=250", "--stall-timeout", "30"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out, nullptr, false);
}

TEST(LossyNetworkTest, ChangesNoResult) {
  const ScratchFolder folder;
  const nlohmann::json good = RunOn("0,0,0", folder.File("good.lcm"));
  // Loss alone; repetition and another order alone; all of it at once.
  for (const std::string chances : {"10,0,0", "0,20,20", "30,10,10"}) {
    const nlohmann::json bad = RunOn(chances, folder.File(chances + ".lcm"));
    EXPECT_EQ(bad["digest"], good["digest"]) << chances;
    EXPECT_EQ(bad["steps"], 250) << chances;
    if (chances != "0,20,20") {
      EXPECT_GT(bad["repairs"], 100) << chances << ": was anything lost?";
    }
  }
}

}  // namespace
}  // namespace fogline::test
