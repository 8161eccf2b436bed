#include "tools/export/mcap/translate.h"

#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/export/mcap/descriptor.h"
#include "tools/web/types/lcm_parser.h"

// Expected bytes are written by hand, by the rules of protobuf.dev/programming-guides/encoding.
namespace fogline::mcap {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;

constexpr const char* kTypes = R"(package p;
struct point_t { int8_t x; }
struct all_t {
  int8_t small;
  int64_t large;
  boolean yes;
  double number;
  string name;
  int32_t count;
  double several[count];
  byte raw[2];
  point_t points[count];
  int16_t matrix[2][2];
}
)";

const web::LcmTypes& Types() {
  static const web::LcmTypes types(web::ParseLcm(kTypes, "all_t.lcm"));
  return types;
}

/// The bytes of a message on LCM's wire: the fingerprint, then `rest`.
std::vector<std::uint8_t> Encoded(const std::string& rest) {
  const auto fingerprint = static_cast<std::uint64_t>(Types().Named("all_t")->fingerprint);
  std::vector<std::uint8_t> bytes;
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(fingerprint >> shift));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

const std::string kRest =
    "\xff"s                                      // small -1
    "\0\0\0\0\0\0\x01\x2c"s                      // large 300
    "\1"s                                        // yes
    "\x3f\xf0\0\0\0\0\0\0"s                      // number 1.0
    "\0\0\0\3hi\0"s                              // name
    "\0\0\0\2"s                                  // count
    "\x3f\xf0\0\0\0\0\0\0\xbf\xf0\0\0\0\0\0\0"s  // several 1.0, -1.0
    "\xab\xcd"s                                  // raw
    "\5\6"s                                      // points
    "\0\1\0\2\0\3\xff\xff"s;                     // matrix 1 2 3 -1

TEST(TranslateTest, WritesEveryKindOfMemberAsProtobufDoes) {
  std::string out;
  ASSERT_TRUE(AppendProtobuf(Types(), *Types().Named("all_t"), Encoded(kRest), out));
  EXPECT_EQ(out,
            "\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"s                    // 1: -1 in ten bytes
            "\x10\xac\x02"s                                                    // 2: 300
            "\x18\x01"s                                                        // 3: true
            "\x21\0\0\0\0\0\0\xf0\x3f"s                                        // 4: 1.0
            "\x2a\x02hi"s                                                      // 5
            "\x30\x02"s                                                        // 6: 2
            "\x3a\x10\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\xf0\xbf"s                // 7: packed
            "\x42\x02\xab\xcd"s                                                // 8: bytes
            "\x4a\x02\x08\x05\x4a\x02\x08\x06"s                                // 9: two messages
            "\x52\x0d\x01\x02\x03\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"s);  // 10: row by row
}

TEST(TranslateTest, RefusesBytesThatAreNotExactlyOneMessage) {
  std::string out;
  for (std::size_t size = 0; size < kRest.size(); ++size) {
    EXPECT_FALSE(
        AppendProtobuf(Types(), *Types().Named("all_t"), Encoded(kRest.substr(0, size)), out))
        << size;
  }
  EXPECT_FALSE(AppendProtobuf(Types(), *Types().Named("all_t"), Encoded(kRest + '\0'), out));
  std::vector<std::uint8_t> other = Encoded(kRest);
  other[0] ^= 1;
  EXPECT_FALSE(AppendProtobuf(Types(), *Types().Named("all_t"), other, out)) << "another type";
}

TEST(DescriptorTest, IsOneFileWithTheTypesOfTheMembersBeforeTheTypeItself) {
  const std::string set = DescriptorSetOf(Types(), *Types().Named("all_t"));
  const std::size_t point = set.find("\x0a\x07point_t");
  const std::size_t all = set.find(
      "\x0a\x05"
      "all_t");
  ASSERT_NE(point, std::string::npos);
  ASSERT_NE(all, std::string::npos);
  EXPECT_LT(point, all);
  EXPECT_THAT(set, HasSubstr("\x12\x01p"));       // package
  EXPECT_THAT(set, HasSubstr("\x62\x06proto3"));  // syntax
  EXPECT_THAT(set, HasSubstr("\x0a\x06points\x18\x09\x20\x03\x28\x0b\x32\x0a.p.point_t"));
  EXPECT_THAT(set, HasSubstr("\x0a\x03raw\x18\x08\x20\x01\x28\x0c"));    // bytes, not repeated
  EXPECT_THAT(set, HasSubstr("\x0a\x05small\x18\x01\x20\x01\x28\x05"));  // int32
}

}  // namespace
}  // namespace fogline::mcap
