// `fogline export` gives other programs every number of a log, exact to the last bit.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "services/runtime/wire/wire.h"
#include "tests/integration/logs/export_fixture.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"
#include "tools/export/matio_library.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

/// A MAT-file as matio reads it.
class MatFile {
 public:
  explicit MatFile(const std::string& file)
      : file_(exports::Matio::Get().open(file.c_str(), MAT_ACC_RDONLY)) {}

  /// The variable with a name such as "TRUTH.header.step", nullptr if there is none.
  const matvar_t* Find(const std::string& name) {
    std::istringstream parts(name);
    std::string part;
    std::getline(parts, part, '.');
    exports::Matio::Variable& variable = variables_[part];
    if (variable == nullptr) variable.reset(exports::Matio::Get().read(file_.get(), part.c_str()));
    matvar_t* found = variable.get();
    while (found != nullptr && std::getline(parts, part, '.')) {
      found = exports::Matio::Get().get_field(found, part.c_str(), 0);
    }
    return found;
  }

 private:
  exports::Matio::File file_;
  std::map<std::string, exports::Matio::Variable> variables_;
};

const char* TypeOf(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return "double";
    case MAT_C_INT8:
      return "int8";
    case MAT_C_INT32:
      return "int32";
    case MAT_C_INT64:
      return "int64";
    default:
      return "another";
  }
}

/// A reader that goes through a CSV file line by line.
class Csv {
 public:
  explicit Csv(const std::filesystem::path& file) : stream_(Content(file)) { names_ = Cells(); }
  const Words& names() const { return names_; }
  Words Cells() {
    std::string line;
    Words cells;
    std::getline(stream_, line);
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
  }
  bool AtEnd() { return stream_.peek() == std::char_traits<char>::eof(); }

 private:
  std::istringstream stream_;
  Words names_;
};

TEST_F(ExportTest, WritesEveryNumberOfEveryChannelAsCsvToTheLastBit) {
  const Outcome outcome = Export({"--out", out_, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["files"].size(), log::kStepChannels + 1)
      << "scenario.json";
  std::map<std::string_view, Csv> files;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    const std::string_view name = kChannels[channel].name;
    files.emplace(name, out_ + "/" + std::string(name) + ".csv");
  });
  log::RunLogReader reader(log_);
  while (const log::StepMessages* messages = reader.Next()) {
    ForEachMessage(*messages, [&]<class M>(const M& message) {
      Csv& file = files.at(ChannelOf<M>().name);
      const Words cells = file.Cells();
      ASSERT_EQ(cells.size(), file.names().size());
      std::size_t next = 0;
      ForEachField(
          message, [&]<class T>(const std::string& name, std::span<const T> values, bool is_list) {
            for (std::size_t i = 0; i < values.size(); ++i, ++next) {
              ASSERT_LT(next, cells.size());
              EXPECT_EQ(file.names()[next], is_list ? fmt::format("{}.{}", name, i) : name);
              // from_chars() must parse int8_t as a number, not as a character.
              std::conditional_t<std::is_same_v<T, std::int8_t>, int, T> number{};
              const std::string& cell = cells[next];
              std::from_chars(cell.data(), cell.data() + cell.size(), number);
              EXPECT_EQ(std::memcmp(&number, &values[i], sizeof(T)), 0) << name << ": " << cell;
            }
          });
      EXPECT_EQ(next, cells.size());
    });
  }
  EXPECT_EQ(reader.run().steps, 230);
  for (auto& [name, file] : files) EXPECT_TRUE(file.AtEnd()) << name;
  EXPECT_EQ(nlohmann::json::parse(Content(out_ + "/scenario.json")),
            nlohmann::json::parse(reader.run().scenario_text));
}

TEST_F(ExportTest, WritesEqualMatFilesOfLevel5ForEqualLogs) {
  ASSERT_EQ(Export({"--out", mat_}).code, 0);
  const std::string again = folder_.File("again.MAT");
  ASSERT_EQ(Export({"--out", again}).code, 0);
  const std::string content = Content(mat_);
  EXPECT_EQ(content, Content(again));
  EXPECT_THAT(content, StartsWith("MATLAB 5.0 MAT-file"));
  // Bytes 124 to 127 of a level 5 file: version 0x0100 and the mark of little endian.
  EXPECT_EQ(content.substr(124, 4), std::string("\0\1IM", 4));
}

TEST_F(ExportTest, WritesEveryNumberOfEveryChannelIntoTheMatFileToTheLastBit) {
  ASSERT_EQ(Export({"--out", mat_}).code, 0);
  MatFile mat(mat_);
  std::size_t matrices = 0;
  for (const auto& [name, field] : FieldsOf(log_)) {
    SCOPED_TRACE(name);
    const matvar_t* variable = mat.Find(name);
    ASSERT_NE(variable, nullptr);
    EXPECT_EQ(TypeOf(*variable), field.type);
    ASSERT_EQ(variable->rank, 2);
    EXPECT_EQ(variable->dims[0], field.rows.size()) << "a row for each message";
    EXPECT_EQ(variable->dims[1], field.columns());
    const std::string expected = field.ByColumns();
    ASSERT_EQ(variable->nbytes, expected.size());
    EXPECT_EQ(std::memcmp(variable->data, expected.data(), expected.size()), 0);
    if (field.columns() > 1) ++matrices;
  }
  EXPECT_GT(matrices, 5U) << "there is something that could be transposed";
  const matvar_t* scenario = mat.Find("scenario");
  ASSERT_NE(scenario, nullptr);
  log::RunLogReader reader(log_);
  while (reader.Next() != nullptr) {
  }
  const std::string_view text(static_cast<const char*>(scenario->data), scenario->nbytes);
  EXPECT_EQ(nlohmann::json::parse(text), nlohmann::json::parse(reader.run().scenario_text));
}

