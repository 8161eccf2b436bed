#include "services/log/driver_inputs.h"

#include "services/log/event_log.h"
#include "services/runtime/wire/driver_input.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::log {

void ForEachDriverInput(const std::filesystem::path& log, std::int64_t run_id,
                        const std::function<void(const driver_input_t&)>& use) {
  EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != ChannelOf<driver_input_t>().name) continue;
    // lcm-logger writes signed messages with their signatures. The message types have no field for
    // the signature, so the signature is removed before decoding.
    const bool is_signed = runtime::LooksSigned(event->data);
    driver_input_t input{};
    const auto wrong =
        runtime::Examine(is_signed ? runtime::WithoutSignature(event->data) : event->data, input);
    if (wrong != nullptr || runtime::WrongIn(input) != nullptr) continue;
    if (input.header.run_id == run_id) use(input);
  }
}

std::vector<driver_input_t> ReadDriverInputs(const std::filesystem::path& log,
                                             std::int64_t run_id) {
  std::vector<driver_input_t> inputs;
  ForEachDriverInput(log, run_id,
                     [&inputs](const driver_input_t& input) { inputs.push_back(input); });
  return inputs;
}

DriverInputs::DriverInputs(const std::vector<driver_input_t>& inputs) {
  for (const driver_input_t& input : inputs) {
    inputs_.try_emplace({input.instance, input.sequence}, input);
  }
}

const driver_input_t* DriverInputs::Find(std::int64_t instance, std::int64_t sequence) const {
  const auto found = inputs_.find({instance, sequence});
  return found == inputs_.end() ? nullptr : &found->second;
}

}  // namespace fogline::log
