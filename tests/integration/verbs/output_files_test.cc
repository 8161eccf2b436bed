// Results are written to files, links, pipes and devices.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/process/poll.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAre;
using Words = std::vector<std::string>;

/// A folder with the log of a short run. The tests add links, pipes and devices to it.
class OutputFilesTest : public testing::Test {
 protected:
  OutputFilesTest() {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                    "direct", "--set", "/steps=20", "--quiet", "--log", log_});
    EXPECT_EQ(run.code, 0) << run.err;
  }
  Outcome Report(const std::string& output) const {
    return RunCommand({Program("fogline"), "report", log_, "--output", output});
  }
  Outcome Bash(const std::string& script) const {
    return RunCommand({"bash", "-c",
                       "cd '" + folder_.path().string() +
                           "' && PATH=" + ProgramDirectory().string() + ":$PATH && " + script});
  }
  Words Files() const {
    Words names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    std::ranges::sort(names);
    return names;
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string page_ = folder_.File("page.html");
};

TEST_F(OutputFilesTest, AReportFollowsNoLinkThatWaitsForIt) {
  std::ofstream(folder_.File("precious")) << "precious";
  std::filesystem::create_symlink(folder_.File("precious"), page_ + ".part");
  EXPECT_EQ(Report(page_).code, 0);
  EXPECT_EQ(Content(folder_.File("precious")), "precious");
  EXPECT_THAT(Content(page_), StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(Files(), ElementsAre("page.html", "page.html.part", "precious", "run.lcm"));
}

TEST_F(OutputFilesTest, TwoReportsAtOnceOnOneFileEachWriteAWholePage) {
  // GIVEN two logs with different pages
  const std::string other = folder_.File("other.lcm");
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--set", "/steps=20", "--seed", "2", "--quiet", "--log", other});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto report = [this](const std::string& log) {
    return Words{Program("fogline"), "report", log, "--output", page_};
  };
  std::vector<std::string> pages;
  for (const std::string& log : {log_, other}) {
    ASSERT_EQ(RunCommand(report(log)).code, 0);
    pages.push_back(Content(page_));
  }
  ASSERT_NE(pages[0], pages[1]);
  // WHEN both logs are reported at the same time, many times, THEN the page is always one of the
  // two pages
  constexpr int kPairs = 20;
  for (int pair = 0; pair < kPairs; ++pair) {
    Background one(report(log_));
    Background two(report(other));
    EXPECT_EQ(one.Wait(), 0) << one.Err();
    EXPECT_EQ(two.Wait(), 0) << two.Err();
    const std::string page = Content(page_);
    ASSERT_TRUE(page == pages[0] || page == pages[1]) << "pair " << pair;
  }
  EXPECT_THAT(Files(), ElementsAre("other.lcm", "page.html", "run.lcm"));
}

TEST_F(OutputFilesTest, AReportReplacesThePageThatALinkLeadsTo) {
  ASSERT_EQ(Report(folder_.File("real.html")).code, 0);
  std::filesystem::resize_file(folder_.File("real.html"), 100);
  std::filesystem::create_symlink("real.html", page_);
  EXPECT_EQ(Report(page_).code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(page_));
  EXPECT_GT(std::filesystem::file_size(folder_.File("real.html")), 1000U);
}

TEST_F(OutputFilesTest, AReportGoesToStdoutAndNothingElseDoes) {
  ASSERT_EQ(Report(page_).code, 0);
  const std::string page = Content(page_);
  EXPECT_EQ(Bash("fogline report run.lcm -o /dev/stdout | cat").out, page);
  EXPECT_EQ(Bash("{ echo before; fogline report run.lcm -o /dev/stdout; } > both").code, 0);
  EXPECT_EQ(Content(folder_.File("both")), "before\n" + page);
}

TEST_F(OutputFilesTest, AReportGoesThroughAPipeOrIntoNothing) {
  ASSERT_EQ(Report(page_).code, 0);
  EXPECT_EQ(Bash("fogline report run.lcm -o >(cat > copied) && wait $!").code, 0);
  EXPECT_EQ(Content(folder_.File("copied")), Content(page_));
  // Descriptor 9 keeps the pipe open for reading and writing. So `head` would find no end of the
  // file, and the command tells `head` how many bytes to read.
  EXPECT_EQ(Bash("mkfifo pipe; exec 9<>pipe; fogline report run.lcm -o pipe & report=$!;"
                 "head -c $(stat -c %s page.html) <&9 > named; wait $report")
                .code,
            0);
  EXPECT_EQ(Content(folder_.File("named")), Content(page_));
  const Outcome nothing = Report("/dev/null");
  EXPECT_EQ(nothing.code, 0) << nothing.err;
  EXPECT_EQ(nothing.out, "/dev/null\n");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const Outcome full = Report("/dev/full");
  EXPECT_EQ(full.code, 3);
  EXPECT_EQ(full.err, "fogline report: error: /dev/full: cannot write: No space left on device\n");
}

