// A request of a page to the server, read from a text frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace fogline::web {

using RequestId = std::uint32_t;

/// A request for all messages of some steps of a log.
struct StepsRequest {
  RequestId id = 0;
  std::int64_t from = 0;
  std::int64_t to = 0;

  static constexpr std::int64_t kMostSteps = 512;
};

/// A request for a field of a log over time.
struct SeriesRequest {
  RequestId id = 0;
  std::string channel;
  std::string field;
  std::int64_t from = 0;
  std::int64_t to = 0;
  std::int64_t points = 0;
  bool changes = false;  // whether to send only values that differ from the value before

  static constexpr std::int64_t kMostPoints = 20'000;
};

/// A request for the messages of a live network that came before the request.
struct HistoryRequest {
  RequestId id = 0;
};

/// A frame that is not a valid request. The sender of the frame gets the reason.
struct BadRequest {
  std::optional<RequestId> id;
  std::string why;
};

using ViewRequest = std::variant<StepsRequest, SeriesRequest, HistoryRequest, BadRequest>;

/// The id of a request, for its answer; nullopt if a bad request has none.
std::optional<RequestId> IdOf(const ViewRequest& request);

/// Reads a request. Never throws: a wrong text becomes a BadRequest.
ViewRequest ParseViewRequest(std::string_view text);
/// Reads a request from any frame. A binary frame becomes a BadRequest.
ViewRequest ParseViewFrame(std::string_view bytes, bool binary);

}  // namespace fogline::web
