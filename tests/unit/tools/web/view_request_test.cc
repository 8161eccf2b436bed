#include "tools/web/view_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline::web {
namespace {

using testing::HasSubstr;

BadRequest Bad(std::string_view text) {
  const ViewRequest request = ParseViewRequest(text);
  const auto* bad = std::get_if<BadRequest>(&request);
  EXPECT_NE(bad, nullptr) << text;
  return bad == nullptr ? BadRequest{} : *bad;
}

TEST(ViewRequestTest, ReadsEachRequest) {
  const auto steps =
      std::get<StepsRequest>(ParseViewRequest(R"({"op":"steps","id":7,"from":100,"to":163})"));
  EXPECT_EQ(steps.id, 7U);
  EXPECT_EQ(steps.from, 100);
  EXPECT_EQ(steps.to, 163);
  const auto series = std::get<SeriesRequest>(ParseViewRequest(
      R"({"op":"series","id":8,"channel":"TRUTH","field":"host_gap_m","from":0,"to":499,"points":9})"));
  EXPECT_EQ(series.id, 8U);
  EXPECT_EQ(series.channel, "TRUTH");
  EXPECT_EQ(series.field, "host_gap_m");
  EXPECT_EQ(series.to, 499);
  EXPECT_EQ(series.points, 9);
  EXPECT_FALSE(series.changes);
  EXPECT_TRUE(std::get<SeriesRequest>(
                  ParseViewRequest(R"({"op":"series","id":8,"channel":"A","field":"b","from":0,)"
                                   R"("to":9,"points":9,"changes":true})"))
                  .changes);
  EXPECT_EQ(std::get<HistoryRequest>(ParseViewRequest(R"({"op":"history","id":4294967295})")).id,
            4294967295U);
}

TEST(ViewRequestTest, SaysWhatIsWrongWithAnIdIfThereIsOne) {
  EXPECT_THAT(Bad("").why, HasSubstr("no JSON"));
  EXPECT_THAT(Bad("{").why, HasSubstr("no JSON"));
  EXPECT_THAT(Bad("[1]").why, HasSubstr("no JSON object"));
  EXPECT_EQ(Bad(R"({"op":"steps"})").id, std::nullopt);
  EXPECT_EQ(Bad(R"({"op":"steps","id":3})").id, 3U);
  EXPECT_THAT(Bad(R"({"op":"steps","id":3})").why, HasSubstr("\"from\""));
  EXPECT_THAT(Bad(R"({"op":"stop","id":3})").why, HasSubstr("\"stop\""));
  EXPECT_THAT(Bad(R"({"op":7,"id":3})").why, HasSubstr("\"op\""));
}

TEST(ViewRequestTest, RefusesNumbersOutOfRange) {
  for (const char* id : {"-1", "4294967296", "1.5", "1e3", "\"1\"", "null", "true",
                         "18446744073709551615", "99999999999999999999999"}) {
    const std::string text = std::string(R"({"op":"history","id":)") + id + "}";
    EXPECT_EQ(Bad(text).id, std::nullopt) << text;
  }
  for (const char* range : {R"("from":-1,"to":5)", R"("from":6,"to":5)", R"("from":0,"to":512)",
                            R"("from":0,"to":9223372036854775807)",
                            R"("from":18446744073709551615,"to":18446744073709551615)"}) {
    const std::string text = std::string(R"({"op":"steps","id":1,)") + range + "}";
    EXPECT_NE(Bad(text).why, "") << text;
  }
  EXPECT_NE(
      Bad(R"({"op":"series","id":1,"channel":"A","field":"b","from":0,"to":1,"points":0})").why,
      "");
  EXPECT_NE(
      Bad(R"({"op":"series","id":1,"channel":"A","field":"b","from":0,"to":1,"points":20001})").why,
      "");
}

TEST(ViewRequestTest, RefusesBinaryFramesAndOddChanges) {
  EXPECT_NE(Bad(R"({"op":"series","id":1,"channel":"A","field":"b","from":0,"to":1,"points":1,)"
                R"("changes":1})")
                .why,
            "");
  const std::string_view history = R"({"op":"history","id":1})";
  EXPECT_TRUE(std::holds_alternative<HistoryRequest>(ParseViewFrame(history, false)));
  EXPECT_TRUE(std::holds_alternative<BadRequest>(ParseViewFrame(history, true)));
}

TEST(ViewRequestTest, SurvivesDeepNestingAndOddBytes) {
  EXPECT_NE(Bad(std::string(60'000, '[')).why, "");
  EXPECT_NE(Bad(std::string(60'000, '{')).why, "");
  EXPECT_NE(Bad("{\"op\":\"\xff\xfe\",\"id\":1}").why, "");
  EXPECT_NE(Bad(std::string(10, '\0')).why, "");
}

}  // namespace
}  // namespace fogline::web
