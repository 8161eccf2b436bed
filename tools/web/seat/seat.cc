#include "tools/web/seat/seat.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/core.h>

namespace fogline::web {
namespace {

std::int64_t MicrosecondsOf(TimePoint time) {
  return duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

std::int64_t ToMicroseconds(double time_ms) { return static_cast<std::int64_t>(time_ms * 1e3); }

}  // namespace

Seat::Seat(std::int64_t instance) {
  message_.instance = instance;
  message_.latency_us = -1;
  message_.header.step = -1;
}

bool Seat::Sit(std::uint64_t client, TimePoint now) {
  if (client_) return client_ == client;
  client_ = client;
  heard_at_ = now;
  silent_ = false;
  return true;
}

std::optional<driver_input_t> Seat::Leave(std::uint64_t client, TimePoint now) {
  if (!Has(client)) return std::nullopt;
  client_.reset();
  silent_ = true;
  return EmptySeat(now);
}

Seat::Taken Seat::Take(std::uint64_t client, const SeatInput& input, TimePoint now) {
  Taken taken;
  const bool sits = !Has(client);
  if (sits && !input.present) return taken;
  if (sits && client_ && message_.present) {
    taken.why = "another person has the seat";
    return taken;
  }
  if (!sits) heard_at_ = now;
  // The rate limit never refuses an input that says that the person has left.
  const bool leaves = message_.present && !input.present;
  if (!limiter_.Take(now) && !leaves) {
    taken.too_many = true;
    taken.why = fmt::format("more than {} inputs a second", runtime::kMostInputsPerSecond);
    return taken;
  }
  if (sits) {
    taken.sits = true;
    taken.before = std::exchange(client_, client);
    heard_at_ = now;
  }
  silent_ = false;
  message_.time_us = std::max<std::int64_t>(0, MicrosecondsOf(now) - ToMicroseconds(input.age_ms));
  message_.latency_us = input.latency_ms ? ToMicroseconds(*input.latency_ms) : -1;
  message_.device_kind = input.device_kind;
  message_.device = input.device;
  message_.present = input.present;
  message_.throttle = input.present ? input.throttle : 0;
  message_.brake = input.present ? input.brake : 0;
  message_.num_axes = static_cast<std::int32_t>(input.axes.size());
  message_.axes = input.axes;
  message_.buttons = input.present ? input.buttons : 0;
  taken.message = Next(now);
  return taken;
}

std::optional<driver_input_t> Seat::Look(TimePoint now) {
  if (client_ && now - heard_at_ >= kSilent) silent_ = true;
  if (!silent_) return std::nullopt;
  // When a client becomes silent while its person is present, the first message of the empty seat
  // is sent immediately.
  if (!message_.present && now - sent_at_ < runtime::kInputEvery) return std::nullopt;
  return EmptySeat(now);
}

TimePoint Seat::next_look() const {
  return silent_ ? sent_at_ + runtime::kInputEvery : heard_at_ + kSilent;
}

driver_input_t Seat::Next(TimePoint now) {
  message_.sequence = sent_++;
  sent_at_ = now;
  return message_;
}

driver_input_t Seat::EmptySeat(TimePoint now) {
  message_.latency_us = -1;
  message_.present = false;
  message_.throttle = 0;
  message_.brake = 0;
  message_.num_axes = 0;
  message_.axes.clear();
  message_.buttons = 0;
  return Next(now);
}

}  // namespace fogline::web
