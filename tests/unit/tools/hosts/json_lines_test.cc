#include "tools/hosts/json_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <utility>

namespace fogline::test {
namespace {

using hosts::JsonLines;
using hosts::NotUnderstood;
using nlohmann::json;

/// A pair of connected sockets: here() and there(). The destructor closes both.
class JsonLinesTest : public testing::Test {
 protected:
  JsonLinesTest() {
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()), 0);
  }
  ~JsonLinesTest() override {
    close(ends_[0]);
    Close();
  }
  /// Closes the socket there().
  void Close() {
    if (const int other = std::exchange(ends_[1], -1); other >= 0) close(other);
  }
  void Write(const std::string& text) {
    ASSERT_EQ(write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  int here() const { return ends_[0]; }
  int there() const { return ends_[1]; }

 private:
  std::array<int, 2> ends_{};
};

TEST_F(JsonLinesTest, CarryObjectsInTheirOrder) {
  JsonLines one(here(), here());
  JsonLines other(there(), there());
  EXPECT_FALSE(other.Take().has_value());
  one.Send({{"start", "fusion"}});
  one.Send({{"text", "line\nfeed"}});
  EXPECT_EQ(other.Take().value(), json({{"start", "fusion"}}));
  EXPECT_EQ(other.Take().value(), json({{"text", "line\nfeed"}}));
  EXPECT_FALSE(other.Take().has_value());
}

TEST_F(JsonLinesTest, PutTogetherWhatComesInPieces) {
  JsonLines lines(here(), here());
  Write("{\"a\"");
  EXPECT_FALSE(lines.Take().has_value());
  Write(": 1}\n{\"b\": 2}\n");
  EXPECT_EQ(lines.Take().value(), json({{"a", 1}}));
  EXPECT_EQ(lines.Take().value(), json({{"b", 2}}));
}

TEST_F(JsonLinesTest, RefuseWhatIsNoObject) {
  JsonLines lines(here(), here());
  Write("Welcome!\n");
  EXPECT_THROW(lines.Take(), NotUnderstood);
  Write("[1]\n");
  EXPECT_THROW(lines.Take(), NotUnderstood);
  Write("{\"a\": 1}\n");
  EXPECT_EQ(lines.Take().value(), json({{"a", 1}}));
}

TEST_F(JsonLinesTest, RefuseALineThatIsTooLong) {
  JsonLines lines(here(), here());
  const std::string piece(1000, 'x');
  EXPECT_THROW(
      {
        for (std::size_t sent = 0; sent < 2 * JsonLines::kMaxLine; sent += piece.size()) {
          Write(piece);
          lines.Take();
        }
      },
      NotUnderstood);
}

TEST_F(JsonLinesTest, RefuseALineThatIsTooLongAlsoIfItComesBitByBit) {
  JsonLines lines(here(), here());
  const std::string piece(1000, 'x');
  EXPECT_THROW(
      {
        for (std::size_t sent = 0; sent < 2 * JsonLines::kMaxLine; sent += piece.size()) {
          Write(piece);
          lines.Wait(Duration::zero());  // reads the piece, so that Take() finds nothing to read
          lines.Take();
        }
      },
      NotUnderstood);
}

TEST_F(JsonLinesTest, RefuseALineThatIsTooLongAlsoWithItsEnd) {
  JsonLines lines(here(), here());
  const std::string piece(1000, 'x');
  std::size_t sent = 0;
  for (; sent + piece.size() <= JsonLines::kMaxLine; sent += piece.size()) {
    Write(piece);
    EXPECT_FALSE(lines.Take().has_value());
  }
  Write(piece + "\n");
  EXPECT_THROW(lines.Take(), NotUnderstood);
}

TEST_F(JsonLinesTest, AreOverWhenTheOtherSideHasClosedAndAllIsTaken) {
  JsonLines lines(here(), here());
  Write("{\"a\": 1}\n");
  Close();
  EXPECT_FALSE(lines.ended());
  EXPECT_EQ(lines.Take().value(), json({{"a", 1}}));
  EXPECT_FALSE(lines.Take().has_value());
  EXPECT_TRUE(lines.ended());
  lines.Send({{"b", 2}});  // SIGPIPE does not end this process
}

TEST_F(JsonLinesTest, DoNotWaitForASideThatReadsNothing) {
  JsonLines lines(here(), here());
  const json message{{"text", std::string(4000, 'x')}};
  constexpr int kMessages = 200;  // more than a socket holds
  for (int i = 0; i < kMessages; ++i) lines.Send(message);
  JsonLines other(there(), there());
  int come = 0;
  constexpr int kTurns = 100'000;
  for (int turn = 0; turn < kTurns && come < kMessages; ++turn) {
    lines.Wait(Duration::zero());  // sends the lines that waited for room
    if (other.Take()) ++come;
  }
  EXPECT_EQ(come, kMessages);
}

}  // namespace
}  // namespace fogline::test
