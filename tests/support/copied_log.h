// Copies a log with changes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/log/event_log.h"

namespace fogline::test {

/// Copies a log event by event. `change` is called before each event is written. It may alter the
/// event, write other events, or return false to end the copy before this event.
template <class Change>
void Copy(const std::string& from, const std::string& to, const Change& change) {
  log::EventLogReader reader(from);
  log::EventLogWriter writer(to);
  while (const auto event = reader.Next()) {
    std::vector<std::uint8_t> data(event->data.begin(), event->data.end());
    if (!change(writer, *event, data)) return;
    writer.Write(event->channel, event->utime, data);
  }
}

}  // namespace fogline::test
