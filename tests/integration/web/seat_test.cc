// `fogline view --seat`: the frames of a page become DRIVER_INPUT on the network of the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <set>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/drive/page_person.h"
#include "tests/integration/web/seat_network.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A frame of a page without a person.
std::string Away(std::int64_t sequence) {
  json frame = json::parse(Braking(sequence));
  frame["present"] = false;
  return frame.dump();
}

/// The answer to an input: "published" or "error".
json AnswerTo(WebClient& client) {
  while (true) {
    const WebFrame frame = client.Receive();
    if (frame.binary) continue;
    json answer = json::parse(frame.bytes);
    if (answer["op"] == "published" || answer["op"] == "error") return answer;
  }
}

TEST_F(SeatPageTest, PrintsTheAddressOfThePageAndThatOfTheView) {
  const std::string host = "http://127.0.0.1:" + std::to_string(port());
  ASSERT_TRUE(viewed_.process().WaitForOut(host + "/\n", kPatience));
  EXPECT_EQ(viewed_.process().Out(), host + "/drive\n" + host + "/\n");
  EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/drive"))), 200);
}

TEST_F(SeatPageTest, AnInputIsPublishedWithTheNewestStep) {
  WebClient page = Page(port());
  EXPECT_EQ(page.protocol(), "fogline.drive.v1");
  ReceiveOp(page, "hello");
  EXPECT_EQ(ReceiveOp(page, "seat")["state"], "yours");
  // When a DRIVER_INPUT names step 7, the seat has received TRUTH of step 7. The test waits for
  // this.
  network_.SendTruth(7);
  network_.Hear([](const driver_input_t& input) { return input.header.step == 7; });
  page.Send(Braking(40));
  const driver_input_t input = network_.Hear(IsThere);
  EXPECT_EQ(input.header.run_id, kSeatRun);
  EXPECT_EQ(input.header.step, 7);
  EXPECT_EQ(input.header.utime, 140'000);
  EXPECT_NE(input.instance, 0);
  EXPECT_EQ(input.brake, 0.5);
  EXPECT_EQ(input.buttons, driver_input_t::TAKE_OVER);
  EXPECT_EQ(input.device, "G29");
  EXPECT_EQ(input.latency_us, 21'000);
  const json published = ReceiveOp(page, "published");
  EXPECT_EQ(published["sequence"], 40);
  EXPECT_EQ(published["input"], input.sequence);
  EXPECT_EQ(published["instance"], std::to_string(input.instance));
  // `time_us` is a time of CLOCK_MONOTONIC. All processes of a machine share this clock, so the
  // test can compare `time_us` with its own clock.
  const double now_us = 1e6 * Seconds(Clock::now().time_since_epoch());
  EXPECT_GT(static_cast<double>(input.time_us), now_us - 60e6);
  EXPECT_LT(static_cast<double>(input.time_us), now_us);
}

TEST_F(SeatPageTest, APageSeesTheRunAndNothingElse) {
  WebClient page = Page(port());
  const json hello = ReceiveOp(page, "hello");
  std::set<std::string> channels;
  for (const json& channel : hello["channels"]) channels.insert(channel["name"]);
  EXPECT_EQ(channels, (std::set<std::string>{"TRUTH", "DRIVER_COMMAND", "HOST_COMMAND"}));
  EXPECT_FALSE(hello.contains("url"));
  // The test sends TRIAL and then TRUTH. The page gets only TRUTH.
  trial_t trial{};
  trial.condition = "secret";
  network_.Send(trial);
  network_.SendTruth(3);
  const auto messages = MessagesOf(ReceiveKind(page, 1));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].channel, IndexOf<truth_t>());
}

TEST_F(SeatPageTest, APageOfTheSeatIsNoViewer) {
  WebClient page = Page(port());
  ReceiveOp(page, "seat");
  WebClient viewer(port());
  const json health = ReceiveOp(viewer, "health");
  EXPECT_EQ(health["viewers"], 1);
  EXPECT_EQ(health["drivers"], 1);
}

