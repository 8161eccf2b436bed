#include "tools/calibrate/target.h"

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

class TargetTest : public testing::Test {
 protected:
  std::vector<calibrate::TargetRow> Read(const std::string& text) const {
    std::ofstream(file_) << text;
    return calibrate::ReadTarget(file_);
  }
  // The error text for a file, without the name of the file.
  std::string ErrorOf(const std::string& text) const {
    std::string what = test::ErrorOf([&] { Read(text); });
    for (std::size_t at = 0; (at = what.find(file_)) != std::string::npos;) {
      what.erase(at, file_.size());
    }
    return what;
  }

 private:
  test::ScratchFolder folder_;
  const std::string file_ = folder_.File("table.json");
};

TEST_F(TargetTest, IsATableAsPrinted) {
  const auto target = Read(R"({"scenario": "x.json", "rows": [
      {"threshold": 0.5, "si_pct": 80.79, "rhe_pct": 0, "si_std_pct": 1, "si_seeds": 20}]})");
  ASSERT_EQ(target.size(), 1U);
  EXPECT_EQ(target[0].threshold, 0.5);
  EXPECT_EQ(target[0].si_pct, 80.79);
  EXPECT_EQ(target[0].rhe_pct, 0);
}

TEST_F(TargetTest, PassesOverANumberThatIsNotThere) {
  const auto target = Read(R"({"rows": [{"threshold": 0.5, "si_pct": null, "rhe_pct": 3}]})");
  EXPECT_EQ(target[0].si_pct, std::nullopt);
  EXPECT_EQ(target[0].rhe_pct, 3);
  EXPECT_EQ(Read(R"({"rows": [{"threshold": 1, "si_pct": 3}]})")[0].rhe_pct, std::nullopt);
}

TEST_F(TargetTest, NamesEveryMistakeWithItsPlace) {
  EXPECT_EQ(ErrorOf("{\"rows\": [\n"
                    "  {\"threshold\": 1.5, \"si_pct\": 101},\n"
                    "  {\"si_pct\": 1},\n"
                    "  {\"threshold\": 0.5, \"rhe_pct\": \"0\"}]}"),
            ":2:17: error: /rows/0/threshold: 1.5 is outside [0, 1]\n"
            ":2:32: error: /rows/0/si_pct: 101 is outside [-1000, 100] %\n"
            ":3:3: error: /rows/1: must be an object with a number \"threshold\"\n"
            ":4:33: error: /rows/2/rhe_pct: must be a number in [0, 100] %, not the text \"0\"");
}

TEST_F(TargetTest, NeedsRows) {
  constexpr const char* kNeeds =
      ": error: /rows: a target needs a list of rows, each with threshold, si_pct and rhe_pct";
  EXPECT_EQ(ErrorOf("[]"), std::string(":1:1") + kNeeds);
  EXPECT_EQ(ErrorOf("{}"), std::string(":1:1") + kNeeds);
  EXPECT_EQ(ErrorOf(R"({"rows": []})"), std::string(":1:10") + kNeeds);
  EXPECT_EQ(ErrorOf(R"({"rows": [{"threshold": 0.5}]})"),
            ": error: /rows: no row has si_pct or rhe_pct");
}

TEST_F(TargetTest, NeedsAFile) {
  EXPECT_EQ(test::ErrorOf([] { calibrate::ReadTarget("/nowhere/table.json"); }),
            "/nowhere/table.json: error: --target: cannot be read: No such file or directory");
}

TEST_F(TargetTest, CanBeThePublishedRows) {
  Scenario scenario;
  scenario.published = {{.threshold = 0.8, .si_pct = 10.23, .rhe_pct = 0}};
  const auto target = calibrate::PublishedTarget(scenario);
  ASSERT_EQ(target.size(), 1U);
  EXPECT_EQ(target[0].threshold, 0.8);
  EXPECT_EQ(target[0].si_pct, 10.23);
  EXPECT_EQ(target[0].rhe_pct, 0);
}

}  // namespace
}  // namespace fogline
