#include "tools/export/take_over_csv.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "common/atomic_file.h"
#include "common/csv.h"

namespace fogline::exports {
namespace {

constexpr std::string_view kKeys = "log,seed,request,outcome,";

std::string RequestColumns() {
  std::string line(kKeys.substr(0, kKeys.size() - 1));
  metrics::VisitTakeOver({}, [&line](std::string_view name, const auto&, std::string_view,
                                     std::string_view) { line += fmt::format(",{}", name); });
  log::VisitLatency(
      {}, [&line](std::string_view name, const auto&, std::string_view, std::string_view) {
        line += fmt::format(",input_latency_{}", name);
      });
  return line + '\n';
}

void AppendRequest(const TakeOverRun& run, std::size_t index, std::string& text) {
  const metrics::TakeOverMeasures& measures = run.take_overs[index];
  text += fmt::format("{},{},{},{}", CsvCell(run.log), run.seed, index + 1,
                      metrics::NameOf(measures.outcome));
  metrics::VisitTakeOver(
      measures, [&text](std::string_view, const std::optional<double>& value, std::string_view,
                        std::string_view) { text += value ? fmt::format(",{}", *value) : ","; });
  log::VisitLatency(run.input_latency.value_or(log::InputLatency{}),
                    [&](std::string_view, std::int64_t value, std::string_view, std::string_view) {
                      text += run.input_latency ? fmt::format(",{}", value) : ",";
                    });
  text += '\n';
}

/// Appends one line for a run whose log lacks messages. For this reason `take_overs` may lack
/// requests. The line stands for all of them.
void AppendUnknown(const TakeOverRun& run, std::string& text) {
  const std::string columns = RequestColumns();
  const auto others = std::ranges::count(columns, ',') - std::ranges::count(kKeys, ',') + 1;
  text += fmt::format("{},{},,unknown{}\n", CsvCell(run.log), run.seed,
                      std::string(static_cast<std::size_t>(others), ','));
}

}  // namespace

bool IsTakeOverCsv(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(kKeys.size(), '\0');
  in.read(head.data(), std::ssize(head));
  return in.gcount() == std::ssize(head) && head == kKeys;
}

void WriteTakeOverCsv(std::span<const TakeOverRun> runs, const std::filesystem::path& file) {
  std::string text = RequestColumns();
  for (const TakeOverRun& run : runs) {
    if (run.unknown) AppendUnknown(run, text);
    for (std::size_t i = 0; i < run.take_overs.size(); ++i) AppendRequest(run, i, text);
  }
  AtomicFile out(file);
  out.Write(text);
  out.Finish();
}

}  // namespace fogline::exports
