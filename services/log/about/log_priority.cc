#include "services/log/about/log_priority.h"

#include "fogline/log_priority_t.hpp"

namespace fogline::log {

std::vector<std::uint8_t> EncodePriority(const RealtimePriority& priority, std::int64_t run_id) {
  log_priority_t message{};
  message.header = {.run_id = run_id, .step = -1, .utime = 0};
  message.granted = priority.granted;
  message.refused = priority.refused;
  message.unknown = priority.unknown;
  message.num_granted = static_cast<std::int32_t>(priority.granted.size());
  message.num_refused = static_cast<std::int32_t>(priority.refused.size());
  message.num_unknown = static_cast<std::int32_t>(priority.unknown.size());
  std::vector<std::uint8_t> bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

std::optional<RealtimePriority> ReadPriority(const Event& event, std::int64_t run_id) {
  log_priority_t message{};
  if (!runtime::Decode(event.data, message) || message.header.run_id != run_id) return std::nullopt;
  return RealtimePriority{
      .granted = message.granted, .refused = message.refused, .unknown = message.unknown};
}

}  // namespace fogline::log
