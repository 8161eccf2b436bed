#include "tools/trials/questionnaires.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace fogline::trials {
namespace {

using ::testing::SizeIs;

QuestionnaireSection Standard(QuestionnaireKind kind) {
  QuestionnaireSection questionnaire;
  questionnaire.kind = kind;
  return WithItems(questionnaire);
}

TEST(QuestionnairesTest, TheTaskLoadIndexHasSixScalesOfTwentyOneMarks) {
  const QuestionnaireSection tlx = Standard(QuestionnaireKind::kNasaTlx);
  ASSERT_THAT(tlx.items, SizeIs(6));
  for (const ItemSection& item : tlx.items) {
    EXPECT_EQ(item.min, 0) << item.name;
    EXPECT_EQ(item.max, 100) << item.name;
    EXPECT_EQ(item.step, 5) << item.name;
  }
  // A high value is bad on each scale, also on the scale of performance.
  EXPECT_EQ(tlx.items[3].name, "performance");
  EXPECT_EQ(tlx.items[3].low, "perfect");
}

TEST(QuestionnairesTest, TheSleepinessScaleGoesFrom1To9) {
  const QuestionnaireSection kss = Standard(QuestionnaireKind::kKss);
  ASSERT_THAT(kss.items, SizeIs(1));
  EXPECT_EQ(kss.items[0].min, 1);
  EXPECT_EQ(kss.items[0].max, 9);
}

TEST(QuestionnairesTest, AnAnswerLiesOnTheScale) {
  const ItemSection item = Standard(QuestionnaireKind::kNasaTlx).items[0];
  std::string why;
  for (const char* good : {"0", "5", "100", "35.0"}) {
    EXPECT_TRUE(ReadAnswer(item, good, why)) << good;
  }
  for (const char* bad : {"", "3", "-5", "105", "5 ", "nan", "inf", "five", "5,0"}) {
    why.clear();
    EXPECT_FALSE(ReadAnswer(item, bad, why)) << bad;
    EXPECT_EQ(why, "a number from 0 to 100 in steps of 5");
  }
}

TEST(QuestionnairesTest, AStepThatIsNoBinaryNumberHasAllItsMarks) {
  ItemSection item;
  item.min = 0;
  item.max = 1;
  item.step = 0.1;
  std::string why;
  EXPECT_EQ(ReadAnswer(item, "0.3", why)->value, 0.3);
  EXPECT_EQ(ReadAnswer(item, "0.7", why)->value, 0.7);
  EXPECT_FALSE(ReadAnswer(item, "0.75", why));
}

TEST(QuestionnairesTest, AFreeTextIsUtf8WithoutControlCharacters) {
  ItemSection item;
  item.kind = ItemKind::kText;
  std::string why;
  EXPECT_EQ(ReadAnswer(item, "glatt, \"gut\"", why)->text, "glatt, \"gut\"");
  EXPECT_EQ(ReadAnswer(item, "", why)->text, "");
  EXPECT_FALSE(ReadAnswer(item, "a\tb", why));
  EXPECT_FALSE(ReadAnswer(item, "\xff", why));
  EXPECT_TRUE(ReadAnswer(item, std::string(500, 'x'), why));
  EXPECT_FALSE(ReadAnswer(item, std::string(501, 'x'), why));
}

TEST(QuestionnairesTest, AFreeTextHasAtMost500BytesAlsoIfItsCharactersHaveSeveral) {
  ItemSection item;
  item.kind = ItemKind::kText;
  std::string longest;
  for (int i = 0; i < 250; ++i) longest += "\u00e4";  // two bytes each
  std::string why;
  EXPECT_EQ(ReadAnswer(item, longest, why)->text, longest);
  EXPECT_FALSE(ReadAnswer(item, longest + "x", why));
  EXPECT_EQ(why, "a text of at most 500 bytes");
}

}  // namespace
}  // namespace fogline::trials
