#include "tools/web/server/access.h"

#include <gtest/gtest.h>

#include <set>

namespace fogline::web {
namespace {

Access Loopback() { return Access({.address = "127.0.0.1", .port = 7680}); }

const std::string kToken(32, 'a');

Access ForOthers() { return Access({.address = "192.168.1.5", .port = 7680, .token = kToken}); }

RequestOrigin From(std::string_view host, std::string_view origin = "",
                   std::string_view target = "/ws") {
  return {.host = host, .origin = origin, .target = target};
}

TEST(AccessTest, TakesTheAddressOnWhichItListens) {
  EXPECT_EQ(Loopback().OfPage(From("127.0.0.1:7680")), Verdict::kAllowed);
  EXPECT_EQ(Loopback().OfPage(From("localhost:7680")), Verdict::kAllowed);
  EXPECT_EQ(Loopback().OfPage(From("LocalHost:7680")), Verdict::kAllowed);
  EXPECT_EQ(ForOthers().OfPage(From("192.168.1.5:7680")), Verdict::kAllowed);
}

TEST(AccessTest, RefusesEveryOtherHost) {
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:7681", "evil.example:7680", "evil.example", "127.0.0.1:76800",
        "localhost.evil.example:7680", "xlocalhost:7680", "127.0.0.2:7680", ":7680",
        "127.0.0.1:7680:7680", "[::1]:7680", " 127.0.0.1:7680"}) {
    EXPECT_EQ(Loopback().OfPage(From(host)), Verdict::kWrongHost) << host;
    EXPECT_EQ(Loopback().OfWebSocket(From(host)), Verdict::kWrongHost) << host;
  }
  EXPECT_EQ(ForOthers().OfPage(From("localhost:7680")), Verdict::kWrongHost);
  EXPECT_EQ(ForOthers().OfPage(From("127.0.0.1:7680")), Verdict::kWrongHost);
}

TEST(AccessTest, TakesAHostWithoutPortOnlyOnPort80) {
  const Access access({.address = "127.0.0.1", .port = 80});
  EXPECT_EQ(access.OfPage(From("127.0.0.1")), Verdict::kAllowed);
  EXPECT_EQ(access.OfPage(From("127.0.0.1:80")), Verdict::kAllowed);
  EXPECT_EQ(access.OfPage(From("evil.example")), Verdict::kWrongHost);
}

TEST(AccessTest, OnEveryAddressTakesAddressesInNumbersOnly) {
  const Access access({.address = "0.0.0.0", .port = 7680});
  EXPECT_EQ(access.OfPage(From("192.168.1.5:7680")), Verdict::kAllowed);
  EXPECT_EQ(access.OfPage(From("localhost:7680")), Verdict::kAllowed);
  // The owner of a domain name can make this name resolve to the address of this machine. So the
  // server accepts no name except localhost.
  EXPECT_EQ(access.OfPage(From("evil.example:7680")), Verdict::kWrongHost);
  EXPECT_EQ(access.OfPage(From("192.168.1:7680")), Verdict::kWrongHost);
  EXPECT_EQ(access.Url(), "http://127.0.0.1:7680/");
}

TEST(AccessTest, TakesItsOwnPageAndProgramsWithoutOrigin) {
  EXPECT_EQ(Loopback().OfWebSocket(From("127.0.0.1:7680")), Verdict::kAllowed);
  EXPECT_EQ(Loopback().OfWebSocket(From("127.0.0.1:7680", "http://127.0.0.1:7680")),
            Verdict::kAllowed);
  EXPECT_EQ(Loopback().OfWebSocket(From("localhost:7680", "http://localhost:7680")),
            Verdict::kAllowed);
}

TEST(AccessTest, RefusesPagesOfOtherOrigins) {
  for (const char* origin :
       {"null", "http://evil.example", "https://127.0.0.1:7680", "http://127.0.0.1:7681",
        "http://127.0.0.1:7680.evil.example", "http://localhost:7680", "file://"}) {
    EXPECT_EQ(Loopback().OfWebSocket(From("127.0.0.1:7680", origin)), Verdict::kForeignOrigin)
        << origin;
  }
}

TEST(AccessTest, TakesOriginsThatTheUserAllows) {
  const Access access({.address = "127.0.0.1", .port = 7680, .origins = {"http://localhost:8080"}});
  EXPECT_EQ(access.OfWebSocket(From("127.0.0.1:7680", "http://localhost:8080")), Verdict::kAllowed);
  EXPECT_EQ(access.OfWebSocket(From("127.0.0.1:7680", "http://localhost:8081")),
            Verdict::kForeignOrigin);
}

