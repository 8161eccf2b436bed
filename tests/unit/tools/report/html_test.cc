#include "tools/report/html.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(EscapeHtmlTest, LeavesNothingThatOpensATagOrEndsAnAttribute) {
  EXPECT_EQ(report::EscapeHtml("<b a=\"1\" c='2'> & \xCE\xBB"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt; &amp; \xCE\xBB");
}

TEST(EscapeScriptTest, KeepsTheJsonAndCannotEndTheScript) {
  EXPECT_EQ(report::EscapeScript(R"({"name":"</script><!--"})"),
            R"({"name":"\u003c/script>\u003c!--"})");
}

TEST(FillTest, PutsValuesInAndDoesNotLookIntoThem) {
  EXPECT_EQ(report::Fill("<{{a}}|{{b}}|{{a}}>", {{"a", "{{b}}"}, {"b", "2"}}), "<{{b}}|2|{{b}}>");
}

TEST(FillTest, RefusesANameWithoutValue) {
  EXPECT_THROW(report::Fill("{{missing}}", {{"a", "1"}}), std::out_of_range);
}

TEST(DecimalTest, UsesATrueMinusSignAndNoNegativeZero) {
  EXPECT_EQ(report::Decimal(-1.25, 1), "\u22121.2");
  EXPECT_EQ(report::Decimal(-0.001, 2), "0.00");
  EXPECT_EQ(report::Decimal(12.345, 0), "12");
}

TEST(DecimalTest, ShowsADashForNoValue) {
  EXPECT_EQ(report::Decimal(std::numeric_limits<double>::quiet_NaN(), 2), "–");
  EXPECT_EQ(report::Decimal(std::numeric_limits<double>::infinity(), 2), "–");
}

TEST(DataElementTest, CarriesTheExactNumberBesideTheRoundedOne) {
  EXPECT_EQ(report::DataElement(0.1 + 0.2, 2), "<data value=\"0.30000000000000004\">0.30</data>");
}

TEST(MetricElementTest, CarriesTheExactNumberBesideTheTextOfTheMeasure) {
  EXPECT_EQ(report::MetricElement("min_host_ttc_s", 2949.25, "s"),
            "<data value=\"2949.25\">&gt; 1000</data>");
  EXPECT_EQ(report::MetricElement("min_host_rss_margin_m", -1e-5, "m"),
            "<data value=\"-1e-05\">&gt; \u22120.001</data>");
  EXPECT_EQ(report::MetricElement("steps", std::numeric_limits<double>::quiet_NaN(), ""), "–");
}

}  // namespace
}  // namespace fogline
