#include "tools/trials/plan_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline::trials {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

/// The message for a file in which this text replaces `"participants": 2`.
std::string Refusal(const std::string& member) {
  const std::string text =
      R"({"version": 1, )" + member + R"(, "conditions": [{"name": "a", "scenario": "a.json"}]})";
  try {
    ParsePlan(text, "e.json");
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "";
}

TEST(PlanFileTest, TheShippedExampleIsGood) {
  const PlanFile file = LoadPlan(test::SourceDirectory() / "scenario/experiment/thresholds.json");
  EXPECT_THAT(file.plan.conditions, SizeIs(3));
  EXPECT_THAT(file.hash, SizeIs(64));
  EXPECT_EQ(LoadCondition(file, file.plan.conditions[0]).arbitrator.threshold, 0.2);
}

TEST(PlanFileTest, TheShippedSchemaIsTheOneOfTheFields) {
  EXPECT_EQ(test::Content(test::SourceDirectory() / "scenario/experiment/experiment.schema.json"),
            ExperimentSchema());
}

TEST(PlanFileTest, AMistakeIsNamedWithFileFieldAndValue) {
  EXPECT_THAT(Refusal(R"("participants": 0)"),
              StartsWith("e.json:1:32: error: /participants: 0 is outside [1, 9999]"));
  EXPECT_THAT(Refusal(R"("paticipants": 3)"),
              HasSubstr("/paticipants: unknown key; did you mean \"participants\"?"));
  EXPECT_THAT(Refusal(R"("order": "latin")"), HasSubstr("/order: \"latin\" is not one of"));
  EXPECT_THAT(Refusal(R"("practice": [{"name": "A b", "scenario": "a.json"}])"),
              HasSubstr("/practice/0/name: \"A b\" is no name"));
  EXPECT_THAT(Refusal(R"("practice": [{"name": "p"}])"),
              HasSubstr("/practice/0/scenario: a scenario file is needed"));
  EXPECT_THAT(Refusal(R"("practice": [{"name": "p", "scenario": "a.json", "set": [1]}])"),
              HasSubstr("/practice/0/set/0: must be"));
  EXPECT_THAT(Refusal(R"("breaks": [{"after_trial": 1}])"),
              HasSubstr("/breaks/0/after_trial: no trial comes after trial 1"));
  EXPECT_THAT(Refusal(R"("questionnaires": [{"name": "q", "kind": "own"}])"),
              HasSubstr("/questionnaires/0/items: kind \"own\" needs items"));
  EXPECT_THAT(Refusal(R"("questionnaires": [{"name": "q", "items": [
                  {"name": "i", "text": "?", "min": 0, "max": 10, "step": 3}]}])"),
              HasSubstr("/items/0/step: 3 does not divide the scale from 0 to 10"));
  EXPECT_THAT(Refusal(R"("questionnaires": [{"name": "q", "kind": "kss"},
                                            {"name": "q", "kind": "kss"}])"),
              HasSubstr("/questionnaires/1/name: two entries have the name \"q\""));
  EXPECT_THAT(Refusal(R"("participants": "x")"), HasSubstr("fogline experiment check --schema"));
}

TEST(PlanFileTest, ATextThatAFactOfALogCannotHoldIsRefused) {
  const auto letters = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "\u00e4";  // two bytes each
    return text;
  };
  const auto title = [&](int count) { return Refusal(R"("title": ")" + letters(count) + "\""); };
  EXPECT_EQ(title(50), "");
  EXPECT_THAT(title(51), StartsWith("e.json:1:25: error: /title: \"\u00e4\u00e4"));
  EXPECT_THAT(title(51), HasSubstr("has 102 bytes; at most 100 are allowed"));
  const auto unit = [&](int count) {
    return Refusal(R"("questionnaires": [{"name": "q", "items": [
                      {"name": "i", "text": "?", "unit": ")" +
                   letters(count) + "\"}]}]");
  };
  EXPECT_EQ(unit(50), "");
  EXPECT_THAT(unit(51), HasSubstr("/questionnaires/0/items/0/unit: "));
  EXPECT_THAT(unit(51), HasSubstr("has 102 bytes; at most 100 are allowed"));
}

TEST(PlanFileTest, TwoBreaksAfterOneTrialAreRefused) {
  const auto error = test::ErrorOf<ScenarioError>([] {
    ParsePlan(R"({"version": 1, "conditions": [{"name": "a", "scenario": "a.json"},
                  {"name": "b", "scenario": "a.json"}],
                  "breaks": [{"after_trial": 1}, {"after_trial": 1, "at_least_s": 60}]})",
              "e.json");
  });
  EXPECT_THAT(error, HasSubstr("/breaks/1/after_trial: two breaks come after trial 1"));
}

