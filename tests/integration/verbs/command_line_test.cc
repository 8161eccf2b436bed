// The help and the errors of the command line.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

/// Checks that a help text has exit codes and at least one example, and no line too long for a
/// terminal.
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
  EXPECT_THAT(HelpOf({Program("fogline-recorder")}),
              HasSubstr("\n  fogline-recorder --run-id 7351 --shared-log --log "));
}

TEST(CommandLineTest, NamesAVerbThatIsNoneAndTheOneThatMayBeMeant) {
  EXPECT_EQ(ErrorOf({"tabel", "scenario/paper.json", "--seeds", "1:3"}),
            "fogline: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)\n");
  EXPECT_EQ(ErrorOf({"levitate"}), "fogline: error: no verb \"levitate\" (see fogline --help)\n");
}

TEST(CommandLineTest, ShowsNoHelpOfAVerbThatIsNone) {
  for (const char* asked : {"--help", "-h", "--version"}) {
    EXPECT_EQ(ErrorOf({"tabel", asked}),
              "fogline: error: no verb \"tabel\"; did you mean \"table\"? (see fogline --help)\n");
    EXPECT_EQ(ErrorOf({asked, "levitate"}),
              "fogline: error: no verb \"levitate\" (see fogline --help)\n");
  }
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
  // The error text does not repeat a value that the field refuses. If several sections have a field
  // of this name, the text names all these fields.
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--end-on-collision", "scenario/x.json"}),
            "fogline run: error: no option \"--end-on-collision\"" + set +
                "/world/end_on_collision=VALUE (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--bias", "0.3"}),
            "fogline run: error: no option \"--bias\"" + set +
                "/fog/bias_m=0.3 or /radar/bias_m or /lidar/bias_m (see fogline run --help)\n");
  // A verb that sets no fields prints no such hint.
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

TEST(CommandLineTest, MeansAScenarioWhereOneIsWanted) {
  const ScratchFolder folder;
  std::filesystem::copy(SourceDirectory() / "scenario/paper.json", folder.File("paper.json"));
  std::ofstream(folder.File("papre.csv")) << "a,b\n";
  const std::string wrong = folder.File("papre");
  EXPECT_EQ(ErrorOf({"run", wrong}),
            wrong + ": error: cannot be read: No such file or directory; did you mean \"" +
                folder.File("paper.json") + "\"?\n");
}

TEST(CommandLineTest, WaitsForNoPipeThatIsGivenAsALogOrKey) {
  const ScratchFolder folder;
  const std::string pipe = folder.File("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string error = pipe + ": error: cannot read the log: it is no regular file\n";
  for (const char* verb : {"metrics", "digest", "events", "report"}) {
    EXPECT_EQ(ErrorOf({verb, pipe}), error);
  }
  EXPECT_EQ(ErrorOf({"replay", pipe, "--all"}), error);
  EXPECT_EQ(ErrorOf({"diff", pipe, pipe}), error);
  EXPECT_EQ(ErrorOf({"export", pipe, "--out", folder.File("out")}), error);
  EXPECT_EQ(ErrorOf({"compare", pipe, pipe}), error);
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--key", pipe}),
            pipe + ": error: cannot read the key: it is no file\n");
  EXPECT_EQ(ErrorOf({"check", folder.path().string()}),
            folder.path().string() + ": error: cannot be read: it is a folder\n");
  EXPECT_EQ(ErrorOf({"check", "/dev/zero"}),
            "/dev/zero: error: cannot be read: it is neither a file nor a pipe\n");
}

