#include "services/log/about/log_version.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "services/log/log_seal.h"
#include "services/runtime/process/version.h"
#include "services/runtime/wire/scenario_parts.h"
#include "tests/support/command.h"
#include "tests/unit/services/log/short_log.h"

namespace fogline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class LogVersionTest : public testing::Test {
 protected:
  /// Writes a log whose only message on RUN has these message types.
  void WriteRun(std::int64_t types) const {
    run_t run = runtime::MakeRunPart(1, run_t::PREPARE, 0, "", {"{}"}, 0);
    run.type_fingerprint = types;
    std::vector<std::uint8_t> bytes;
    runtime::Encode(run, bytes);
    log::EventLogWriter writer(log_);
    writer.Write("RUN", 0, bytes);
    writer.Flush();
  }
  void SealAs(const std::string& version) const {
    log_seal_t seal{};
    seal.version = version;
    log::SealLog(log_, test::WriteShortLog(log_), seal, nullptr);
  }

  test::ScratchFolder folder_;
  const std::string log_ = folder_.File("log");
};

TEST_F(LogVersionTest, IsThatOfTheSeal) {
  SealAs("0.9.3");
  const log::LogVersion version = log::VersionOf(log_);
  EXPECT_EQ(version.writer, "Fogline 0.9.3");
  EXPECT_FALSE(version.other_types);
  EXPECT_EQ(version.Text(),
            "written by Fogline 0.9.3; this is Fogline " + std::string(runtime::Version()));
}

TEST_F(LogVersionTest, OfThisBuildHasNothingToSay) {
  SealAs(std::string(runtime::Version()));
  EXPECT_EQ(log::VersionOf(log_).Text(), "");
  test::WriteShortLog(log_);
  EXPECT_FALSE(log::VersionOf(log_).other_types) << "a log without a seal";
}

TEST_F(LogVersionTest, IsUnknownForMessageTypesThatNoReleaseHas) {
  WriteRun(TypeFingerprint() ^ 1);
  const log::LogVersion version = log::VersionOf(log_);
  EXPECT_EQ(version.writer, "");
  EXPECT_TRUE(version.other_types);
  EXPECT_THAT(version.Text(),
              StartsWith("written by another version of Fogline with other message types; "));
}

TEST_F(LogVersionTest, ShowsNoControlCharactersOfASeal) {
  SealAs("0.9\033[2J");
  EXPECT_EQ(log::VersionOf(log_).Text().find('\033'), std::string::npos);
  EXPECT_THAT(log::VersionOf(log_).Text(), HasSubstr("0.9"));
}

}  // namespace
}  // namespace fogline
