#include "tools/web/types/lcm_parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/errors.h"

namespace fogline::web {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

LcmStruct Only(std::string_view text) {
  const std::vector<LcmStruct> structs = ParseLcm(text, "a.lcm");
  EXPECT_EQ(structs.size(), 1U);
  return structs.empty() ? LcmStruct{} : structs.front();
}

std::string ParserErrorOf(std::string_view text) {
  try {
    ParseLcm(text, "a.lcm");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A text with every element of the language.
constexpr std::string_view kLab = R"(package lab.two;
struct inner_t { int8_t n; float x[n][3]; }
struct outer_t
{
  const int32_t A = 1, B = -2;
  const double PI = 3.14;
  const int64_t H = 0xff;
  int16_t rows, cols;
  byte raw[rows][cols];
  inner_t parts[rows];
  lab.two.inner_t one;
  string names[2][cols];
})";

TEST(LcmParserTest, HashesNamesTypesAndDimensionsAsLcmGenDoes) {
  const std::vector<LcmStruct> structs = ParseLcm(kLab, "a.lcm");
  ASSERT_EQ(structs.size(), 2U);
  // The hashes that `lcm-gen -d` of LCM 1.3.1 prints.
  EXPECT_EQ(OwnHash(structs[0]), -3177966472144266089);
  EXPECT_EQ(OwnHash(structs[1]), -7454815794681965952);
}

TEST(LcmParserTest, ReadsConstantsWithTheirValues) {
  const LcmStruct outer = ParseLcm(kLab, "a.lcm")[1];
  ASSERT_EQ(outer.constants.size(), 4U);
  EXPECT_EQ(outer.FullName(), "lab.two.outer_t");
  EXPECT_EQ(outer.constants[1].name, "B");
  EXPECT_EQ(outer.constants[1].type, "int32_t");
  EXPECT_EQ(std::get<std::int64_t>(outer.constants[1].value), -2);
  EXPECT_EQ(std::get<double>(outer.constants[2].value), 3.14);
  EXPECT_EQ(std::get<std::int64_t>(outer.constants[3].value), 255);
}

TEST(LcmParserTest, KnowsWhichMemberIsTheLengthOfWhichDimension) {
  const LcmStruct outer = ParseLcm(kLab, "a.lcm")[1];
  const LcmMember& rows = outer.members[0];
  const LcmMember& cols = outer.members[1];
  ASSERT_TRUE(rows.length_slot && cols.length_slot);
  EXPECT_NE(*rows.length_slot, *cols.length_slot);
  const LcmMember& names = outer.members[5];
  ASSERT_EQ(names.dimensions.size(), 2U);
  EXPECT_EQ(names.dimensions[0].fixed, 2U);
  EXPECT_FALSE(names.dimensions[1].fixed);
  EXPECT_EQ(names.dimensions[1].slot, *cols.length_slot);
  EXPECT_FALSE(outer.members[3].primitive);
  EXPECT_EQ(names.primitive, LcmPrimitive::kString);
}

TEST(LcmParserTest, GivesAMemberTheCommentBeforeItAndTheOneBehindIt) {
  const LcmStruct type = Only(R"(
// A file begins so.

// What it is,
// in two lines.
struct a_t {
  // Before.
  double x;  // Behind.
  double y;

  // Of no member, because a blank line follows.

  /* In a block
   * of two lines. */
  double z, w;
  const int8_t K = 1;  // a constant
})");
  EXPECT_EQ(type.comment, "What it is, in two lines.");
  EXPECT_EQ(type.members[0].comment, "Before. Behind.");
  EXPECT_EQ(type.members[1].comment, "");
  EXPECT_EQ(type.members[2].comment, "In a block of two lines.");
  EXPECT_EQ(type.members[3].comment, "In a block of two lines.");
  EXPECT_EQ(type.constants[0].comment, "a constant");
}

TEST(LcmParserTest, NamesTheLineOfAMistake) {
  EXPECT_EQ(ParserErrorOf("struct a_t {\n  double x\n}"),
            "a.lcm:3: error: expected \";\", not \"}\"");
  EXPECT_EQ(ParserErrorOf("struct a_t {\n  double x;"),
            "a.lcm:2: error: the type of the member is missing");
  EXPECT_THAT(ParserErrorOf("struct a_t {\n\n  double x; $"), StartsWith("a.lcm:3: error: \"$\""));
  EXPECT_EQ(ParserErrorOf("/* no end"), "a.lcm:1: error: the comment has no end");
}

TEST(LcmParserTest, RefusesWhatLcmGenRefuses) {
  EXPECT_THAT(ParserErrorOf("struct a_t { double x[n]; int32_t n; }"),
              HasSubstr("\"n\" is no length"));
  EXPECT_THAT(ParserErrorOf("struct a_t { byte n; double x[n]; }"),
              HasSubstr("\"n\" is no length"));
  EXPECT_THAT(ParserErrorOf("struct a_t { int8_t n[2]; double x[n]; }"), HasSubstr("is no length"));
  EXPECT_THAT(ParserErrorOf("struct a_t { double x[0]; }"), HasSubstr("\"0\" is no length"));
  EXPECT_THAT(ParserErrorOf("struct a_t { double x[-1]; }"), HasSubstr("\"-1\" is no length"));
  EXPECT_THAT(ParserErrorOf("struct a_t { const string S = a; double x; }"),
              HasSubstr("no constant has the type \"string\""));
  EXPECT_THAT(ParserErrorOf("struct a_t { const int8_t S = 1.5; double x; }"),
              HasSubstr("\"1.5\" is no value of \"int8_t\""));
  EXPECT_THAT(ParserErrorOf("struct a_t { double x; double x; }"), HasSubstr("two members \"x\""));
  EXPECT_THAT(ParserErrorOf("enum a_t { A }"), HasSubstr("expected \"struct\""));
}

TEST(LcmParserTest, LimitsWhatADecoderWouldHaveToKeep) {
  EXPECT_THAT(ParserErrorOf("struct a_t { }"), HasSubstr("a_t has no members"));
  EXPECT_THAT(ParserErrorOf("struct a_t { double x[1][1][1][1][1]; }"), HasSubstr("dimensions"));
  std::string text = "struct a_t { ";
  for (std::size_t i = 0; i <= kMaxLengths; ++i) {
    text += "int8_t n" + std::to_string(i) + "; double x" + std::to_string(i) + "[n" +
            std::to_string(i) + "]; ";
  }
  EXPECT_THAT(ParserErrorOf(text + "}"), HasSubstr("members are lengths"));
}

TEST(LcmParserTest, FindsTheUnitAtTheEndOfAName) {
  EXPECT_EQ(UnitOf("host_gap_m"), "m");
  EXPECT_EQ(UnitOf("host_speed_mps"), "m/s");
  EXPECT_EQ(UnitOf("acceleration_mps2"), "m/s²");
  EXPECT_EQ(UnitOf("jitter_p50_us"), "µs");
  EXPECT_EQ(UnitOf("input_rate_hz"), "Hz");
  EXPECT_EQ(UnitOf("stall_ms"), "ms");
  EXPECT_EQ(UnitOf("collision_time_s"), "s");
  EXPECT_EQ(UnitOf("num_followers"), "");
  EXPECT_EQ(UnitOf("ticks"), "");
}

}  // namespace
}  // namespace fogline::web
