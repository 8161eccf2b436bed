#include "common/csv.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>

#include "common/parse_number.h"
#include "common/text.h"

namespace fogline {
namespace {

struct Cell {
  std::string_view text;
  std::uint32_t offset;
};

// Cuts a text into lines; offsets count from the beginning of the text.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text), at_(SkipByteOrderMark(text)) {}

  // The next line without its line end; nullopt after the last line.
  std::optional<Cell> Next() {
    if (at_ >= text_.size()) return std::nullopt;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    Cell line{.text = text_.substr(at_, end - at_), .offset = static_cast<std::uint32_t>(at_)};
    if (line.text.ends_with('\r')) line.text.remove_suffix(1);
    at_ = end + 1;
    return line;
  }

 private:
  std::string_view text_;
  std::size_t at_;
};

Cell Trim(Cell cell) {
  const std::size_t begin = std::min(cell.text.find_first_not_of(" \t"), cell.text.size());
  cell.text.remove_prefix(begin);
  cell.offset += static_cast<std::uint32_t>(begin);
  cell.text = cell.text.substr(0, cell.text.find_last_not_of(" \t") + 1);
  return cell;
}

void Split(const Cell& line, std::vector<Cell>& cells) {
  cells.clear();
  std::size_t begin = 0;
  while (begin <= line.text.size()) {
    const std::size_t end = std::min(line.text.find(',', begin), line.text.size());
    cells.push_back(Trim({.text = line.text.substr(begin, end - begin),
                          .offset = line.offset + static_cast<std::uint32_t>(begin)}));
    begin = end + 1;
  }
}

std::optional<double> ToFinite(std::string_view text) {
  const auto number = ParseNumber<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

}  // namespace

std::vector<std::string_view> CsvHeader(std::string_view text) {
  const std::optional<Cell> line = Lines(text).Next();
  if (!line || Trim(*line).text.empty()) return {};
  std::vector<Cell> cells;
  Split(*line, cells);
  std::vector<std::string_view> names;
  names.reserve(cells.size());
  for (const Cell& cell : cells) names.push_back(cell.text);
  return names;
}

std::string_view ForeignSeparator(std::span<const std::string_view> header) {
  if (header.size() != 1) return "";
  if (header.front().find(';') != std::string_view::npos) return "';'";
  return header.front().find('\t') != std::string_view::npos ? "tabs" : "";
}

std::vector<std::vector<CsvNumber>> ReadCsvColumns(std::string_view text,
                                                   const std::vector<std::size_t>& columns,
                                                   const CsvRefuse& refuse) {
  std::vector<std::vector<CsvNumber>> numbers(columns.size());
  Lines lines(text);
  lines.Next();  // the header
  std::vector<Cell> cells;
  std::optional<Cell> empty;  // an empty line, allowed only if no row follows
  while (const std::optional<Cell> line = lines.Next()) {
    if (Trim(*line).text.empty()) {
      if (!empty) empty = line;
      continue;
    }
    if (empty) refuse(std::exchange(empty, std::nullopt)->offset, "an empty line between rows");
    Split(*line, cells);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i] >= cells.size()) {
        refuse(line->offset, fmt::format("the row ends before column {}", columns[i] + 1));
        break;
      }
      const Cell& cell = cells[columns[i]];
      const std::optional<double> value = ToFinite(cell.text);
      if (!value) refuse(cell.offset, QuoteShort(cell.text) + " is not a number");
      numbers[i].push_back({.value = value.value_or(0.0), .offset = cell.offset});
    }
  }
  return numbers;
}

std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace fogline
