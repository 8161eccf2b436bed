// Octave reads every number of an exported log. `tools/setup bench` installs Octave.
#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/integration/logs/export_fixture.h"

namespace fogline::test {
namespace {

// An Octave script that prints the bytes of every field, column by column, in hexadecimal.
constexpr const char* kOctave = R"(
  s = load(argv(){1});
  function show(name, x)
    if isstruct(x)
      for f = fieldnames(x)'
        show([name "." f{1}], x.(f{1}));
      end
    else
      printf("%s %s %d %d %s\n", name, class(x), rows(x), columns(x), ...
             sprintf("%02x", typecast(x(:), "uint8")));
    end
  end
  for f = fieldnames(s)'
    if isstruct(s.(f{1})), show(f{1}, s.(f{1})); end
  end
  printf("title %s\n", jsondecode(s.scenario).title);
)";

TEST_F(ExportTest, HasEveryNumberOfTheMatFileToTheLastBit) {
  ASSERT_EQ(Export({"--out", mat_}).code, 0);
  std::ofstream(folder_.File("show.m")) << kOctave;
  const Outcome octave = RunCommand({"octave-cli", "--norc", folder_.File("show.m"), mat_});
  ASSERT_EQ(octave.code, 0) << octave.err;
  // GIVEN the fields of the exported log, read by Fogline, with a row of numbers for each message
  std::vector<std::string> expected;
  for (const auto& [name, field] : FieldsOf(log_)) {
    std::string hex;
    for (const char c : field.ByColumns()) {
      hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
    }
    expected.push_back(
        fmt::format("{} {} {} {} {}", name, field.type, field.rows.size(), field.columns(), hex));
  }
  expected.emplace_back("title F\u00f6hn");
  // THEN Octave has printed the same bytes for each field
  std::vector<std::string> shown;
  std::istringstream lines(octave.out);
  for (std::string line; std::getline(lines, line);) shown.push_back(line);
  EXPECT_TRUE(std::ranges::is_permutation(shown, expected)) << octave.out.substr(0, 400);
}

}  // namespace
}  // namespace fogline::test
