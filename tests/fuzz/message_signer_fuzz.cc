// The signatures of messages. Input: an index into kChannels, a role, the position of an alteration
// (two bytes), the alteration itself, and a message that may be signed.
#include <algorithm>
#include <array>

#include "services/runtime/wire/message_signer.h"
#include "tests/fuzz/samples.h"

namespace fogline::fuzz {
namespace {

runtime::SigningKey Key(std::uint8_t byte) {
  runtime::SigningKey::Secret secret{};
  secret.fill(byte);
  return runtime::SigningKey(secret);
}

bool IsGood(const runtime::MessageSigner& signer, std::string_view channel,
            runtime::Bytes message) {
  return signer.Open(channel, message).verdict == runtime::MessageSigner::Verdict::kGood;
}

/// Demands that a message with a good verdict was signed with the key, by one of the roles.
void DemandUnforgeable(const runtime::MessageSigner& signer, const ChannelInfo& channel,
                       runtime::Bytes message) {
  const runtime::MessageSigner::Opened opened = signer.Open(channel.name, message);
  Demand((opened.verdict == runtime::MessageSigner::Verdict::kNotSigned) ==
             !runtime::LooksSigned(message),
         "a message that looks signed is good or badly signed");
  if (opened.verdict != runtime::MessageSigner::Verdict::kGood) {
    Demand(opened.payload.empty(), "a message that is not good gives no payload");
    return;
  }
  bool signed_by_a_role = false;
  for (int role = 0; role <= static_cast<int>(Role::kRunner); ++role) {
    runtime::MessageSigner of_role(Key(1), static_cast<Role>(role));
    signed_by_a_role |= std::ranges::equal(of_role.Sign(channel.name, opened.payload), message);
  }
  Demand(signed_by_a_role, "a good message was signed");
  Took();
}

/// Demands that a signed message is good only with its own channel, its own key and its own bytes.
void DemandBinding(runtime::MessageSigner& signer, std::size_t place, Cutter& cutter,
                   runtime::Bytes payload) {
  const ChannelInfo& channel = kChannels[place];
  const runtime::Bytes sent = signer.Sign(channel.name, payload);
  Input message(sent.begin(), sent.end());
  const runtime::MessageSigner::Opened opened = signer.Open(channel.name, message);
  Demand(opened.verdict == runtime::MessageSigner::Verdict::kGood &&
             std::ranges::equal(opened.payload, payload),
         "a signed message is good, with the same payload");
  Demand(!IsGood(signer, kChannels[(place + 1) % kNumChannels].name, message),
         "it is not good for another channel");
  Demand(!IsGood(runtime::MessageSigner(Key(2), {}), channel.name, message),
         "it is not good for another key");
  std::size_t at = cutter.Byte();
  at = at << 8 | cutter.Byte();
  const auto change = static_cast<std::uint8_t>(std::max<int>(1, cutter.Byte()));
  message[at % message.size()] ^= change;
  Demand(!IsGood(signer, channel.name, message), "it is not good after a change");
}

void DemandNoOthersMessages(std::size_t place, std::uint8_t role, runtime::Bytes payload) {
  const ChannelInfo& channel = kChannels[place];
  const auto sender = static_cast<Role>(role % (static_cast<int>(Role::kRunner) + 1));
  runtime::MessageSigner signer(Key(1), sender);
  const runtime::Bytes sent = signer.Sign(channel.name, payload);
  if (channel.pace != Pace::kStep) return;
  Demand(
      IsGood(signer, channel.name, sent) == (sender == channel.from || sender == Role::kRecorder),
      "a step's message is good from its producer and the recorder");
}

}  // namespace

std::vector<Input> Seeds() {
  std::vector<Input> seeds;
  runtime::MessageSigner signer(Key(1), {});
  const auto add = [&](std::size_t channel, const Input& message) {
    Input seed{static_cast<std::uint8_t>(channel), 1, 0, 40, 1};
    seed.insert(seed.end(), message.begin(), message.end());
    seeds.push_back(seed);
    seed.resize(5);
    const runtime::Bytes sent = signer.Sign(kChannels[channel].name, message);
    seed.insert(seed.end(), sent.begin(), sent.end());
    seeds.push_back(seed);
  };
  add(IndexOf<ego_t>(), Encoded(Sample<ego_t>(1)));
  add(IndexOf<status_t>(), Encoded(Sample<status_t>(1)));
  add(IndexOf<resend_t>(), Encoded(Sample<resend_t>(1)));
  return seeds;
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogline;
  constexpr std::size_t kHead = 5;
  if (size < kHead) return 0;
  fuzz::Cutter head({data, kHead});
  const std::size_t channel = head.Byte() % kNumChannels;
  const std::uint8_t role = head.Byte();
  const runtime::Bytes message{data + kHead, size - kHead};
  runtime::MessageSigner signer(fuzz::Key(1), {});
  fuzz::DemandUnforgeable(signer, kChannels[channel], message);
  fuzz::DemandBinding(signer, channel, head, message);
  fuzz::DemandNoOthersMessages(channel, role, message);
  return 0;
}
