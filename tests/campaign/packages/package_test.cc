// The Debian packages of this build.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/graph.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Makes the packages once for all suites.
class PackageTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (folder_ != nullptr) return;
    folder_ = std::make_unique<ScratchFolder>();
    const Outcome cpack = RunCommand({"cpack", "--config", FOGLINE_BINARY_DIR "/CPackConfig.cmake",
                                      "-B", folder_->path().string()},
                                     std::chrono::seconds(500));
    ASSERT_EQ(cpack.code, 0) << cpack.out << cpack.err;
    for (const auto& file : std::filesystem::directory_iterator(folder_->path())) {
      const std::string name = file.path().filename().string();
      if (file.path().extension() == ".deb") {
        packages_[name.substr(0, name.find('_'))] = file.path().string();
      }
    }
    for (const char* package : {"fogline", "fogline-dev", "python3-fogline-lab"}) {
      ASSERT_TRUE(packages_.contains(package)) << package;
      const Outcome unpack =
          RunCommand({"dpkg-deb", "-x", packages_[package], folder_->File(package)});
      ASSERT_EQ(unpack.code, 0) << unpack.err;
    }
  }

  static std::string Field(const std::string& package, const std::string& field) {
    return RunCommand({"dpkg-deb", "-f", packages_.at(package), field}).out;
  }
  /// A file of the unpacked packages.
  static std::string Installed(const std::string& file) { return folder_->File(file); }

  static std::unique_ptr<ScratchFolder> folder_;
  static std::map<std::string, std::string> packages_;
};
std::unique_ptr<ScratchFolder> PackageTest::folder_;
std::map<std::string, std::string> PackageTest::packages_;

TEST_F(PackageTest, LintianFindsNoErrorAndNoWarning) {
  for (const auto& [name, file] : packages_) {
    const Outcome lintian =
        RunCommand({"lintian", "--allow-root", "--fail-on", "error,warning", file});
    EXPECT_EQ(lintian.code, 0) << name << ":\n" << lintian.out << lintian.err;
  }
}

TEST_F(PackageTest, DependsOnTheLibrariesThatItsProgramsLoad) {
  const std::string depends = Field("fogline", "Depends");
  for (const char* library : {"libc6 (>= ", "liblcm1", "libfmt9", "libmatio11", "libsodium23"}) {
    EXPECT_THAT(depends, HasSubstr(library));
  }
  EXPECT_THAT(Field("fogline-dev", "Depends"), HasSubstr("liblcm-dev"));
}

TEST_F(PackageTest, HasAManualPageOfEveryProgramAndEveryVerb) {
  const std::filesystem::path pages = Installed("fogline/usr/share/man/man1");
  for (const auto& file : std::filesystem::directory_iterator(Installed("fogline/usr/bin"))) {
    const std::string program = file.path().filename().string();
    EXPECT_TRUE(std::filesystem::exists(pages / (program + ".1.gz"))) << program;
  }
  const Outcome verbs = RunCommand({Program("fogline"), "--complete", ""});
  std::istringstream lines(verbs.out);
  for (std::string verb; std::getline(lines, verb);) {
    verb = verb.substr(0, verb.find('\t'));
    EXPECT_TRUE(std::filesystem::exists(pages / ("fogline-" + verb + ".1.gz"))) << verb;
  }
  EXPECT_TRUE(std::filesystem::exists(pages / "fogline-experiment-run.1.gz"));
}

TEST_F(PackageTest, HasManualPagesThatTheFormatterTakesWithoutAWarning) {
  for (const auto& page :
       std::filesystem::directory_iterator(Installed("fogline/usr/share/man/man1"))) {
    const Outcome man =
        RunCommand({"env", "LANG=C.UTF-8", "MANROFFSEQ=", "MANWIDTH=80", "man", "--warnings", "-E",
                    "UTF-8", "-l", "-Tutf8", "-Z", page.path().string()});
    EXPECT_EQ(man.code, 0) << page.path();
    EXPECT_EQ(man.err, "") << page.path();
  }
}

TEST_F(PackageTest, HasTheMessageTypesFromWhichLcmGenMakesThisBuildsTypes) {
  std::vector<std::string> types;
  for (const auto& file :
       std::filesystem::directory_iterator(Installed("fogline-dev/usr/share/fogline/lcmtypes"))) {
    types.push_back(file.path().string());
  }
  std::vector<std::string> command{"lcm-gen", "-p", "--ppath", Installed("python")};
  command.insert(command.end(), types.begin(), types.end());
  ASSERT_EQ(RunCommand(command).code, 0);
  // The generated Python class gives the fingerprint of truth_t. Every TRUTH message begins with
  // this fingerprint.
  const Outcome fingerprint = RunCommand(
      {"python3", "-c",
       "import sys; sys.path.insert(0, '" + Installed("python") +
           "'); import fogline; print(fogline.truth_t._get_packed_fingerprint().hex())"});
  ASSERT_EQ(fingerprint.code, 0) << fingerprint.err;
  EXPECT_EQ(std::stoull(fingerprint.out, nullptr, 16),
            static_cast<std::uint64_t>(truth_t::getHash()));
}

