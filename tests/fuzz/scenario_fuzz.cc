// The scenario reader. Input: the text of a scenario.
#include <algorithm>
#include <string>
#include <string_view>

#include "scenario/io/loader.h"
#include "tests/fuzz/fuzz.h"

namespace fogline::fuzz {
namespace {

void DemandPlausible(const Diagnostic& diagnostic, std::string_view text) {
  const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
  Demand(diagnostic.line >= 1 && diagnostic.line <= lines, "the line is in the text");
  Demand(diagnostic.column >= 1, "columns count from 1");
  std::size_t begin = 0;
  for (int line = 1; line < diagnostic.line; ++line) begin = text.find('\n', begin) + 1;
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  Demand(static_cast<std::size_t>(diagnostic.column) <= end - begin + 1,
         "the column is in the line");
  Demand(diagnostic.pointer.empty() || diagnostic.pointer[0] == '/', "the pointer is a pointer");
  Demand(!diagnostic.rule.empty() && !diagnostic.message.empty(), "rule and message are there");
}

void DemandScenarioOrDiagnostics(std::string_view text) {
  try {
    const std::string printed = PrintScenario(ParseScenario(text));
    Demand(PrintScenario(ParseScenario(printed)) == printed, "printing is canonical");
    Took();
  } catch (const ScenarioError& error) {
    Demand(!error.diagnostics().empty(), "a refusal names a reason");
    for (const Diagnostic& diagnostic : error.diagnostics()) DemandPlausible(diagnostic, text);
    Demand(Printable(error.what()), "no control character reaches the terminal");
  }
}

}  // namespace

std::vector<Input> Seeds() {
  const std::string text = PrintScenario(Scenario{});
  return {Input(text.begin(), text.end())};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandScenarioOrDiagnostics({reinterpret_cast<const char*>(data), size});
  return 0;
}