TEST_F(OutputFilesTest, APipeThatNoProcessReadsIsRefused) {
  ASSERT_EQ(mkfifo(folder_.File("pipe").c_str(), 0600), 0);
  const Outcome outcome = Report(folder_.File("pipe"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            folder_.File("pipe") + ": error: cannot write: no process reads this pipe\n");
}

TEST_F(OutputFilesTest, ASweepIntoADeviceOrPipeIsItsRowsAndLeavesNoFile) {
  std::filesystem::create_symlink("/dev/null", folder_.File("null.csv"));
  const Words sweep{Program("fogline"),
                    "sweep",
                    "scenario/paper.json",
                    "--set",
                    "/steps=20",
                    "--seeds",
                    "1:4",
                    "--out"};
  const auto to = [&](const std::string& out) {
    Words command = sweep;
    command.push_back(out);
    return RunCommand(command);
  };
  EXPECT_EQ(to(folder_.File("null.csv")).code, 0);
  EXPECT_THAT(Files(), ElementsAre("null.csv", "run.lcm"));
  ASSERT_EQ(to(folder_.File("file.csv")).code, 0);
  const Outcome rows = to("/dev/stdout");
  EXPECT_EQ(rows.code, 0) << rows.err;
  EXPECT_EQ(rows.out, Content(folder_.File("file.csv")));
  EXPECT_THAT(rows.err, HasSubstr("4 rows in "));
}

TEST_F(OutputFilesTest, AForcedCalibrationReplacesOnlyAScenario) {
  const auto calibrate = [&](const std::string& out) {
    return RunCommand({Program("fogline"), "calibrate", "scenario/paper.json", "--free",
                       "/fog/bias_m=0.2:0.3", "--set", "/steps=310", "--seeds", "1:1",
                       "--evaluations", "1", "--out", out, "--force"});
  };
  const std::string thesis = folder_.File("thesis.tex");
  std::ofstream(thesis) << "\\documentclass{book}";
  const Outcome refused = calibrate(thesis);
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(
      refused.err,
      thesis + ": error: --out: the file is no scenario and is not replaced, even with --force\n");
  EXPECT_EQ(Content(thesis), "\\documentclass{book}");
  const std::string found = folder_.File("found.json");
  std::filesystem::copy(SourceDirectory() / "scenario/dense_fog.json", found);
  EXPECT_EQ(calibrate(found).code, 0);
  EXPECT_THAT(Content(found), HasSubstr("Sourav"));
}

TEST_F(OutputFilesTest, ASweepReplacesNoFileBesideItsOwnThatIsOfNoSweep) {
  std::filesystem::copy(SourceDirectory() / "scenario/paper.json", folder_.File("paper.json"));
  std::ofstream(folder_.File("notes.sums")) << "precious";
  std::ofstream(folder_.File("list.sums")) << "0123abcd\n0123abcd  file\n";
  const Words before = Files();
  for (const Words& files :
       {Words{"paper", ".json", "sweep description"}, Words{"notes", ".sums", "file of checksums"},
        Words{"list", ".sums", "file of checksums"}}) {
    const std::string file = folder_.File(files[0]);
    const std::string content = Content(file + files[1]);
    for (const char* force : {"--force", "--jobs=1"}) {
      const Outcome sweep =
          RunCommand({Program("fogline"), "sweep", folder_.File("paper.json"), "--set", "/steps=20",
                      "--seeds", "1:4", "--out", file, force});
      EXPECT_EQ(sweep.code, 2);
      EXPECT_EQ(sweep.err, file + files[1] + ": error: --out: the file is no " + files[2] +
                               " and is not replaced, even with --force\n");
      EXPECT_EQ(Content(file + files[1]), content);
    }
  }
  EXPECT_EQ(Files(), before);
}

/// Whether every thread of a process waits for an event.
bool AllThreadsSleep(pid_t pid) {
  for (const auto& thread :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    // The state follows the name of the program, which is in parentheses.
    const std::string stat = Content(thread.path() / "stat");
    if (stat.find(") S ") == std::string::npos) return false;
  }
  return true;
}

TEST_F(OutputFilesTest, ASweepIntoAPipeThatIsNotReadEndsOnCtrlC) {
  const std::string pipe = folder_.File("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  Background sweep({Program("fogline"), "sweep", "scenario/paper.json", "--set", "/steps=20",
                    "--seeds", "1:100000", "--jobs", "2", "--out", pipe});
  // Waits until the pipe has no room. Then the sweep waits in its next write.
  const int writer = open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (PollFor(writer, POLLOUT, Duration::zero()) != 0) {
    ASSERT_LT(std::chrono::steady_clock::now(), end) << sweep.Err();
    std::this_thread::sleep_for(milliseconds(20));
  }
  // No event shows that the sweep has come to this write. So the test looks at the threads of the
  // sweep again and again. If all of them sleep at kLooks looks in a row, the sweep waits in its
  // write.
  constexpr int kLooks = 50;
  for (int asleep = 0; asleep < kLooks;) {
    ASSERT_LT(std::chrono::steady_clock::now(), end) << sweep.Err();
    std::this_thread::sleep_for(milliseconds(20));
    asleep = AllThreadsSleep(sweep.pid()) ? asleep + 1 : 0;
  }
  sweep.Signal(SIGINT);
  EXPECT_EQ(sweep.Wait(), 130);
  EXPECT_EQ(sweep.Err(), "fogline sweep: interrupted in " + pipe + "\n");
  close(writer);
  close(reader);
}

