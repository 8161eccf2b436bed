#include "tools/export/mat_export.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "tools/export/matio_library.h"

namespace fogline::exports {
namespace {

// Beginning of a MAT-file of level 5. Readers evaluate only the first word. Unlike matio's default,
// this beginning has no time of day, so that equal logs give equal files.
constexpr const char* kHeader = "MATLAB 5.0 MAT-file, Fogline";
// MAT-files have sizes of 32 bits, and readers interpret these sizes as signed numbers.
constexpr std::size_t kMaxBytes = std::numeric_limits<std::int32_t>::max();
constexpr std::string_view kHeaderStruct = "header";
// Name of a field that a channel has only if messages are missing: 1 for a message, 0 for a gap.
constexpr const char* kHeard = "heard";

using Variable = Matio::Variable;

/// matio's two constants for one type of numbers.
struct MatType {
  matio_classes class_type;
  matio_types data_type;
};
constexpr MatType TypeOf(double) { return {MAT_C_DOUBLE, MAT_T_DOUBLE}; }
constexpr MatType TypeOf(std::int8_t) { return {MAT_C_INT8, MAT_T_INT8}; }
constexpr MatType TypeOf(std::int32_t) { return {MAT_C_INT32, MAT_T_INT32}; }
constexpr MatType TypeOf(std::int64_t) { return {MAT_C_INT64, MAT_T_INT64}; }

/// A field as a matrix with one row for each message. MAT-files store matrices column by column.
Variable MatrixOf(const FieldTable& field, std::size_t messages) {
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        std::vector<T> columns(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          columns[i % field.width * messages + i / field.width] = values[i];
        }
        std::array<std::size_t, 2> size{messages, field.width};
        const auto [class_type, data_type] = TypeOf(T());
        return Variable(Matio::Get().create_variable(nullptr, class_type, data_type, size.size(),
                                                     size.data(), columns.data(), 0));
      },
      field.values);
}

/// A struct with these fields, which have no values yet.
Variable StructOf(const char* name, const std::vector<std::string>& names) {
  std::vector<const char*> pointers;
  for (const std::string& one : names) pointers.push_back(one.c_str());
  const std::array<std::size_t, 2> size{1, 1};
  pointers.push_back(nullptr);  // marks the end
  return Variable(Matio::Get().create_struct(name, size.size(), size.data(), pointers.data()));
}

/// The field `heard`: 1 for each message of a channel, 0 for each gap.
FieldTable HeardOf(const ChannelTable& table) {
  std::vector<std::int8_t> heard(table.messages, 1);
  for (const std::size_t row : table.gaps) heard[row] = 0;
  return {.name = kHeard, .values = std::move(heard)};
}

/// The struct of a channel. In its struct `header`, the names of fields have no prefix "header.".
Variable StructOf(const ChannelTable& table) {
  const std::string prefix = std::string(kHeaderStruct) + '.';
  std::vector<std::string> of_header;
  std::vector<std::string> names{std::string(kHeaderStruct)};
  for (const FieldTable& field : table.fields) {
    const bool in_header = field.name.starts_with(prefix);
    (in_header ? of_header : names).push_back(field.name.substr(in_header ? prefix.size() : 0));
  }
  if (!table.gaps.empty()) names.emplace_back(kHeard);
  Variable all = StructOf(std::string(table.name).c_str(), names);
  Variable header = StructOf(nullptr, of_header);
  if (all == nullptr || header == nullptr) throw std::bad_alloc();
  for (const FieldTable& field : table.fields) {
    const bool in_header = field.name.starts_with(prefix);
    const std::string name = field.name.substr(in_header ? prefix.size() : 0);
    Variable matrix = MatrixOf(field, table.messages);
    if (matrix == nullptr) throw std::bad_alloc();
    Matio::Get().set_field((in_header ? header : all).get(), name.c_str(), 0, matrix.release());
  }
  if (!table.gaps.empty()) {
    Variable heard = MatrixOf(HeardOf(table), table.messages);
    if (heard == nullptr) throw std::bad_alloc();
    Matio::Get().set_field(all.get(), kHeard, 0, heard.release());
  }
  Matio::Get().set_field(all.get(), kHeaderStruct.data(), 0, header.release());
  return all;
}

