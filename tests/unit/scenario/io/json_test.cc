#include "scenario/io/json.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

// The mistakes in a text, as a user sees them.
std::vector<Diagnostic> JsonDiagnosticsOf(std::string_view text) {
  DiagnosticList list;
  ParseJson(text, 0, list);
  if (list.empty()) return {};
  try {
    list.Throw({{.name = "f", .text = text}});
  } catch (const ScenarioError& error) {
    return error.diagnostics();
  }
}

std::string PlaceOf(std::string_view text) {
  const std::vector<Diagnostic> diagnostics = JsonDiagnosticsOf(text);
  if (diagnostics.size() != 1) return std::to_string(diagnostics.size()) + " mistakes";
  return std::to_string(diagnostics[0].line) + ":" + std::to_string(diagnostics[0].column);
}

TEST(JsonTest, KnowsTheFirstByteOfEveryKeyAndValue) {
  constexpr std::string_view kText = R"({"a": 12 ,"b\"": [true, {"c":null}, "x,:"],"d":-1.5e3})";
  DiagnosticList diagnostics;
  const std::optional<JsonValue> root = ParseJson(kText, 7, diagnostics);
  ASSERT_TRUE(root);
  ASSERT_TRUE(diagnostics.empty());

  std::vector<std::string_view> starts;
  const auto note = [&](Place place) {
    EXPECT_EQ(place.source, 7U);
    starts.push_back(kText.substr(place.offset, 2));
  };
  const auto& members = *root->As<JsonObject>();
  for (const JsonMember& member : members) {
    note(member.place);
    note(member.value.place);
  }
  for (const JsonValue& item : *members[1].value.As<JsonArray>()) note(item.place);
  EXPECT_THAT(starts,
              testing::ElementsAre("\"a", "12", "\"b", "[t", "\"d", "-1", "tr", "{\"", "\"x"));
}

TEST(JsonTest, TellsIntegersFromNumbersWithAFraction) {
  DiagnosticList diagnostics;
  const auto root = ParseJson("[3, 3.0, 9223372036854775807, 9223372036854775808]", 0, diagnostics);
  const auto& items = *root->As<JsonArray>();
  EXPECT_EQ(*items[0].As<std::int64_t>(), 3);
  EXPECT_EQ(*items[1].As<double>(), 3.0);
  EXPECT_EQ(*items[2].As<std::int64_t>(), 9223372036854775807);
  EXPECT_EQ(*items[3].As<double>(), 0x1p63);
}

TEST(JsonTest, PointsAtTheTokenThatBreaksTheSyntax) {
  EXPECT_EQ(PlaceOf(""), "1:1");
  EXPECT_EQ(PlaceOf("{\n  \"a\" 1}"), "2:7");
  EXPECT_EQ(PlaceOf("[1,,2]"), "1:4");
  EXPECT_EQ(PlaceOf("[1\n,2\n]]"), "3:2");
  EXPECT_EQ(PlaceOf("[1 2]"), "1:4");
  EXPECT_EQ(PlaceOf("[01]"), "1:3");
  EXPECT_EQ(PlaceOf("[\"a\"\"b\"]"), "1:5");
  EXPECT_EQ(PlaceOf("{\"a\": nul}"), "1:7");
  EXPECT_EQ(PlaceOf("[1"), "1:3");
}

TEST(JsonTest, PointsAtTheByteThatBreaksAString) {
  EXPECT_EQ(PlaceOf("[\"abc\\x\"]"), "1:7");
  EXPECT_EQ(PlaceOf("[\"abc\n\"]"), "1:6");
}

TEST(JsonTest, CountsColumnsInCharactersAndSkipsAByteOrderMark) {
  EXPECT_EQ(PlaceOf("\xef\xbb\xbf[1,,]"), "1:4");
  EXPECT_EQ(PlaceOf("[\"\xc3\xa4\xe2\x82\xac\", ,]"), "1:8");
  EXPECT_EQ(PlaceOf("[1,\r\n ,]"), "2:2");
}

TEST(JsonTest, RefusesWhatOnlyLooksLikeJson) {
  for (const std::string_view text :
       {"NaN", "[Infinity]", "[-Infinity]", "[+1]", "[.5]", "[1.]", "{'a':1}", "[1,]", "// x\n1",
        "[1e999]", "[\"\\ud800\"]", "[\"\xff\"]", "1 2", "\xef\xbb", "[tru]", "{1:2}"}) {
    const std::vector<Diagnostic> diagnostics = JsonDiagnosticsOf(text);
    ASSERT_EQ(diagnostics.size(), 1U) << text;
    EXPECT_EQ(diagnostics[0].rule, "syntax") << text;
  }
}

TEST(JsonTest, RefusesANulByteWhereverItIs) {
  EXPECT_EQ(PlaceOf(std::string_view("[1]\0", 4)), "1:4");
  EXPECT_EQ(PlaceOf(std::string_view("\0", 1)), "1:1");
}

TEST(JsonTest, SaysThatATextIsUtf16) {
  for (const std::string_view text :
       {std::string_view("\xff\xfe[\0", 4), std::string_view("\xfe\xff\0[", 4)}) {
    const std::vector<Diagnostic> diagnostics = JsonDiagnosticsOf(text);
    ASSERT_EQ(diagnostics.size(), 1U);
    EXPECT_EQ(diagnostics[0].rule, "syntax");
    EXPECT_EQ(diagnostics[0].message, "not JSON: the text is UTF-16; save it as UTF-8");
  }
}

TEST(JsonTest, ReportsEveryDuplicateKeyWithItsPointer) {
  const auto diagnostics =
      JsonDiagnosticsOf(R"({"a": [{"x/y": 1, "b": 2, "x/y": 3, "x/y": 4}], "a": 5})");
  std::vector<std::string> pointers;
  for (const Diagnostic& diagnostic : diagnostics) {
    EXPECT_EQ(diagnostic.rule, "duplicate-key");
    pointers.push_back(std::to_string(diagnostic.column) + " " + diagnostic.pointer);
  }
  EXPECT_THAT(pointers, testing::ElementsAre("27 /a/0/x~1y", "37 /a/0/x~1y", "49 /a"));
}

TEST(JsonTest, RefusesDepthBeyondItsLimitWithoutRecursion) {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  EXPECT_TRUE(JsonDiagnosticsOf(nested(32)).empty());
  for (const std::size_t depth : {std::size_t{33}, std::size_t{5'000'000}}) {
    const auto diagnostics = JsonDiagnosticsOf(nested(depth));
    ASSERT_EQ(diagnostics.size(), 1U);
    EXPECT_EQ(diagnostics[0].rule, "too-large");
    EXPECT_EQ(diagnostics[0].column, 33);
  }
}

TEST(JsonTest, RefusesMoreValuesThanAnyScenarioHas) {
  std::string text = "[0";
  for (int i = 0; i < 2'000'000; ++i) text += ",0";
  const auto diagnostics = JsonDiagnosticsOf(text + "]");
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].rule, "too-large");
}

TEST(JsonTest, RefusesATextBeyondItsLimitWithoutReadingIt) {
  const auto diagnostics = JsonDiagnosticsOf(std::string(kMaxFileBytes + 1, ' '));
  ASSERT_EQ(diagnostics.size(), 1U);
  EXPECT_EQ(diagnostics[0].rule, "too-large");
}

}  // namespace
}  // namespace fogline
