// The checksums of a sweep's rows. The input is a list of pieces (Datagram() in fuzz.h): first the
// bytes of FILE.sums, then each row of FILE.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/fuzz.h"
#include "tools/sweep/row_sums.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxRows = 64;

std::string Text(runtime::Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The file FILE.sums with this content. The file exists during the lifetime of this object.
class SumsOnDisk {
 public:
  explicit SumsOnDisk(const std::string& content)
      : csv_(std::filesystem::temp_directory_path() /
             ("fogline-fuzz-" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(path(), std::ios::binary) << content;
  }
  ~SumsOnDisk() { std::filesystem::remove(path()); }
  SumsOnDisk(const SumsOnDisk&) = delete;
  SumsOnDisk& operator=(const SumsOnDisk&) = delete;

  const std::filesystem::path& csv() const { return csv_; }
  std::filesystem::path path() const { return sweep::SumsFile(csv_); }

 private:
  std::filesystem::path csv_;
};

/// Whether this content has only lines of eight hexadecimal digits. The last line may be
/// incomplete, with zeros after it.
bool LooksLikeSums(std::string content) {
  const std::size_t last_line = content.rfind('\n') + 1;  // npos + 1 is 0
  while (content.size() > last_line && content.back() == '\0') content.pop_back();
  if (content.size() - last_line >= static_cast<std::size_t>(sweep::kSumLineBytes)) return false;
  for (std::size_t i = 0; i < content.size(); ++i) {
    const bool at_end = (i + 1) % static_cast<std::size_t>(sweep::kSumLineBytes) == 0;
    const char c = content[i];
    const bool digit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
    if (at_end ? c != '\n' : !digit) return false;
  }
  return true;
}

/// The lines of a text that end with a line feed, without the line feed.
std::vector<std::string> WholeLines(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos;) {
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return lines;
}

void DemandSoundVerdicts(runtime::Bytes input) {
  using Verdict = sweep::RowChecker::Verdict;
  Cutter cutter(input);
  const std::string sums = Text(cutter.Datagram());
  const SumsOnDisk file(sums);
  Demand(sweep::IsSums(file.path()) == LooksLikeSums(sums), "only lines of checksums are sums");
  sweep::RowChecker checker(file.csv());
  Demand(checker.has_sums() == !sums.empty(), "a file with a byte has checksums");
  const std::vector<std::string> lines = WholeLines(sums);
  std::size_t same = 0;
  for (std::size_t row = 0; row < kMaxRows && !cutter.empty(); ++row) {
    const std::string text = Text(cutter.Datagram());
    const Verdict verdict = checker.Check(text);
    const Verdict due = row >= lines.size()                         ? Verdict::kNoSum
                        : lines[row] + '\n' == sweep::SumLine(text) ? Verdict::kSame
                                                                    : Verdict::kOther;
    Demand(verdict == due, "a row is compared with the line of its number");
    if (verdict == Verdict::kSame) ++same;
  }
  if (same > 0) Took();
}

/// The input that contains these checksums and rows.
Input Of(const std::string& sums, const std::vector<std::string>& rows) {
  const auto bytes = [](const std::string& text) {
    return runtime::Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  Input input;
  AddDatagram(bytes(sums), input);
  for (const std::string& row : rows) AddDatagram(bytes(row), input);
  return input;
}

}  // namespace

std::vector<Input> Seeds() {
  const std::vector<std::string> rows{"seed,si_pct", "1,62.5", "2,-3"};
  std::string sums;
  for (const std::string& row : rows) sums += sweep::SumLine(row);
  // FILE.sums is complete, or was cut by a kill, or was cut by a power failure.
  return {Of(sums, rows), Of(sums.substr(0, sums.size() - 4), rows),
          Of(sums.substr(0, sums.size() - 4) + std::string(4, '\0'), rows)};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundVerdicts({data, size});
  return 0;
}