TEST(CommandLineTest, ReadsAScenarioFromAPipeThatAProcessWritesInto) {
  const Outcome outcome = RunCommand({"bash", "-c",
                                      Program("fogline") +
                                          " check <(cat scenario/paper.json) && cat "
                                          "scenario/paper.json | " +
                                          Program("fogline") + " check /dev/stdin"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST(CommandLineTest, SaysWhatAFolderOrAnEmptyFileIsInPlaceOfALog) {
  const ScratchFolder folder;
  const std::string name = folder.path().string();
  const std::string empty = folder.File("empty.lcm");
  std::ofstream{empty};
  for (const char* verb : {"metrics", "digest", "events", "report"}) {
    EXPECT_EQ(ErrorOf({verb, name}), name +
                                         ": error: cannot read the log: it is a folder; its "
                                         "logs are " +
                                         name + "/*.lcm\n");
    EXPECT_EQ(ErrorOf({verb, empty}),
              empty + ": error: the log is empty: no run has begun to write it\n");
  }
}

TEST(CommandLineTest, ARunWhoseNetworkCannotBeOpenedMakesNoFolderForItsLog) {
  const ScratchFolder folder;
  const Outcome outcome = RunCommand(
      {"sh", "-c", "cd \"$0\" && exec \"$@\"", folder.path().string(),
       std::filesystem::absolute(Program("fogline")).string(), "run",
       (SourceDirectory() / "scenario/paper.json").string(), "--lcm-url", "tcpq://127.0.0.1:1"});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("no process listens on 127.0.0.1:1"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CommandLineTest, ARunThatLacksDescriptorsFailsAndItsInputIsNotCalledBad) {
  const ScratchFolder folder;
  int failed = 0;
  for (const char* transport : {"udpm", "memq", "tcpq", "direct"}) {
    for (int limit = 12; limit <= 28; limit += 4) {  // about as many files as the libraries open
      const Outcome outcome =
          RunCommand({"sh", "-c", fmt::format("ulimit -n {}; exec \"$@\"", limit), "sh",
                      Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=5",
                      "--transport", transport, "--force", "--log", folder.File("run.lcm")});
      EXPECT_TRUE(outcome.code == 0 || outcome.code == 3)
          << transport << " " << limit << ": " << outcome.code << " " << outcome.err;
      if (outcome.code != 3) continue;
      EXPECT_THAT(outcome.err, HasSubstr("Too many open files")) << transport << " " << limit;
      ++failed;
    }
  }
  EXPECT_GT(failed, 3);
  // The error text ends with a remedy.
  const Outcome outcome =
      RunCommand({"sh", "-c", "ulimit -n 12; exec \"$@\"", "sh", Program("fogline"), "run",
                  "scenario/paper.json", "--transport", "udpm", "--log", folder.File("x.lcm")});
  EXPECT_THAT(outcome.err, HasSubstr("ulimit -n 1024"));
}

TEST(CommandLineTest, PrintsNoNameThatATerminalWouldObey) {
  const ScratchFolder folder;
  // This name changes the colour, breaks the line, and reverses the direction of the text after it.
  const std::string log = folder.File("a\x1b[31m\nb\xe2\x80\xae.lcm");
  const std::string shown = folder.File("a\\u001b[31m\\u000ab\\u202e.lcm");
  const auto expect_shown = [&](std::vector<std::string> arguments) {
    SCOPED_TRACE(arguments.front());
    arguments.insert(arguments.begin(), Program("fogline"));
    const Outcome outcome = RunCommand(arguments);
    const std::string said = outcome.out + outcome.err;
    EXPECT_THAT(said, HasSubstr(shown));
    EXPECT_THAT(said, testing::Not(HasSubstr("\x1b")));
    EXPECT_THAT(said, testing::Not(HasSubstr("\xe2\x80\xae")));
    EXPECT_THAT(said, testing::Not(HasSubstr("[31m\n")));
  };
  const std::vector<std::string> run{
      "run", "scenario/paper.json", "--transport", "direct", "--set", "/steps=5", "--log", log};
  expect_shown(run);
  expect_shown(run);  // the log now exists
  for (const char* verb : {"digest", "metrics", "events"}) expect_shown({verb, log});
  expect_shown({"diff", log, log + "x"});
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 1);
  for (const char* verb : {"digest", "metrics", "events"}) expect_shown({verb, log});
  expect_shown({"diff", log, log});
  expect_shown({"replay", log, "--all"});
  expect_shown({"export", log, "--out", folder.File("csv")});
  expect_shown({"compare", log, "scenario/data/acc_platoon_a.csv"});
  for (const char* verb : {"run", "table", "sweep", "check"}) expect_shown({verb, log});
  expect_shown({"report", "--curves", log});
  expect_shown({"run", "scenario/paper.json", "--key", log});
  expect_shown({"sweep", "scenario/paper.json", "--out", log});
  expect_shown({"sweep", "--merge", log, "--out", folder.File("whole.csv")});
}

TEST(CommandLineTest, PrintsJsonThatNoTerminalObeysOfAnyName) {
  const ScratchFolder folder;
  const std::string log = folder.File("a\x1b\xc2\x9b\xe2\x80\xae.lcm");
  ASSERT_EQ(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                        "--set", "/steps=5", "--log", log})
                .code,
            0);
  const Outcome digest = RunCommand({Program("fogline"), "digest", "--json", log});
  EXPECT_EQ(nlohmann::json::parse(digest.out)[0]["log"], log);
  for (const char* control : {"\x1b", "\xc2\x9b", "\xe2\x80\xae"}) {
    EXPECT_THAT(digest.out, testing::Not(HasSubstr(control)));
  }
  // JSON cannot contain this name, because the name is not valid UTF-8.
  const std::string latin = folder.File("f\xf6hn.lcm");
  std::filesystem::rename(log, latin);
  for (const char* verb : {"digest", "metrics", "events"}) {
    const Outcome outcome = RunCommand({Program("fogline"), verb, "--json", latin});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out)[0]["log"], folder.File("f\xef\xbf\xbdhn.lcm"));
  }
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
            "fogline-relay: error: no option \"--bogus\" (see fogline-relay --help)\n");
}

TEST(CommandLineTest, NamesTheOptionOfARoleThatIsProbablyMeant) {
  const Outcome outcome =
      RunCommand({Program("fogline-fusion"), "--lcm-urll", "udpm://239.255.76.67:7700?ttl=0"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "fogline-fusion: error: no option \"--lcm-urll\"; did you mean \"--lcm-url\"? (see "
            "fogline-fusion --help)\n");
  EXPECT_EQ(
      RunCommand({Program("fogline-fusion"), "lab"}).err,
      "fogline-fusion: error: \"lab\" is one argument too many (see fogline-fusion --help)\n");
}

TEST(CommandLineTest, BeginsEveryRefusalWithTheVerb) {
  EXPECT_EQ(ErrorOf({"run"}),
            "fogline run: error: SCENARIO is required (see fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--pace", "fast"}),
            "fogline run: error: --pace: Value fast not in range 0 to 1000 (see "
            "fogline run --help)\n");
  EXPECT_EQ(ErrorOf({"run", "scenario/paper.json", "--seed"}),
            "fogline run: error: --seed: the value is missing (see fogline run --help)\n");
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
