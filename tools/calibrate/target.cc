#include "tools/calibrate/target.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "common/file.h"
#include "common/text.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"
#include "scenario/io/loader.h"
#include "scenario/sections/field_text.h"
#include "scenario/sections/field_view.h"

namespace fogline::calibrate {
namespace {

std::optional<double> AsNumber(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return static_cast<double>(*integer);
  if (const auto* number = value.As<double>()) return *number;
  return std::nullopt;
}

/// Reads a number of a target row into `field`. `field` is a field of a PublishedRow, because
/// target rows have the same fields and ranges as the published rows of a scenario. A missing
/// number becomes NaN.
void ReadField(const JsonObject& object, const Field& field, DiagnosticList& diagnostics) {
  const auto& [value, spec] = *field.As<NumberField>();
  *value = std::nan("");
  const JsonMember* member = FindMember(object, field.name);
  if (member == nullptr || member->value.As<std::monostate>() != nullptr) return;
  const auto refuse = [&](std::string message) {
    diagnostics.Add(member->value.place, field.pointer, "range", std::move(message));
  };
  const std::optional<double> number = AsNumber(member->value);
  if (!number) {
    refuse(fmt::format("must be {}, not {}", Allowed(spec), Describe(member->value)));
  } else if (*number < spec.min || *number > spec.max) {
    refuse(fmt::format("{} is outside {}", NumberText(*number), Range(spec)));
  } else {
    *value = *number;
  }
}

std::optional<double> Present(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

std::optional<TargetRow> ReadRow(const JsonValue& value, const std::string& pointer,
                                 DiagnosticList& diagnostics) {
  const auto* object = value.As<JsonObject>();
  const JsonMember* threshold = object ? FindMember(*object, "threshold") : nullptr;
  if (threshold == nullptr || !AsNumber(threshold->value)) {
    diagnostics.Add(value.place, pointer, "missing-key",
                    "must be an object with a number \"threshold\"");
    return std::nullopt;
  }
  PublishedRow row;
  for (const Field& field : FieldsOf(row, pointer)) ReadField(*object, field, diagnostics);
  return TargetRow{
      .threshold = row.threshold, .si_pct = Present(row.si_pct), .rhe_pct = Present(row.rhe_pct)};
}

std::vector<TargetRow> ReadRows(const JsonValue& root, DiagnosticList& diagnostics) {
  const auto* object = root.As<JsonObject>();
  const JsonMember* rows = object != nullptr ? FindMember(*object, "rows") : nullptr;
  const auto* items = rows != nullptr ? rows->value.As<JsonArray>() : nullptr;
  std::vector<TargetRow> target;
  if (items == nullptr || items->empty()) {
    diagnostics.Add(rows != nullptr ? rows->value.place : root.place, "/rows", "missing-key",
                    "a target needs a list of rows, each with threshold, si_pct and rhe_pct");
    return target;
  }
  for (std::size_t i = 0; i < items->size(); ++i) {
    const std::string pointer = fmt::format("/rows/{}", i);
    if (const auto row = ReadRow((*items)[i], pointer, diagnostics)) target.push_back(*row);
  }
  return target;
}

/// Throws all diagnostics as one error. Each diagnostic has its position in the file, but no hint
/// about the fields of scenarios, because the file is no scenario.
[[noreturn]] void Throw(DiagnosticList& diagnostics, const std::vector<Source>& sources) {
  std::string text;
  try {
    diagnostics.Throw(sources);
  } catch (const ScenarioError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) {
      text += fmt::format("{}{}:{}:{}: error: {}{}{}", text.empty() ? "" : "\n", diagnostic.file,
                          diagnostic.line, diagnostic.column, diagnostic.pointer,
                          diagnostic.pointer.empty() ? "" : ": ", diagnostic.message);
    }
  }
  throw InputError(text);
}

}  // namespace

std::vector<TargetRow> ReadTarget(const std::filesystem::path& file) {
  const FileText read = ReadFile(file, kMaxFileBytes, ".json");
  if (!read.error.empty()) {
    throw InputError(fmt::format("{}: error: --target: {}", PathText(file), read.error));
  }
  DiagnosticList diagnostics;
  std::vector<TargetRow> target;
  if (const auto root = ParseJson(read.text, 0, diagnostics)) target = ReadRows(*root, diagnostics);
  if (!diagnostics.empty()) Throw(diagnostics, {{.name = file.string(), .text = read.text}});
  const auto has_number = [](const TargetRow& row) { return row.si_pct || row.rhe_pct; };
  if (std::none_of(target.begin(), target.end(), has_number)) {
    throw InputError(fmt::format("{}: error: /rows: no row has si_pct or rhe_pct", PathText(file)));
  }
  return target;
}

std::vector<TargetRow> PublishedTarget(const Scenario& scenario) {
  std::vector<TargetRow> target;
  for (const PublishedRow& row : scenario.published) {
    target.push_back({.threshold = row.threshold, .si_pct = row.si_pct, .rhe_pct = row.rhe_pct});
  }
  return target;
}

}  // namespace fogline::calibrate