TEST(AccessTest, ComparesOriginsAsBrowsersWriteThem) {
  const auto verdict = [](const std::string& allowed, const char* origin) {
    const Access access({.address = "127.0.0.1", .port = 7680, .origins = {allowed}});
    return access.OfWebSocket(From("127.0.0.1:7680", origin));
  };
  EXPECT_EQ(verdict("HTTP://Lab1:80", "http://lab1"), Verdict::kAllowed);
  EXPECT_EQ(verdict("http://lab1", "http://lab1:80"), Verdict::kAllowed);
  EXPECT_EQ(verdict("https://App.Example:443", "https://app.example"), Verdict::kAllowed);
  EXPECT_EQ(verdict("https://lab1:80", "https://lab1"), Verdict::kForeignOrigin);
  EXPECT_EQ(verdict("http://lab1:443", "http://lab1"), Verdict::kForeignOrigin);
  EXPECT_EQ(verdict("http://lab1:8080", "http://lab1:80"), Verdict::kForeignOrigin);
  EXPECT_TRUE(IsOrigin("HTTP://Lab1:80"));
}

TEST(AccessTest, NeedsTheTokenForAWebSocketButNotForThePage) {
  const Access access = ForOthers();
  const std::string host = "192.168.1.5:7680";
  EXPECT_EQ(access.OfPage(From(host, "", "/")), Verdict::kAllowed);
  EXPECT_EQ(access.OfWebSocket(From(host, "", "/ws?token=" + kToken)), Verdict::kAllowed);
  const std::string wrong = std::string(31, 'a') + "b";
  for (const std::string& target :
       {std::string("/ws"), std::string("/ws?token="), "/ws?token=" + wrong,
        "/ws?token=" + kToken + "a", "/ws?token=" + kToken.substr(1), "/ws?tokens=" + kToken,
        "/ws?xtoken=" + kToken, "/ws#token=" + kToken, "/ws?token=" + kToken + "#"}) {
    EXPECT_EQ(access.OfWebSocket(From(host, "", target)), Verdict::kWrongToken) << target;
  }
}

TEST(AccessTest, PutsTokenAndStepBehindTheHash) {
  EXPECT_EQ(Loopback().Url(), "http://127.0.0.1:7680/");
  EXPECT_EQ(Loopback().Url("step=190"), "http://127.0.0.1:7680/#step=190");
  EXPECT_EQ(ForOthers().Url(), "http://192.168.1.5:7680/#token=" + kToken);
  EXPECT_EQ(ForOthers().Url("step=190"), "http://192.168.1.5:7680/#token=" + kToken + "&step=190");
}

TEST(AccessTest, DrawsTokensOf128Bits) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = DrawToken();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100U);
}

TEST(AccessTest, KnowsATokenFromOtherTexts) {
  EXPECT_TRUE(IsToken(DrawToken()));
  EXPECT_TRUE(IsToken("Token_of-16-char"));
  EXPECT_TRUE(IsToken(std::string(128, 'a')));
  for (const std::string& text :
       {std::string(), std::string(15, 'a'), std::string(129, 'a'),
        std::string("a token of 16 characters"), std::string("token=aaaaaaaaaaaa"),
        std::string("aaaaaaaaaaaaaaa\n"), std::string("aaaaaaaaaaaaaaa&"), std::string(32, '\0')}) {
    EXPECT_FALSE(IsToken(text)) << text;
  }
}

TEST(AccessTest, ReadsAValueOfAQuery) {
  EXPECT_EQ(QueryValue("/ws?a=1&token=x&b=2", "token"), "x");
  EXPECT_EQ(QueryValue("/ws?token=x", "token"), "x");
  EXPECT_EQ(QueryValue("/ws?token=x&token=y", "token"), "x");
  EXPECT_EQ(QueryValue("/ws?&&token=x", "token"), "x");
  EXPECT_EQ(QueryValue("/ws?token", "token"), "");
  EXPECT_EQ(QueryValue("/ws", "token"), "");
  EXPECT_EQ(QueryValue("", "token"), "");
}

TEST(AccessTest, KnowsAnOriginFromOtherTexts) {
  EXPECT_TRUE(IsOrigin("http://localhost:8080"));
  EXPECT_TRUE(IsOrigin("https://app.example"));
  EXPECT_TRUE(IsOrigin("http://[::1]"));
  EXPECT_TRUE(IsOrigin("http://[::1]:65535"));
  for (const char* text :
       {"", "*", "null", "localhost:8080", "http://", "http://a/", "http://a b", "http://user@a",
        "file://", "http://a:99999", "http://a:0", "http://a:", "http://[::1]:x", "http://:8080",
        "http://[::1", "http://[::1]8080", "http://a:08080", "http://a:-1"}) {
    EXPECT_FALSE(IsOrigin(text)) << text;
  }
}

}  // namespace
}  // namespace fogline::web
