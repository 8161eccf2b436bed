#include "tools/web/seat/seat_frame.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/text.h"
#include "services/runtime/wire/driver_input.h"

namespace fogline::web {
namespace {

using nlohmann::json;

// The largest number up to which JavaScript represents every integer.
constexpr std::int64_t kMostSequence = (std::int64_t{1} << 53) - 1;

template <class Number>
struct Named {
  std::string_view name;
  Number number;
};
constexpr auto kButtons = std::to_array<Named<std::int32_t>>(
    {{"take_over", driver_input_t::TAKE_OVER}, {"give_back", driver_input_t::GIVE_BACK}});
constexpr auto kKinds = std::to_array<Named<std::int8_t>>({{"keyboard", driver_input_t::KEYBOARD},
                                                           {"gamepad", driver_input_t::GAMEPAD},
                                                           {"wheel", driver_input_t::WHEEL}});

/// The entry of a table whose name is `value`; nullptr if there is none.
template <class Table>
auto Find(const Table& table, const json& value) -> decltype(table.data()) {
  if (!value.is_string()) return nullptr;
  const auto found = std::ranges::find(table, std::string_view(value.get_ref<const std::string&>()),
                                       &Table::value_type::name);
  return found == table.end() ? nullptr : &*found;
}

/// @throws InputError if the member is missing
const json& MemberOf(const json& frame, const char* name) {
  const auto found = frame.find(name);
  if (found == frame.end()) throw InputError(fmt::format("\"{}\" is missing", name));
  return *found;
}

/// @throws InputError if the value is not a number in [least, most]
double NumberIn(const json& value, const char* name, double least, double most) {
  const double number = value.is_number() ? value.get<double>() : least - 1;
  if (!(number >= least && number <= most)) {  // also refuses NaN
    throw InputError(fmt::format("\"{}\" must be a number from {} to {}", name, least, most));
  }
  return number;
}

std::int64_t SequenceOf(const json& frame) {
  const json& value = MemberOf(frame, "sequence");
  // A number beyond int64 would wrap around.
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::uint64_t{kMostSequence}) {
    throw InputError(
        fmt::format("\"sequence\" must be a whole number from 0 to {}", kMostSequence));
  }
  return value.get<std::int64_t>();
}

std::vector<double> AxesOf(const json& frame) {
  const json& list = MemberOf(frame, "axes");
  if (!list.is_array() || list.size() > static_cast<std::size_t>(runtime::kMostAxes)) {
    throw InputError(
        fmt::format("\"axes\" must be a list of at most {} numbers", runtime::kMostAxes));
  }
  std::vector<double> axes;
  for (const json& value : list) axes.push_back(NumberIn(value, "axes", -1, 1));
  return axes;
}

std::int32_t ButtonsOf(const json& frame) {
  const json& list = MemberOf(frame, "buttons");
  std::int32_t buttons = 0;
  bool known = list.is_array() && list.size() <= kButtons.size();
  for (std::size_t i = 0; known && i < list.size(); ++i) {
    const auto* button = Find(kButtons, list[i]);
    known = button != nullptr;
    if (known) buttons |= button->number;
  }
  if (!known) throw InputError("\"buttons\" must be a list of \"take_over\" and \"give_back\"");
  return buttons;
}

void ReadDevice(const json& frame, SeatInput& input) {
  const json& device = MemberOf(frame, "device");
  if (!device.is_object()) throw InputError("\"device\" must be an object");
  const auto* kind = Find(kKinds, MemberOf(device, "kind"));
  if (kind == nullptr) {
    throw InputError("\"kind\" must be \"keyboard\", \"gamepad\" or \"wheel\"");
  }
  input.device_kind = kind->number;
  const json& name = MemberOf(device, "name");
  if (!name.is_string() || name.get_ref<const std::string&>().size() > runtime::kMostDeviceBytes ||
      HasControlCharacter(name.get_ref<const std::string&>())) {
    throw InputError(fmt::format("\"name\" must be a text of at most {} bytes in one line",
                                 runtime::kMostDeviceBytes));
  }
  input.device = name.get<std::string>();
}

/// @throws InputError that says what is wrong in the text
SeatInput ParseInput(std::string_view text) {
  const json frame = json::parse(text, nullptr, false);
  if (frame.is_discarded()) throw InputError("this frame is no JSON");
  if (!frame.is_object()) throw InputError("this frame is no JSON object");
  if (MemberOf(frame, "op") != "input") throw InputError("a seat takes only the \"op\" \"input\"");
  SeatInput input{.sequence = SequenceOf(frame)};
  input.age_ms = NumberIn(MemberOf(frame, "age_ms"), "age_ms", 0, kMostSeatTime_ms);
  const json& present = MemberOf(frame, "present");
  if (!present.is_boolean()) throw InputError("\"present\" must be true or false");
  input.present = present.get<bool>();
  input.throttle = NumberIn(MemberOf(frame, "throttle"), "throttle", 0, 1);
  input.brake = NumberIn(MemberOf(frame, "brake"), "brake", 0, 1);
  input.axes = AxesOf(frame);
  input.buttons = ButtonsOf(frame);
  ReadDevice(frame, input);
  if (const auto found = frame.find("latency_ms"); found != frame.end()) {
    input.latency_ms = NumberIn(*found, "latency_ms", 0, kMostSeatTime_ms);
  }
  return input;
}

}  // namespace

SeatFrame ParseSeatFrame(std::string_view text) {
  try {
    return ParseInput(text);
  } catch (const InputError& error) {
    return BadSeatFrame{error.what()};
  }
}

}  // namespace fogline::web
