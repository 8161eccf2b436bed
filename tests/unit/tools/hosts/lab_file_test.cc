#include "tools/hosts/lab_file.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/command.h"
#include "tests/support/input_errors.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The error text for a laboratory file with these members.
std::string LabRefusal(const std::string& members) {
  return ErrorOf([&] { hosts::ParseLab(R"({"version": 1, )" + members + "}", "lab.json"); });
}

TEST(LabFileTest, TheShippedExampleIsGood) {
  const LabPlan lab = hosts::LoadLab(SourceDirectory() / "scenario/lab/four_machines.json");
  EXPECT_EQ(lab.hosts.size(), 3U);
}

TEST(LabFileTest, TheShippedSchemaIsTheOneOfTheFields) {
  EXPECT_EQ(Content(SourceDirectory() / "scenario/lab/lab.schema.json"), LabSchema());
}

TEST(LabFileTest, AMistakeIsNamedWithFileLineColumnAndField) {
  EXPECT_THAT(LabRefusal(R"("hosts": [])"),
              StartsWith("lab.json:1:25: error: /hosts: 0 items; allowed are"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a", "rols": []}])"),
              HasSubstr("/hosts/0/rols: unknown key; did you mean \"roles\"?"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"roles": ["acc"]}])"),
              HasSubstr("/hosts/0/name: a name is needed"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a"}, {"name": "a"}])"),
              StartsWith("lab.json:1:50: error: /hosts/1/name: two machines have the name \"a\""));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a", "ssh": "-v"}])"),
              HasSubstr("/hosts/0/ssh: \"-v\" is no machine"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a", "roles": ["ac"]}])"),
              StartsWith("lab.json:1:50: error: /hosts/0/roles/0: \"ac\" is no role; did you mean "
                         "\"acc\"?"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a", "roles": ["recorder"]}])"),
              HasSubstr("/hosts/0/roles/0: the recorder runs on the machine of the run"));
  EXPECT_THAT(
      LabRefusal(R"("hosts": [{"name": "a", "roles": ["acc"]}, {"name": "b", "roles": ["acc"]}])"),
      HasSubstr("/hosts/1/roles/0: the acc already runs on another machine (/hosts/0/roles/0)"));
  EXPECT_THAT(LabRefusal(R"("url": "lab2:7700", "hosts": [{"name": "a"}])"),
              HasSubstr("/url: \"lab2:7700\": no LCM URL such as"));
  EXPECT_THAT(LabRefusal(R"("url": "udpm://239.1.1.1:7700?tll=1", "hosts": [{"name": "a"}])"),
              HasSubstr("/url: \"udpm://239.1.1.1:7700?tll=1\": udpm has no option \"tll\""));
  EXPECT_THAT(LabRefusal(R"("url": "memq", "hosts": [{"name": "a"}])"),
              HasSubstr("/url: \"memq\": no LCM URL such as"));
  EXPECT_THAT(
      LabRefusal(R"("url": "memq://", "hosts": [{"name": "a"}])"),
      HasSubstr("/url: \"memq://\": other machines cannot look into the memory of this one; "
                "give a udpm:// URL"));
  EXPECT_THAT(LabRefusal(R"("url": "tcpq://a", "relay": true, "hosts": [{"name": "a"}])"),
              HasSubstr("/url: the relay has a URL of its own"));
  EXPECT_THAT(LabRefusal(R"("hosts": [{"name": "a"}], "relay": 1)"),
              HasSubstr("what is allowed: fogline check --lab --schema"));
}

TEST(LabFileTest, AFileThatIsMissingIsNamed) {
  EXPECT_THAT(ErrorOf([] { hosts::LoadLab("none/lab.json"); }),
              HasSubstr("none/lab.json: error: "));
}

}  // namespace
}  // namespace fogline::test