/// The verbs that write a document into a file, with all arguments except the name of this file.
class DocumentTest : public OutputFilesTest {
 protected:
  DocumentTest() {
    const Outcome run =
        RunCommand({Program("fogline"), "run", "scenario/recorded_lead.json", "--transport",
                    "direct", "--set", "/steps=20", "--quiet", "--log", recorded_});
    EXPECT_EQ(run.code, 0) << run.err;
  }
  std::vector<Words> Calls() const {
    return {{"sweep", paper_, "--set", "/steps=20", "--seeds", "1:2", "--out"},
            {"report", log_, "--output"},
            {"compare", recorded_, InTree("scenario/data/acc_platoon_a.csv"), "--out"},
            {"calibrate", paper_, "--free", "/fog/bias_m=0.2:0.3", "--set", "/steps=310", "--seeds",
             "1:1", "--evaluations", "1", "--out"}};
  }
  /// Runs the verb in the folder, because a scenario on stdout has paths that are relative to this
  /// folder.
  Outcome Call(const Words& words, const Words& more) const {
    std::string script = "fogline";
    for (const std::string& word : words) script += " " + word;
    for (const std::string& word : more) script += " " + word;
    return Bash(script);
  }
  static std::string InTree(const char* file) { return (SourceDirectory() / file).string(); }

  const std::string recorded_ = folder_.File("recorded.lcm");
  const std::string paper_ = InTree("scenario/paper.json");
};

TEST_F(DocumentTest, IsAllThatComesOutOfStdoutIfItIsToGoThere) {
  for (const Words& words : Calls()) {
    SCOPED_TRACE(words.front());
    const std::string file = folder_.File(words.front());
    const Outcome written = Call(words, {file});
    ASSERT_EQ(written.code, 0) << written.err;
    const Outcome outcome = Call(words, {"/dev/stdout"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, Content(file));
  }
}

TEST_F(DocumentTest, GoesToStdoutOnlyWithoutTheJsonOfTheVerb) {
  std::vector<Words> calls = Calls();
  calls.push_back({"sweep", "--merge", "part.csv", "--out"});
  for (const Words& words : calls) {
    SCOPED_TRACE(words.front());
    const Outcome outcome = Call(words, {"/dev/stdout", "--json"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "fogline " + words.front() + ": error: --json: " + words.back() +
                               " /dev/stdout uses stdout already; give " + words.back() +
                               " a file\n");
  }
  // Both the page and the JSON text may go to /dev/null, because no program reads them there.
  EXPECT_EQ(Bash("fogline report run.lcm -o /dev/null --json > /dev/null").code, 0);
}

TEST_F(DocumentTest, HasANameThatIsRefusedIfItIsTooLong) {
  const std::string file(300, 'x');
  for (const Words& words : Calls()) {
    SCOPED_TRACE(words.front());
    const Outcome outcome = Call(words, {file});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, EndsWith(file + ": error: " + words.back() +
                                      ": cannot write: File name too long\n"));
  }
}

}  // namespace
}  // namespace fogline::test
