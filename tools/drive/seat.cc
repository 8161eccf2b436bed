#include "tools/drive/seat.h"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "common/process/poll.h"
#include "common/process/priority.h"
#include "services/graph.h"
#include "services/host_modes.h"
#include "services/runtime/seat/seat_instance.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/driver_input.h"

namespace fogline::drive {
namespace {

// The longest time that the thread waits for its device. The thread reads the messages of the run
// after this wait, so a message waits at most this long. In this time, a pedal that is controlled
// by a key moves by at most a fifth of its travel, because key_press_ps is at most 20 per second.
constexpr Duration kTick = milliseconds(10);
// The real-time priority of the thread. The roles other than the world have the same priority. On a
// busy machine a thread without this priority may be silent for so long that the person counts as
// absent. The thread needs little processor time.
constexpr int kPriority = 1;

/// The text that the person sees for a mode of HOST_COMMAND; "" if the mode has no text.
std::string_view TextOf(std::int8_t mode) {
  switch (mode) {
    case arbitration_t::REQUEST:
      return ">>> take over, please";
    case arbitration_t::REQUEST_URGENT:
      return ">>> TAKE OVER NOW";
    case arbitration_t::RECOVERING:
    case arbitration_t::HUMAN:
      return ">>> you drive";
    case arbitration_t::AUTOMATION:
      return ">>> the automation drives";
    default:
      return IsLocked(mode) || InMinimalRisk(mode) ? ">>> the car stops by itself" : "";
  }
}

}  // namespace

std::string FirstBytes(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t size = most;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;
  return text.substr(0, size);
}

InputMaker::InputMaker(std::int64_t run_id, std::int64_t instance, std::int8_t kind,
                       const std::string& name) {
  out_.header.run_id = run_id;
  out_.header.step = -1;
  out_.instance = instance;
  out_.sequence = -1;
  out_.latency_us = -1;
  out_.device_kind = kind;
  out_.device = FirstBytes(name, runtime::kMostDeviceBytes);
}

void InputMaker::SawTruth(const header_t& header) {
  if (header.run_id == out_.header.run_id && header.step > out_.header.step) out_.header = header;
}

bool InputMaker::Due(const PedalState& state, TimePoint now) const {
  if (out_.sequence < 0 || now - sent_at_ >= kEvery) return true;
  return !state.SameAs(sent_) && now - sent_at_ >= kLeast;
}

const driver_input_t& InputMaker::Make(const PedalState& state, TimePoint now) {
  using std::chrono::microseconds;
  sent_ = state;
  sent_at_ = now;
  ++out_.sequence;
  out_.time_us = duration_cast<microseconds>(state.at.time_since_epoch()).count();
  out_.present = state.present ? 1 : 0;
  out_.throttle = state.present ? std::clamp(state.throttle, 0.0, 1.0) : 0;
  out_.brake = state.present ? std::clamp(state.brake, 0.0, 1.0) : 0;
  out_.buttons = state.present ? state.buttons : 0;
  out_.axes = state.axes;
  out_.axes.resize(std::min<std::size_t>(state.axes.size(), runtime::kMostAxes));
  out_.num_axes = static_cast<std::int32_t>(out_.axes.size());
  return out_;
}

Seat::Seat(const std::string& url, std::int64_t run_id, const runtime::TrafficOptions& traffic,
           std::unique_ptr<PedalSource> source)
    : source_(std::move(source)), thread_([=, this] {
        try {
          Run(url, run_id, traffic);
        } catch (const std::exception& error) {
          Complain(fmt::format("fogline drive: error: the seat has ended: {}", error.what()));
        }
      }) {}

Seat::~Seat() {
  ends_ = true;
  thread_.join();
}

void Seat::Run(const std::string& url, std::int64_t run_id,
               const runtime::TrafficOptions& traffic) {
  // If the kernel refuses, this thread prints nothing: the runner prints the refusal for its roles.
  RunThreadBeforeOthers(kPriority);
  // --faults does not apply to the messages of a seat, because a seat is not a part of the run. The
  // seat signs its messages as the runner, because the runner is the sender of DRIVER_INPUT in
  // services/graph.h.
  const auto opened =
      runtime::OpenBus(url, {.key_file = traffic.key_file, .faults = ""}, Role::kRunner);
  runtime::Bus& bus = *opened;
  InputMaker maker(run_id, runtime::DrawSeatInstance(), source_->kind(), source_->name());
  bus.Subscribe(ChannelOf<truth_t>().name, [&](runtime::Arrival& arrival) {
    if (const auto* truth = arrival.As<truth_t>()) maker.SawTruth(truth->header);
  });
  bus.Subscribe(ChannelOf<arbitration_t>().name, [&](runtime::Arrival& arrival) {
    const auto* command = arrival.As<arbitration_t>();
    if (command != nullptr && command->header.run_id == run_id) Tell(command->mode);
  });
  std::vector<std::uint8_t> bytes;
  const auto send = [&](const PedalState& state, TimePoint now) {
    runtime::Encode(maker.Make(state, now), bytes);
    bus.Publish(ChannelOf<driver_input_t>().name, bytes);
  };
  while (!ends_) {
    PollFor(source_->fd(), POLLIN, kTick);
    bus.Drain();
    const TimePoint now = Clock::now();
    const PedalState state = source_->Read(now);
    if (maker.Due(state, now)) send(state, now);
  }
  send({.present = false, .axes = {}}, Clock::now());
}

void Seat::Tell(std::int8_t mode) {
  const std::string_view text = TextOf(mode);
  if (text.empty() || std::exchange(told_, text) == text) return;
  if (mode != arbitration_t::AUTOMATION) Draw("\a");
  Notice(text);
}

}  // namespace fogline::drive
