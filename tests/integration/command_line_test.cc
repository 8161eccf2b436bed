// The command line as a person meets it: what it says when asked, and when it cannot follow.
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/graph.h"
#include "tests/support/command.h"
#include "tests/support/verbs.h"

namespace fogline::test {
namespace {

using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Le;
using ::testing::SizeIs;

std::string HelpOf(std::vector<std::string> command) {
  command.emplace_back("--help");
  const Outcome help = RunCommand(command);
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.err, "");
  return help.out;
}

/// What the command line cannot follow: exit code 2, nothing on stdout, one line on stderr.
std::string ErrorOf(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), Program("fogline"));
  const Outcome outcome = RunCommand(arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(Lines(outcome.err), SizeIs(1));
  return outcome.err;
}

/// What every help text has: exit codes, at least one example, no line too long for a terminal.
void ExpectWholeHelp(const std::vector<std::string>& command) {
  SCOPED_TRACE(command.front() + " " + command.back());
  const std::string help = HelpOf(command);
  EXPECT_THAT(help, HasSubstr("\nExit codes: 0 "));
  EXPECT_THAT(help, HasSubstr(", 2 bad "));
  EXPECT_THAT(help, HasSubstr("\nExample"));
  for (const std::string& line : Lines(help)) EXPECT_THAT(line, SizeIs(Le(100U)));
}

TEST(CommandLineTest, ShowsHelpWithExitCodesAndExamplesAndNoLongLineForEveryVerb) {
  const std::vector<std::string> verbs = Verbs();
  ASSERT_THAT(verbs, SizeIs(Ge(20U)));
  ExpectWholeHelp({Program("fogline")});
  for (const std::string& verb : verbs) ExpectWholeHelp({Program("fogline"), verb});
}

TEST(CommandLineTest, ShowsHelpWithExitCodesAndAnExampleAndNoLongLineForEveryOtherProgram) {
  for (const RoleInfo& role : kRoles)
    ExpectWholeHelp({Program(fmt::format("fogline-{}", role.name))});
  ExpectWholeHelp({Program("fogline-relay")});
}

TEST(CommandLineTest, ShowsTheHelpWithoutAVerbAndSucceedsAsCargoDoes) {
  const Outcome bare = RunCommand({Program("fogline")});
  EXPECT_EQ(bare.code, 0);
  EXPECT_EQ(bare.out, HelpOf({Program("fogline")}));
  EXPECT_EQ(bare.err, "");
}

TEST(CommandLineTest, ShowsTheSameHelpByTheVerbHelpAsByTheOption) {
  const auto help = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {Program("fogline"), "help"});
    const Outcome outcome = RunCommand(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_EQ(help({}), HelpOf({Program("fogline")}));
  for (const std::string& verb : Verbs()) {
    EXPECT_EQ(help({verb}), HelpOf({Program("fogline"), verb}));
  }
  EXPECT_EQ(
      ErrorOf({"help", "tabel"}),
      "fogline help: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)\n");
}

TEST(CommandLineTest, GivesTheRecorderItsLogInItsExample) {
  EXPECT_THAT(HelpOf({Program("fogline-recorder")}), HasSubstr("\n  fogline-recorder --log "));
}

TEST(CommandLineTest, NamesAVerbThatIsNoneAndTheOneThatMayBeMeant) {
  EXPECT_EQ(ErrorOf({"tabel", "scenario/paper.json", "--seeds", "1:3"}),
            "fogline: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({"levitate"}), "fogline: error: no verb \"levitate\" (see fogline --help)\n");
}

TEST(CommandLineTest, NamesAnOptionThatIsNoneAndTheOneThatMayBeMeant) {
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--sede=7"}),
            "fogline run: error: no option \"--sede\"; did you mean \"--seed\"? "
            "(see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"--quite"}), "fogline: error: no option \"--quite\" (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "scenario/other.json"}),
            "fogline run: error: \"scenario/other.json\" is one argument too many "
            "(see fogline run --help)\n");
}

TEST(CommandLineTest, SaysHowAFieldIsSetThatIsTakenForAnOption) {
  const std::string set = "; a field of the scenario is set with --set ";
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--threshold", "0.8"}),
            "fogline run: error: no option \"--threshold\"" + set +
                "/arbitrator/threshold=0.8 (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"sweep", "scenario/paper.json", "--policy=none"}),
            "fogline sweep: error: no option \"--policy\"" + set +
                "/arbitrator/policy=none (see fogline sweep --help)\n");
  // Several sections have the name; a value that the field does not allow is not repeated.
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--end-on-collision", "scenario/x.json"}),
            "fogline run: error: no option \"--end-on-collision\"" + set +
                "/world/end_on_collision=VALUE (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--bias", "0.3"}),
            "fogline run: error: no option \"--bias\"" + set +
                "/fog/bias_m=0.3 or /radar/bias_m or /lidar/bias_m (see fogline run --help)\n");
  // A verb that sets no fields has no such hint.
  EXPECT_EQ(ErrorOf({"metrics", "x.lcm", "--threshold", "0.8"}),
            "fogline metrics: error: no option \"--threshold\" (see fogline metrics --help)\n");
  for (const char* dashes : {"-", "---", "-x"}) {
    EXPECT_THAT(ErrorOf({"run", "scenario/paper.json", dashes}), HasSubstr("fogline run: error: "));
  }
}

