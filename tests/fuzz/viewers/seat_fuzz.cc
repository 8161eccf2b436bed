// The seat of `fogline drive`. Input: for each event a byte and a datagram. The low bits of the
// byte name the event: a frame of one of two pages (0, 1), a new page (2, 3), the end of a page (4,
// 5), or a time that passes (6, 7). The high bits tell the amount of time.
#include <string>
#include <string_view>
#include <variant>

#include "services/runtime/wire/driver_input.h"
#include "tests/fuzz/samples.h"
#include "tools/web/seat/seat.h"
#include "tools/web/seat/seat_frame.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxEvents = 256;

/// Checks the messages of a seat. They must be valid for any frames of the pages.
class Listener {
 public:
  void Hear(const driver_input_t& message, TimePoint now) {
    Demand(runtime::WrongIn(message) == nullptr, "the driver role would take the message");
    Demand(message.present || (message.throttle == 0 && message.brake == 0 && message.buttons == 0),
           "an empty seat presses no pedal and no button");
    Demand(message.sequence == next_++, "messages are numbered from 0");
    Demand(message.time_us >= 0, "an input has a time");
    Demand(static_cast<std::size_t>(message.num_axes) == message.axes.size(),
           "the length of the axes is right");
    const Input bytes = Encoded(message);
    driver_input_t again;
    Demand(runtime::Decode({bytes.data(), bytes.size()}, again), "the message can be decoded");
    Demand(Encoded(again) == bytes, "the decoded message is the same");
    heard_at_ = now;
    present_ = message.present;
  }
  /// @pre Look() of the seat was called at this time
  void DemandHeard(TimePoint now) const {
    // After kSilent without a frame, the seat sends a message every kInputEvery. The tolerance is
    // two of these periods.
    Demand(now - heard_at_ < web::Seat::kSilent + 2 * runtime::kInputEvery,
           "the run hears from the seat");
    Demand(next_ > 0, "the run hears from the seat");
  }
  bool present() const { return present_; }

 private:
  std::int64_t next_ = 0;
  TimePoint heard_at_{};
  bool present_ = false;
};

void DemandSoundSeat(runtime::Bytes input) {
  web::Seat seat(1);
  Listener listener;
  TimePoint now(std::chrono::seconds(1));
  const auto hear = [&](const std::optional<driver_input_t>& message) {
    if (message) listener.Hear(*message, now);
  };
  Cutter cutter(input);
  for (std::size_t i = 0; i < kMaxEvents && !cutter.empty(); ++i) {
    const std::uint8_t event = cutter.Byte();
    const runtime::Bytes bytes = cutter.Datagram();
    const std::uint64_t client = event & 1U;
    now += milliseconds(event >> 3U);
    hear(seat.Look(now));
    listener.DemandHeard(now);
    switch ((event >> 1U) & 3U) {
      case 0: {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const web::SeatFrame frame = web::ParseSeatFrame(text);
        if (const auto* bad = std::get_if<web::BadSeatFrame>(&frame)) {
          Demand(!bad->why.empty() && Printable(bad->why), "a refusal can be printed");
          break;
        }
        Took();
        const auto& sent = std::get<web::SeatInput>(frame);
        const bool idle = !sent.present && !seat.Has(client);  // an idle page without the seat
        const bool taken_before = listener.present();
        const web::Seat::Taken taken = seat.Take(client, sent, now);
        if (idle) {
          Demand(!taken.message && taken.why.empty() && !taken.sits, "an idle page does nothing");
          break;
        }
        Demand(taken.message.has_value() == taken.why.empty(), "an input is taken or refused");
        Demand(!taken.sits || !taken_before,
               "the seat of a person who drives stays with this person");
        Demand(!taken.message || seat.Has(client), "only the page that has the seat drives");
        hear(taken.message);
        break;
      }
      case 1:
        Demand(seat.Sit(client, now) == seat.Has(client), "who may sit has the seat");
        Demand(seat.client().has_value(), "a client has the seat");
        break;
      case 2: {
        const bool had = seat.Has(client);
        const auto message = seat.Leave(client, now);
        Demand(message.has_value() == had, "who leaves the seat releases the pedals at once");
        hear(message);
        Demand(!had || !listener.present(), "who leaves the seat drives no more");
        break;
      }
      default:
        break;
    }
  }
}

void Add(std::uint8_t event, std::string_view text, Input& input) {
  input.push_back(event);
  AddDatagram({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, input);
}

}  // namespace

std::vector<Input> Seeds() {
  constexpr std::string_view kBrakes =
      R"({"op":"input","sequence":1,"age_ms":4.5,"present":true,"throttle":0,"brake":0.5,)"
      R"("axes":[0.1,-1],"buttons":["take_over"],"device":{"kind":"wheel","name":"G29"},)"
      R"("latency_ms":17})";
  constexpr std::string_view kAway =
      R"({"op":"input","sequence":2,"age_ms":0,"present":false,"throttle":0,"brake":0,"axes":[],)"
      R"("buttons":[],"device":{"kind":"keyboard","name":"Keyboard"}})";
  constexpr std::uint8_t kFrame = 0, kSit = 2, kLeave = 4, kWait = 6, kOther = 1, kLong = 31 << 3;
  Input drives;
  Add(kSit, "", drives);
  Add(kFrame, kBrakes, drives);
  Add(kFrame, kAway, drives);
  Add(kSit | kOther, "", drives);
  Add(kFrame | kOther, kBrakes, drives);
  Add(kLeave, "", drives);
  Input silent;
  Add(kSit, "", silent);
  Add(kFrame, kBrakes, silent);
  for (int i = 0; i < 12; ++i) Add(kWait | kLong, "", silent);
  Add(kFrame, kBrakes, silent);
  return {drives, silent};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundSeat({data, size});
  return 0;
}