TEST_F(SeatPageTest, APageThatIsOpenedLateIsToldWhenTheRequestBegan) {
  const auto command = [this](std::int64_t step, std::int8_t mode) {
    arbitration_t host{};
    host.header = {.run_id = kSeatRun, .step = step, .utime = step * 20'000};
    host.mode = mode;
    network_.Send(host);
  };
  WebClient page = Page(port());
  ReceiveOp(page, "seat");
  command(0, arbitration_t::AUTOMATION);
  command(5, arbitration_t::REQUEST);
  const json told = ReceiveOp(page, "request");
  EXPECT_EQ(told["since_s"], 0.1);
  EXPECT_EQ(told["begin_known"], true);
  command(400, arbitration_t::REQUEST_URGENT);
  WebClient late = Page(port());
  EXPECT_EQ(ReceiveOp(late, "request"), told);
}

TEST_F(SeatPageTest, AClosedSocketReleasesThePedalsAtOnce) {
  // The number of times that the program has reported a silent page. When the program answers the
  // GET request, it has already printed its reports of all earlier events.
  const auto silences = [this] {
    EXPECT_EQ(StatusOf(Exchange(port(), GetRequest(port(), "/drive"))), 200);
    const std::string err = viewed_.process().Err();
    int count = 0;
    for (std::size_t at = 0; (at = err.find("its page is silent", at)) != std::string::npos; ++at) {
      ++count;
    }
    return count;
  };
  // On a busy machine a page may count as silent before the test closes it. Then the test tries
  // again with another page.
  constexpr int kTries = 10;
  bool at_once = false;
  for (int i = 0; i < kTries && !at_once; ++i) {
    const int before = silences();
    std::optional<WebClient> page(Page(port()));
    page->Send(Braking(0));
    const driver_input_t there = network_.Hear(IsThere);
    page.reset();
    const driver_input_t away = network_.Hear(IsAway);
    EXPECT_EQ(away.brake, 0);
    EXPECT_EQ(away.buttons, 0);
    EXPECT_EQ(away.instance, there.instance);
    EXPECT_EQ(away.sequence, there.sequence + 1);
    at_once = silences() == before;
  }
  EXPECT_TRUE(at_once) << viewed_.process().Err();
  EXPECT_EQ(viewed_.End(), 0);
}

TEST_F(SeatPageTest, ASilentPageDrivesNoMoreAndIsTold) {
  WebClient page = Page(port());
  const TimePoint silent = Clock::now();  // the page sends its last message after this time
  page.Send(Braking(0));
  network_.Hear(IsThere);
  network_.Hear(IsAway);
  EXPECT_GT(Clock::now() - silent, milliseconds(250));
  ReceiveOp(page, "seat");  // with the state "yours"
  EXPECT_EQ(ReceiveOp(page, "seat")["state"], "lost");
  EXPECT_TRUE(viewed_.process().WaitForErr("its page is silent"));
  // While the page is silent, the seat tells the run every 50 ms that no person drives.
  const driver_input_t first = network_.Hear(IsAway);
  const driver_input_t second = network_.Hear(
      [&](const driver_input_t& input) { return input.sequence > first.sequence + 5; });
  EXPECT_FALSE(second.present);
  page.Send(Braking(1));
  network_.Hear(IsThere);
  EXPECT_EQ(ReceiveOp(page, "seat")["state"], "yours");
}

TEST_F(SeatPageTest, TheSecondPageIsToldThatTheSeatIsTaken) {
  const PagePerson first(port());
  network_.Hear(IsThere);
  WebClient second = Page(port());
  EXPECT_EQ(ReceiveOp(second, "seat")["state"], "taken");
  EXPECT_TRUE(viewed_.process().WaitForErr("another page has the seat"));
  json answer;
  while (answer["op"] != "error") {
    second.Send(Braking(0));
    answer = AnswerTo(second);
    if (answer["op"] == "error") break;
    // If the machine delays the first person for 300 ms, this person counts as absent, and the
    // second page gets the seat. Then the second page gives the seat back, and the test tries
    // again.
    second.Send(Away(1));
    // If the first person already has the seat again, the server does not answer this input. But
    // the server has already told the second page that the seat is taken.
    for (json told; told["op"] != "published" && told["state"] != "taken";) {
      const WebFrame frame = second.Receive();
      if (!frame.binary) told = json::parse(frame.bytes);
    }
    network_.Hear(IsThere);
  }
  EXPECT_THAT(answer["message"].get<std::string>(), HasSubstr("another person has the seat"));
  EXPECT_EQ(ReceiveOp(second, "seat")["state"], "taken");
}

TEST_F(SeatPageTest, APageThatIsOnlyOpenGivesTheSeatToThePersonAtAnother) {
  std::optional<WebClient> first(Page(port()));
  EXPECT_EQ(ReceiveOp(*first, "seat")["state"], "yours");
  WebClient second = Page(port());
  EXPECT_EQ(ReceiveOp(second, "seat")["state"], "taken");
  second.Send(Braking(0));
  network_.Hear(IsThere);
  EXPECT_EQ(ReceiveOp(second, "seat")["state"], "yours");
  // The first page sends nothing. On a busy machine it may lose the seat before the second page
  // gets the seat. Then the first page is told "lost" before it is told "taken".
  nlohmann::json told;
  do {
    told = ReceiveOp(*first, "seat");
  } while (told["state"] == "lost");
  EXPECT_EQ(told["state"], "taken");
  // The end of a page without the seat changes nothing.
  first.reset();
  second.Send(Braking(1));
  network_.Hear(IsThere);
}

TEST_F(SeatPageTest, AViewerCannotDriveAndADriverCannotAsk) {
  WebClient viewer(port());
  viewer.Send(Braking(0));
  EXPECT_EQ(ReceiveOp(viewer, "error")["id"], nullptr);
  WebClient page = Page(port());
  page.Send(R"({"op":"history","id":1})");
  EXPECT_THAT(ReceiveOp(page, "error")["message"].get<std::string>(), HasSubstr("\"input\""));
  network_.Hear(IsAway);
}

TEST_F(SeatPageTest, RefusesCountsAndNamesWhatIsOutOfRange) {
  WebClient page = Page(port());
  page.Send(Braking(0, 1.5));
  EXPECT_THAT(ReceiveOp(page, "error")["message"].get<std::string>(), HasSubstr("\"brake\""));
  page.Send("{");
  page.Send("\1\2", true);
  EXPECT_TRUE(viewed_.process().WaitForErr("wrong frame (1 so far): \"brake\""));
  EXPECT_TRUE(viewed_.process().WaitForErr("wrong frame (2 so far): this frame is no JSON"));
  EXPECT_TRUE(viewed_.process().WaitForErr("wrong frame (3 so far): inputs are text frames"));
  page.Send(Braking(1));
  network_.Hear(IsThere);
}

TEST_F(SeatPageTest, ClosesAPageThatSendsALargeFrame) {
  WebClient page = Page(port());
  page.Send(std::string((4 << 10) + 1, ' '));
  EXPECT_EQ(CloseCodeOf(page), 1009);
  EXPECT_TRUE(viewed_.process().WaitForErr("cut off: sends more than 4 KiB in a frame"));
}

TEST_F(SeatPageTest, RefusesAFloodAndThenClosesThePage) {
  WebClient page = Page(port());
  try {
    const std::string frame = Braking(0);
    for (int i = 0; i < 100'000; ++i) page.Send(frame);
  } catch (const WebClosed&) {
    // The server has cut the page off.
  }
  EXPECT_TRUE(viewed_.process().WaitForErr("more than 250 inputs a second"));
  EXPECT_TRUE(viewed_.process().WaitForErr("cut off: sends more than 500 frames a second"));
  network_.Hear(IsAway);
}

TEST_F(SeatPageTest, RefusesAPageOfAnotherOrigin) {
  EXPECT_THROW(WebClient(port(), {.protocol = "fogline.drive.v1", .origin = "http://evil.example"}),
               WebRefused);
  EXPECT_TRUE(viewed_.process().WaitForErr("refused: a page of another origin asks"));
}

TEST_F(SeatPageTest, TheEndOfTheProgramReleasesThePedals) {
  WebClient page = Page(port());
  page.Send(Braking(0));
  network_.Hear(IsThere);
  viewed_.process().Signal(SIGINT);
  network_.Hear(IsAway);
  EXPECT_EQ(viewed_.process().Wait(), 0);
}

TEST(SeatAccessTest, TheDriverHasATokenOfItsOwn) {
  const SeatNetwork network;
  Viewed viewed({"--seat", "--lcm-url", network.url()}, {"--listen", "127.0.0.1:0"});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  ASSERT_TRUE(viewed.process().WaitForOut("/#token=", kPatience));
  const auto token_behind = [&](const std::string& path) {
    const std::string out = viewed.process().Out();
    return out.substr(out.find(path + "#token=") + path.size() + 7, 32);
  };
  const std::string driver = token_behind("/drive");
  const std::string viewer = token_behind(std::to_string(viewed.port()) + "/");
  EXPECT_NE(driver, viewer);
  const auto status = [&](const std::string& protocol, const std::string& token) {
    try {
      const WebClient client(viewed.port(), {.target = "/ws?token=" + token, .protocol = protocol});
      return 101;
    } catch (const WebRefused& refused) {
      return refused.status();
    }
  };
  EXPECT_EQ(status("fogline.drive.v1", driver), 101);
  EXPECT_EQ(status("fogline.drive.v1", viewer), 403);
  EXPECT_EQ(status("fogline.drive.v1", ""), 403);
  EXPECT_EQ(status("fogline.view.v1", viewer), 101);
  EXPECT_EQ(status("fogline.view.v1", driver), 403);
  // The tokens are secret, so only stdout has them.
  EXPECT_THAT(viewed.process().Err(), Not(HasSubstr(driver)));
}

TEST(SeatAccessTest, TheTokensCanComeFromStdin) {
  const ScratchFolder folder;
  const std::string command =
      "exec " + Program("fogline") +
      " view --seat --no-browser --listen 127.0.0.1:0 --tokens-on-stdin --lcm-url '" +
      runtime::FreshMulticastUrl() + "' < " + folder.File("tokens");
  std::ofstream(folder.File("tokens")) << "viewers-viewers-\ndriver-driver-driver\n";
  Background good({"sh", "-c", command});
  ASSERT_TRUE(good.WaitForOut("/#token=viewers-viewers-\n", kPatience)) << good.Err();
  EXPECT_THAT(good.Out(), HasSubstr("/drive#token=driver-driver-driver\n"));
  good.Signal(SIGINT);
  EXPECT_EQ(good.Wait(), 0);
  const auto expect_refused = [&](const std::string& tokens, const std::string& why) {
    std::ofstream(folder.File("tokens")) << tokens;
    Background bad({"sh", "-c", command});
    EXPECT_EQ(bad.Wait(), 2);
    EXPECT_THAT(bad.Err(), HasSubstr("--tokens-on-stdin: " + why));
  };
  expect_refused("viewers-viewers-\n", "a line is no token");
  expect_refused("same-same-same-same\nsame-same-same-same\n", "both lines are the same token");
}

TEST(SeatAccessTest, WithoutTheOptionThereIsNoSeat) {
  Viewed viewed({"--lcm-url", runtime::FreshMulticastUrl()});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  EXPECT_THROW(Page(viewed.port()), WebRefused);
}

TEST(SeatAccessTest, ALogHasNoSeat) {
  const Outcome outcome =
      RunCommand({Program("fogline"), "view", "--no-browser", "--seat", "a.lcm"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--seat"));
}

TEST(SeatKeyTest, SignsWithTheKeyOfTheRun) {
  const ScratchFolder folder;
  const std::string file = folder.File("run.key");
  runtime::SigningKey::Create(file);
  SeatNetwork network(runtime::SigningKey::Load(file));
  Viewed viewed({"--seat", "--lcm-url", network.url(), "--key", file});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient page = Page(viewed.port());
  network.SendTruth(2);
  network.Hear([](const driver_input_t& input) { return input.header.step == 2; });
  page.Send(Braking(0));
  network.Hear(IsThere);
  EXPECT_EQ(network.bus().unverified().not_signed, 0);
  EXPECT_EQ(network.bus().unverified().badly_signed, 0);
}

}  // namespace
}  // namespace fogline::test