TEST(PlanFileTest, AFileWithoutConditionsIsRefused) {
  EXPECT_THROW(ParsePlan(R"({"version": 1})"), ScenarioError);
  EXPECT_THROW(ParsePlan(R"({"version": 1, "conditions": []})"), ScenarioError);
  EXPECT_THROW(ParsePlan("[]"), ScenarioError);
}

TEST(PlanFileTest, EachMistakeOfAScenarioIsNamedWithItsLineAndField) {
  const test::ScratchFolder folder;
  const std::string paper = (test::SourceDirectory() / "scenario/paper.json").string();
  std::ofstream(folder.File("wrong.json")) << "{\n  \"steps\": 0, \"version\": 1\n}\n";
  std::ofstream(folder.File("e.json"))
      << "{\"version\": 1, \"conditions\": [\n{\"name\": \"wild\", \"scenario\": \"" << paper
      << "\", \"set\": [\"/steps=1\", \"/arbitrator/threshold=7\", \"/lead/recorded/fil="
      << std::string(200, 'x') << "\"]},\n"
      << R"({"name": "wrong", "scenario": "wrong.json"},)"
      << R"({"name": "again", "scenario": "wrong.json"}], "practice": [{"name": "gone", )"
      << "\n"
      << R"("scenario": "gone.json"}]})";
  try {
    LoadPlan(folder.File("e.json"));
    FAIL() << "accepted";
  } catch (const ScenarioError& error) {
    EXPECT_THAT(error.what(), HasSubstr("e.json:2:"));
    EXPECT_THAT(error.what(), HasSubstr(": error: /conditions/0/set/1: /arbitrator/threshold: 7 is "
                                        "outside [0, 1]"));
    EXPECT_THAT(error.what(), HasSubstr("e.json:3:"));
    EXPECT_THAT(error.what(), HasSubstr(": error: /conditions/1/scenario: " +
                                        folder.File("wrong.json") + ":2:12: /steps: 0 is outside"));
    EXPECT_THAT(error.what(), HasSubstr("e.json:4:"));
    EXPECT_THAT(error.what(), HasSubstr(": error: /practice/0/scenario: " +
                                        folder.File("gone.json") + ": cannot be read"));
    EXPECT_THAT(error.what(), HasSubstr(": error: /conditions/0/set/2: /lead/recorded/fil: "));
    EXPECT_THAT(error.what(), Not(HasSubstr("/conditions/2")));
    EXPECT_THAT(error.what(), EndsWith("\n4 errors; what is allowed: fogline check --explain "
                                       "/arbitrator/threshold"));
  }
}

TEST(PlanFileTest, AMissingFileIsNamedOnceAndTheFirstMistakeIsExplained) {
  const test::ScratchFolder folder;
  const std::string paper = (test::SourceDirectory() / "scenario/paper.json").string();
  // "practice" comes first in the text, but is checked after "conditions". The hint at the end of
  // the error must belong to the first mistake in the text.
  std::ofstream(folder.File("e.json"))
      << R"({"version": 1, "practice": [{"name": "p", "scenario": ")" << paper
      << R"(", "set": ["/arbitrator/threshold=7"]}], "conditions": [)"
      << R"({"name": "a", "scenario": "gone.json"}, {"name": "b", "scenario": "gone.json"}]})";
  const std::string error = test::ErrorOf([&folder] { LoadPlan(folder.File("e.json")); });
  EXPECT_THAT(error, HasSubstr("/conditions/0/scenario: " + folder.File("gone.json")));
  EXPECT_THAT(error, Not(HasSubstr("/conditions/1")));
  EXPECT_THAT(error, EndsWith("\n2 errors; what is allowed: fogline check --explain "
                              "/arbitrator/threshold"));
}

TEST(PlanFileTest, ASpeedAtWhichNoTrialCanBeMadeIsRefused) {
  const test::ScratchFolder folder;
  const auto error_at = [&folder](const std::string& speed, const std::string& set) {
    const std::string paper = (test::SourceDirectory() / "scenario/paper.json").string();
    std::ofstream(folder.File("e.json"))
        << "{\"version\": 1, \"speed\": " << speed << ",\n\"conditions\": [{\"name\": \"a\", "
        << "\"scenario\": \"" << paper << "\", \"set\": [" << set << "]}]}";
    return test::ErrorOf([&folder] { LoadPlan(folder.File("e.json")); });
  };
  EXPECT_EQ(error_at("20", ""), "");
  EXPECT_THAT(error_at("50", ""),
              HasSubstr("e.json:1:25: error: /speed: 50: in condition \"a\": a step of 0.1 s would "
                        "take 2 ms of wall clock; the shortest is 5 ms"));
  EXPECT_EQ(error_at("1", "\"/person/drives=true\""), "");
  EXPECT_THAT(
      error_at("2", "\"/person/drives=true\""),
      HasSubstr("e.json:1:25: error: /speed: 2: in condition \"a\": a person drives at speed 1"));
}

}  // namespace
}  // namespace fogline::trials
