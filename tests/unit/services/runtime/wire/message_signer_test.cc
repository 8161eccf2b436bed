#include "services/runtime/wire/message_signer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "tests/support/command.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_errors.h"
#include "tests/support/machine.h"

namespace fogline {
namespace {

using test::ScratchFolder;
using testing::HasSubstr;
using Verdict = runtime::MessageSigner::Verdict;
using Message = std::vector<std::uint8_t>;

constexpr auto kOwnerAlone =
    std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;

runtime::SigningKey KeyOf(std::uint8_t byte) {
  runtime::SigningKey::Secret secret{};
  secret.fill(byte);
  return runtime::SigningKey(secret);
}

Message Copy(runtime::Bytes bytes) { return {bytes.begin(), bytes.end()}; }

template <class M>
Message PayloadOf(const M& message) {
  Message bytes;
  runtime::Encode(message, bytes);
  return bytes;
}

Message StatusOf(std::string_view role) {
  status_t status{};
  status.role = role;
  return PayloadOf(status);
}

const Message kRadar = PayloadOf(radar_t{});

/// A role signs a message. @return the verdict of a receiver with the same key
Verdict VerdictOn(Role sender, std::string_view channel, runtime::Bytes payload) {
  runtime::MessageSigner signer(KeyOf(1), sender);
  return runtime::MessageSigner(KeyOf(1), Role::kWorld)
      .Open(channel, signer.Sign(channel, payload))
      .verdict;
}

TEST(MessageSignerTest, GivesThePayloadBackAsItWas) {
  runtime::MessageSigner radar(KeyOf(1), Role::kRadar);
  const Message message = Copy(radar.Sign("RADAR", kRadar));
  EXPECT_EQ(message.size(), kRadar.size() + runtime::kSignatureBytes);
  const auto [verdict, payload] =
      runtime::MessageSigner(KeyOf(1), Role::kFusion).Open("RADAR", message);
  EXPECT_EQ(verdict, Verdict::kGood);
  EXPECT_EQ(Copy(payload), kRadar);
  EXPECT_EQ(Copy(runtime::WithoutSignature(message)), kRadar);
}

TEST(MessageSignerTest, NoticesEveryBitThatIsWrong) {
  runtime::MessageSigner signer(KeyOf(1), Role::kRadar);
  Message message = Copy(signer.Sign("RADAR", kRadar));
  for (std::size_t bit = 0; bit < 8 * message.size(); ++bit) {
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    message[bit / 8] ^= mask;
    EXPECT_NE(signer.Open("RADAR", message).verdict, Verdict::kGood) << "bit " << bit;
    message[bit / 8] ^= mask;
  }
  EXPECT_EQ(signer.Open("RADAR", message).verdict, Verdict::kGood);
}

TEST(MessageSignerTest, NoticesEveryCut) {
  runtime::MessageSigner signer(KeyOf(1), Role::kRadar);
  const Message message = Copy(signer.Sign("RADAR", kRadar));
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_EQ(signer.Open("RADAR", runtime::Bytes(message).first(size)).verdict,
              Verdict::kNotSigned)
        << size;
  }
}

TEST(MessageSignerTest, RefusesOtherKeysAndOtherChannels) {
  runtime::MessageSigner signer(KeyOf(1), Role::kWorld);
  const Message message = Copy(signer.Sign("TRUTH", kRadar));
  EXPECT_EQ(runtime::MessageSigner(KeyOf(2), Role::kWorld).Open("TRUTH", message).verdict,
            Verdict::kBadlySigned);
  EXPECT_EQ(signer.Open("HOST_EGO", message).verdict, Verdict::kBadlySigned);
}

TEST(MessageSignerTest, TakesNoSenderForAnother) {
  // The recorder, too, may send messages on RADAR. But the radar has signed this message. So the
  // message is refused if it names the recorder as its sender.
  runtime::MessageSigner signer(KeyOf(1), Role::kRadar);
  Message message = Copy(signer.Sign("RADAR", kRadar));
  constexpr std::size_t kSenderFromTheEnd = 17;  // the second byte of the sender, before the tag
  message[message.size() - kSenderFromTheEnd] = static_cast<std::uint8_t>(Role::kRecorder);
  EXPECT_EQ(signer.Open("RADAR", message).verdict, Verdict::kBadlySigned);
}

TEST(MessageSignerTest, HasTheTagOfTheProtocol) {
  const std::string_view channel = "RADAR";
  const Message message =
      Copy(runtime::MessageSigner(KeyOf(1), Role::kRadar).Sign(channel, kRadar));
  Message hashed(channel.begin(), channel.end());
  hashed.insert(hashed.end(), {0, 0, static_cast<std::uint8_t>(Role::kRadar)});
  hashed.insert(hashed.end(), kRadar.begin(), kRadar.end());
  const Message key(32, 1);
  Message tag(16);
  ASSERT_EQ(crypto_generichash(tag.data(), tag.size(), hashed.data(), hashed.size(), key.data(),
                               key.size()),
            0);
  EXPECT_EQ(Message(message.end() - 16, message.end()), tag);
}

TEST(MessageSignerTest, TakesAStepFromItsProducerAndTheRecorderAlone) {
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    for (const RoleInfo& info : kRoles) {
      const bool may = info.role == channel.from || info.role == Role::kRecorder;
      EXPECT_EQ(VerdictOn(info.role, channel.name, kRadar),
                may ? Verdict::kGood : Verdict::kBadlySigned)
          << channel.name << " from " << info.name;
    }
  }
}

