#include "tools/web/types/lcm_types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <tuple>

#include "common/errors.h"
#include "fogline/beacon_t.hpp"
#include "fogline/header_t.hpp"
#include "fogline/log_seal_t.hpp"
#include "services/graph.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"
#include "tools/web/types/lcm_parser.h"

namespace fogline::web {
namespace {

using ::testing::HasSubstr;

template <class M>
void ExpectFingerprint() {
  const LcmStruct* type = FoglineTypes().Named(M::getTypeName());
  ASSERT_NE(type, nullptr) << M::getTypeName();
  EXPECT_EQ(type->fingerprint, M::getHash()) << M::getTypeName();
  EXPECT_EQ(FoglineTypes().WithFingerprint(M::getHash()), type);
}

TEST(LcmTypesTest, ComputesTheFingerprintsOfTheGeneratedClasses) {
  std::apply([]<class... M>(const Channel<M>&...) { (ExpectFingerprint<M>(), ...); }, kGraph);
  ExpectFingerprint<header_t>();
  ExpectFingerprint<beacon_t>();
  ExpectFingerprint<log_seal_t>();
}

TEST(LcmTypesTest, HasEveryFileOfLcmtypes) {
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::SourceDirectory() / "lcmtypes")) {
    if (entry.path().extension() != ".lcm") continue;
    ++files;
    EXPECT_NE(FoglineTypes().Named(entry.path().stem().string()), nullptr) << entry.path();
  }
  EXPECT_EQ(FoglineTypes().structs().size(), files);
}

TEST(LcmTypesTest, KnowsTheTypeOfAMessageByItsFirstBytes) {
  std::vector<std::uint8_t> bytes;
  runtime::Encode(ego_t{}, bytes);
  const LcmStruct* type = FoglineTypes().TypeOf(bytes);
  ASSERT_NE(type, nullptr);
  EXPECT_EQ(type->name, "ego_t");
  EXPECT_EQ(FoglineTypes().TypeOf(Bytes(bytes).first(7)), nullptr);
  bytes[0] ^= 1;
  EXPECT_EQ(FoglineTypes().TypeOf(bytes), nullptr);
}

TEST(LcmTypesTest, KnowsWhichTypesHaveAFixedSize) {
  EXPECT_EQ(FoglineTypes().Named("header_t")->fixed_size, 24U);
  EXPECT_EQ(FoglineTypes().Named("ego_t")->fixed_size, 40U);
  EXPECT_EQ(FoglineTypes().Named("truth_t")->fixed_size, std::nullopt);
  EXPECT_EQ(FoglineTypes().Named("status_t")->fixed_size, std::nullopt);
}

std::string TypesErrorOf(std::string_view text) {
  try {
    LcmTypes types(ParseLcm(text, "a.lcm"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LcmTypesTest, RefusesTypesThatHaveNoMeaning) {
  EXPECT_EQ(TypesErrorOf("struct a_t { b_t b; }"), "a_t.b: there is no struct b_t");
  EXPECT_EQ(TypesErrorOf("struct a_t { b_t b; } struct b_t { a_t a; }"), "a_t contains itself");
  EXPECT_EQ(TypesErrorOf("struct a_t { int8_t x; } struct a_t { int8_t y; }"),
            "there are two structs a_t");
}

TEST(LcmTypesTest, FindsAStructOfTheSamePackageFirst) {
  std::vector<LcmStruct> structs =
      ParseLcm("package a; struct x_t { int8_t v; } struct user_t { x_t x; b.x_t y; }", "a.lcm");
  const std::vector<LcmStruct> others = ParseLcm("package b; struct x_t { int32_t v; }", "b.lcm");
  structs.insert(structs.begin(), others.begin(), others.end());
  const LcmTypes types(structs);
  const LcmStruct& user = *types.Named("user_t");
  EXPECT_EQ(types.StructOf(user.members[0]).FullName(), "a.x_t");
  EXPECT_EQ(types.StructOf(user.members[1]).FullName(), "b.x_t");
  EXPECT_EQ(user.fixed_size, 5U);
}

TEST(LcmTypesTest, TreatsASizeThatNoMessageHasAsNotFixed) {
  const LcmTypes types(ParseLcm(
      "struct a_t { double x[4000000000][4000000000][4000000000]; } struct b_t { a_t a[9]; }",
      "a.lcm"));
  EXPECT_EQ(types.Named("a_t")->fixed_size, std::nullopt);
  EXPECT_EQ(types.Named("b_t")->fixed_size, std::nullopt);
}

}  // namespace
}  // namespace fogline::web
