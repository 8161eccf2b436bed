// Words of a command line that every verb refuses: empty texts, and file names that look like
// options.
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/verbs.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

TEST(RefusedWordsTest, RefusesAnEmptyTextForEveryOptionAndArgumentThatNamesAFileOrFolder) {
  const std::string scenario = "scenario/paper.json";
  const std::vector<std::vector<std::string>> calls{
      {"run", scenario, "--log"},
      {"run", scenario, "--key"},
      {"run", "--resume"},
      {"drive", scenario, "--log"},
      {"drive", scenario, "--evdev"},
      {"run", ""},
      {"table", scenario, "--logs"},
      {"sweep", scenario, "--out"},
      {"sweep", "--merge"},
      {"calibrate", scenario, "--free", "/fog/bias_m=0:1", "--out"},
      {"calibrate", scenario, "--free", "/fog/bias_m=0:1", "--target"},
      {"compare", "a.lcm", "a.csv", "--out"},
      {"report", "a.lcm", "--output"},
      {"report", "a.lcm", "--png"},
      {"report", "a.lcm", "--svg"},
      {"report", "a.lcm", "--pdf"},
      {"report", "--curves"},
      {"export", "a.lcm", "--out"},
      {"study", "policy", "--out"},
      {"study", "policy", "--scenarios"},
      {"digest", "a.lcm", "--key"},
      {"spy", "--jars"},
      {"spy", "--types"}};
  for (std::vector<std::string> call : calls) {
    const std::string name = call.back().empty() ? "SCENARIO" : call.back();
    if (!call.back().empty()) call.emplace_back();
    EXPECT_EQ(ErrorOf(call), fmt::format("fogline {0}: error: {1}: the text is empty (see fogline "
                                         "{0} --help)\n",
                                         call.front(), name));
  }
  for (const char* verb : {"digest", "metrics", "events", "report", "check", "keygen", "replay"}) {
    EXPECT_THAT(ErrorOf({verb, ""}), HasSubstr(": the text is empty (see "));
  }
  EXPECT_THAT(ErrorOf({"run", "--log=", scenario}), HasSubstr("--log: the text is empty"));
}

TEST(RefusedWordsTest, RefusesWhatWouldHaveNoEffect) {
  const std::string scenario = "scenario/paper.json";
  EXPECT_THAT(ErrorOf({"run", scenario, "--transport", "direct", "--restarts", "3"}),
              HasSubstr("error: --restarts: a run with --transport direct has no processes"));
  EXPECT_THAT(ErrorOf({"check", "--explain", "/fog/bias_m", "nope.json"}),
              HasSubstr("error: --explain: neither a FILE nor --set has an effect on it"));
  EXPECT_THAT(ErrorOf({"experiment", "check", "--schema", "nope.json"}),
              HasSubstr("error: --schema: a FILE has no effect on it"));
  EXPECT_THAT(ErrorOf({"sweep", scenario, "--grid", "/arbitrator/threshold=0.5", "--set",
                       "/arbitrator/threshold=0.9"}),
              HasSubstr("error: --set /arbitrator/threshold: the values are those of --grid"));
  EXPECT_THAT(ErrorOf({"sweep", scenario, "--seeds", "1:2", "--set", "/seed=7"}),
              HasSubstr("error: --set /seed: the seeds are those of --seeds"));
  EXPECT_THAT(ErrorOf({"sweep", scenario, "--grid", "/fog=1,2"}),
              HasSubstr("error: /fog: a section; `fogline check --explain /fog` lists its fields"));
}

TEST(RefusedWordsTest, NamesAFileThatWasTakenForAnOption) {
  EXPECT_EQ(ErrorOf({"digest", "-dash.lcm"}),
            "fogline digest: error: no option \"-dash.lcm\"; a file of this name is "
            "\"./-dash.lcm\" (see fogline digest --help)\n");
}

}  // namespace
}  // namespace fogline::test