TEST(MessageSignerTest, TakesRunFromTheRunnerAloneAndResendFromEveryRole) {
  EXPECT_EQ(VerdictOn(Role::kRunner, "RUN", kRadar), Verdict::kGood);
  EXPECT_EQ(VerdictOn(Role::kRunner, "RESEND", kRadar), Verdict::kGood);
  for (const RoleInfo& info : kRoles) {
    EXPECT_EQ(VerdictOn(info.role, "RUN", kRadar), Verdict::kBadlySigned) << info.name;
    EXPECT_EQ(VerdictOn(info.role, "RESEND", kRadar), Verdict::kGood) << info.name;
  }
}

TEST(MessageSignerTest, TakesAStatusFromTheRoleThatItNamesAlone) {
  EXPECT_EQ(VerdictOn(Role::kRadar, "STATUS", StatusOf("radar")), Verdict::kGood);
  EXPECT_EQ(VerdictOn(Role::kRadar, "STATUS", StatusOf("lidar")), Verdict::kBadlySigned);
  EXPECT_EQ(VerdictOn(Role::kRecorder, "STATUS", StatusOf("lidar")), Verdict::kBadlySigned);
  EXPECT_EQ(VerdictOn(Role::kRadar, "STATUS", StatusOf("pilot")), Verdict::kBadlySigned);
  EXPECT_EQ(VerdictOn(Role::kRadar, "STATUS", runtime::Bytes(kRadar).first(34)),
            Verdict::kBadlySigned);
}

TEST(MessageSignerTest, SignsAsEveryRoleInAProcessThatIsAll) {
  runtime::MessageSigner all(KeyOf(1), std::nullopt);
  for (const ChannelInfo& channel : kChannels) {
    const Message payload = channel.name == "STATUS" ? StatusOf("acc") : kRadar;
    EXPECT_EQ(all.Open(channel.name, all.Sign(channel.name, payload)).verdict, Verdict::kGood)
        << channel.name;
  }
}

TEST(MessageSignerTest, LeavesASignedMessageToLcmsOwnDecodersAndNoneToOurs) {
  runtime::MessageSigner signer(KeyOf(1), Role::kRadar);
  const Message message = Copy(signer.Sign("RADAR", kRadar));
  radar_t decoded{};
  // Calls the generated decoder as LCM's own programs do.
  EXPECT_GE(decoded.decode(message.data(), 0, static_cast<int>(message.size())), 0);
  EXPECT_FALSE(runtime::Decode(message, decoded));
}

