// Reads columns of numbers from a CSV file with commas, a header line, and no quotes. Also writes a
// text as a cell.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fogline {

/// A number and the byte at which its cell begins.
struct CsvNumber {
  double value;
  std::uint32_t offset;
};

/// The header line's names, without the spaces around them.
std::vector<std::string_view> CsvHeader(std::string_view text);

/// The separator that a header line seems to use in place of ',', as text for a message: "';'" or
/// "tabs". The result is "" if the header line has no such separator.
std::string_view ForeignSeparator(std::span<const std::string_view> header);

/// Function that gets the faults of a file: each cell that is not a finite number, each row that
/// lacks a cell, and empty lines between rows.
using CsvRefuse = std::function<void(std::uint32_t offset, std::string message)>;

/// Returns the numbers of each column in `columns` (indices into the header), from top to bottom.
/// Accepts LF and CRLF, a byte order mark, spaces around cells, and empty lines at the end.
std::vector<std::vector<CsvNumber>> ReadCsvColumns(std::string_view text,
                                                   const std::vector<std::size_t>& columns,
                                                   const CsvRefuse& refuse);

/// A text as a cell of a CSV file: in quotes if a character requires them (RFC 4180).
std::string CsvCell(const std::string& text);

}  // namespace fogline
