#include "services/models/traffic/load_sumo.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/errors.h"
#include "tests/support/command.h"

namespace fogline::models {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Scenario WithSumo() {
  Scenario scenario;
  scenario.lead.profile = LeadProfile::kSumo;
  scenario.lead.sumo.net = {"<net/>"};
  scenario.lead.sumo.routes = {"<routes/>"};
  return scenario;
}

std::string ErrorOf(const Scenario& scenario, const std::filesystem::path& module) {
  try {
    LoadSumo(scenario, module);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(LoadSumoTest, NamesThePackageIfThisBuildHasNoModule) {
  const test::ScratchFolder folder;
  EXPECT_EQ(ErrorOf(WithSumo(), folder.File("sumo.so")),
            "/lead/profile: \"sumo\" needs SUMO, and this build of Fogline has none: install "
            "Debian's package sumo, and build again "
            "(tools/build fogline_programs)");
}

TEST(LoadSumoTest, NamesThePackageAndTheReasonIfTheModuleCannotBeLoaded) {
  const test::ScratchFolder folder;
  const std::string module = folder.File("sumo.so");
  std::ofstream(module) << "no library";
  const std::string error = ErrorOf(WithSumo(), module);
  EXPECT_THAT(error, StartsWith("/lead/profile: \"sumo\" needs SUMO: install Debian's package sumo "
                                "("));
  EXPECT_THAT(error, HasSubstr(module));
}

TEST(LoadSumoTest, LooksForTheModuleBesideTheFolderOfTheProgram) {
  EXPECT_EQ(SumoModule(), test::ProgramDirectory().parent_path() / "lib/fogline/sumo.so");
}

}  // namespace
}  // namespace fogline::models
