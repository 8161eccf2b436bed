// Every message type: from the bytes to the values that a reader gets. Input: an index into
// kChannels, then the message.
#include <algorithm>
#include <array>
#include <utility>

#include "services/runtime/wire/arrival.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

template <class M>
void DemandOneMeaning(runtime::Bytes bytes) {
  M message{};
  const bool whole = runtime::Decode(bytes, message);
  const bool finite = runtime::FirstNonFiniteField(message).empty();
  runtime::Arrival arrival;
  arrival.Renew(bytes, {});
  Demand((arrival.As<M>() != nullptr) == (whole && finite),
         "a reader is given what is whole and finite, and nothing else");
  const runtime::RefusalCounter expected = bytes.size() < runtime::kHeaderEnd ? &status_t::malformed
                                           : runtime::ReadInt64(bytes, 0) != M::getHash()
                                               ? &status_t::wrong_type
                                           : !whole  ? &status_t::malformed
                                           : !finite ? &status_t::not_finite
                                                     : nullptr;
  Demand(arrival.Wrong<M>() == expected, "a refusal names the defect of the message");
  if (!whole) return;
  Demand(std::ranges::equal(Encoded(message), bytes),
         "a decoded message encodes to the same bytes");
  M used = Sample<M>(1);
  Demand(runtime::Decode(bytes, used) && std::ranges::equal(Encoded(used), bytes),
         "nothing is left of an earlier message");
  Demand(!runtime::Decode(bytes.first(bytes.size() - 1), used),
         "a message without its end is refused");
  Input longer(bytes.begin(), bytes.end());
  longer.push_back(0);
  Demand(!runtime::Decode(longer, used), "a message with more bytes behind its end is refused");
  if (finite) Took();
}

template <class M>
void DemandNoOther(runtime::Bytes bytes) {
  M message{};
  Demand(!runtime::Decode(bytes, message), "a message is of one type only");
}

template <std::size_t... I>
void TryAll(std::size_t channel, runtime::Bytes bytes, std::index_sequence<I...>) {
  (
      [&] {
        using M = typename std::tuple_element_t<I, decltype(kGraph)>::Message;
        if (channel == I) DemandOneMeaning<M>(bytes);
        const bool of_another =
            bytes.size() >= runtime::kHeaderEnd && runtime::ReadInt64(bytes, 0) != M::getHash();
        if (of_another) DemandNoOther<M>(bytes);
      }(),
      ...);
}

}  // namespace

std::vector<Input> Seeds() {
  std::vector<Input> seeds;
  std::apply(
      [&](const auto&... each) {
        const auto add = [&]<class M>(const M& message) {
          Input seed = Encoded(message);
          seed.insert(seed.begin(), static_cast<std::uint8_t>(IndexOf<M>()));
          seeds.push_back(std::move(seed));
        };
        (add(Sample<typename std::decay_t<decltype(each)>::Message>(1)), ...);
      },
      kGraph);
  return seeds;
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  fogline::fuzz::TryAll(data[0] % fogline::kNumChannels, {data + 1, size - 1},
                        std::make_index_sequence<fogline::kNumChannels>{});
  return 0;
}