TEST_F(PackageTest, LetsAnotherProjectBuildARoleThatTakesPartInARun) {
  const std::string build = Installed("driver");
  Outcome step = RunCommand({"cmake", "-S", "tests/integration/external_driver", "-B", build, "-G",
                             "Ninja", "-DCMAKE_PREFIX_PATH=" + Installed("fogline-dev/usr")});
  ASSERT_EQ(step.code, 0) << step.err;
  step = RunCommand({"cmake", "--build", build});
  ASSERT_EQ(step.code, 0) << step.out;
  const std::string url = runtime::FreshMulticastUrl();
  Background driver({build + "/my_driver", "--lcm-url", url});
  const Outcome run = RunCommand({Installed("fogline/usr/bin/fogline"), "run",
                                  Installed("fogline/usr/share/fogline/scenario/paper.json"),
                                  "--set", "/steps=60", "--external", "driver", "--lcm-url", url,
                                  "--log", Installed("run.lcm"), "--json"});
  ASSERT_EQ(run.code, 0) << run.err << driver.Err();
  EXPECT_EQ(nlohmann::json::parse(run.out)["steps"], 60);
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(PackageTest, HasEveryScenarioExperimentAndLaboratoryOfTheTree) {
  const std::filesystem::path source = SourceDirectory() / "scenario";
  const std::filesystem::path installed = Installed("fogline/usr/share/fogline/scenario");
  int files = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(source)) {
    const std::filesystem::path name = std::filesystem::relative(file.path(), source);
    if (name.extension() != ".json" || *name.begin() == "bad") continue;
    ++files;
    EXPECT_EQ(Content((installed / name).string()), Content(file.path().string())) << name;
  }
  EXPECT_GE(files, 15);
}

TEST_F(PackageTest, LetsPythonStartARunAndBeItsDriver) {
  const std::vector<std::string> python{
      "env",
      "PYTHONPATH=" + Installed("python3-fogline-lab/usr/lib/python3/dist-packages"),
      "PATH=" + Installed("fogline/usr/bin") + ":/usr/bin:/bin",
      "LCM_DEFAULT_URL=" + runtime::FreshMulticastUrl(),
      "/usr/bin/python3",
      "-B"};
  const auto with = [&python](std::vector<std::string> more) {
    more.insert(more.begin(), python.begin(), python.end());
    return more;
  };
  Background driver(with({"tools/python/examples/driver.py"}));
  const Outcome runs = RunCommand(with({"-c", R"(
import fogline_lab as fl
paper = "scenario/paper.json"
print(fl.run(paper, external="driver").digest == fl.run(paper, transport="direct").digest))"}));
  EXPECT_EQ(runs.code, 0) << runs.err << driver.Err();
  EXPECT_EQ(runs.out, "True\n");
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

/// The systemd unit of a role. It starts the programs of the unpacked package, not those in
/// /usr/bin.
class UnitTest : public PackageTest {
 protected:
  void SetUp() override {
    std::string text = Content(Installed("fogline/lib/systemd/system/fogline@.service"));
    const std::string bin = "/usr/bin/";
    for (std::size_t at = 0; (at = text.find(bin, at)) != std::string::npos;) {
      text.replace(at, bin.size(), Installed("fogline") + bin);
      at += Installed("fogline").size() + bin.size();
    }
    std::ofstream(unit_) << text;
  }

  const std::string unit_ = Installed("fogline@fusion.service");
};

TEST_F(UnitTest, IsValidForSystemd) {
  const Outcome verify = RunCommand({"systemd-analyze", "verify", "--man=no", unit_});
  EXPECT_EQ(verify.code, 0) << verify.err;
  std::istringstream lines(verify.err);
  std::vector<std::string> remarks;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("fogline") != std::string::npos) remarks.push_back(line);
  }
  EXPECT_THAT(remarks, IsEmpty());
}

TEST_F(UnitTest, HasNoLimitThatShortRunsOrRealTimeWouldReach) {
  const std::string text = Content(unit_);
  EXPECT_THAT(text, HasSubstr("\nStartLimitIntervalSec=0\n"));
  EXPECT_THAT(text, HasSubstr("\nLimitRTPRIO=2\n"));
  EXPECT_THAT(text, HasSubstr("\nLimitMEMLOCK=infinity\n"));
}

// A role that is started while the network is away ends with exit code 2.
TEST_F(UnitTest, StartsARoleAgainWhateverItsExitCode) {
  const std::string text = Content(unit_);
  EXPECT_THAT(text, HasSubstr("\nRestart=always\n"));
  EXPECT_THAT(text, Not(HasSubstr("\nRestartPreventExitStatus=")));
}

TEST_F(UnitTest, StartsARoleThatTakesPartInARun) {
  // GIVEN the command of the unit, with the variables of /etc/default/fogline
  const std::string text = Content(unit_);
  const std::string key = "ExecStart=";
  const std::size_t at = text.find(key) + key.size();
  std::string command = text.substr(at, text.find('\n', at) - at);
  for (std::size_t i = 0; (i = command.find("%i")) != std::string::npos;) {
    command.replace(i, 2, "fusion");
  }
  const std::string url = runtime::FreshMulticastUrl();
  Background role({"sh", "-c",
                   ". " + Installed("fogline/etc/default/fogline") + "; export LCM_DEFAULT_URL='" +
                       url + "'; exec " + command});
  // WHEN a run waits for this role THEN the role takes part
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=60",
                  "--external", "fusion", "--lcm-url", url, "--log", Installed("unit.lcm")});
  EXPECT_EQ(run.code, 0) << run.err << role.Err();
  EXPECT_EQ(role.Wait(), 0) << role.Err();
}

}  // namespace
}  // namespace fogline::test
