#include "tests/fuzz/scenario_fuzz.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "scenario/loader.h"

namespace fogline {
namespace {

void Demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "scenario_fuzz: does not hold: %s\n", what);
  std::abort();
}

void DemandPlausible(const Mistake& mistake, std::string_view text) {
  const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
  Demand(mistake.line >= 1 && mistake.line <= lines, "the line is in the text");
  Demand(mistake.column >= 1, "columns count from 1");
  std::size_t begin = 0;
  for (int line = 1; line < mistake.line; ++line) begin = text.find('\n', begin) + 1;
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  Demand(static_cast<std::size_t>(mistake.column) <= end - begin + 1, "the column is in the line");
  Demand(mistake.pointer.empty() || mistake.pointer[0] == '/', "the pointer is a pointer");
  Demand(!mistake.rule.empty() && !mistake.message.empty(), "rule and message are there");
}

}  // namespace

bool DemandScenarioOrMistakes(std::string_view text) {
  try {
    const std::string printed = PrintScenario(ParseScenario(text));
    Demand(PrintScenario(ParseScenario(printed)) == printed, "printing is canonical");
    return true;
  } catch (const ScenarioError& error) {
    Demand(!error.mistakes().empty(), "who refuses says why");
    for (const Mistake& mistake : error.mistakes()) DemandPlausible(mistake, text);
    const std::string_view what = error.what();
    Demand(std::none_of(what.begin(), what.end(),
                        [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n'; }),
           "no control character reaches the terminal");
    return false;
  }
}

}  // namespace fogline

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::DemandScenarioOrMistakes({reinterpret_cast<const char*>(data), size});
  return 0;
}