TEST(SigningKeyTest, IsMadeForItsOwnerAloneAndReadAgain) {
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  runtime::SigningKey::Create(file);
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  const runtime::SigningKey key = runtime::SigningKey::Load(file);
  runtime::SigningKey::Create(folder.File("other"));
  EXPECT_NE(key.secret(), runtime::SigningKey::Load(folder.File("other")).secret());
}

TEST(SigningKeyTest, IsNeverReplaced) {
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  runtime::SigningKey::Create(file);
  const runtime::SigningKey key = runtime::SigningKey::Load(file);
  EXPECT_THROW(runtime::SigningKey::Create(file), InputError);
  EXPECT_EQ(runtime::SigningKey::Load(file).secret(), key.secret());
  EXPECT_THROW(runtime::SigningKey::Create(folder.File("no/folder/key")), InputError);
}

TEST(SigningKeyTest, ThatDoesNotFitOnTheDiskIsAFailureAndNoBadInput) {
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  const test::FileSizeLimit limit(10);
  try {
    runtime::SigningKey::Create(file);
    FAIL() << "the key fits";
  } catch (const InputError& error) {
    FAIL() << error.what();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file + ": cannot write: File too large");
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(SigningKeyTest, IsReadFrom64HexadecimalDigitsAndNothingElse) {
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  const std::string digits(64, 'a');
  const auto load = [&](const std::string& content) {
    std::ofstream(file) << content;
    std::filesystem::permissions(file, kOwnerAlone);
    return runtime::SigningKey::Load(file).secret();
  };
  runtime::SigningKey::Secret expected{};
  expected.fill(0xaa);
  for (const std::string& good :
       {digits, digits + "\n", digits + "\n\n", digits + "\r\n", std::string(64, 'A')}) {
    EXPECT_EQ(load(good), expected);
  }
  for (const std::string& bad :
       {std::string(), digits + "a", digits + digits, digits.substr(1), "x" + digits.substr(1),
        " " + digits, digits.substr(0, 32) + "\n" + digits.substr(32), std::string(64, '0'),
        digits + "\n\n\n", digits + "\r\n\r\n", digits + "\n\n\n" + digits}) {
    EXPECT_THROW(load(bad), InputError) << bad;
  }
  EXPECT_THROW(runtime::SigningKey::Load(folder.File("none")), InputError);
  EXPECT_THROW(runtime::SigningKey::Load(folder.path()), InputError);
}

TEST(SigningKeyTest, IsNotReadFromAPipeWhichMayHaveNoWriter) {
  const ScratchFolder folder;
  const std::string pipe = folder.File("key");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(runtime::SigningKey::Load(pipe), InputError);
}

/// The error text for a key file; "" if the file is accepted.
std::string Complaint(const std::string& file) {
  return test::ErrorOf([&file] { runtime::SigningKey::Load(file); });
}

TEST(SigningKeyTest, IsRefusedIfGroupOrOthersCanReadOrChangeItsFile) {
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  runtime::SigningKey::Create(file);
  for (const mode_t mode : {0640U, 0620U, 0604U, 0602U, 0666U}) {
    ASSERT_EQ(chmod(file.c_str(), mode), 0);
    EXPECT_EQ(Complaint(file),
              fmt::format("{0}: error: others can read or change this key (mode {1:o}); chmod 600 "
                          "{0}",
                          file, mode));
  }
  for (const mode_t mode : {0600U, 0400U}) {
    ASSERT_EQ(chmod(file.c_str(), mode), 0);
    EXPECT_EQ(Complaint(file), "");
  }
}

TEST(SigningKeyTest, IsRefusedIfItsFileBelongsToAnotherUser) {
  if (geteuid() != 0) return test::MachineLacks("root, to give a file away");
  const ScratchFolder folder;
  const std::string file = folder.File("key");
  runtime::SigningKey::Create(file);
  constexpr uid_t kOtherUser = 65534;
  ASSERT_EQ(chown(file.c_str(), kOtherUser, kOtherUser), 0);
  EXPECT_THAT(Complaint(file), HasSubstr("error: the key belongs to user 65534"));
}

}  // namespace
}  // namespace fogline