TEST(CommandLineTest, NamesTheVerbThatHasAnOption) {
  EXPECT_EQ(ErrorOf({"check", "scenario/paper.json", "--pace", "1"}),
            "fogline check: error: no option \"--pace\"; it is an option of fogline run "
            "(see fogline check --help)\n");
  EXPECT_EQ(ErrorOf({"--json", "run", "scenario/paper.json"}),
            "fogline: error: no option \"--json\"; an option stands after its verb "
            "(see fogline --help)\n");
}

TEST(CommandLineTest, NamesTheFileThatMayBeMeant) {
  const std::string missing = ": error: cannot be read: No such file or directory; did you mean ";
  for (const char* verb : {"run", "table", "sweep", "check"}) {
    EXPECT_EQ(ErrorOf({verb, "scenario/papr.json"}),
              "scenario/papr.json" + missing + "\"scenario/paper.json\"?\n");
  }
  EXPECT_EQ(ErrorOf({"calibrate", "scenario/paper", "--free", "/fog/bias_m=0:1"}),
            "scenario/paper" + missing + "\"scenario/paper.json\"?\n");
  EXPECT_EQ(ErrorOf({"report", "--curves", "scenario/densefog.json"}),
            "scenario/densefog.json" + missing + "\"scenario/dense_fog.json\"?\n");
}

TEST(CommandLineTest, NamesTheLogThatMayBeMeant) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=2",
                        "--transport", "direct", "--log", log})
                .code,
            0);
  const std::string wrong = folder.File("papre.lcm");
  const std::string error = wrong +
                            ": error: cannot read the log: No such file or directory; did " +
                            "you mean \"" + log + "\"?\n";
  for (const char* verb : {"metrics", "digest", "events", "report"}) {
    EXPECT_EQ(ErrorOf({verb, wrong}), error);
  }
  EXPECT_EQ(ErrorOf({"diff", log, wrong}), error);
  EXPECT_EQ(ErrorOf({"replay", wrong, "--all"}), error);
  EXPECT_EQ(ErrorOf({"export", wrong, "--out", folder.File("out")}), error);
  EXPECT_EQ(ErrorOf({"compare", wrong, "scenario/data/acc_platoon_a.csv"}), error);
}

TEST(CommandLineTest, BeginsARefusalOfTheRelayWithItsName) {
  const Outcome outcome = RunCommand({Program("fogline-relay"), "--bogus"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err,
            "fogline-relay: error: The following argument was not expected: --bogus "
            "(see fogline-relay --help)\n");
}

TEST(CommandLineTest, BeginsEveryRefusalWithTheVerb) {
  EXPECT_EQ(ErrorOf({"run"}),
            "fogline run: error: SCENARIO is required (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--pace", "fast"}),
            "fogline run: error: --pace: Value fast not in range 0.000000 to 1000.000000 (see "
            "fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--seed"}),
            "fogline run: error: --seed: 1 required TEXT missing (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"table", "scenario/paper.json", "--seeds", "2:1"}).substr(0, 40),
            "fogline table: error: --seeds 2:1: neith");
  EXPECT_EQ(ErrorOf({"check"}), "fogline check: error: FILE is missing\n");
  EXPECT_EQ(ErrorOf({"check", "--print", "--schema"}),
            "fogline check: error: --print, --schema, --explain and --json exclude each other\n");
}

TEST(CommandLineTest, BeginsEveryRefusalOfAnotherProgramWithItsName) {
  for (const char* program : {"fogline-relay", "fogline-radar", "fogline-recorder"}) {
    const Outcome outcome = RunCommand({Program(program), "--bogus"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(Lines(outcome.err), SizeIs(1));
    EXPECT_THAT(outcome.err, testing::StartsWith(program + std::string(": error: ")));
    EXPECT_THAT(outcome.err, testing::EndsWith(" (see " + std::string(program) + " --help)\n"));
  }
}

TEST(CommandLineTest, KeepsControlCharactersOfAWordOutOfItsMessages) {
  EXPECT_EQ(ErrorOf({"ta\nble"}),
            "fogline: error: no verb \"ta\\u000able\"; did you mean \"table\"? "
            "(see fogline --help)\n");
}

}  // namespace
}  // namespace fogline::test
