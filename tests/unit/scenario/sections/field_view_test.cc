#include "scenario/sections/field_view.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fogline {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> Pointers(const FieldList& fields) {
  std::vector<std::string> pointers;
  for (const Field& field : fields) pointers.push_back(field.pointer);
  return pointers;
}

TEST(FieldViewTest, HasTheFieldsOfASectionInTheirOrder) {
  PublishedRow row;
  EXPECT_THAT(Pointers(FieldsOf(row, "/rows/3")),
              ElementsAre("/rows/3/threshold", "/rows/3/si_pct", "/rows/3/rhe_pct"));
}

TEST(FieldViewTest, KnowsNameRangeMeaningAndSource) {
  Scenario scenario;
  const Field field = FieldAt(scenario, "/step_s").value();
  EXPECT_EQ(field.name, "step_s");
  EXPECT_EQ(field.doc, "Length of a step.");
  EXPECT_EQ(field.source, "Sourav & Cheng 2024: 0.1 s");
  const NumberSpec& spec = field.As<NumberField>()->spec;
  EXPECT_EQ(spec.min, 0.001);
  EXPECT_EQ(spec.max, 1);
  EXPECT_EQ(spec.unit, "s");
}

TEST(FieldViewTest, HasForEachChoiceANameOfItsOwnAndAMeaning) {
  Scenario scenario;
  int choices = 0;
  for (const Field& field : AllFields(scenario)) {
    const auto* choice = field.As<ChoiceField>();
    if (choice == nullptr) continue;
    ++choices;
    const std::set<std::string_view> names(choice->names.begin(), choice->names.end());
    EXPECT_EQ(names.size(), choice->names.size()) << field.pointer;
    ASSERT_EQ(choice->docs.size(), choice->names.size()) << field.pointer;
    EXPECT_THAT(choice->names, Each(Not(IsEmpty()))) << field.pointer;
    EXPECT_THAT(choice->docs, Each(Not(IsEmpty()))) << field.pointer;
  }
  EXPECT_GE(choices, 20);
}

TEST(FieldViewTest, RefersToTheValuesOfTheScenario) {
  Scenario scenario;
  scenario.lead.recorded.speeds_mps = {1, 2};
  scenario.lead.breakpoints.resize(2);
  *FieldAt(scenario, "/fog/bias_m")->As<NumberField>()->value = 5;
  *FieldAt(scenario, "/lead/recorded/speeds_mps/1")->As<NumberField>()->value = 6;
  *FieldAt(scenario, "/lead/breakpoints/1/speed_mps")->As<NumberField>()->value = 7;
  FieldAt(scenario, "/fog/model")->As<ChoiceField>()->set(2);
  EXPECT_EQ(scenario.fog.bias_m, 5);
  EXPECT_THAT(scenario.lead.recorded.speeds_mps, ElementsAre(1, 6));
  EXPECT_EQ(scenario.lead.breakpoints[1].speed_mps, 7);
  EXPECT_EQ(scenario.fog.model, FogModel::kBeam);
}

TEST(FieldViewTest, HasNoFieldWhereTheScenarioHasNone) {
  Scenario scenario;
  scenario.lead.recorded.speeds_mps = {1, 2};
  for (const char* pointer : {"", "/", "/fogs", "/fog/bias", "/fog/bias_m/0", "/published/0",
                              "/lead/recorded/speeds_mps/2", "/lead/recorded/speeds_mps/01",
                              "/lead/recorded/speeds_mps/1/x"}) {
    EXPECT_FALSE(FieldAt(scenario, pointer)) << pointer;
  }
}

TEST(FieldViewTest, PutsContentsBehindTheirSectionOrList) {
  Scenario scenario;
  scenario.lead.recorded.speeds_mps = {1, 2};
  scenario.published.resize(1);
  const std::vector<std::string> all = Pointers(AllFields(scenario));
  const auto speeds = std::find(all.begin(), all.end(), "/lead/recorded/speeds_mps");
  ASSERT_LT(speeds + 3, all.end());
  EXPECT_THAT(std::vector(speeds, speeds + 4),
              ElementsAre("/lead/recorded/speeds_mps", "/lead/recorded/speeds_mps/0",
                          "/lead/recorded/speeds_mps/1", "/lead/sumo"));
  EXPECT_THAT(std::vector(all.end() - 5, all.end()),
              ElementsAre("/published", "/published/0", "/published/0/threshold",
                          "/published/0/si_pct", "/published/0/rhe_pct"));
}

}  // namespace
}  // namespace fogline
