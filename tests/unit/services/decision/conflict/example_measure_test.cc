// The example of services/decision/conflict/README.md.
#include "tests/unit/services/decision/conflict/example_measure.h"
#include "tests/support/command.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "services/decision/conflict/conflict_measures.h"

namespace fogline {
namespace {

using conflict::Relative;
using test::Content;
using test::SourceDirectory;

template <class Measure>
std::unique_ptr<conflict::ConflictMeasure> Make(const conflict::ConflictParameters& parameters) {
  return std::make_unique<Measure>(parameters);
}

constexpr conflict::ConflictMeasureRow kRow = {"relative", "ours", "[0, 1]", "holds",
                                               Make<Relative>};

TEST(ExampleMeasureTest, IsAMeasureLikeAnyOther) {
  const auto measure = kRow.make({});
  EXPECT_EQ(measure->Step({.radar = {true, 40, 0.1}, .lidar = {true, 10, 0.1}, .prediction = {}}),
            0.75);
  EXPECT_EQ(measure->Step({}), 0.75);
}

TEST(ExampleMeasureTest, StandsInTheReadmeAsItIsBuiltHere) {
  const std::string readme = Content(SourceDirectory() / "services/decision/conflict/README.md");
  EXPECT_NE(readme.find(Content(SourceDirectory() /
                                "tests/unit/services/decision/conflict/example_measure.h")),
            std::string::npos);
  EXPECT_NE(readme.find(R"({"relative", "missing share of the radar's range"})"),
            std::string::npos);
  EXPECT_NE(readme.find(R"({"relative", "ours", "[0, 1]", "holds", Make<Relative>})"),
            std::string::npos);
}

}  // namespace
}  // namespace fogline