std::size_t BytesOf(const ChannelTable& table) {
  std::size_t bytes = 0;
  for (const FieldTable& field : table.fields) {
    std::visit([&]<class T>(const std::vector<T>& values) { bytes += values.size() * sizeof(T); },
               field.values);
  }
  return bytes;
}

/// Throws an exception with the reason why matio could not write the tables. matio does not report
/// the reason. So this function writes zeros to the same file, about as many bytes as the tables
/// need. This write fails for the same reason, such as a full disk, and its exception states the
/// reason. If this write succeeds, the exception states no reason.
/// @throws std::runtime_error
[[noreturn]] void Fail(const RunTables& tables, const std::filesystem::path& path,
                       AtomicFile& file) {
  constexpr std::size_t kMostOfField = 1024;  // bytes of a field's name and matrix description
  const std::string zeros(1 << 20, '\0');
  std::size_t bytes = tables.scenario.size();
  for (const ChannelTable& table : tables.channels) {
    bytes += BytesOf(table) + kMostOfField * (table.fields.size() + 1);
  }
  for (std::size_t at = 0; at < bytes; at += zeros.size()) file.Write(zeros);
  file.Close();
  throw std::runtime_error(fmt::format("{}: cannot write the MAT-file", PathText(path)));
}

Variable TextVariable(const char* name, std::string text) {
  std::array<std::size_t, 2> size{1, text.size()};
  return Variable(Matio::Get().create_variable(name, MAT_C_CHAR, MAT_T_UINT8, size.size(),
                                               size.data(), text.data(), 0));
}

/// Whether the file has this number of variables, and all of them are complete. The sizes of the
/// variables must add up to the end of the file. This check is necessary because matio does not
/// report every failed write to a full disk.
bool IsWhole(const std::filesystem::path& file, std::size_t variables) {
  constexpr std::streamoff kHeaderBytes = 128;
  std::ifstream in(file, std::ios::binary);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file));
  std::streamoff at = kHeaderBytes;
  std::size_t whole = 0;
  std::array<std::uint32_t, 2> tag{};  // type and bytes
  while (at < size) {
    in.seekg(at);
    if (!in.read(reinterpret_cast<char*>(tag.data()), sizeof(tag))) return false;
    at += static_cast<std::streamoff>(sizeof(tag)) + tag[1];
    if (at <= size) ++whole;
  }
  return at == size && whole == variables;
}

}  // namespace

bool IsMatExport(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(std::strlen(kHeader), '\0');
  in.read(head.data(), std::ssize(head));
  return head == kHeader;
}

void WriteMat(const RunTables& tables, const std::filesystem::path& path) {
  for (const ChannelTable& table : tables.channels) {
    if (BytesOf(table) < kMaxBytes) continue;
    throw InputError(fmt::format(
        "{}: error: {} has more than the 2 GB that a variable of a MAT-file can have; export the "
        "log as CSV",
        PathText(path), table.name));
  }
  AtomicFile file(path);
  Matio::File mat(Matio::Get().create(file.part().c_str(), kHeader, MAT_FT_MAT5));
  if (mat == nullptr) Fail(tables, path, file);
  const auto write = [&](const Variable& variable) {
    if (variable == nullptr) throw std::bad_alloc();
    if (Matio::Get().write(mat.get(), variable.get(), MAT_COMPRESSION_NONE) == 0) return;
    mat.reset();
    Fail(tables, path, file);
  };
  for (const ChannelTable& table : tables.channels) {
    if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
    write(StructOf(table));
  }
  const bool has_scenario = !tables.scenario.empty();
  if (has_scenario) write(TextVariable("scenario", tables.scenario));
  const std::size_t variables = tables.channels.size() + (has_scenario ? 1 : 0);
  if (Matio::Get().close(mat.release()) != 0 || !IsWhole(file.part(), variables)) {
    Fail(tables, path, file);
  }
  file.Finish();
}

}  // namespace fogline::exports
