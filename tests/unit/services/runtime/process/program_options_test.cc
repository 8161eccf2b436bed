#include "services/runtime/process/program_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;

std::optional<std::int64_t> Read(const std::string& text) {
  CLI::App app;
  std::optional<std::int64_t> run_id;
  runtime::AddRunIdOption(app, "--run-id", run_id, "the run");
  app.parse(std::vector<std::string>{text, "--run-id"});  // in reverse order
  return run_id;
}

TEST(RunIdOptionTest, TakesEveryIdThatARunCanHave) {
  EXPECT_EQ(Read("1"), 1);
  EXPECT_EQ(Read("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
}

TEST(RunIdOptionTest, RefusesWhatIsNoId) {
  for (const char* text : {"0", "-5", "x", "1.5", "9223372036854775808", "99999999999999999999"}) {
    EXPECT_THAT(ErrorOf<CLI::ParseError>([text] { Read(text); }), HasSubstr(text));
  }
}

}  // namespace
}  // namespace fogline::test
