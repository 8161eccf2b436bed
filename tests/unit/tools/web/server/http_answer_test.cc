#include "tools/web/server/http_answer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace fogline::web {
namespace {

constexpr std::array kFiles{
    Asset{"/index.html", "text/html; charset=utf-8", "\"e1\"", "<p>"},
    Asset{"/page.js", "text/javascript; charset=utf-8", "\"e2\"", "let a;"},
};

HttpAnswer AnswerTo(std::string_view method, std::string_view target,
                    std::string_view if_none_match = "", std::string_view host = "127.0.0.1:7680") {
  const Access access({.address = "127.0.0.1", .port = 7680});
  return Answer({.method = method,
                 .from = {.host = host, .origin = "", .target = target},
                 .if_none_match = if_none_match},
                access, kFiles);
}

std::string HeaderOf(const HttpAnswer& answer, std::string_view name) {
  const auto found = std::ranges::find_if(answer.headers,
                                          [&](const auto& header) { return header.first == name; });
  return found == answer.headers.end() ? "" : found->second;
}

TEST(HttpAnswerTest, GivesTheFilesByTheirExactNames) {
  EXPECT_EQ(AnswerTo("GET", "/").body, "<p>");
  EXPECT_EQ(AnswerTo("GET", "/index.html").body, "<p>");
  const HttpAnswer script = AnswerTo("GET", "/page.js?x=1");
  EXPECT_EQ(script.status, 200U);
  EXPECT_EQ(script.body, "let a;");
  EXPECT_EQ(HeaderOf(script, "Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(HeaderOf(script, "ETag"), "\"e2\"");
}

TEST(HttpAnswerTest, KnowsNoOtherPath) {
  for (const char* target : {"", "*", "/page", "/page.js/", "//page.js", "/../page.js", "/PAGE.JS",
                             "/%70age.js", "http://127.0.0.1:7680/page.js", "/etc/passwd"}) {
    EXPECT_EQ(AnswerTo("GET", target).status, 404U) << target;
  }
}

TEST(HttpAnswerTest, SendsNoFileThatTheBrowserHas) {
  const HttpAnswer same = AnswerTo("GET", "/page.js", "\"e1\", \"e2\"");
  EXPECT_EQ(same.status, 304U);
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(HeaderOf(same, "ETag"), "\"e2\"");
  EXPECT_EQ(AnswerTo("GET", "/page.js", "\"old\"").status, 200U);
}

TEST(HttpAnswerTest, KnowsOnlyGet) {
  for (const char* method : {"HEAD", "POST", "PUT", "DELETE", "OPTIONS", "TRACE", "BREW"}) {
    const HttpAnswer answer = AnswerTo(method, "/");
    EXPECT_EQ(answer.status, 405U) << method;
    EXPECT_EQ(HeaderOf(answer, "Allow"), "GET");
  }
}

TEST(HttpAnswerTest, RefusesAWrongHostBeforeAnythingElse) {
  const HttpAnswer answer = AnswerTo("POST", "/nothing", "", "evil.example:7680");
  EXPECT_EQ(answer.status, 403U);
  EXPECT_EQ(answer.verdict, Verdict::kWrongHost);
  EXPECT_EQ(answer.text.find("evil"), std::string::npos);
}

TEST(HttpAnswerTest, SaysThatThePathOfTheSocketNeedsAWebSocket) {
  EXPECT_EQ(AnswerTo("GET", "/ws").status, 426U);
}

TEST(HttpAnswerTest, LetsThePageLoadOnlyItsOwnFiles) {
  const auto headers = SafetyHeaders();
  const auto policy = std::ranges::find_if(
      headers, [](const auto& header) { return header.first == "Content-Security-Policy"; });
  ASSERT_NE(policy, headers.end());
  EXPECT_TRUE(policy->second.starts_with("default-src 'none';"));
  EXPECT_EQ(policy->second.find("unsafe"), std::string_view::npos);
  EXPECT_EQ(policy->second.find("http"), std::string_view::npos);
}

}  // namespace
}  // namespace fogline::web
