#include "tools/sweep/row_sums.h"

#include <libdeflate.h>

#include <fmt/core.h>

namespace fogline::sweep {
namespace {

constexpr std::size_t kSumDigits = kSumLineBytes - 1;

}  // namespace

std::filesystem::path SumsFile(const std::filesystem::path& csv) {
  return std::filesystem::path(csv) += ".sums";
}

std::string SumLine(std::string_view row) {
  return fmt::format("{:08x}\n", libdeflate_crc32(0, row.data(), row.size()));
}

bool IsSums(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    if (in.eof()) line.erase(line.find_last_not_of('\0') + 1);
    const bool has_length = line.size() == kSumDigits || (in.eof() && line.size() < kSumDigits);
    if (!has_length || line.find_first_not_of("0123456789abcdef") != std::string::npos) {
      return false;
    }
  }
  return true;
}

RowChecker::RowChecker(const std::filesystem::path& csv) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(SumsFile(csv), ignored)) {
    sums_.open(SumsFile(csv), std::ios::binary);
  }
  has_sums_ = sums_.is_open() && sums_.peek() != std::ifstream::traits_type::eof();
}

RowChecker::Verdict RowChecker::Check(std::string_view row) {
  std::string line;
  if (!std::getline(sums_, line) || sums_.eof()) return Verdict::kNoSum;
  return line + '\n' == SumLine(row) ? Verdict::kSame : Verdict::kOther;
}

}  // namespace fogline::sweep