TEST_F(ExportTest, ReplacesNoFileUnlessForced) {
  ASSERT_EQ(Export({"--out", mat_}).code, 0);
  ASSERT_EQ(Export({"--out", out_}).code, 0);
  const auto error = [&](const std::string& out) {
    const Outcome outcome = Export({"--out", out});
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_EQ(error(mat_), mat_ + ": error: --out: the file exists; --force replaces it\n");
  EXPECT_EQ(error(out_), out_ + "/TRUTH.csv: error: --out: the file exists; --force replaces it\n");
  EXPECT_EQ(Export({"--out", mat_, "--force"}).code, 0);
  EXPECT_EQ(Export({"--out", out_, "--force"}).code, 0);
  // --force does not replace a file that no export has written.
  std::ofstream(mat_) << "MATLAB 5.0 MAT-file, my own analysis";
  EXPECT_EQ(
      Export({"--out", mat_, "--force"}).err,
      mat_ + ": error: --out: the file is no export and is not replaced, even with --force\n");
  const std::string csv = out_ + "/RADAR.csv";
  std::ofstream(csv) << "range,rate\n";
  EXPECT_EQ(Export({"--out", out_, "--force"}).err,
            csv + ": error: --out: the file is no export and is not replaced, even with --force\n");
  std::filesystem::remove(csv);
  std::ofstream(out_ + "/scenario.json") << "{\"mine\": 1}";
  EXPECT_EQ(Export({"--out", out_, "--force"}).code, 2);
  EXPECT_EQ(error(log_), log_ + ": error: --out: cannot write: it is a file, not a folder\n");
  EXPECT_EQ(error("run.MCAP"), "run.MCAP: error: --out: an MCAP file is written with --mcap\n");
  for (const std::string file : {"run.csv", "run.XLSX", "out/run.json"}) {
    EXPECT_EQ(error(file), file + ": error: --out: neither FILE.mat nor a folder for CSV files\n");
  }
  EXPECT_EQ(error(log_ + "/x.mat"), log_ + "/x.mat: error: --out: cannot write: Not a directory\n");
}

TEST_F(ExportTest, ReplacesNoScenarioThatDoesNotStandBesideTheFilesOfAnExport) {
  ASSERT_EQ(Export({"--out", out_}).code, 0);
  const std::string scenario = out_ + "/scenario.json";
  const std::string before = Content(scenario);
  std::filesystem::remove(out_ + "/RADAR.csv");
  const Outcome outcome = Export({"--out", out_, "--force"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.err,
      scenario + ": error: --out: the file is no export and is not replaced, even with --force\n");
  EXPECT_EQ(Content(scenario), before);
}

TEST_F(ExportTest, WritesWhatALogThatWasCutOffHasAndSaysSo) {
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const Outcome outcome = Export({"--out", out_});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("ends after step "));
  EXPECT_TRUE(std::filesystem::exists(out_ + "/HOST_COMMAND.csv"));
}

TEST_F(ExportTest, MakesNothingOfALogThatItCannotRead) {
  for (const std::string& out : {out_, folder_.File("new/run.mat")}) {
    const Outcome outcome =
        RunCommand({Program("fogline"), "export", "scenario/paper.json", "--out", out});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("new")));
}

TEST_F(ExportTest, FailsOnAFullDiskAndKeepsTheMatFileThatWasThere) {
  if (geteuid() != 0) return MachineLacks("root, to mount a small file system");
  if (const Outcome own = RunCommand({"unshare", "--mount", "true"}); own.code != 0) {
    return MachineLacks("mount namespaces: " + own.err);
  }
  // A file system of 64 KiB has room for some channels of the log, but not for all. It is mounted
  // only for these commands.
  const ScratchFolder folder;
  const Outcome outcome = RunCommand({"unshare", "--mount", "sh", "-c",
                                      "mount -t tmpfs -o size=64k small \"$1\" || exit 99\n"
                                      "echo 'MATLAB 5.0 MAT-file, Fogline' > \"$1/run.mat\"\n"
                                      "\"$0\" export \"$2\" --out \"$1/run.mat\" --force; code=$?\n"
                                      "ls \"$1\"; cat \"$1/run.mat\"; exit $code",
                                      Program("fogline"), folder.path().string(), log_});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_EQ(outcome.out, "run.mat\nMATLAB 5.0 MAT-file, Fogline\n");
  EXPECT_EQ(outcome.err, "fogline export: error: " + folder.File("run.mat") +
                             ": cannot write: No space left on device\n");
}

TEST_F(ExportTest, LeavesEveryFileAsItWasWhenOneOfThemCannotBeWritten) {
  ASSERT_EQ(Export({"--out", out_}).code, 0);
  const std::string before = Content(out_ + "/TRUTH.csv");
  const std::string last = out_ + "/scenario.json";
  std::filesystem::remove(last);
  std::filesystem::create_directory(last);
  // GIVEN another log, which is the first half of the exported log
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const Outcome outcome = Export({"--out", out_, "--force"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("it is a folder"));
  EXPECT_EQ(Content(out_ + "/TRUTH.csv"), before);
}

}  // namespace
}  // namespace fogline::test
