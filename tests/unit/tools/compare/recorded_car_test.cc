#include "tools/compare/recorded_car.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline {
namespace {

using test::ErrorOf;
using testing::EndsWith;
using testing::HasSubstr;

class RecordedCarTest : public testing::Test {
 protected:
  RecordedCarTest() {
    leader_.time_column = "t";
    leader_.speed_column = "v1";
  }
  compare::RecordedCar Read(const std::string& text) const {
    std::ofstream(file_) << text;
    return compare::ReadRecordedCar(file_, {.speed = "v2", .gap = "gap"}, leader_);
  }
  std::string Error(const std::string& text) const {
    return ErrorOf([&] { Read(text); });
  }

  const test::ScratchFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "car.csv";
  RecordedSection leader_;
};

TEST_F(RecordedCarTest, HasTheNamedColumnsInAnyOrderAndALeaderOnlyIfTheFileHasOne) {
  const compare::RecordedCar car = Read("gap,x,v2,t,v1\n30,9,20,0,21\n31,9,20.5,0.1,22\n");
  ASSERT_EQ(car.times_s.size(), 2U);
  EXPECT_EQ(car.times_s[1].value, 0.1);
  EXPECT_EQ(car.speeds_mps[1].value, 20.5);
  EXPECT_EQ(car.gaps_m[1].value, 31);
  EXPECT_EQ(car.leader_mps[1].value, 22);
  EXPECT_TRUE(Read("t,v2,gap\n0,20,30\n").leader_mps.empty());
}

TEST_F(RecordedCarTest, NamesTheLineAndTheColumnOfAWrongValue) {
  EXPECT_THAT(Error("t,v2,gap\n0,20,30\n0.1,200,30\n"),
              EndsWith("car.csv:3: error: v2 is 200, not between -150 and 150"));
  EXPECT_THAT(Error("t,v2,gap\n0,20,-1\n"),
              EndsWith("car.csv:2: error: gap is -1, not between 0 and 10000"));
  EXPECT_THAT(Error("t,v2,gapp\n0,20,30\n"), HasSubstr("did you mean \"gapp\"?"));
  EXPECT_THAT(Error("0,20,30\n"), HasSubstr("it must name the columns"));
  EXPECT_THAT(Error("t;v2;gap\n0;20;30\n"), HasSubstr("seems to be separated by ';'"));
  EXPECT_THAT(Error(""), HasSubstr("the file is empty"));
}

TEST_F(RecordedCarTest, MustAscendAndCoverTheRun) {
  const std::vector<CsvNumber> times_s{{200, 0}, {200.1, 0}, {200.2, 0}};
  const auto error = [&](double begin_s, double end_s) {
    return ErrorOf([&] { compare::CheckTimes(times_s, begin_s, end_s, file_); });
  };
  EXPECT_EQ(error(200, 200.2), "");
  EXPECT_THAT(error(199.9, 200.2), HasSubstr("has 200 s to 200.2 s, but the run is from 199.9 s"));
  EXPECT_THAT(error(200, 200.3), HasSubstr("but the run is from 200 s to 200.3 s"));
  EXPECT_THAT(ErrorOf([&] {
                compare::CheckTimes({{1, 0}, {1, 0}}, 1, 1, file_);
              }),
              HasSubstr("time 1 s is followed by 1 s"));
  EXPECT_THAT(ErrorOf([&] { compare::CheckTimes({}, 1, 1, file_); }), HasSubstr("no rows"));
}

TEST_F(RecordedCarTest, MustHaveTheLeaderOfTheRun) {
  const compare::RecordedCar car = Read("t,v1,v2,gap\n200,20,19,30\n201,22,19,30\n");
  leader_.start_s = 200;
  const auto error = [&](double speed_mps) {
    metrics::Sample sample;
    sample.time_s = 0.5;
    sample.preceding_speed_mps = speed_mps;
    return ErrorOf([&] { compare::CheckLeader(car, leader_, std::vector{sample}, file_); });
  };
  EXPECT_EQ(error(21.4), "");
  EXPECT_THAT(error(21.6), HasSubstr("v1 is 21.00 m/s at 200.5 s, but the run's leader drives "
                                     "21.60 m/s"));
}

}  // namespace
}  // namespace fogline
