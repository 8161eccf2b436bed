#include "services/decision/conflict/over_time/degree_of_conflict.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr auto kAbsolute = ConflictReading::kMeanOfAbsolute;
constexpr auto kSigned = ConflictReading::kAbsoluteOfMean;
constexpr double kSlope = 10;  // 1/m, of the paper
constexpr double kCentre = 1;  // m, of the paper

TEST(DegreeOfConflictTest, HasThePaperValueWithoutConflict) {
  EXPECT_NEAR(conflict::DegreeOfConflict(0, kSlope, kCentre), 4.54e-5,
              5e-8);  // the paper prints 0.00005
}

TEST(DegreeOfConflictTest, HasTheTabulatedValues) {
  const std::array<std::pair<double, double>, 6> table{
      {{0.8, 0.119}, {0.9, 0.269}, {1.0, 0.500}, {1.1, 0.731}, {1.22, 0.900}, {1.5, 0.993}}};
  for (const auto& [z, doc] : table) {
    EXPECT_NEAR(conflict::DegreeOfConflict(z, kSlope, kCentre), doc, 5e-4) << "z = " << z;
  }
}

TEST(DegreeOfConflictTest, IsExactlyOneHalfAtTheCentre) {
  EXPECT_EQ(conflict::DegreeOfConflict(kCentre, kSlope, kCentre), 0.5);
  EXPECT_EQ(conflict::DegreeOfConflict(3, 0.7, 3), 0.5);
}

TEST(DegreeOfConflictTest, StaysWithinZeroAndOneWhereTheExponentialOverflows) {
  EXPECT_EQ(conflict::DegreeOfConflict(0, 1000, 100), 0);
  EXPECT_EQ(conflict::DegreeOfConflict(1000, 1000, 0), 1);
}

TEST(ConflictWindowTest, HasNoConflictWhileItIsEmpty) {
  conflict::ConflictWindow window(3);
  EXPECT_EQ(window.Conflict(kAbsolute), 0);
  window.Push(std::nullopt);
  EXPECT_EQ(window.Conflict(kAbsolute), 0);
  EXPECT_EQ(window.Conflict(kSigned), 0);
}

TEST(ConflictWindowTest, AveragesWhatIsThereUntilItIsFull) {
  conflict::ConflictWindow window(4);
  window.Push(1.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 1.0);
  window.Push(2.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 1.5);
  window.Push(6.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 3.0);
}

TEST(ConflictWindowTest, ForgetsADifferenceExactlyAfterItsLength) {
  constexpr int kLength = 8;
  conflict::ConflictWindow window(kLength);
  for (int i = 0; i < kLength; ++i) window.Push(0.0);
  window.Push(8.0);
  for (int age = 0; age < kLength; ++age) {
    EXPECT_EQ(window.Conflict(kAbsolute), 1.0) << "age " << age;
    window.Push(0.0);
  }
  EXPECT_EQ(window.Conflict(kAbsolute), 0.0);
}

TEST(ConflictWindowTest, AnEmptyPlaceAgesLikeAnyOther) {
  conflict::ConflictWindow window(3);
  window.Push(6.0);
  window.Push(std::nullopt);
  window.Push(2.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 4.0);
  window.Push(std::nullopt);  // 6 leaves the window
  EXPECT_EQ(window.Conflict(kAbsolute), 2.0);
  window.Push(std::nullopt);
  EXPECT_EQ(window.Conflict(kAbsolute), 2.0);
  window.Push(std::nullopt);  // 2 leaves the window
  EXPECT_EQ(window.Conflict(kAbsolute), 0.0);
}

TEST(ConflictWindowTest, ReadingsDifferForDifferencesOfAlternatingSign) {
  conflict::ConflictWindow window(4);
  for (const double difference : {1.0, -1.0, 1.0, -1.0}) window.Push(difference);
  EXPECT_EQ(window.Conflict(kAbsolute), 1.0);
  EXPECT_EQ(window.Conflict(kSigned), 0.0);
}

TEST(ConflictWindowTest, ReadingsAgreeForDifferencesOfOneSign) {
  conflict::ConflictWindow window(2);
  window.Push(-1.0);
  window.Push(-3.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 2.0);
  EXPECT_EQ(window.Conflict(kSigned), 2.0);
}

TEST(ConflictWindowTest, OfOneStepIsThatStep) {
  conflict::ConflictWindow window(1);
  window.Push(5.0);
  window.Push(-2.0);
  EXPECT_EQ(window.Conflict(kAbsolute), 2.0);
  window.Push(std::nullopt);
  EXPECT_EQ(window.Conflict(kAbsolute), 0.0);
}

}  // namespace
}  // namespace fogline
