#include "tools/web/view_request.h"

#include <limits>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::web {
namespace {

using nlohmann::json;

/// @throws InputError if the member is missing, not a whole number, or out of range
std::int64_t WholeNumber(const json& request, const char* name, std::int64_t least,
                         std::int64_t most) {
  const auto found = request.find(name);
  const bool whole = found != request.end() && found->is_number_integer();
  // A number beyond int64 would wrap around.
  const bool huge = whole && found->is_number_unsigned() &&
                    found->get<std::uint64_t>() > static_cast<std::uint64_t>(most);
  if (!whole || huge || found->get<std::int64_t>() < least || found->get<std::int64_t>() > most) {
    throw InputError(fmt::format("\"{}\" must be a whole number from {} to {}", name, least, most));
  }
  return found->get<std::int64_t>();
}

std::string TextOf(const json& request, const char* name) {
  const auto found = request.find(name);
  if (found == request.end() || !found->is_string()) {
    throw InputError(fmt::format("\"{}\" must be a text", name));
  }
  return found->get<std::string>();
}

constexpr std::int64_t kMostStep = 1'000'000'000;

ViewRequest ParseSteps(const json& request, RequestId id) {
  StepsRequest steps{.id = id};
  steps.from = WholeNumber(request, "from", 0, kMostStep);
  steps.to = WholeNumber(request, "to", steps.from, kMostStep);
  if (steps.to - steps.from >= StepsRequest::kMostSteps) {
    throw InputError(fmt::format("at most {} steps in one request", StepsRequest::kMostSteps));
  }
  return steps;
}

ViewRequest ParseSeries(const json& request, RequestId id) {
  SeriesRequest series{.id = id};
  series.channel = TextOf(request, "channel");
  series.field = TextOf(request, "field");
  series.from = WholeNumber(request, "from", 0, kMostStep);
  series.to = WholeNumber(request, "to", series.from, kMostStep);
  series.points = WholeNumber(request, "points", 1, SeriesRequest::kMostPoints);
  if (const auto changes = request.find("changes"); changes != request.end()) {
    if (!changes->is_boolean()) throw InputError("\"changes\" must be true or false");
    series.changes = changes->get<bool>();
  }
  return series;
}

}  // namespace

ViewRequest ParseViewRequest(std::string_view text) {
  BadRequest bad;
  try {
    const json request = json::parse(text, nullptr, false);
    if (request.is_discarded()) throw InputError("this frame is no JSON");
    if (!request.is_object()) throw InputError("this frame is no JSON object");
    bad.id = static_cast<RequestId>(
        WholeNumber(request, "id", 0, std::numeric_limits<RequestId>::max()));
    const std::string op = TextOf(request, "op");
    if (op == "steps") return ParseSteps(request, *bad.id);
    if (op == "series") return ParseSeries(request, *bad.id);
    if (op == "history") return HistoryRequest{.id = *bad.id};
    throw InputError(fmt::format("there is no \"op\" {}", QuoteShort(op)));
  } catch (const InputError& error) {
    bad.why = error.what();
  }
  return bad;
}

std::optional<RequestId> IdOf(const ViewRequest& request) {
  return std::visit([](const auto& any) { return std::optional<RequestId>(any.id); }, request);
}

ViewRequest ParseViewFrame(std::string_view bytes, bool binary) {
  if (binary) return BadRequest{.id = std::nullopt, .why = "requests are text frames"};
  return ParseViewRequest(bytes);
}

}  // namespace fogline::web
